//! Mechanical parts with known surfaces, noise as the paper adds it, and simulated scans.
//!
//! ```
//! use quadrics::{Context, synth};
//!
//! let part = synth::part("demo", 10_000)?;
//! let scanner = synth::Scanner { faces: 10_000, ..synth::Scanner::default() };
//! let scan = synth::scan(&mut Context::new(0), &part, &scanner)?;
//! assert_eq!(scan.labels.len(), scan.mesh.faces.len());
//! # Ok::<(), quadrics::Error>(())
//! ```

mod build;
mod catalogue;
mod crumbs;
mod curve;
mod discs;
mod field;
mod lattice;
mod noise;
mod part;
mod resample;
mod revolve;
mod scan;
mod sheet;
mod sweep;

pub use noise::{Distribution, Noise, add_noise};
pub use part::{Part, names, part};
pub use scan::{Scanner, scan};

#[cfg(test)]
mod tests;
