//! Faces that stand across the surfaces that their corners lie on, and the bands that they make.

use super::assign::Model;
use super::scene::Scene;
use crate::math::{Point, Unit, Vector};

/// A face stands across the surfaces that its corners lie on where it turns from all of them by more, in radians.
const ACROSS: f64 = 0.6;
/// The least that a face says of where its corners lie, of one.
const LEAST: f64 = 0.01;
/// Rounds in which the faces of a band take the mean of their normals: their vertices still err along it.
const ROUNDS: usize = 6;
/// Faces whose normals have a lesser cosine are not of one band, and do not mix.
const MIXES: f64 = 0.3;
/// Surfaces look in opposite ways where the cosine of their normals is below minus this.
const OPPOSED: f64 = 0.5;
/// Faces of a band, times the squared distance, in sigmas, that three quarters of its corners keep from each other's
/// surface: from here on it stands between surfaces that might meet. Of bands that say less a fifth are right, of
/// those that say more two thirds (decision 0002).
const CERTAIN: f64 = 40.0;

const NONE: u32 = u32::MAX;

/// A face as it is with its vertices on their surfaces.
pub struct Standing {
    /// Which.
    pub face: u32,
    /// The regions on whose surfaces its corners lie.
    pub homes: [u32; 3],
    /// The corners, on these surfaces.
    pub corners: [Point; 3],
    area: f64,
    /// Its own; in a band, the mean of those around it.
    pub normal: Vector,
}

impl Standing {
    /// Its barycentre.
    pub fn middle(&self) -> Point {
        middle(self.corners)
    }
}

/// Faces that stand across what is beside them and hang together.
pub struct Band {
    /// Which, and how they stand.
    pub faces: Vec<Standing>,
    /// Places in the band of those beside each.
    beside: Vec<Vec<u32>>,
}

impl Band {
    fn new(scene: &Scene, faces: Vec<Standing>) -> Self {
        let mut order: Vec<(u32, u32)> = faces.iter().map(|one| one.face).zip(0..).collect();
        order.sort_unstable();
        let place = |face: usize| {
            let at = order.binary_search_by_key(&(face as u32), |&(face, _)| face);
            at.ok().map(|at| order[at].1)
        };
        let beside = |one: &Standing| scene.adjacency.across(one.face as usize).filter_map(place);
        let beside = faces.iter().map(|one| beside(one).collect()).collect();
        Self { faces, beside }
    }

    /// Places of at most so many faces around one, nearest first, over those that are let in.
    pub fn around(&self, start: u32, most: usize, may: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut found = vec![start];
        let mut seen = vec![false; self.faces.len()];
        seen[start as usize] = true;
        let mut next = 0;
        while next < found.len() && found.len() < most {
            for &other in &self.beside[found[next] as usize] {
                if may(other) && !std::mem::replace(&mut seen[other as usize], true) {
                    found.push(other);
                }
            }
            next += 1;
        }
        found
    }
}

/// The bands of faces that must be there.
pub fn bands(scene: &Scene, models: &[Model], labels: &[u32]) -> Vec<Band> {
    let mut bands = connected(scene, standing(scene, models, labels));
    bands.retain(|band| is_certain(scene, models, &band.faces));
    bands
}

/// All faces that stand across the surfaces of their corners.
fn standing(scene: &Scene, models: &[Model], labels: &[u32]) -> Vec<Standing> {
    let home = homes(scene, models, labels);
    let stand = |face| stand(scene, models, &home, face);
    (0..labels.len() as u32).filter_map(stand).collect()
}

/// The region on whose surface each vertex lies, among those that meet there.
fn homes(scene: &Scene, models: &[Model], labels: &[u32]) -> Vec<u32> {
    // How a face lies on the surface that it is labelled by: a band's lie on none.
    let lies = |&face: &u32| {
        let model = &models[labels[face as usize] as usize];
        let own = model.surface.normal(scene.geometry.barycentres[face as usize]);
        let along = |own: Unit| model.side * own.dot(&scene.geometry.normals[face as usize]);
        (labels[face as usize], own.map_or(0.0, along).max(LEAST).powi(2))
    };
    let home = |vertex: u32| {
        let around = scene.adjacency.around(vertex);
        let first = labels[*around.first()? as usize];
        if around.iter().all(|&face| labels[face as usize] == first) {
            return Some(first);
        }
        let at = scene.mesh.positions[vertex as usize];
        let mut own: Vec<(u32, f64)> = around.iter().map(lies).collect();
        own.sort_unstable_by_key(|&(label, _)| label);
        let cost = |same: &[(u32, f64)]| {
            let distance = models[same[0].0 as usize].surface.distance(at)?;
            let share: f64 = same.iter().map(|&(_, lies)| lies).sum();
            let far = (distance / scene.evidence.sigma).powi(2) / 2.0;
            Some((far - share.ln(), same[0].0))
        };
        let best =
            own.chunk_by(|a, b| a.0 == b.0).filter_map(cost).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|best| best.1)
    };
    (0..scene.mesh.positions.len() as u32).map(|vertex| home(vertex).unwrap_or(NONE)).collect()
}

/// A face that stands across all surfaces that its corners lie on, of which there are more than one.
fn stand(scene: &Scene, models: &[Model], home: &[u32], face: u32) -> Option<Standing> {
    let homes = scene.mesh.faces[face as usize].map(|vertex| home[vertex as usize]);
    if homes[0] == homes[1] && homes[1] == homes[2] {
        return None;
    }
    let mut corners = scene.mesh.corners(face as usize);
    for (corner, home) in corners.iter_mut().zip(homes) {
        let surface = &models.get(home as usize)?.surface;
        *corner -= surface.normal(*corner)?.into_inner() * surface.distance(*corner)?;
    }
    let [a, b, c] = corners;
    let cross = (b - a).cross(&(c - a));
    let normal = cross.try_normalize(f64::MIN_POSITIVE)?;
    let middle = middle(corners);
    for home in homes {
        let model = &models[home as usize];
        if model.side * model.surface.normal(middle)?.dot(&normal) > ACROSS.cos() {
            return None;
        }
    }
    Some(Standing { face, homes, corners, area: cross.norm() / 2.0, normal })
}

fn middle([a, b, c]: [Point; 3]) -> Point {
    Point::from((a.coords + b.coords + c.coords) / 3.0)
}

/// Standing faces that hang together.
fn connected(scene: &Scene, mut standing: Vec<Standing>) -> Vec<Band> {
    let mut place = vec![NONE; scene.mesh.faces.len()];
    standing.iter().zip(0..).for_each(|(one, i)| place[one.face as usize] = i);
    let across = |one: &Standing| {
        let places = scene.adjacency.across(one.face as usize).map(|face| place[face]);
        places.filter(|&place| place != NONE).collect()
    };
    let beside: Vec<Vec<u32>> = standing.iter().map(across).collect();
    for _ in 0..ROUNDS {
        let mixed = |(one, beside): (&Standing, &Vec<u32>)| {
            let near = beside.iter().map(|&i| &standing[i as usize]).chain([one]);
            let near = near.filter(|other| other.normal.dot(&one.normal) > MIXES);
            let sum: Vector = near.map(|other| other.normal * other.area).sum();
            sum.try_normalize(f64::MIN_POSITIVE).unwrap_or(one.normal)
        };
        let mixed: Vec<Vector> = standing.iter().zip(&beside).map(mixed).collect();
        standing.iter_mut().zip(mixed).for_each(|(one, normal)| one.normal = normal);
    }
    let mut standing: Vec<Option<Standing>> = standing.into_iter().map(Some).collect();
    let same = |standing: &[Option<Standing>], one: &Standing, other: u32| {
        let other = standing[other as usize].as_ref();
        other.is_some_and(|other| one.normal.dot(&other.normal) > MIXES)
    };
    let mut bands = Vec::new();
    for start in 0..standing.len() {
        let Some(first) = standing[start].take() else { continue };
        let (mut faces, mut places) = (vec![first], vec![start]);
        let mut next = 0;
        while next < faces.len() {
            for &other in &beside[places[next]] {
                if same(&standing, &faces[next], other) {
                    places.push(other as usize);
                    faces.extend(standing[other as usize].take());
                }
            }
            next += 1;
        }
        bands.push(Band::new(scene, faces));
    }
    bands
}

/// Whether a band must be there: because it parts surfaces that look in opposite ways, which cannot meet, or because
/// its corners lie too far off each other's surface to be of one.
fn is_certain(scene: &Scene, models: &[Model], band: &[Standing]) -> bool {
    let mut apart: Vec<f64> = Vec::new();
    let mut opposed = 0;
    for one in band {
        let at = one.middle();
        let ways = one.homes.map(|home| {
            let model = &models[home as usize];
            model.surface.normal(at).map_or(Vector::zeros(), |way| way.into_inner() * model.side)
        });
        let against = |(i, j): (usize, usize)| ways[i].dot(&ways[j]) < -OPPOSED;
        opposed += usize::from([(0, 1), (1, 2), (2, 0)].into_iter().any(against));
        for (corner, home) in one.corners.iter().zip(one.homes) {
            let others = one.homes.into_iter().filter(|&other| other != home);
            let away = others.filter_map(|other| models[other as usize].surface.distance(*corner));
            apart.extend(away.map(f64::abs).min_by(f64::total_cmp));
        }
    }
    if apart.is_empty() {
        return false;
    }
    let at = apart.len() / 4;
    let (_, quartile, _) = apart.select_nth_unstable_by(at, f64::total_cmp);
    let evidence = band.len() as f64 * (*quartile / scene.evidence.sigma).powi(2);
    2 * opposed > band.len() || evidence > CERTAIN
}
