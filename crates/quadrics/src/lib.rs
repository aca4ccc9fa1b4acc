//! Recognises the surfaces that a scanned mechanical part was made of.

#![forbid(unsafe_code)]

pub mod baseline;
pub mod constrain;
pub mod context;
mod default;
pub mod denoise;
pub mod describe;
pub mod detect;
pub mod error;
pub mod evaluate;
pub mod format;
mod impose;
pub mod math;
pub mod mesh;
pub mod options;
pub mod paper;
pub mod partition;
pub mod pipeline;
pub mod prepare;
pub mod recognise;
pub mod render;
pub mod result;
mod retype;
pub mod segment;
pub mod surface;
pub mod synth;

pub use context::Context;
pub use error::Error;
pub use mesh::Mesh;
pub use options::Options;
pub use pipeline::segment;
pub use result::Segmentation;
pub use surface::Surface;
