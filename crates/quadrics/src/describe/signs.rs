//! Signs by which a region that is not one surface of the part is told, without knowing the part.

use crate::mesh::NONE;
use crate::recognise::assign::{Model, NORMAL_CAP, face_cost};
use crate::recognise::scene::{Marks, Scene};
use crate::surface::select;
use crate::surface::{Shape, Surface};

/// Vertices that are looked at.
const SAMPLES: usize = 400;
/// Two surfaces explain a face alike when it costs at most so much more on one of them, in nats.
const ALIKE: f64 = 1.0;

/// What a region shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signs {
    /// Mean of squared distances in squared sigmas, capped: 1 where only noise is left.
    pub misfit: f64,
    /// Mean cosine of its raw normals with those of its surface: low where faces look both ways.
    pub facing: f64,
    /// Mean of squared deviations of its normals, in nats, capped: high where surfaces cross the faces.
    pub turn: f64,
    /// Its overlap with the true region if borders are anywhere among the faces that it and a neighbour
    /// explain alike, and all those are wrong: intersection over union.
    pub overlap: f64,
    /// What its type costs ([`select::cost`]).
    pub cost: f64,
}

/// Log-odds that a region is right, as a sum over its signs: logistic regression over the regions of
/// 23 parts, clean, under noise and as scans, rounded (decision 0007). Fitted on half of the parts it
/// holds on the other half.
const START: f64 = 0.2;
const MISFIT: f64 = -2.0;
const FACING: f64 = 2.0;
const TURN: f64 = -0.6;
const OVERLAP: f64 = 5.0;
const COST: f64 = -0.5;

impl Signs {
    /// Probability that extent, type and surface are right.
    pub fn probability(&self) -> f64 {
        let odds = START
            + MISFIT * self.misfit
            + FACING * self.facing
            + TURN * self.turn
            + OVERLAP * self.overlap
            + COST * self.cost;
        1.0 / (1.0 + (-odds).exp())
    }
}

/// The regions whose signs are read.
pub struct Reader<'a> {
    /// The mesh and its noise.
    pub scene: &'a Scene<'a>,
    /// The region of every face.
    pub labels: &'a [u32],
    /// The surface of every region.
    pub models: &'a [Model],
}

impl Reader<'_> {
    /// Signs of a region and its faces; `None` for free-form.
    pub fn read(&self, id: usize, faces: &[u32], marks: &mut Marks) -> Option<Signs> {
        let Model { surface, side } = &self.models[id];
        let (facing, turn) = match surface {
            Surface::Plane(s) => self.normals(s, *side, faces),
            Surface::Sphere(s) => self.normals(s, *side, faces),
            Surface::Cylinder(s) => self.normals(s, *side, faces),
            Surface::Cone(s) => self.normals(s, *side, faces),
            Surface::Torus(s) => self.normals(s, *side, faces),
            Surface::Quadric(s) => self.normals(&s.principal(), *side, faces),
            Surface::FreeForm => return None,
        };
        let points = self.scene.samples(faces, SAMPLES, marks).points;
        let misfit = select::misfit(surface, &points, self.scene.evidence.sigma);
        let overlap = self.overlap(id as u32, faces, marks);
        Some(Signs { misfit, facing, turn, overlap, cost: select::cost(surface) })
    }

    fn normals<S: Shape>(&self, shape: &S, side: f64, faces: &[u32]) -> (f64, f64) {
        let (mut area, mut facing, mut turn) = (0.0, 0.0, 0.0);
        for &face in faces {
            let geometry = self.scene.geometry;
            let own = geometry.areas[face as usize];
            let squared = self.scene.normal_deviation(shape, face as usize, side);
            let at = geometry.barycentres[face as usize];
            let cosine =
                shape.normal(at).map_or(0.0, |n| side * n.dot(&geometry.normals[face as usize]));
            let nats = squared / (2.0 * self.scene.evidence.normal_sigma.powi(2));
            area += own;
            facing += own * cosine;
            turn += own * nats.min(NORMAL_CAP);
        }
        let area = area.max(f64::MIN_POSITIVE);
        (facing / area, turn / area)
    }

    fn overlap(&self, id: u32, faces: &[u32], marks: &mut Marks) -> f64 {
        let area = |faces: &[u32]| -> f64 {
            faces.iter().map(|&face| self.scene.geometry.areas[face as usize]).sum()
        };
        let across = |face: u32| self.scene.adjacency.neighbours[face as usize];
        let mut own = Vec::new();
        let mut theirs = Vec::new();
        for &face in faces {
            for other in across(face).into_iter().filter(|&other| other != NONE) {
                let label = self.labels[other as usize];
                if label != id {
                    own.push((face, label));
                    theirs.push((other, id));
                }
            }
        }
        let lost = area(&self.reached(own, marks, |label| label == id));
        let won = area(&self.reached(theirs, marks, |label| label != id));
        let area = area(faces);
        (area - lost) / (area + won).max(f64::MIN_POSITIVE)
    }

    /// Faces connected with the `starts`, each beside a region that explains them as well as their own.
    fn reached(
        &self,
        mut starts: Vec<(u32, u32)>,
        marks: &mut Marks,
        inside: impl Fn(u32) -> bool,
    ) -> Vec<u32> {
        marks.clear(self.labels.len());
        let mut reached = Vec::new();
        while let Some((face, rival)) = starts.pop() {
            let cost =
                |label: u32| face_cost(self.scene, &self.models[label as usize], face as usize);
            if marks.has(face) || cost(rival) - cost(self.labels[face as usize]) > ALIKE {
                continue;
            }
            marks.mark(face);
            reached.push(face);
            for other in self.scene.adjacency.across(face as usize) {
                if inside(self.labels[other]) {
                    starts.push((other as u32, rival));
                }
            }
        }
        reached
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Point, Vector};
    use crate::mesh::{Mesh, Working};
    use crate::surface::Plane;

    #[test]
    fn whatever_speaks_against_a_region_lowers_its_probability() {
        let good = Signs { misfit: 0.9, facing: 0.98, turn: 0.2, overlap: 1.0, cost: 3.0 };
        assert!(good.probability() > 0.95, "{}", good.probability());
        for worse in [
            Signs { misfit: 3.0, ..good },
            Signs { facing: 0.1, ..good },
            Signs { turn: 4.0, ..good },
            Signs { overlap: 0.3, ..good },
            Signs { cost: 8.0, ..good },
        ] {
            assert!(worse.probability() < good.probability() - 0.02, "{worse:?}");
        }
    }

    /// A strip in the plane z = 0, 2 by 8 triangles, and upright from its end on.
    fn bent() -> Working {
        let place = |i: u32| {
            let (along, across) = (f64::from(i / 2), f64::from(i % 2));
            Point::new(across, along.min(4.0), (along - 4.0).max(0.0)) / 8.0
        };
        let square = |i: u32| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]];
        Working::new(Mesh {
            positions: (0..18).map(place).collect(),
            faces: (0..8).flat_map(square).collect(),
        })
    }

    fn overlaps(labels: &[u32], normals: &[Vector]) -> Vec<f64> {
        let working = bent();
        let scene = Scene::new(&working);
        let plane = |normal: &Vector| {
            let through = Point::new(0.0, 0.5, 0.0);
            let surface =
                Surface::Plane(Plane::through(through, crate::math::Unit::new_normalize(*normal)));
            Model { surface, side: 1.0 }
        };
        let models: Vec<Model> = normals.iter().map(plane).collect();
        let reader = Reader { scene: &scene, labels, models: &models };
        let regions = crate::partition::Regions::new(labels);
        let read = |id| reader.read(id, regions.faces(id), &mut Marks::default()).unwrap().overlap;
        (0..models.len()).map(read).collect()
    }

    #[test]
    fn a_border_at_a_crease_is_certain_and_one_within_a_plane_is_not() {
        let up = bent().geometry.normals[0];
        let back = bent().geometry.normals[15];
        let halves: Vec<u32> = (0..16).map(|face| face / 8).collect();
        assert_eq!(overlaps(&halves, &[up, back]), [1.0, 1.0]);
        let pieces: Vec<u32> = (0..16).map(|face| [0, 1, 2, 2][face / 4]).collect();
        let found = overlaps(&pieces, &[up, up, back]);
        assert_eq!(found[2], 1.0);
        assert!(found[0] == 0.0 && found[1] == 0.0, "{found:?}");
    }
}
