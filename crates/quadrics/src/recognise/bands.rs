//! Bands: walls that are hardly wider than a face or than the noise, between surfaces that are known. Rims of
//! sheet metal, spokes, chamfers of one row of faces.
//!
//! All vertices of such a band lie on its neighbours, too, and its raw normals err by the noise over its width:
//! no neighbourhood shows it, and its neighbours divide its faces. But where a vertex lies on a known surface, its
//! error across that surface is known: with the vertices moved there, the faces that span from one surface to the
//! other stand across both.

use super::assign::{Model, connect};
use super::detect::most_misfit;
use super::expand::expand;
use super::moves::{LABEL, SAMPLES, drop_needless, tidy};
use super::scene::{Gathered, Marks, Scene};
use super::standing::{Band, Standing, bands};
use crate::math::Point;
use crate::partition::Regions;
use crate::surface::Surface;
use crate::surface::related::Shown;
use crate::surface::select::{self, Choice};

/// Fewest faces of a band.
const FEWEST: usize = 10;
/// Least cosine between a surface and the normal of a face, and the mean of those of all its faces.
const AGREES: f64 = 0.85;
/// Every how many faces of a band a surface starts to grow, how often it is fitted again, and how often what is left
/// is asked.
const SEEDS: usize = 4;
const REFITS: usize = 5;
const PASSES: usize = 4;
/// A face is of a surface that its corners lie within so many sigmas of.
const REACH: f64 = 2.5;
/// Bands that lie within so many faces of each other may be one.
const GAP: usize = 6;

/// Looks for bands between the regions and makes regions of them. `scene` learns where their vertices lie and how
/// their faces stand.
pub fn find(scene: &mut Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let bands = bands(scene, models, labels);
    // A few faces are no region, but may be the end of one.
    for one in bands.iter().flat_map(|band| &band.faces) {
        scene.normals.to_mut()[one.face as usize] = one.normal;
    }
    let walls = models.len();
    let parts: Vec<Part> = bands.iter().flat_map(|band| parts(scene, models, band)).collect();
    for Part { surface, faces } in parts {
        place(scene, &surface, &faces);
        let faces: Vec<u32> = faces.iter().map(|one| one.face).collect();
        faces.iter().for_each(|&face| labels[face as usize] = models.len() as u32);
        models.push(Model::new(scene, surface, &faces));
    }
    if models.len() == walls {
        return;
    }
    scene.banded = labels.iter().map(|&label| label as usize >= walls).collect();
    expand(scene, models, labels);
    connect(scene, models, labels);
    tidy(models, labels);
    drop_needless(scene, models, labels);
    tidy(models, labels);
    unite(scene, models, labels);
    // What is one now may have a gap.
    connect(scene, models, labels);
    tidy(models, labels);
}

/// Faces of a band that one surface explains.
struct Part<'a> {
    surface: Surface,
    faces: Vec<&'a Standing>,
}

/// The surfaces of a band, the largest first.
fn parts<'a>(scene: &Scene, models: &[Model], band: &'a Band) -> Vec<Part<'a>> {
    let mut parts = Vec::new();
    let mut left = vec![true; band.faces.len()];
    for _ in 0..PASSES {
        // What has grown over a face would grow from it.
        let mut open = left.clone();
        let mut all = Vec::new();
        for seed in (0..band.faces.len() as u32).step_by(SEEDS) {
            if open[seed as usize]
                && let Some(grown) = grow(scene, models, band, seed, &left)
            {
                grown.1.iter().for_each(|&place| open[place as usize] = false);
                all.push(grown);
            }
        }
        if all.is_empty() {
            break;
        }
        all.sort_by_key(|(_, places)| std::cmp::Reverse(places.len()));
        for (surface, mut places) in all {
            places.retain(|&place| left[place as usize]);
            if places.len() >= FEWEST {
                places.iter().for_each(|&place| left[place as usize] = false);
                let faces = places.iter().map(|&place| &band.faces[place as usize]).collect();
                parts.push(Part { surface, faces });
            }
        }
    }
    parts
}

/// What grows from a face of a band over those that are left.
fn grow(
    scene: &Scene,
    models: &[Model],
    band: &Band,
    seed: u32,
    left: &[bool],
) -> Option<(Surface, Vec<u32>)> {
    let mut places = band.around(seed, FEWEST, |place| left[place as usize]);
    let mut surface = None;
    for _ in 0..REFITS {
        if places.len() < FEWEST {
            return None;
        }
        let faces: Vec<&Standing> =
            places.iter().map(|&place| &band.faces[place as usize]).collect();
        let own = fit(scene, models, &faces)?;
        let model = Model { side: side(&own, &faces), surface: own };
        let explains = |place: u32| {
            left[place as usize] && explains(scene, &model, &band.faces[place as usize])
        };
        let grown = band.around(seed, usize::MAX, explains);
        let settled = grown.len() == places.len();
        (places, surface) = (grown, Some(model.surface));
        if settled {
            break;
        }
    }
    (places.len() >= FEWEST).then_some((surface?, places))
}

/// The cosine between a surface and the normal of a face.
fn cosine(surface: &Surface, one: &Standing) -> f64 {
    surface.normal(one.middle()).map_or(0.0, |own| own.dot(&one.normal))
}

/// +1 where the faces' normals agree with the surface's.
fn side(surface: &Surface, faces: &[&Standing]) -> f64 {
    faces.iter().map(|one| cosine(surface, one)).sum::<f64>().signum()
}

/// Whether a face lies on a surface and stands as it does.
fn explains(scene: &Scene, model: &Model, one: &Standing) -> bool {
    let near = |corner: &Point| {
        let distance = model.surface.distance(*corner);
        distance.is_some_and(|distance| distance.abs() < REACH * scene.evidence.sigma)
    };
    one.corners.iter().all(near) && model.side * cosine(&model.surface, one) > AGREES
}

/// The best surface for faces of a band.
fn fit(scene: &Scene, models: &[Model], band: &[&Standing]) -> Option<Surface> {
    let mut corners: Vec<(u32, usize, &Standing)> = Vec::with_capacity(3 * band.len());
    for one in band {
        corners.extend((0..3).map(|k| (scene.mesh.faces[one.face as usize][k], k, *one)));
    }
    corners.sort_by_key(|&(vertex, ..)| vertex);
    corners.dedup_by_key(|&mut (vertex, ..)| vertex);
    let mut gathered = Gathered::default();
    for (_, k, one) in corners {
        gathered.points.push(one.corners[k]);
        gathered.barycentres.push(one.middle());
        gathered.normals.push(one.normal);
    }
    gathered.total = gathered.points.len();
    let mut homes: Vec<u32> = band.iter().flat_map(|one| one.homes).collect();
    homes.sort_unstable();
    homes.dedup();
    let walls: Vec<Surface> = homes.iter().map(|&id| models[id as usize].surface.clone()).collect();
    best(scene, &gathered, &Shown::of(&walls)).map(|choice| choice.surface)
}

/// The best plane, cylinder or cone that normals agree with, of those that surfaces beside it show: positions alone
/// do not tell how a wall stands that is no wider than the noise.
fn best(scene: &Scene, gathered: &Gathered, shown: &Shown) -> Option<Choice> {
    let samples = gathered.samples();
    let related = shown.nearest(&gathered.points).map(|surface| {
        let cost = select::cost(&surface) - shown.held(&surface).0;
        judge(scene, surface, cost, gathered)
    });
    let agrees = |choice: &Choice| {
        choice.misfit < most_misfit(2 * gathered.total)
            && select::agreement(&choice.surface, samples) > AGREES
    };
    related.filter(agrees).min_by(|a, b| a.criterion.total_cmp(&b.criterion))
}

fn judge(scene: &Scene, surface: Surface, cost: f64, gathered: &Gathered) -> Choice {
    select::judge_at(cost, surface, &gathered.points, gathered.total, scene.evidence)
}

/// Puts the vertices of a band onto their surfaces, and the normals of its faces onto its own.
fn place(scene: &mut Scene, surface: &Surface, band: &[&Standing]) {
    for one in band {
        let (normals, mesh) = (scene.normals.to_mut(), scene.mesh.to_mut());
        let own = surface.normal(one.middle()).map(|own| own.into_inner());
        let side = own.map_or(1.0, |own| own.dot(&one.normal).signum());
        normals[one.face as usize] = own.unwrap_or(one.normal) * side;
        for (vertex, corner) in mesh.faces[one.face as usize].into_iter().zip(one.corners) {
            mesh.positions[vertex as usize] = corner;
        }
    }
}

/// Unites bands that lie within a few faces of each other and that one surface explains.
fn unite(scene: &Scene, models: &mut Vec<Model>, labels: &mut [u32]) {
    let mut marks = Marks::default();
    loop {
        let regions = Regions::new(labels);
        let is_band: Vec<bool> = regions.iter().map(|faces| scene.is_band(faces)).collect();
        let bands = (0..regions.len() as u32).filter(|&id| is_band[id as usize]);
        let pairs = bands.flat_map(|id| {
            let near = near(scene, labels, id, regions.faces(id as usize), &mut marks);
            near.into_iter().map(move |other| (id, other))
        });
        let pairs: Vec<(u32, u32)> =
            pairs.filter(|&(id, other)| other > id && is_band[other as usize]).collect();
        let mut unions: Vec<(f64, (u32, u32), Surface)> = Vec::new();
        for (one, other) in pairs {
            let pair = [one, other];
            let faces = pair.map(|id| regions.faces(id as usize));
            let own = pair.map(|id| models[id as usize].surface.clone());
            let mut gather = |faces: &[u32]| scene.samples(faces, SAMPLES, &mut marks);
            let apart = |(surface, faces): (&Surface, &[u32])| {
                let gathered = gather(faces);
                judge(scene, surface.clone(), select::cost(surface), &gathered).criterion
            };
            let apart: f64 = own.iter().zip(faces).map(apart).sum();
            let gathered = scene.samples(&faces.concat(), SAMPLES, &mut marks);
            let Some(choice) = best(scene, &gathered, &Shown::of(&own)) else { continue };
            let gain = apart + 2.0 * LABEL - choice.criterion;
            if gain > 0.0 {
                unions.push((gain, (one, other), choice.surface));
            }
        }
        if unions.is_empty() {
            return;
        }
        unions.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut busy = vec![false; models.len()];
        for (_, (one, other), surface) in unions {
            if !busy[one as usize] && !busy[other as usize] {
                busy[one as usize] = true;
                busy[other as usize] = true;
                regions.faces(other as usize).iter().for_each(|&face| labels[face as usize] = one);
                models[one as usize].surface = surface;
            }
        }
        tidy(models, labels);
    }
}

/// The regions that are reached from some faces of one over a few faces.
fn near(scene: &Scene, labels: &[u32], id: u32, faces: &[u32], marks: &mut Marks) -> Vec<u32> {
    marks.clear(labels.len());
    let mut wave = faces.to_vec();
    wave.iter().for_each(|&face| _ = marks.mark(face));
    let mut near: Vec<u32> = Vec::new();
    for _ in 0..GAP {
        let across = wave.iter().flat_map(|&face| scene.adjacency.across(face as usize));
        wave = across.map(|face| face as u32).filter(|&face| marks.mark(face)).collect();
        near.extend(wave.iter().map(|&face| labels[face as usize]).filter(|&label| label != id));
    }
    near.sort_unstable();
    near.dedup();
    near
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::Context;
    use crate::math::{Unit, Vector};
    use crate::mesh::{Mesh, Working};
    use crate::recognise::assign::models;
    use crate::surface::Plane;
    use crate::synth::{self, Noise};

    /// Vertices along a side of the sheet, and its size.
    const SIDE: u32 = 24;
    const EDGE: f64 = 1.0 / (SIDE - 1) as f64;

    fn corner(k: u32, i: u32, j: u32) -> u32 {
        (k * SIDE + i) * SIDE + j
    }

    /// The corners of the squares of a side of the sheet.
    fn quads(k: u32) -> impl Iterator<Item = [u32; 4]> {
        let all = (0..SIDE - 1).flat_map(|i| (0..SIDE - 1).map(move |j| (i, j)));
        all.map(move |(i, j)| {
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(k, i, j))
        })
    }

    /// A square sheet as thick as a face is wide, its rim one row of faces. Labels are 0 above and 1 below, and
    /// either on the rim, as noise has it.
    fn sheet() -> (Mesh, Vec<u32>) {
        let at = |n: u32| {
            let [x, y] = [n / SIDE % SIDE, n % SIDE].map(|n| f64::from(n) * EDGE);
            Point::new(x, y, if n < SIDE * SIDE { EDGE } else { 0.0 })
        };
        let last = SIDE - 1;
        let rim = (0..last).flat_map(|n| {
            let sides = [[(n, 0), (n + 1, 0)], [(last, n), (last, n + 1)]];
            let others = [[(n + 1, last), (n, last)], [(0, n + 1), (0, n)]];
            sides.into_iter().chain(others).map(move |ends| {
                let [a, b] = ends.map(|(i, j)| corner(0, i, j));
                let [d, c] = ends.map(|(i, j)| corner(1, i, j));
                ([a, d, c, b], [n % 2, n / 2 % 2])
            })
        });
        let above = quads(0).map(|quad| (quad, [0, 0]));
        let below = quads(1).map(|[a, b, c, d]| ([a, d, c, b], [1, 1]));
        let (quads, labels): (Vec<_>, Vec<_>) = above.chain(below).chain(rim).unzip();
        let faces = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let positions = (0..2 * SIDE * SIDE).map(at).collect();
        (Mesh { positions, faces }, labels.concat())
    }

    /// What is seen of a mesh under noise of that sigma whose regions are two planes.
    fn seen<T>(
        (mesh, mut labels): (&Mesh, Vec<u32>),
        planes: [Plane; 2],
        (sigma, seed): (f64, u64),
        look: impl Fn(&mut Scene, &mut Vec<Model>, &mut [u32]) -> T,
    ) -> (T, Vec<Model>, Vec<u32>) {
        let noise = Noise::uniform(3f64.sqrt() * sigma, 1.0);
        let noisy = synth::add_noise(&mut Context::new(seed), mesh, &noise).unwrap();
        let working = Working::new(noisy);
        let mut scene = Scene::raw(&working);
        scene.evidence.sigma = sigma;
        scene.evidence.general = false;
        scene.filter_for_borders();
        let planes = planes.map(Surface::Plane);
        let mut models = models(&scene, &Regions::new(&labels), planes.iter());
        (look(&mut scene, &mut models, &mut labels), models, labels)
    }

    /// A plane across the z axis.
    fn level(height: f64, normal: Unit) -> Plane {
        Plane::through(Point::new(0.0, 0.0, height), normal)
    }

    #[test]
    fn the_rim_of_a_sheet_is_four_walls_that_stand_on_it() {
        let up: Unit = Vector::z_axis();
        let (mesh, labels) = sheet();
        let planes = [level(EDGE, up), level(0.0, -up)];
        let ((), models, labels) = seen((&mesh, labels), planes, (EDGE / 3.0, 1), find);
        let regions = Regions::new(&labels);
        let walls = models.iter().zip(regions.iter()).skip(2);
        let walls: Vec<_> = walls.filter(|(_, faces)| faces.len() > SIDE as usize).collect();
        assert_eq!(walls.len(), 4, "{models:?}");
        for (wall, _) in walls {
            let Surface::Plane(Plane { normal, .. }) = wall.surface else { panic!("{wall:?}") };
            assert!(normal.x.abs().max(normal.y.abs()) > 0.99, "{normal:?}");
        }
    }

    #[test]
    fn noise_between_two_levels_is_no_wall() {
        let up: Unit = Vector::z_axis();
        let (sheet, _) = sheet();
        let above = 2 * (SIDE - 1) * (SIDE - 1);
        let mesh = Mesh { faces: sheet.faces[..above as usize].to_vec(), ..sheet };
        // Two halves of one plane that chance has put 0.6 sigmas apart, with a ragged border.
        let half = |face: u32| u32::from(face / 2 % (SIDE - 1) > SIDE / 2 + face % 5);
        let labels: Vec<u32> = (0..above).map(half).collect();
        let sigma = EDGE;
        for seed in 0..20 {
            let planes = [level(EDGE, up), level(EDGE + 0.6 * sigma, up)];
            let certain = |scene: &mut Scene, models: &mut Vec<Model>, labels: &mut [u32]| {
                bands(scene, models, labels).iter().map(|band| band.faces.len()).max()
            };
            let (longest, ..) = seen((&mesh, labels.clone()), planes, (sigma, seed), certain);
            assert!(longest.is_none(), "seed {seed}: {longest:?}");
        }
    }
}
