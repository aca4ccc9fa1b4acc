//! The total error of a segmentation whoever made it (paper, eq. 1 to 3).

use rayon::prelude::*;

use crate::error::Result;
use crate::math::triangle::Triangle;
use crate::mesh::Mesh;
use crate::partition::Regions;
use crate::prepare::to_unit_cube;
use crate::segment::Proxy;
use crate::surface::{Shape, Surface, Torus, quadrature};

/// Eq. 1 of a segmentation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// The sum of eq. 2 over all faces that have a surface, in the unit cube.
    pub total: f64,
    /// Share of the area that has none (free-form, or without a label) and is not in the sum.
    pub without_surface: f64,
}

/// Eq. 1 with surfaces in the units of the mesh; `labels` are places in `surfaces`.
///
/// A surface's normals are taken on the side that its region's normals are on. A torus is no
/// quadric: its distance is the orthogonal one.
///
/// # Errors
/// What makes a mesh have no unit cube.
pub fn energy(
    mesh: &Mesh,
    labels: &[u32],
    surfaces: &[Option<&Surface>],
    beta: f64,
) -> Result<Energy> {
    let into = to_unit_cube(mesh)?;
    let corners = |face: usize| mesh.corners(face).map(|corner| into * corner);
    let faces = (0..mesh.faces.len()).into_par_iter();
    let all: Vec<Triangle> = faces.map(|face| Triangle::new(corners(face))).collect();
    let area = |faces: &[Triangle]| faces.iter().map(|face| face.area).sum::<f64>();
    let (mut total, mut covered) = (0.0, 0.0);
    for (faces, surface) in Regions::new(labels).iter().zip(surfaces) {
        let Some(surface) = surface.filter(|surface| !matches!(surface, Surface::FreeForm)) else {
            continue;
        };
        let triangles: Vec<_> = faces.iter().map(|&face| all[face as usize]).collect();
        total += error(&surface.transformed(&into), &triangles, beta);
        covered += area(&triangles);
    }
    let without_surface = (1.0 - covered / area(&all)).max(0.0);
    Ok(Energy { total, without_surface })
}

fn error(surface: &Surface, faces: &[Triangle], beta: f64) -> f64 {
    let flip = faces.iter().map(|face| agreement(surface, face)).sum::<f64>() < 0.0;
    match (surface, surface.quadric()) {
        (Surface::Plane(plane), _) => {
            let mut plane = plane.clone();
            if flip {
                (plane.normal, plane.offset) = (-plane.normal, -plane.offset);
            }
            Proxy::Plane(plane).errors(faces, beta).iter().sum()
        }
        (_, Some(quadric)) => {
            let proxy = Proxy::Quadric(if flip { quadric.flipped() } else { quadric });
            proxy.errors(faces, beta).iter().sum()
        }
        (Surface::Torus(torus), None) => {
            let sign = if flip { -1.0 } else { 1.0 };
            faces.iter().map(|face| torus_error(torus, face, sign, beta)).sum()
        }
        _ => 0.0,
    }
}

/// How much of a face's area looks the way the surface does.
fn agreement(surface: &Surface, face: &Triangle) -> f64 {
    let normal = surface.normal(face.barycentre());
    normal.map_or(0.0, |n| n.dot(&face.normal) * face.area)
}

fn torus_error(torus: &Torus, face: &Triangle, sign: f64, beta: f64) -> f64 {
    let mean = quadrature::mean(face.corners, |point| {
        // On the axis there is no normal: nothing deviates more than the opposite one.
        let deviation = torus
            .normal(point)
            .map_or(4.0, |n| (n.into_inner() - face.normal * sign).norm_squared());
        torus.distance(point).powi(2) + beta * deviation
    });
    mean * face.area
}
