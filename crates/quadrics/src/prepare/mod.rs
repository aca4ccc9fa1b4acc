//! What happens to a mesh before surfaces are sought.

pub mod noise;
pub mod normals;
