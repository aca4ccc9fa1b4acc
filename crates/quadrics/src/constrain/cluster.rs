//! Classes of equal things: agglomeration, the surest pair first.

/// A thing that is known up to its covariance, or several that were taken for one.
pub trait Estimate: Sized {
    /// Log odds of being the same thing; `None` where the data refuse or nothing says so.
    fn log_odds(&self, other: &Self) -> Option<f64>;
    /// Both as one thing.
    fn fused(&self, other: &Self) -> Self;
    /// A number that is nearly the same for what is nearly the same.
    fn key(&self) -> f64;
}

/// Weights that make one number of three: nothing on a part is aligned with them.
pub const SKEW: [f64; 3] = [1.0, 0.618, 0.271];

/// Of more estimates than this, those that are next to each other by their keys are joined first:
/// to ask all pairs again after every join costs the cube of their number.
const CROWD: usize = 200;
/// Places along the keys within which a partner is sought.
const BESIDE: usize = 4;

/// What was decided beforehand, by numbers of estimates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rules {
    /// Pairs that are one thing.
    pub same: Vec<(usize, usize)>,
    /// Pairs that are not.
    pub apart: Vec<(usize, usize)>,
}

impl Rules {
    /// The rules by place among some of the things: `at` has their numbers, ascending.
    pub fn at(&self, at: &[usize]) -> Self {
        let place = |&(i, j): &(usize, usize)| {
            Some((at.binary_search(&i).ok()?, at.binary_search(&j).ok()?))
        };
        let of = |pairs: &[(usize, usize)]| pairs.iter().filter_map(place).collect();
        Self { same: of(&self.same), apart: of(&self.apart) }
    }
}

/// Joins the pair of the highest odds until none is left; the class of every estimate, numbered by
/// first member.
pub fn agglomerate<E: Estimate>(estimates: Vec<E>, rules: &Rules) -> (Vec<usize>, Vec<E>) {
    let count = estimates.len();
    let mut work = Work {
        class: (0..count).collect(),
        alive: estimates.into_iter().map(Some).collect(),
        apart: &rules.apart,
    };
    for &(i, j) in &rules.same {
        let (i, j) = (work.class[i], work.class[j]);
        work.join(i.min(j), i.max(j));
    }
    if count > CROWD {
        work.sweep();
    }
    let mut best: Vec<Option<(f64, usize)>> = (0..count).map(|i| work.partner(i)).collect();
    loop {
        let pairs = best.iter().enumerate().filter_map(|(i, found)| found.map(|(o, j)| (o, i, j)));
        let top = pairs.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let Some((_, i, j)) = top else { break };
        work.join(i, j);
        best[j] = None;
        for (k, known) in best.iter_mut().enumerate() {
            let touched = k == i || known.is_some_and(|(_, other)| other == i || other == j);
            if touched {
                *known = work.partner(k);
            } else if k < i
                && let Some(o) = work.odds(k, i)
                && known.is_none_or(|(best, _)| o > best)
            {
                *known = Some((o, i));
            }
        }
    }
    work.numbered()
}

struct Work<'a, E> {
    /// The estimate that stands for the class of every estimate.
    class: Vec<usize>,
    alive: Vec<Option<E>>,
    apart: &'a [(usize, usize)],
}

impl<E: Estimate> Work<'_, E> {
    fn odds(&self, i: usize, j: usize) -> Option<f64> {
        let odds = self.alive[i].as_ref()?.log_odds(self.alive[j].as_ref()?)?;
        let splits = |(a, b): &(usize, usize)| {
            let ends = (self.class[*a], self.class[*b]);
            ends == (i, j) || ends == (j, i)
        };
        (!self.apart.iter().any(splits)).then_some(odds)
    }

    /// The best partner after an estimate.
    fn partner(&self, i: usize) -> Option<(f64, usize)> {
        let pairs = (i + 1..self.alive.len()).filter_map(|j| Some((self.odds(i, j)?, j)));
        pairs.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
    }

    /// Joins whatever are each other's best partners among those beside them, until nothing is.
    fn sweep(&mut self) {
        loop {
            let alive = |i: usize| Some((self.alive[i].as_ref()?.key(), i));
            let mut line: Vec<(f64, usize)> = (0..self.alive.len()).filter_map(alive).collect();
            line.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let partner = |at: usize| {
                let beside = at.saturating_sub(BESIDE)..line.len().min(at + BESIDE + 1);
                let odds = |other: usize| Some((self.odds(line[at].1, line[other].1)?, other));
                let others = beside.filter(|&other| other != at).filter_map(odds);
                let best = others.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
                best.map(|(_, other)| other)
            };
            let partners: Vec<Option<usize>> = (0..line.len()).map(partner).collect();
            let mutual = |&(at, other): &(usize, usize)| at < other && partners[other] == Some(at);
            let joins: Vec<(usize, usize)> = partners
                .iter()
                .enumerate()
                .filter_map(|(at, other)| Some((at, (*other)?)))
                .filter(mutual)
                .map(|(at, other)| (line[at].1, line[other].1))
                .collect();
            if joins.is_empty() {
                return;
            }
            joins.into_iter().for_each(|(i, j)| self.join(i.min(j), i.max(j)));
        }
    }

    fn join(&mut self, i: usize, j: usize) {
        if i == j {
            return;
        }
        if let (Some(one), Some(other)) = (self.alive[i].take(), self.alive[j].take()) {
            self.alive[i] = Some(one.fused(&other));
        }
        self.class.iter_mut().filter(|c| **c == j).for_each(|c| *c = i);
    }

    fn numbered(self) -> (Vec<usize>, Vec<E>) {
        let mut next = 0;
        let mut number = vec![0; self.alive.len()];
        for (own, known) in number.iter_mut().zip(&self.alive) {
            *own = next;
            next += usize::from(known.is_some());
        }
        (
            self.class.into_iter().map(|c| number[c]).collect(),
            self.alive.into_iter().flatten().collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number, and of how many it is the mean.
    struct Number(f64, f64);

    impl Estimate for Number {
        fn log_odds(&self, other: &Self) -> Option<f64> {
            let apart = (self.0 - other.0).abs();
            (apart < 0.1).then_some(1.0 - apart)
        }

        fn fused(&self, other: &Self) -> Self {
            let count = self.1 + other.1;
            Self((self.0 * self.1 + other.0 * other.1) / count, count)
        }

        fn key(&self) -> f64 {
            self.0
        }
    }

    #[test]
    fn a_crowd_falls_into_the_same_classes_as_a_few() {
        let value = |i: usize| (i % 7) as f64 + 0.01 * (i as f64).sin();
        for count in [70, 7 * CROWD] {
            let numbers = (0..count).map(|i| Number(value(i), 1.0)).collect();
            let (classes, left) = agglomerate(numbers, &Rules::default());
            assert_eq!(left.len(), 7);
            assert!(classes.iter().enumerate().all(|(i, &class)| class == i % 7));
        }
    }
}
