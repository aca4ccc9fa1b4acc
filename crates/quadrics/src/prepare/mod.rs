//! What happens to a mesh before surfaces are sought: unit cube, subdivision, noise, normals.

mod back;
pub mod noise;
pub mod normals;
mod subdivide;
mod unit_cube;

pub use back::{Returned, labels_back};
pub use subdivide::{Subdivided, subdivide};
pub use unit_cube::to_unit_cube;
