//! The total error of a segmentation whoever made it (paper, eq. 1 to 3).

use crate::error::Result;
use crate::math::{Point, Vector};
use crate::mesh::{Geometry, Mesh};
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
    let positions = mesh.positions.iter().map(|point| into * point).collect();
    let cube = Mesh { positions, faces: mesh.faces.clone() };
    let geometry = Geometry::new(&cube);
    let (mut total, mut covered) = (0.0, 0.0);
    for (faces, surface) in Regions::new(labels).iter().zip(surfaces) {
        let Some(surface) = surface.filter(|surface| !matches!(surface, Surface::FreeForm)) else {
            continue;
        };
        let region = Region { mesh: &cube, geometry: &geometry, faces };
        total += region.error(&surface.transformed(&into), beta);
        covered += faces.iter().map(|&face| geometry.areas[face as usize]).sum::<f64>();
    }
    let without_surface = (1.0 - covered / geometry.areas.iter().sum::<f64>()).max(0.0);
    Ok(Energy { total, without_surface })
}

struct Region<'a> {
    mesh: &'a Mesh,
    geometry: &'a Geometry,
    faces: &'a [u32],
}

impl Region<'_> {
    fn error(&self, surface: &Surface, beta: f64) -> f64 {
        let flip = self.faces.iter().map(|&face| self.agreement(surface, face)).sum::<f64>() < 0.0;
        match (surface, surface.quadric()) {
            (Surface::Plane(plane), _) => {
                let mut plane = plane.clone();
                if flip {
                    (plane.normal, plane.offset) = (-plane.normal, -plane.offset);
                }
                self.sum(|c, n, a| Proxy::Plane(plane.clone()).error(c, n, a, beta))
            }
            (_, Some(quadric)) => {
                let proxy = Proxy::Quadric(if flip { quadric.flipped() } else { quadric });
                self.sum(|corners, normal, area| proxy.error(corners, normal, area, beta))
            }
            (Surface::Torus(torus), None) => {
                let sign = if flip { -1.0 } else { 1.0 };
                self.sum(|c, n, area| torus_error(torus, c, n * sign, beta) * area)
            }
            _ => 0.0,
        }
    }

    /// How much of a face's area looks the way the surface does.
    fn agreement(&self, surface: &Surface, face: u32) -> f64 {
        let face = face as usize;
        let normal = surface.normal(self.geometry.barycentres[face]);
        normal.map_or(0.0, |n| n.dot(&self.geometry.normals[face]) * self.geometry.areas[face])
    }

    fn sum(&self, error: impl Fn([Point; 3], Vector, f64) -> f64) -> f64 {
        let of = |&face: &u32| {
            let (face, geometry) = (face as usize, self.geometry);
            error(self.mesh.corners(face), geometry.normals[face], geometry.areas[face])
        };
        self.faces.iter().map(of).sum()
    }
}

fn torus_error(torus: &Torus, corners: [Point; 3], normal: Vector, beta: f64) -> f64 {
    quadrature::mean(corners, |point| {
        // On the axis there is no normal: nothing deviates more than the opposite one.
        let deviation =
            torus.normal(point).map_or(4.0, |n| (n.into_inner() - normal).norm_squared());
        torus.distance(point).powi(2) + beta * deviation
    })
}
