//! Classes of equal things: agglomeration, the surest pair first.

/// A thing that is known up to its covariance, or several that were taken for one.
pub trait Estimate: Sized {
    /// Log odds of being the same thing; `None` where the data refuse or nothing says so.
    fn log_odds(&self, other: &Self) -> Option<f64>;
    /// Both as one thing.
    fn fused(&self, other: &Self) -> Self;
}

/// Joins the pair of the highest odds until none is left; the class of every estimate, numbered by
/// first member, and the classes.
pub fn agglomerate<E: Estimate>(estimates: Vec<E>) -> (Vec<usize>, Vec<E>) {
    let count = estimates.len();
    let mut class: Vec<usize> = (0..count).collect();
    let mut alive: Vec<Option<E>> = estimates.into_iter().map(Some).collect();
    let odds =
        |alive: &[Option<E>], i: usize, j: usize| alive[i].as_ref()?.log_odds(alive[j].as_ref()?);
    // The best partner after every estimate.
    let best_of = |alive: &[Option<E>], i: usize| {
        let pairs = (i + 1..count).filter_map(|j| Some((odds(alive, i, j)?, j)));
        pairs.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
    };
    let mut best: Vec<Option<(f64, usize)>> = (0..count).map(|i| best_of(&alive, i)).collect();
    loop {
        let pairs = best.iter().enumerate().filter_map(|(i, found)| found.map(|(o, j)| (o, i, j)));
        let top = pairs.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let Some((_, i, j)) = top else { break };
        let (Some(one), Some(other)) = (alive[i].take(), alive[j].take()) else { break };
        alive[i] = Some(one.fused(&other));
        class.iter_mut().filter(|c| **c == j).for_each(|c| *c = i);
        best[j] = None;
        for (k, known) in best.iter_mut().enumerate() {
            let touched = k == i || known.is_some_and(|(_, other)| other == i || other == j);
            if touched {
                *known = best_of(&alive, k);
            } else if k < i
                && let Some(o) = odds(&alive, k, i)
                && known.is_none_or(|(best, _)| o > best)
            {
                *known = Some((o, i));
            }
        }
    }
    let number: Vec<usize> = alive
        .iter()
        .scan(0, |next, known| {
            let own = *next;
            *next += usize::from(known.is_some());
            Some(own)
        })
        .collect();
    (class.into_iter().map(|c| number[c]).collect(), alive.into_iter().flatten().collect())
}
