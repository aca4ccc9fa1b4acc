//! Which face belongs to which surface: what a face costs on each, and regions that hang together.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::scene::{Marks, Scene};
use crate::partition::{Regions, UNLABELLED, components};
use crate::surface::{Shape, Surface};

/// A surface in the partition.
#[derive(Debug, Clone)]
pub struct Model {
    /// The surface.
    pub surface: Surface,
    /// +1 where the mesh's normals agree with the surface's, else -1.
    pub side: f64,
}

impl Model {
    /// A surface as some faces see it.
    pub fn new(scene: &Scene, surface: Surface, faces: &[u32]) -> Self {
        Self { side: side_of(scene, &surface, faces), surface }
    }
}

/// The surfaces of all regions, as their faces see them.
pub fn models<'a>(
    scene: &Scene,
    regions: &Regions,
    surfaces: impl Iterator<Item = &'a Surface>,
) -> Vec<Model> {
    let pairs = regions.iter().zip(surfaces);
    pairs.map(|(faces, surface)| Model::new(scene, surface.clone(), faces)).collect()
}

/// +1 where the faces' normals agree with the surface's.
pub fn side_of(scene: &Scene, surface: &Surface, faces: &[u32]) -> f64 {
    let step = (faces.len() / 64).max(1);
    let agreement: f64 = faces
        .iter()
        .step_by(step)
        .filter_map(|&f| {
            let normal = surface.normal(scene.geometry.barycentres[f as usize])?;
            Some(normal.dot(&scene.normals[f as usize]))
        })
        .sum();
    if agreement < 0.0 { -1.0 } else { 1.0 }
}

/// The normal term counts at most so much: creases turn filtered normals by any angle.
pub const NORMAL_CAP: f64 = 6.0;
/// What a face of a free-form region costs.
const FREE_FORM: f64 = 8.0;
/// Cost of a mean edge between two regions: smooth boundaries under independent noise; less where
/// faces tell by themselves; on scans, whose edges are a triangle wide, little.
const SMOOTHNESS: f64 = 2.0;
const SMOOTHNESS_NOISY: f64 = 3.0;
const SMOOTHNESS_SCAN: f64 = 0.3;

/// Minus the log-likelihood of a face on a surface: `d²/2σ²` of its corners and a capped normal term.
pub fn face_cost(scene: &Scene, model: &Model, face: usize) -> f64 {
    match &model.surface {
        Surface::Plane(s) => cost(scene, s, model.side, face),
        Surface::Sphere(s) => cost(scene, s, model.side, face),
        Surface::Cylinder(s) => cost(scene, s, model.side, face),
        Surface::Cone(s) => cost(scene, s, model.side, face),
        Surface::Torus(s) => cost(scene, s, model.side, face),
        Surface::Quadric(s) => cost(scene, &s.principal(), model.side, face),
        Surface::FreeForm => FREE_FORM,
    }
}

fn cost<S: Shape>(scene: &Scene, shape: &S, side: f64, face: usize) -> f64 {
    let sigma = scene.evidence.sigma;
    let position = scene.squared_distance(shape, face) / (2.0 * sigma * sigma);
    let normal =
        scene.normal_deviation(shape, face, side) / (2.0 * scene.evidence.normal_sigma.powi(2));
    position + normal.min(NORMAL_CAP)
}

/// Cost of a border along an edge of a face.
pub(super) fn border_cost(scene: &Scene, face: usize, edge: usize) -> f64 {
    let [a, b] = [edge, (edge + 1) % 3].map(|k| scene.mesh.faces[face][k] as usize);
    let length = (scene.mesh.positions[a] - scene.mesh.positions[b]).norm() / scene.edge;
    let smoothness = if scene.correlated() {
        SMOOTHNESS_SCAN
    } else if scene.noisy() {
        SMOOTHNESS_NOISY
    } else {
        SMOOTHNESS
    };
    length * smoothness
}

/// Hands unlabelled faces to a neighbour's surface, the best fitting face first.
pub fn flood(scene: &Scene, models: &[Model], labels: &mut [u32]) {
    let mut queue = BinaryHeap::new();
    // The bits of a non-negative float sort like the number itself.
    let key = |cost: f64| (cost.max(0.0) as f32).to_bits();
    let push = |queue: &mut BinaryHeap<_>, face: usize, label: u32| {
        let cost = face_cost(scene, &models[label as usize], face);
        queue.push(Reverse((key(cost), face as u32, label)));
    };
    for face in 0..labels.len() {
        if labels[face] == UNLABELLED {
            for other in scene.adjacency.across(face).filter(|&o| labels[o] != UNLABELLED) {
                push(&mut queue, face, labels[other]);
            }
        }
    }
    while let Some(Reverse((_, face, label))) = queue.pop() {
        let face = face as usize;
        if labels[face] != UNLABELLED {
            continue;
        }
        labels[face] = label;
        for other in scene.adjacency.across(face).filter(|&o| labels[o] == UNLABELLED) {
            push(&mut queue, other, label);
        }
    }
}

/// Fewest faces of a piece that a cut left apart from its region and that stands on its own.
const PIECE: u32 = 40;
/// Pieces of a region this many faces apart are joined again: narrow bands tear at a single face.
const GAP: usize = 8;
/// Most rounds of mending; two bands that tear each other would never end.
const MENDS: usize = 5;
/// Pieces of fewer faces are not worth a bridge.
const CRUMB: u32 = 4;
/// What a face may cost on a surface to become a bridge between two pieces of its region.
const BRIDGE: f64 = 50.0;

/// Makes every region connected: torn bands are mended, large pieces become regions on the same
/// surface, crumbs join a neighbour.
pub fn connect(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    // Pieces join in pairs, so half of them are left each time.
    for _ in 0..MENDS {
        if !mend(scene, models, labels) {
            break;
        }
    }
    let (component, sizes) = components(labels, scene.adjacency);
    let largest = largest_pieces(labels, &component, &sizes, models.len());
    let mut own: Vec<u32> = vec![UNLABELLED; sizes.len()];
    for face in 0..labels.len() {
        let piece = component[face] as usize;
        let label = labels[face];
        if component[face] == largest[label as usize] {
            continue;
        }
        if own[piece] == UNLABELLED && sizes[piece] >= PIECE * scene.grain {
            own[piece] = models.len() as u32;
            models.push(models[label as usize].clone());
        }
        labels[face] = own[piece];
    }
    flood(scene, models, labels);
    name_the_rest(scene, models, labels);
}

/// A part of the mesh that touches no region becomes one, free-form, that nobody has to explain.
pub fn name_the_rest(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    if !labels.contains(&UNLABELLED) {
        return;
    }
    let (component, sizes) = components(labels, scene.adjacency);
    let mut own: Vec<u32> = vec![UNLABELLED; sizes.len()];
    for face in (0..labels.len()).filter(|&f| labels[f] == UNLABELLED).collect::<Vec<_>>() {
        let name = &mut own[component[face] as usize];
        if *name == UNLABELLED {
            *name = models.len() as u32;
            models.push(Model { surface: Surface::FreeForm, side: 1.0 });
        }
        labels[face] = *name;
    }
}

/// The component that is the largest of each label.
fn largest_pieces(labels: &[u32], component: &[u32], sizes: &[u32], count: usize) -> Vec<u32> {
    let mut largest = vec![UNLABELLED; count];
    for (face, &label) in labels.iter().enumerate() {
        let best = &mut largest[label as usize];
        if *best == UNLABELLED || sizes[component[face] as usize] > sizes[*best as usize] {
            *best = component[face];
        }
    }
    largest
}

/// Bridges small gaps between the pieces of a region over faces that its surface nearly explains.
/// Whether any was bridged.
fn mend(scene: &Scene, models: &[Model], labels: &mut [u32]) -> bool {
    let (component, sizes) = components(labels, scene.adjacency);
    let largest = largest_pieces(labels, &component, &sizes, models.len());
    let mut starts: Vec<Vec<u32>> = vec![Vec::new(); sizes.len()];
    for (face, &label) in labels.iter().enumerate() {
        if component[face] != largest[label as usize]
            && sizes[component[face] as usize] >= CRUMB * scene.grain
        {
            starts[component[face] as usize].push(face as u32);
        }
    }
    let mut seen = Marks::default();
    let mut bridged = false;
    for (piece, faces) in starts.iter().enumerate().filter(|(_, faces)| !faces.is_empty()) {
        let label = labels[faces[0] as usize];
        let model = &models[label as usize];
        seen.clear(labels.len());
        // Breadth first over foreign faces: (face, where it was reached from, hops).
        let mut walk: Vec<(u32, usize, usize)> = Vec::new();
        for &face in faces {
            seen.mark(face);
            walk.push((face, usize::MAX, 0));
        }
        let mut next = 0;
        let mut reached = None;
        while next < walk.len() && reached.is_none() {
            let (face, _, hops) = walk[next];
            for other in scene.adjacency.across(face as usize) {
                if labels[other] == label && component[other] as usize != piece {
                    reached = Some(next);
                    break;
                }
                if hops < GAP
                    && labels[other] != label
                    && face_cost(scene, model, other) < BRIDGE
                    && seen.mark(other as u32)
                {
                    walk.push((other as u32, next, hops + 1));
                }
            }
            next += 1;
        }
        let mut at = reached.unwrap_or(usize::MAX);
        while at != usize::MAX && walk[at].1 != usize::MAX {
            labels[walk[at].0 as usize] = label;
            at = walk[at].1;
            bridged = true;
        }
    }
    bridged
}
