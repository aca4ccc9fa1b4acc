//! The inside of a planar figure, filled with a lattice of nearly equilateral triangles.

use super::curve::Point2;

/// Rows of an equilateral lattice are this much closer than its columns.
const ROW: f64 = 0.866_025_403_784_438_6;

/// Nodes nearer to the boundary than this many spacings would make slivers with it.
const CLEARANCE: f64 = 0.6;

/// Nodes within this many spacings of the boundary adapt to it; beyond, the lattice is as it is.
const BAND: f64 = 2.5;

/// What a node of the lattice is to the figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Node {
    /// Outside, or too close to the boundary.
    Out,
    /// In the band along the boundary.
    Near,
    /// Beyond the band, with a neighbour in it.
    Rim,
    /// Beyond the band.
    Deep,
}

/// Nodes in rows; every other row is shifted by half a column.
pub(super) struct Lattice {
    origin: Point2,
    step: Point2,
    columns: usize,
    rows: usize,
    /// Row by row.
    pub(super) nodes: Vec<Node>,
}

impl Lattice {
    /// The lattice inside closed polygons, of which one is the outer boundary and the others are
    /// holes. It is fitted to their bounding box, so that a rectangle is filled without a seam.
    pub(super) fn inside(loops: &[Vec<Point2>], spacing: f64) -> Self {
        let mut lattice = Self::over(loops, spacing);
        lattice.fill(loops);
        for (from, to) in edges(loops) {
            lattice.clear_along(from, to, spacing);
        }
        for node in 0..lattice.nodes.len() {
            let at_band = |l: &Self| l.around(node).any(|n| l.nodes[n] == Node::Near);
            if lattice.nodes[node] == Node::Deep && at_band(&lattice) {
                lattice.nodes[node] = Node::Rim;
            }
        }
        lattice
    }

    /// Where a node is.
    pub(super) fn position(&self, node: usize) -> Point2 {
        let (row, column) = (node / self.columns, node % self.columns);
        let shift = if row % 2 == 1 { 0.5 } else { 0.0 };
        [
            self.origin[0] + self.step[0] * (column as f64 + shift),
            self.origin[1] + self.step[1] * row as f64,
        ]
    }

    /// Triangles with a corner beyond the band, counter-clockwise.
    pub(super) fn deep_triangles(&self) -> impl Iterator<Item = [usize; 3]> {
        let places = (0..self.rows.saturating_sub(1)).flat_map(move |row| {
            (0..self.columns - 1).map(move |column| (row, row * self.columns + column))
        });
        places
            .flat_map(|(row, a)| {
                let (b, c, d) = (a + 1, a + self.columns, a + self.columns + 1);
                if row % 2 == 0 { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] }
            })
            .filter(|corners| corners.iter().any(|&n| self.nodes[n] >= Node::Rim))
    }

    fn over(loops: &[Vec<Point2>], spacing: f64) -> Self {
        let points = || loops.iter().flatten();
        let bound =
            |i: usize, pick: fn(f64, f64) -> f64, start| points().map(|p| p[i]).fold(start, pick);
        let low = [0, 1].map(|i| bound(i, f64::min, f64::INFINITY));
        let high = [0, 1].map(|i| bound(i, f64::max, f64::NEG_INFINITY));
        let count = |i: usize, pitch: f64| ((high[i] - low[i]) / pitch).round().max(1.0);
        let (columns, rows) = (count(0, spacing), count(1, spacing * ROW));
        let step = [(high[0] - low[0]) / columns, (high[1] - low[1]) / rows];
        let (columns, rows) = (columns as usize + 1, rows as usize + 1);
        Self { origin: low, step, columns, rows, nodes: vec![Node::Out; columns * rows] }
    }

    /// Marks the nodes between every second pair of crossings of their row.
    fn fill(&mut self, loops: &[Vec<Point2>]) {
        let mut crossings = vec![Vec::new(); self.rows];
        for (from, to) in edges(loops) {
            let (low, high) = if from[1] < to[1] { (from, to) } else { (to, from) };
            // Half open, so that a row through a vertex is crossed once; floor, and not ceil, lest
            // rounding skips that row.
            let first = self.row_at(low[1]).floor().max(0.0) as usize;
            for (row, cuts) in crossings.iter_mut().enumerate().skip(first) {
                let y = self.origin[1] + row as f64 * self.step[1];
                if y >= high[1] {
                    break;
                }
                if y >= low[1] {
                    let part = (y - low[1]) / (high[1] - low[1]);
                    cuts.push(low[0] + part * (high[0] - low[0]));
                }
            }
        }
        for (row, cuts) in crossings.iter_mut().enumerate() {
            cuts.sort_by(f64::total_cmp);
            for pair in cuts.chunks_exact(2) {
                let [first, last] = [pair[0], pair[1]].map(|x| self.column_at(row, x));
                let end = ((last.floor() + 1.0).max(0.0) as usize).min(self.columns);
                for column in first.ceil().max(0.0) as usize..end {
                    self.nodes[row * self.columns + column] = Node::Deep;
                }
            }
        }
    }

    /// Takes away the nodes too close to an edge of the boundary, and marks the band.
    fn clear_along(&mut self, from: Point2, to: Point2, spacing: f64) {
        let reach = BAND * spacing;
        let first = (self.row_at(from[1].min(to[1]) - reach)).ceil().max(0.0) as usize;
        let last = (self.row_at(from[1].max(to[1]) + reach)).floor() as usize;
        for row in first..=last.min(self.rows - 1) {
            let left = self.column_at(row, from[0].min(to[0]) - reach).ceil().max(0.0) as usize;
            let right = self.column_at(row, from[0].max(to[0]) + reach).floor().max(0.0) as usize;
            for column in left..=right.min(self.columns - 1) {
                let node = row * self.columns + column;
                if self.nodes[node] != Node::Out {
                    let far = distance_to_segment(self.position(node), from, to) / spacing;
                    if far < CLEARANCE {
                        self.nodes[node] = Node::Out;
                    } else if far < BAND {
                        self.nodes[node] = Node::Near;
                    }
                }
            }
        }
    }

    fn row_at(&self, y: f64) -> f64 {
        (y - self.origin[1]) / self.step[1]
    }

    fn column_at(&self, row: usize, x: f64) -> f64 {
        (x - self.origin[0]) / self.step[0] - if row % 2 == 1 { 0.5 } else { 0.0 }
    }

    /// The up to six neighbours of a node.
    fn around(&self, node: usize) -> impl Iterator<Item = usize> {
        let (row, column) = ((node / self.columns) as isize, (node % self.columns) as isize);
        let side = if row % 2 == 1 { 1 } else { -1 };
        let steps = [(0, -1), (0, 1), (-1, 0), (-1, side), (1, 0), (1, side)];
        steps.into_iter().filter_map(move |(up, right)| {
            let (row, column) = (row + up, column + right);
            let inside = (0..self.rows as isize).contains(&row)
                && (0..self.columns as isize).contains(&column);
            inside.then_some(row as usize * self.columns + column as usize)
        })
    }
}

/// The edges of closed polygons.
pub(super) fn edges(loops: &[Vec<Point2>]) -> impl Iterator<Item = (Point2, Point2)> {
    loops
        .iter()
        .flat_map(|points| (0..points.len()).map(|i| (points[i], points[(i + 1) % points.len()])))
}

fn distance_to_segment(point: Point2, from: Point2, to: Point2) -> f64 {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let along = (point[0] - from[0]) * dx + (point[1] - from[1]) * dy;
    let part = (along / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (point[0] - from[0] - part * dx).hypot(point[1] - from[1] - part * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_node_is_in_a_hole_and_none_at_the_boundary() {
        let square = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
        let hole = vec![[3.0, 3.0], [3.0, 7.0], [7.0, 7.0], [7.0, 3.0]];
        let loops = [square, hole];
        let lattice = Lattice::inside(&loops, 0.3);
        let mut count = 0;
        for node in 0..lattice.nodes.len() {
            let p = lattice.position(node);
            let in_hole = p.iter().all(|&c| c > 3.0 && c < 7.0);
            let near = edges(&loops).map(|(a, b)| distance_to_segment(p, a, b)).fold(9.0, f64::min);
            if lattice.nodes[node] != Node::Out {
                assert!(!in_hole && near >= CLEARANCE * 0.3);
                count += 1;
            } else {
                assert!(in_hole || near < CLEARANCE * 0.3 || p[0] > 10.0, "{p:?}");
            }
        }
        // 84 square units, less the clearance, at 0.3² √3 / 2 a node.
        assert!((900..1080).contains(&count), "{count}");
    }
}
