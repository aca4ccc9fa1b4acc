//! Scratch memory that threads hand on to each other.

use std::sync::{Mutex, PoisonError};

/// Values that are lent to one thread at a time; as many are made as are needed at once. Whoever
/// borrows one clears it: what it holds must not matter.
#[derive(Default)]
pub struct Pool<T>(Mutex<Vec<T>>);

impl<T: Default> Pool<T> {
    /// Calls `work` with one of the values.
    pub fn with<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        // Whoever panicked has kept its value: the others are as they were.
        let lent = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut value = lent.unwrap_or_default();
        let result = work(&mut value);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(value);
        result
    }
}
