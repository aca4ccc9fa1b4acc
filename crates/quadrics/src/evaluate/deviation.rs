//! How far two meshes are apart, as Metro measures it.
//!
//! P. Cignoni, C. Rocchini and R. Scopigno, *Metro: measuring error on simplified surfaces* (1998):
//! both surfaces are sampled evenly, and every sample is taken to the nearest point of the other.

use parry3d_f64::math::Vector as ParryVector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh;
use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::math::Point;
use crate::mesh::{Geometry, Mesh};

/// Distance between samples, as a fraction of the diagonal (Metro's default).
const STEP: f64 = 0.005;
/// Most samples along an edge: a face as long as the part has 200 steps.
const MOST: usize = 200;

/// Distances between two meshes, both ways, in the unit of the meshes.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// The largest distance of a point of either mesh from the other: symmetric Hausdorff.
    pub hausdorff: f64,
    /// The mean over both surfaces, each by area.
    pub mean: f64,
    /// Distance of every vertex of the first mesh from the second.
    pub of_vertex: Vec<f64>,
}

/// Measures the distance between two meshes.
///
/// # Errors
/// [`Error::Empty`] if a mesh has no face.
pub fn deviation(mesh: &Mesh, reference: &Mesh) -> Result<Deviation> {
    let (there, back) = (Target::new(mesh)?, Target::new(reference)?);
    let diagonal = |mesh: &Mesh| mesh.bounds().map_or(0.0, |(low, high)| (high - low).norm());
    let step = STEP * diagonal(mesh).max(diagonal(reference));
    let (one, other) = (back.distances_of(mesh, step), there.distances_of(reference, step));
    let of_vertex = mesh.positions.par_iter().map(|&point| back.distance(point)).collect();
    Ok(Deviation { hausdorff: one.0.max(other.0), mean: (one.1 + other.1) / 2.0, of_vertex })
}

/// A mesh that distances are taken to: the only place that knows whose search tree it is.
struct Target(TriMesh);

impl Target {
    fn new(mesh: &Mesh) -> Result<Self> {
        let points = mesh.positions.iter().map(|&p| foreign(p)).collect();
        TriMesh::new(points, mesh.faces.clone()).map(Self).map_err(|_| Error::Empty)
    }

    fn distance(&self, point: Point) -> f64 {
        let foot = self.0.project_local_point(foreign(point), false).point;
        (point - Point::new(foot.x, foot.y, foot.z)).norm()
    }

    /// Largest and mean distance of a mesh.
    fn distances_of(&self, mesh: &Mesh, step: f64) -> (f64, f64) {
        let areas = Geometry::new(mesh).areas;
        let rows: Vec<(f64, f64)> = (0..mesh.faces.len())
            .into_par_iter()
            .map(|face| self.distances_of_face(mesh.corners(face), step))
            .collect();
        let most = rows.iter().map(|row| row.0).fold(0.0, f64::max);
        let sum: f64 = rows.iter().zip(&areas).map(|(row, area)| row.1 * area).sum();
        (most, sum / areas.iter().sum::<f64>().max(f64::MIN_POSITIVE))
    }

    /// Largest and mean distance over a lattice on a triangle, by the trapezoidal rule.
    fn distances_of_face(&self, [a, b, c]: [Point; 3], step: f64) -> (f64, f64) {
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let n = ((longest / step).ceil() as usize).clamp(1, MOST);
        let (mut most, mut sum) = (0f64, 0.0);
        for i in 0..=n {
            for j in 0..=n - i {
                let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
                let distance = self.distance(a + (b - a) * u + (c - a) * v);
                most = most.max(distance);
                // So many of the small triangles have their corner here: six inside.
                let borders = usize::from(i == 0) + usize::from(j == 0) + usize::from(i + j == n);
                sum += distance * [6.0, 3.0, 1.0][borders];
            }
        }
        (most, sum / (3 * n * n) as f64)
    }
}

fn foreign(point: Point) -> ParryVector {
    ParryVector::new(point.x, point.y, point.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;
    use crate::mesh::samples::cube;

    #[test]
    fn a_mesh_is_nowhere_off_itself_and_a_lifted_sheet_everywhere() {
        let mesh = cube(3).mesh;
        let none = deviation(&mesh, &mesh).unwrap();
        assert!(none.hausdorff < 1e-12 && none.mean < 1e-12);
        let sheet = |height: f64| Mesh {
            positions: [[0., 0.], [1., 0.], [0., 1.]].map(|[x, y]| [x, y, height].into()).into(),
            faces: vec![[0, 1, 2]],
        };
        let lifted = deviation(&sheet(0.0), &sheet(0.25)).unwrap();
        assert!((lifted.hausdorff - 0.25).abs() < 1e-12 && (lifted.mean - 0.25).abs() < 1e-12);
        assert!(lifted.of_vertex.iter().all(|d| (d - 0.25).abs() < 1e-12));
    }

    #[test]
    fn both_ways_count() {
        let small = cube(2).mesh;
        let mut large = small.clone();
        // A corner drawn out: the small cube is near the large one everywhere, not the reverse.
        let far = large.positions.iter().position(|p| *p == Point::new(1.0, 1.0, 1.0)).unwrap();
        large.positions[far] += Vector::new(0.3, 0.3, 0.3);
        let (one, other) = (deviation(&small, &large), deviation(&large, &small));
        let (one, other) = (one.unwrap(), other.unwrap());
        assert!((one.hausdorff - 0.27f64.sqrt()).abs() < 1e-9);
        assert_eq!((one.hausdorff, one.mean), (other.hausdorff, other.mean));
        assert_eq!(deviation(&small, &Mesh::default()), Err(Error::Empty));
    }

    #[test]
    fn the_mean_of_a_slope_is_its_middle() {
        let at = |z: [f64; 3]| Mesh {
            positions: vec![[0., 0., z[0]].into(), [1., 0., z[1]].into(), [0., 1., z[2]].into()],
            faces: vec![[0, 1, 2]],
        };
        let slope = deviation(&at([0.0, 0.003, 0.0]), &at([0.0; 3])).unwrap();
        assert!((slope.mean - 0.001).abs() < 1e-6, "{}", slope.mean);
    }
}
