//! One winding for all: neighbours agree, and closed components look outward.
//!
//! A component is what hangs together over edges of exactly two faces. Within it the winding is
//! settled by its first face; as a whole it is then turned
//! * outward by its signed volume, if it is closed;
//! * along with the component around it, if it is closed and lies in the box of another: it may be a
//!   void, whose normals rightly point inward;
//! * as most of its faces were, if it is open.

use rayon::prelude::*;

use super::Mesh;
use super::adjacency::{NONE, twins};
use super::windings::Windings;
use crate::math::Point;

/// How many of the largest closed components are asked whether they enclose another: all pairs would
/// be quadratic, and a void lies in something large.
const ENCLOSERS: usize = 64;

/// Faces whose volumes one thread adds up.
const CHUNK: usize = 1 << 14;

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
    let (mut census, windings, open) = walk(mesh);
    let (component, mut flip, count) = windings.components();
    let mut components = components(mesh, &component, &flip, count);
    open.into_iter().for_each(|face| components[component[face as usize] as usize].closed = false);
    let turned = turned(&components);
    census.components = count;
    census.closed_components = components.iter().filter(|component| component.closed).count();
    for ((corners, flip), component) in mesh.faces.iter_mut().zip(&mut flip).zip(component) {
        *flip ^= turned[component as usize];
        if *flip {
            corners.swap(1, 2);
            census.flipped += 1;
        }
    }
    census
}

/// Counts the edges, joins the faces across them, and names faces beside which no other can agree.
fn walk(mesh: &Mesh) -> (Census, Windings, Vec<u32>) {
    let count = |census: &mut Census, edge: &[u32]| {
        census.edges += 1;
        census.border += usize::from(edge.len() == 1);
        census.non_manifold += usize::from(edge.len() > 2);
    };
    let (twins, counts) = twins(&mesh.faces, mesh.positions.len(), count);
    let sum = |of: fn(&Census) -> usize| counts.iter().map(of).sum();
    let mut census = Census {
        edges: sum(|census| census.edges),
        border: sum(|census| census.border),
        non_manifold: sum(|census| census.non_manifold),
        ..Census::default()
    };
    let mut windings = Windings::new(mesh.faces.len());
    let mut open = Vec::new();
    for (face, (corners, twins)) in (0..).zip(mesh.faces.iter().zip(&twins)) {
        for (start, &twin) in corners.iter().zip(twins) {
            let other = twin / 3;
            if twin == NONE {
                open.push(face);
            } else if other > face {
                // Neighbours agree when they run along their edge in opposite directions.
                let agree = *start != mesh.faces[other as usize][twin as usize % 3];
                if !windings.join(face, other, agree) {
                    census.unorientable += 1;
                    open.push(face);
                }
            }
        }
    }
    (census, windings, open)
}

struct Component {
    low: Point,
    high: Point,
    faces: usize,
    /// Faces that are wound against the first.
    flipped: usize,
    /// Six times the volume, were all faces wound as the first.
    volume: f64,
    closed: bool,
}

impl Component {
    /// Some faces of one component, where `origin` is near.
    fn of(mesh: &Mesh, faces: &[u32], flip: &[bool], origin: Point) -> Self {
        let mut own = Self {
            low: origin,
            high: origin,
            faces: faces.len(),
            flipped: 0,
            volume: 0.0,
            closed: true,
        };
        for &face in faces {
            let flip = flip[face as usize];
            let corners = mesh.corners(face as usize);
            for p in corners {
                (own.low, own.high) = (own.low.inf(&p), own.high.sup(&p));
            }
            // Far from the component the terms would cancel.
            let [a, b, c] = corners.map(|p| p - origin);
            let volume = a.dot(&b.cross(&c));
            own.volume += if flip { -volume } else { volume };
            own.flipped += usize::from(flip);
        }
        own
    }

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
            faces: self.faces + other.faces,
            flipped: self.flipped + other.flipped,
            volume: self.volume + other.volume,
            closed: self.closed && other.closed,
        }
    }

    fn extent(&self) -> f64 {
        (self.high - self.low).max()
    }

    fn holds(&self, other: &Component) -> bool {
        (0..3).all(|i| self.low[i] < other.low[i] && other.high[i] < self.high[i])
    }

    fn mostly_flipped(&self) -> bool {
        2 * self.flipped > self.faces
    }
}

/// All components, as if closed.
fn components(mesh: &Mesh, component: &[u32], flip: &[bool], count: usize) -> Vec<Component> {
    let mut faces: Vec<u32> = (0..component.len() as u32).collect();
    if count > 1 {
        faces.par_sort_unstable_by_key(|&face| (component[face as usize], face));
    }
    let all: Vec<&[u32]> =
        faces.chunk_by(|&f, &g| component[f as usize] == component[g as usize]).collect();
    let whole = |faces: &[u32]| {
        let origin = mesh.corners(faces[0] as usize)[0];
        let part = |faces| Component::of(mesh, faces, flip, origin);
        // Parts do not depend on threads, and so neither does the sum.
        let parts: Vec<Component> = faces.par_chunks(CHUNK).map(part).collect();
        parts.into_iter().reduce(Component::with)
    };
    all.into_par_iter().filter_map(whole).collect()
}

/// Which components must be turned against their first face.
fn turned(components: &[Component]) -> Vec<bool> {
    // From the largest: what lies in another is settled after it.
    let mut order: Vec<usize> = (0..components.len()).collect();
    order.sort_by(|&i, &j| components[j].extent().total_cmp(&components[i].extent()));
    let mut turned = vec![false; components.len()];
    // The largest closed ones, and whether the majority of their faces was turned.
    let mut enclosers: Vec<(usize, bool)> = Vec::new();
    for i in order {
        let component = &components[i];
        let mostly_flipped = component.mostly_flipped();
        let around =
            enclosers.iter().find(|(j, _)| component.closed && components[*j].holds(component));
        let against_majority = match around {
            Some(&(_, turned)) => turned,
            None => component.closed && (component.volume < 0.0) != mostly_flipped,
        };
        if component.closed && enclosers.len() < ENCLOSERS {
            enclosers.push((i, against_majority));
        }
        turned[i] = mostly_flipped != against_majority;
    }
    turned
}
