//! Reading and writing through the public door.

mod fixtures;
mod hostile;
mod readers;
mod writers;

use quadrics::error::Result;
use quadrics::format::{self, Loaded};

/// Reads bytes that refer to no other file.
fn read(extension: &str, bytes: &[u8]) -> Result<Loaded> {
    format::read(extension, bytes, &mut |name| panic!("asked for {name}"))
}

/// The corners of every triangle: the mesh, however its vertices are numbered.
fn triangles(loaded: &Loaded) -> Vec<[[f64; 3]; 3]> {
    let mesh = &loaded.mesh;
    (0..mesh.faces.len()).map(|face| mesh.corners(face).map(|p| [p.x, p.y, p.z])).collect()
}

/// What the error says.
fn complaint(extension: &str, bytes: &[u8]) -> String {
    read(extension, bytes).expect_err("this should not be readable").to_string()
}
