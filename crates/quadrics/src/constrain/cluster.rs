//! Classes of equal things: agglomeration, the surest pair first.

/// A thing that is known up to its covariance, or several that were taken for one.
pub trait Estimate: Sized {
    /// Log odds of being the same thing; `None` where the data refuse or nothing says so.
    fn log_odds(&self, other: &Self) -> Option<f64>;
    /// Both as one thing.
    fn fused(&self, other: &Self) -> Self;
}

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
