//! Mechanical parts with known surfaces, noise as the paper adds it, and simulated scans.

mod build;
mod catalogue;
mod curve;
mod lattice;
mod noise;
mod part;
mod revolve;
mod sheet;
mod sweep;

pub use noise::{Distribution, Noise, add_noise};
pub use part::{Part, names, part};

#[cfg(test)]
mod tests;
