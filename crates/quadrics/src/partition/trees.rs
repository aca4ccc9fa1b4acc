//! Sets that are joined, as trees of numbers: every number has a parent that is no larger (Tarjan, JACM 1975).

/// Joins the trees of two numbers; `parent` has the numbers from `first` on.
pub(crate) fn join(parent: &mut [u32], first: u32, one: u32, other: u32) {
    let (one, other) = (root(parent, first, one), root(parent, first, other));
    parent[(one.max(other) - first) as usize] = one.min(other);
}

/// The least number of a tree; halves the way to it.
pub(crate) fn root(parent: &mut [u32], first: u32, mut number: u32) -> u32 {
    loop {
        let above = parent[(number - first) as usize];
        if above == number {
            return number;
        }
        let next = parent[(above - first) as usize];
        parent[(number - first) as usize] = next;
        number = next;
    }
}
