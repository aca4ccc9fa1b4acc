//! Which of some starts is nearest to everything, by steps.

use crate::partition::UNLABELLED;

/// The place in `starts` of the one that is nearest to each of `count` things; [`UNLABELLED`] where no
/// way leads. `visit` calls back with what is beside one.
pub fn nearest(count: usize, starts: &[u32], visit: impl Fn(u32, &mut dyn FnMut(u32))) -> Vec<u32> {
    let mut nearest = vec![UNLABELLED; count];
    starts.iter().zip(0..).for_each(|(&start, i)| nearest[start as usize] = i);
    let mut wave = starts.to_vec();
    let mut next = Vec::new();
    while !wave.is_empty() {
        for &one in &wave {
            visit(one, &mut |other| {
                if nearest[other as usize] == UNLABELLED {
                    nearest[other as usize] = nearest[one as usize];
                    next.push(other);
                }
            });
        }
        wave.clear();
        std::mem::swap(&mut wave, &mut next);
    }
    nearest
}
