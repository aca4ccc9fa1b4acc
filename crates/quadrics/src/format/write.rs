//! Meshes to bytes: PLY, STL, OBJ, OFF.
//!
//! Text is written with the shortest digits that read back as the same number; binary PLY as `float`
//! where that loses nothing, else as `double`. STL knows no more than `float`.

use std::fmt::Write as _;

use super::error;
use crate::error::Result;
use crate::math::Vector;
use crate::mesh::Mesh;

/// The mesh in the format that `extension` (any case, no dot) names: `ply`, `stl`, `obj` or `off`.
///
/// # Errors
/// [`crate::Error::Format`] for another extension, or for coordinates that the format cannot hold.
pub fn write(extension: &str, mesh: &Mesh) -> Result<Vec<u8>> {
    match extension.to_ascii_lowercase().as_str() {
        "ply" => Ok(ply(mesh, None)),
        "stl" => stl(mesh),
        "obj" => Ok(text("", mesh, "v ", "f ", 1)),
        "off" => {
            let header = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.faces.len());
            Ok(text(&header, mesh, "", "3 ", 0))
        }
        _ => Err(error(
            "format",
            "cannot be written: give a name that ends in .ply, .stl, .obj or .off",
        )),
    }
}

/// A binary PLY with a colour and a label on every face.
///
/// # Panics
/// If there are fewer labels or colours than faces.
pub fn write_segmentation(mesh: &Mesh, labels: &[i32], colours: &[[u8; 3]]) -> Vec<u8> {
    assert!(labels.len() >= mesh.faces.len() && colours.len() >= mesh.faces.len());
    ply(mesh, Some((labels, colours)))
}

fn ply(mesh: &Mesh, painted: Option<(&[i32], &[[u8; 3]])>) -> Vec<u8> {
    let exact = |x: &f64| f64::from(*x as f32) == *x;
    let single = mesh.positions.iter().all(|p| p.iter().all(exact));
    let real = if single { "float" } else { "double" };
    let extra = match painted {
        Some(_) => {
            "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int label\n"
        }
        None => "",
    };
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\ncomment quadrics\nelement vertex {}\n\
         property {real} x\nproperty {real} y\nproperty {real} z\nelement face {}\n\
         property list uchar int vertex_indices\n{extra}end_header\n",
        mesh.positions.len(),
        mesh.faces.len()
    )
    .into_bytes();
    bytes.reserve(24 * mesh.positions.len() + 20 * mesh.faces.len());
    for &x in mesh.positions.iter().flat_map(|p| p.iter()) {
        match single {
            true => bytes.extend_from_slice(&(x as f32).to_le_bytes()),
            false => bytes.extend_from_slice(&x.to_le_bytes()),
        }
    }
    for (face, corners) in mesh.faces.iter().enumerate() {
        bytes.push(3);
        corners.iter().for_each(|corner| bytes.extend_from_slice(&corner.to_le_bytes()));
        if let Some((labels, colours)) = painted {
            bytes.extend_from_slice(&colours[face]);
            bytes.extend_from_slice(&labels[face].to_le_bytes());
        }
    }
    bytes
}

fn stl(mesh: &Mesh) -> Result<Vec<u8>> {
    if let Some(vertex) =
        mesh.positions.iter().position(|p| p.iter().any(|x| !(*x as f32).is_finite()))
    {
        let what = format!("vertex {vertex} is beyond what a float can hold: write PLY instead");
        return Err(error("STL", what));
    }
    let count =
        u32::try_from(mesh.faces.len()).map_err(|_| error("STL", "too many faces: write PLY"))?;
    let mut bytes = vec![b' '; 80];
    // Not "solid": that would make readers take it for text.
    bytes[..8].copy_from_slice(b"quadrics");
    bytes.extend_from_slice(&count.to_le_bytes());
    bytes.reserve(50 * mesh.faces.len());
    for face in 0..mesh.faces.len() {
        let [a, b, c] = mesh.corners(face);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(Vector::zeros);
        for v in [normal, a.coords, b.coords, c.coords] {
            v.iter().for_each(|x| bytes.extend_from_slice(&(*x as f32).to_le_bytes()));
        }
        bytes.extend_from_slice(&[0, 0]);
    }
    Ok(bytes)
}

/// A line a vertex, a line a face; indices count from `first`.
fn text(header: &str, mesh: &Mesh, vertex: &str, face: &str, first: u32) -> Vec<u8> {
    let mut text = String::with_capacity(40 * (mesh.positions.len() + mesh.faces.len()));
    text.push_str(header);
    // Writing into a String cannot fail.
    for p in &mesh.positions {
        let _ = writeln!(text, "{vertex}{} {} {}", p.x, p.y, p.z);
    }
    for corners in &mesh.faces {
        let [a, b, c] = corners.map(|corner| u64::from(corner) + u64::from(first));
        let _ = writeln!(text, "{face}{a} {b} {c}");
    }
    text.into_bytes()
}
