//! Before the first region: unit cube and subdivision (paper, section 4.1), the way back, and what the
//! mesh tells of its noise.

mod back;
pub mod noise;
pub mod normals;
mod subdivide;
mod unit_cube;

pub use back::{Returned, labels_back};
pub use subdivide::{Subdivided, subdivide};
pub use unit_cube::to_unit_cube;
