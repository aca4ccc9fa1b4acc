//! What is in a mesh: what `quadrics info` shows, without segmenting.

use super::{Geometry, Mesh, repair};
use crate::error::Result;
use crate::math::Point;
use crate::result::Repair;

/// Counts, sizes and faults of a mesh; lengths in its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Inspection {
    /// Vertices of the input, used or not.
    pub vertices: usize,
    /// Triangles of the input.
    pub faces: usize,
    /// Least and greatest coordinates of the used vertices.
    pub bounds: (Point, Point),
    /// The longest side of the bounding box.
    pub size: f64,
    /// Area of the repaired mesh.
    pub area: f64,
    /// Volume, where every component is closed; voids count against it.
    pub volume: Option<f64>,
    /// Pieces that hang together over edges of exactly two faces.
    pub components: usize,
    /// Those of them that are closed.
    pub closed_components: usize,
    /// Edges of one face.
    pub border_edges: usize,
    /// Edges of more than two faces.
    pub non_manifold_edges: usize,
    /// Vertices - edges + faces of the repaired mesh: 2 for a ball, 0 for a ring.
    pub euler: i64,
    /// Half of the edges are shorter.
    pub median_edge: f64,
    /// What [`repair`] would mend.
    pub repairs: Vec<Repair>,
}

/// Looks at `mesh`, repairs a copy, and measures that.
///
/// # Errors
/// Those of [`super::validate`].
pub fn inspect(mesh: &Mesh) -> Result<Inspection> {
    let repaired = repair(mesh)?;
    let (clean, census) = (&repaired.mesh, &repaired.census);
    let closed = census.closed_components == census.components;
    Ok(Inspection {
        vertices: mesh.positions.len(),
        faces: mesh.faces.len(),
        bounds: clean.bounds().unwrap_or_default(),
        size: clean.size(),
        area: Geometry::new(clean).areas.iter().sum(),
        volume: closed.then(|| volume(clean)),
        components: census.components,
        closed_components: census.closed_components,
        border_edges: census.border,
        non_manifold_edges: census.non_manifold,
        euler: clean.positions.len() as i64 - census.edges as i64 + clean.faces.len() as i64,
        median_edge: median_edge(clean),
        repairs: repaired.repairs,
    })
}

fn volume(mesh: &Mesh) -> f64 {
    // From a point of the mesh: far from the origin the terms would cancel.
    let origin = mesh.positions.first().copied().unwrap_or_default();
    let corners = (0..mesh.faces.len()).map(|face| mesh.corners(face).map(|p| p - origin));
    corners.map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum()
}

/// Over the half-edges: an edge inside counts twice, one at the border once.
fn median_edge(mesh: &Mesh) -> f64 {
    let corners = (0..mesh.faces.len()).map(|face| mesh.corners(face));
    let mut lengths: Vec<f64> =
        corners.flat_map(|[a, b, c]| [(b - a).norm(), (c - b).norm(), (a - c).norm()]).collect();
    let middle = lengths.len() / 2;
    *lengths.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_far_away_has_its_volume_and_the_euler_number_of_a_ball() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
        let mut mesh = Mesh {
            positions: positions.map(|p| Point::from(p.map(|x| x + 1e6))).to_vec(),
            faces: vec![[0, 1, 2], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        };
        let seen = inspect(&mesh).unwrap();
        assert!((seen.volume.unwrap() - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!((seen.euler, seen.components, seen.closed_components), (2, 1, 1));
        assert_eq!((seen.median_edge, seen.size), (2f64.sqrt(), 1.0));
        assert_eq!(seen.repairs[0].kind, "flipped_faces");

        mesh.faces.pop();
        let seen = inspect(&mesh).unwrap();
        assert_eq!((seen.volume, seen.euler, seen.border_edges), (None, 1, 3));
        assert!((seen.area - 1.5).abs() < 1e-9);
    }
}
