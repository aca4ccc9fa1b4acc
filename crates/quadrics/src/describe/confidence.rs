//! How sure the type of a region's surface is.

use crate::surface::select::{CAP, Choice};

/// A runner-up of less probability than this is far behind.
const NOTEWORTHY: f64 = 0.05;

/// Probability that `best` is of the right type, in [0, 1].
///
/// The criterion is minus twice the logarithm of a posterior, so half its difference to the second
/// best type goes through a logistic curve; times the part of the residual that noise explains: all of
/// it up to a mean square of one sigma, nothing where every distance is capped.
pub fn confidence(best: &Choice, second: Option<&Choice>) -> f64 {
    preference(best, second) * explained(best.misfit)
}

/// Whether the second best type deserves to be named.
pub fn is_noteworthy(best: &Choice, second: &Choice) -> bool {
    1.0 - preference(best, Some(second)) > NOTEWORTHY
}

fn preference(best: &Choice, second: Option<&Choice>) -> f64 {
    let margin = second.map_or(f64::INFINITY, |second| second.criterion - best.criterion);
    1.0 / (1.0 + (-margin / 2.0).exp())
}

fn explained(misfit: f64) -> f64 {
    (1.0 - (misfit - 1.0) / (CAP - 1.0)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Surface;

    #[test]
    fn a_tie_is_a_coin_toss_and_a_misfit_is_no_answer() {
        let choice = |misfit, criterion| Choice { surface: Surface::FreeForm, misfit, criterion };
        let best = choice(0.9, 100.0);
        assert_eq!(confidence(&best, Some(&choice(1.0, 100.0))), 0.5);
        assert_eq!(confidence(&best, None), 1.0);
        assert!(confidence(&best, Some(&choice(1.0, 120.0))) > 0.999);
        assert_eq!(confidence(&choice(CAP, 100.0), None), 0.0);
        assert!(is_noteworthy(&best, &choice(1.0, 104.0)));
        assert!(!is_noteworthy(&best, &choice(1.0, 108.0)));
    }
}
