//! Mechanical parts with known surfaces, noise as the paper adds it, and simulated scans.

mod curve;
mod lattice;
mod sheet;
