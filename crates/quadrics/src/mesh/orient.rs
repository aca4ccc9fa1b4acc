//! One winding for all: neighbours agree, and closed components look outward.
//!
//! A component is what hangs together over edges of exactly two faces. Within it the winding is
//! settled by its first face; as a whole it is then turned
//! * outward by its signed volume, if it is closed;
//! * along with the component around it, if it is closed and lies in the box of another: it may be a
//!   void, whose normals rightly point inward;
//! * as most of its faces were, if it is open.

use super::Mesh;
use super::adjacency::NONE;
use super::edges::{ends, for_each_edge};
use crate::math::Point;

/// How many of the largest closed components are asked whether they enclose another: all pairs would
/// be quadratic, and a void lies in something large.
const ENCLOSERS: usize = 64;

/// What the edges say, counted while the faces were turned.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Census {
    pub edges: usize,
    /// Edges of one face.
    pub border: usize,
    /// Edges of more than two faces.
    pub non_manifold: usize,
    /// Edges across which the winding cannot agree, as on a Möbius strip.
    pub unorientable: usize,
    pub components: usize,
    pub closed_components: usize,
    pub flipped: usize,
}

/// Turns the faces of `mesh` so that they agree.
pub(crate) fn orient(mesh: &mut Mesh) -> Census {
    let mut census = Census::default();
    let twins = twins(mesh, &mut census);
    let (mut components, mut flip) = spread(mesh, &twins, &mut census);
    // From the largest: what lies in another is settled after it.
    components.sort_by(|one, other| other.extent().total_cmp(&one.extent()));
    let mut enclosers: Vec<(usize, bool)> = Vec::new();
    for (i, component) in components.iter().enumerate() {
        let around =
            enclosers.iter().find(|(j, _)| component.closed && components[*j].holds(component));
        let against_majority = match around {
            Some(&(_, turned)) => turned,
            None => component.closed && component.volume_of_majority(mesh, &flip) < 0.0,
        };
        if component.closed && enclosers.len() < ENCLOSERS {
            enclosers.push((i, against_majority));
        }
        if component.mostly_flipped(&flip) != against_majority {
            component.faces.iter().for_each(|&face| flip[face as usize] ^= true);
        }
    }
    census.components = components.len();
    census.closed_components = components.iter().filter(|component| component.closed).count();
    for (corners, _) in mesh.faces.iter_mut().zip(&flip).filter(|(_, flip)| **flip) {
        corners.swap(1, 2);
        census.flipped += 1;
    }
    census
}

/// The half-edge on the other side of every half-edge; [`NONE`] at borders and non-manifold edges.
fn twins(mesh: &Mesh, census: &mut Census) -> Vec<u32> {
    let mut twins = vec![NONE; 3 * mesh.faces.len()];
    for_each_edge(&mesh.faces, mesh.positions.len(), |edge| {
        census.edges += 1;
        match *edge {
            [_] => census.border += 1,
            [one, other] => {
                twins[one as usize] = other;
                twins[other as usize] = one;
            }
            _ => census.non_manifold += 1,
        }
    });
    twins
}

struct Component {
    faces: Vec<u32>,
    closed: bool,
    low: Point,
    high: Point,
}

impl Component {
    fn extent(&self) -> f64 {
        (self.high - self.low).max()
    }

    fn holds(&self, other: &Component) -> bool {
        (0..3).all(|i| self.low[i] < other.low[i] && other.high[i] < self.high[i])
    }

    fn mostly_flipped(&self, flip: &[bool]) -> bool {
        2 * self.faces.iter().filter(|&&face| flip[face as usize]).count() > self.faces.len()
    }

    /// Six times the volume, were all faces wound as most of them are.
    fn volume_of_majority(&self, mesh: &Mesh, flip: &[bool]) -> f64 {
        // From a point of the component: far from the origin the terms would cancel.
        let origin = self.low;
        let term = |&face: &u32| {
            let [a, b, c] = mesh.corners(face as usize).map(|p| p - origin);
            let volume = a.dot(&b.cross(&c));
            if flip[face as usize] { -volume } else { volume }
        };
        let volume: f64 = self.faces.iter().map(term).sum();
        if self.mostly_flipped(flip) { -volume } else { volume }
    }
}

/// The components, and for every face whether it must be turned to agree with the first of its own.
fn spread(mesh: &Mesh, twins: &[u32], census: &mut Census) -> (Vec<Component>, Vec<bool>) {
    let mut walk = Walk {
        mesh,
        twins,
        seen: vec![false; mesh.faces.len()],
        flip: vec![false; mesh.faces.len()],
        clashes: 0,
    };
    let mut components = Vec::new();
    for first in 0..mesh.faces.len() {
        if !walk.seen[first] {
            components.push(walk.component(first as u32));
        }
    }
    // Each was met from both of its sides.
    census.unorientable = walk.clashes / 2;
    (components, walk.flip)
}

struct Walk<'a> {
    mesh: &'a Mesh,
    twins: &'a [u32],
    seen: Vec<bool>,
    flip: Vec<bool>,
    clashes: usize,
}

impl Walk<'_> {
    /// All that can be reached from `first`, breadth first.
    fn component(&mut self, first: u32) -> Component {
        self.seen[first as usize] = true;
        let mut faces = vec![first];
        let mut next = 0;
        let mut closed = true;
        while let Some(&face) = faces.get(next) {
            next += 1;
            for half_edge in 3 * face..3 * face + 3 {
                closed &= self.cross(half_edge, &mut faces);
            }
        }
        let (low, high) = bounds(self.mesh, &faces);
        Component { faces, closed, low, high }
    }

    /// Steps over an edge; whether there is a face that can agree with this one.
    fn cross(&mut self, half_edge: u32, faces: &mut Vec<u32>) -> bool {
        let twin = self.twins[half_edge as usize];
        if twin == NONE {
            return false;
        }
        // Neighbours agree when they run along their edge in opposite directions.
        let start = |half_edge| ends(&self.mesh.faces, half_edge).0;
        let agree = start(half_edge) != start(twin);
        let wanted = self.flip[half_edge as usize / 3] == agree;
        let neighbour = twin as usize / 3;
        if self.seen[neighbour] {
            self.clashes += usize::from(self.flip[neighbour] != wanted);
            return self.flip[neighbour] == wanted;
        }
        self.seen[neighbour] = true;
        self.flip[neighbour] = wanted;
        faces.push(neighbour as u32);
        true
    }
}

fn bounds(mesh: &Mesh, faces: &[u32]) -> (Point, Point) {
    let first = mesh.corners(faces[0] as usize)[0];
    let corners = faces.iter().flat_map(|&face| mesh.corners(face as usize));
    corners.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)))
}
