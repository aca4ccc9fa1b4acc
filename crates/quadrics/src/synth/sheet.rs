//! Planar figures with holes, filled with triangles: constrained Delaunay along the boundary, the
//! plain lattice inside, so that millions of triangles cost no more than writing them down.

use spade::{ConstrainedDelaunayTriangulation, HasPosition, Triangulation};

use super::curve::Point2;
use super::lattice::{Lattice, Node};

/// Smoothing steps in the band between boundary and lattice: more no longer show.
const SMOOTHING: usize = 4;

/// Triangles of a figure. The vertices of its boundary come first, loop by loop, as given.
pub(super) struct Sheet {
    /// Vertices inside, numbered on after those of the boundary.
    pub(super) interior: Vec<Point2>,
    /// Counter-clockwise.
    pub(super) faces: Vec<[u32; 3]>,
}

/// Fills the figure inside closed polygons: the first is its outer boundary, the others are
/// holes; their orientation does not matter. No vertex is added to the boundary.
pub(super) fn fill(loops: &[Vec<Point2>], spacing: f64) -> Sheet {
    let lattice = Lattice::inside(loops, spacing);
    let mut positions: Vec<Point2> = loops.concat();
    let boundary = positions.len();
    let mut number = vec![u32::MAX; lattice.nodes.len()];
    let inside = |node: &usize| lattice.nodes[*node] != Node::Out;
    // The band first: only its vertices, and those at its rim, are triangulated.
    let (mut band, mut deep) = (Vec::new(), Vec::new());
    for node in (0..lattice.nodes.len()).filter(inside) {
        if lattice.nodes[node] == Node::Near { &mut band } else { &mut deep }.push(node);
    }
    deep.sort_by_key(|&node| lattice.nodes[node] == Node::Deep);
    for &node in band.iter().chain(&deep) {
        number[node] = positions.len() as u32;
        positions.push(lattice.position(node));
    }
    let rim = deep.partition_point(|&node| lattice.nodes[node] == Node::Rim);
    let free = boundary + band.len();
    let mut faces = triangulate(loops, &positions[..free + rim]);
    faces.retain(|corners| corners.iter().all(|&v| (v as usize) < free));
    faces.extend(lattice.deep_triangles().map(|corners| corners.map(|node| number[node])));
    smooth(&mut positions, &faces, boundary..free);
    Sheet { interior: positions.split_off(boundary), faces }
}

/// A vertex that remembers its number.
struct Corner {
    at: Point2,
    number: u32,
}

impl HasPosition for Corner {
    type Scalar = f64;
    fn position(&self) -> spade::Point2<f64> {
        spade::Point2::new(self.at[0], self.at[1])
    }
}

/// Delaunay triangles inside the figure; `points` begin with the vertices of the loops.
fn triangulate(loops: &[Vec<Point2>], points: &[Point2]) -> Vec<[u32; 3]> {
    let next = successors(loops);
    let corners = points.iter().zip(0..).map(|(&at, number)| Corner { at, number }).collect();
    let constraints = next.iter().enumerate().map(|(i, &j)| [i, j as usize]).collect();
    let mesh = ConstrainedDelaunayTriangulation::<Corner>::bulk_load_cdt(corners, constraints)
        .expect("boundaries are finite and do not cross");
    let mut verdicts = vec![None; mesh.num_all_faces()];
    verdicts[mesh.outer_face().fix().index()] = Some(false);
    let mut open = Vec::new();
    for face in mesh.inner_faces() {
        let corners = face.vertices().map(|v| v.data().number);
        let verdict = verdict(corners, &next);
        verdicts[face.fix().index()] = verdict;
        if verdict.is_none() {
            open.push(face);
        }
    }
    // The few triangles between boundary vertices that do not follow each other ask their
    // neighbours: without a boundary edge between them they are on the same side.
    while !open.is_empty() {
        let before = open.len();
        open.retain(|face| {
            let known =
                face.adjacent_edges().iter().find_map(|e| verdicts[e.rev().face().fix().index()]);
            verdicts[face.fix().index()] = known;
            known.is_none()
        });
        debug_assert!(open.len() < before, "a figure without boundary");
    }
    mesh.inner_faces()
        .filter(|face| verdicts[face.fix().index()] == Some(true))
        .map(|face| face.vertices().map(|v| v.data().number))
        .collect()
}

/// The vertex that follows each vertex of the loops, with the figure on the left.
fn successors(loops: &[Vec<Point2>]) -> Vec<u32> {
    let mut next = Vec::new();
    for (i, points) in loops.iter().enumerate() {
        let (first, count) = (next.len() as u32, points.len() as u32);
        let step = if (doubled_area(points) > 0.0) == (i == 0) { 1 } else { count - 1 };
        next.extend((0..count).map(|i| first + (i + step) % count));
    }
    next
}

/// Whether a triangle is inside, as far as its own corners tell.
fn verdict(corners: [u32; 3], next: &[u32]) -> Option<bool> {
    if corners.iter().any(|&v| v as usize >= next.len()) {
        return Some(true);
    }
    (0..3).find_map(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if next[a as usize] == b {
            Some(true)
        } else if next[b as usize] == a {
            Some(false)
        } else {
            None
        }
    })
}

fn doubled_area(points: &[Point2]) -> f64 {
    let cross = |(a, b): (&Point2, &Point2)| a[0] * b[1] - a[1] * b[0];
    points.iter().zip(points.iter().cycle().skip(1)).map(cross).sum()
}

/// Moves the vertices of a range to the mean of their neighbours, where no triangle suffers.
fn smooth(positions: &mut [Point2], faces: &[[u32; 3]], range: std::ops::Range<usize>) {
    let mut fans = vec![Vec::new(); range.len()];
    for &[a, b, c] in faces {
        for [v, left, right] in [[a, b, c], [b, c, a], [c, a, b]] {
            if range.contains(&(v as usize)) {
                fans[v as usize - range.start].push([left as usize, right as usize]);
            }
        }
    }
    for _ in 0..SMOOTHING {
        for (fan, v) in fans.iter().zip(range.clone()) {
            let count = fan.len() as f64;
            let mean = [0, 1].map(|i| fan.iter().map(|e| positions[e[0]][i]).sum::<f64>() / count);
            let old = worst(positions, fan, positions[v]);
            if worst(positions, fan, mean) > old.min(0.5) {
                positions[v] = mean;
            }
        }
    }
}

/// The least quality of the triangles of a fan around a point: 1 equilateral, 0 flat.
fn worst(positions: &[Point2], fan: &[[usize; 2]], at: Point2) -> f64 {
    let quality = |&[left, right]: &[usize; 2]| {
        let (p, q) = (positions[left], positions[right]);
        let squares: f64 = [(p, q), (p, at), (q, at)]
            .iter()
            .map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2))
            .sum();
        // 2 √3 |cross product| over the sum of the squared sides is 1 for an equilateral.
        2.0 * 3f64.sqrt() * doubled_area(&[at, p, q]) / squares
    };
    fan.iter().map(quality).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(center: Point2, radius: f64, count: usize) -> Vec<Point2> {
        let angle = |i: usize| i as f64 / count as f64 * std::f64::consts::TAU;
        let at = |(s, c): (f64, f64)| [center[0] + radius * c, center[1] + radius * s];
        (0..count).map(|i| at(angle(i).sin_cos())).collect()
    }

    /// Of a disc with two holes: one fine, one that almost touches the rim.
    fn figure() -> (Vec<Vec<Point2>>, Sheet) {
        let spacing = 0.08;
        let hole = circle([-0.4, 0.1], 0.25, 20);
        let loops = vec![circle([0.0, 0.0], 1.0, 78), hole, circle([0.7, 0.0], 0.25, 20)];
        let sheet = fill(&loops, spacing);
        (loops, sheet)
    }

    #[test]
    fn the_triangles_cover_the_figure_and_nothing_twice() {
        let (loops, sheet) = figure();
        let positions = [loops.concat(), sheet.interior].concat();
        let areas: Vec<_> =
            sheet.faces.iter().map(|f| doubled_area(&f.map(|v| positions[v as usize]))).collect();
        assert!(areas.iter().all(|&a| a > 0.0));
        let expected = doubled_area(&loops[0]) - 2.0 * doubled_area(&loops[1]);
        assert!((areas.iter().sum::<f64>() - expected).abs() < 1e-12);
        // Euler: a disc with two holes.
        let boundary = loops.concat().len();
        let edges = (3 * sheet.faces.len() + boundary) / 2;
        assert_eq!(positions.len() + sheet.faces.len() + 1, edges);
    }

    #[test]
    fn hardly_a_triangle_is_a_sliver() {
        let (loops, sheet) = figure();
        let positions = [loops.concat(), sheet.interior].concat();
        let quality = |&[a, b, c]: &[u32; 3]| {
            worst(&positions, &[[b as usize, c as usize]], positions[a as usize])
        };
        let mut all: Vec<_> = sheet.faces.iter().map(quality).collect();
        all.sort_by(f64::total_cmp);
        assert!(all[all.len() / 20] > 0.7, "{}", all[all.len() / 20]);
    }
}
