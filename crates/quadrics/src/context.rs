//! What an algorithm needs from outside: randomness, progress, cancellation, a clock.

use std::time::Instant;

use rand_pcg::Pcg64Mcg;

use crate::error::{Error, Result};

/// Called with the stage and how much of it is done, in [0, 1]; `false` asks to stop.
pub type Progress<'a> = dyn FnMut(&'static str, f64) -> bool + Send + 'a;

/// An odd multiplier without pattern (the 128-bit one of PCG).
const SPREAD: u128 = 0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645;

/// Passed down as the first argument of everything that takes long or draws at random.
pub struct Context<'a> {
    /// The only source of randomness: the same seed gives the same result.
    pub rng: Pcg64Mcg,
    progress: Option<Box<Progress<'a>>>,
    timing: Vec<(&'static str, f64)>,
}

impl<'a> Context<'a> {
    /// A context that reports to nobody.
    pub fn new(seed: u64) -> Self {
        // Spread over the generator's 128 bits of state, so that small seeds differ at once.
        let state = u128::from(seed).wrapping_add(1).wrapping_mul(SPREAD);
        Self { rng: Pcg64Mcg::new(state | 1), progress: None, timing: Vec::new() }
    }

    /// The same, with a listener.
    pub fn with_progress(
        seed: u64,
        progress: impl FnMut(&'static str, f64) -> bool + Send + 'a,
    ) -> Self {
        Self { progress: Some(Box::new(progress)), ..Self::new(seed) }
    }

    /// Tells the listener how far `stage` is; called at least ten times a second.
    ///
    /// # Errors
    /// [`Error::Cancelled`] if the listener asks to stop.
    pub fn step(&mut self, stage: &'static str, fraction: f64) -> Result<()> {
        let go_on =
            self.progress.as_mut().is_none_or(|listen| listen(stage, fraction.clamp(0.0, 1.0)));
        if go_on { Ok(()) } else { Err(Error::Cancelled) }
    }

    /// Runs one stage and notes how long it took.
    ///
    /// # Errors
    /// Those of the stage.
    pub fn timed<T>(
        &mut self,
        stage: &'static str,
        run: impl FnOnce(&mut Self) -> Result<T>,
    ) -> Result<T> {
        self.step(stage, 0.0)?;
        let start = Instant::now();
        let value = run(self)?;
        let seconds = start.elapsed().as_secs_f64();
        match self.timing.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, total)) => *total += seconds,
            None => self.timing.push((stage, seconds)),
        }
        Ok(value)
    }

    /// Seconds per stage, in the order in which the stages first ran.
    pub fn timing(&self) -> &[(&'static str, f64)] {
        &self.timing
    }
}
