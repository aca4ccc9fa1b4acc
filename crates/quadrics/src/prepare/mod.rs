//! Before the first region: unit cube and subdivision (paper, section 4.1), and the way back.

mod back;
mod subdivide;
mod unit_cube;

pub use back::{Returned, labels_back};
pub use subdivide::{Subdivided, subdivide};
pub use unit_cube::to_unit_cube;
