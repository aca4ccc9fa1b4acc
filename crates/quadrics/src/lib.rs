//! Recognises the surfaces that a scanned mechanical part was made of.

#![forbid(unsafe_code)]

pub mod context;
pub mod error;
pub mod format;
pub mod math;
pub mod mesh;
pub mod options;
pub mod partition;
pub mod pipeline;
pub mod prepare;
pub mod recognise;
