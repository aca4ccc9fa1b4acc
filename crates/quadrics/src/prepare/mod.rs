//! What happens to a mesh before surfaces are sought: unit cube, subdivision, noise, normals.

mod axes;
mod back;
mod coarsen;
mod nearest;
pub mod noise;
pub mod normals;
mod order;
mod place;
mod relax;
mod subdivide;
mod tessellation;
mod unit_cube;

pub use axes::{Placed, in_own_cube, in_unit_cube};
pub use back::{Returned, labels_back};
pub use coarsen::{Coarse, coarsen, gather, is_faceted};
pub use order::{Ordered, ordered};
pub use place::place;
pub use subdivide::{Subdivided, subdivide};
pub use tessellation::is_tessellated;
pub use unit_cube::to_unit_cube;
