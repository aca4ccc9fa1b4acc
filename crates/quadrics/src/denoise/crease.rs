//! Whether two surfaces that meet do so where the mesh has its crease.
//!
//! Where a chamfer was overlooked the curve of its neighbours lies outside of the part, and the noise
//! brings just those vertices within reach of it that stick out already. Along a true crease
//! nearly all vertices reach theirs, and stick out of their neighbours by about the same.

use super::Task;
use super::place::{Goal, Noisy, furthest};
use crate::math::Point;

/// Vertices along a crease that are asked, at most.
const WITNESSES: usize = 20;
/// Share of them that reach the curve. Of a curve that is as far off as the noise goes half do.
const MOST: f64 = 0.6;
/// Vertices along a crease that tell how far it usually sticks out.
const FEWEST: usize = 7;

/// Where vertices of several regions would go, if the noise explains it.
pub struct Creases<'a> {
    pub task: &'a Task<'a>,
    pub regions: &'a [Vec<u32>],
    pub joints: &'a [Option<Point>],
    pub noisy: &'a [Noisy],
}

impl Creases<'_> {
    /// Where a vertex goes, as far as its neighbours allow it.
    pub fn place(&self, vertex: usize, goals: &[Goal]) -> Point {
        let noisy = &self.noisy[vertex];
        let way = self.settle(vertex, goals) - noisy.position;
        let way = self.usual_height(vertex).map_or(way, |usual| noisy.held(way, usual));
        noisy.position + way
    }

    /// How far vertices like this one are above their neighbours: inside a region not at all, along a
    /// crease by the median there; `None` where there are too few to tell.
    fn usual_height(&self, vertex: usize) -> Option<f64> {
        let at = &self.regions[vertex];
        if at.len() == 1 {
            return Some(0.0);
        }
        let along = self.along(vertex as u32, at);
        if at.len() > 2 || along.len() < FEWEST {
            return None;
        }
        let mut heights: Vec<f64> = along.iter().map(|&v| self.noisy[v as usize].height).collect();
        let middle = heights.len() / 2;
        Some(*heights.select_nth_unstable_by(middle, f64::total_cmp).1)
    }

    /// Where its surfaces send a vertex: to their joint, or without the one furthest off to that of
    /// those that are left, if the crease is believed; else to one of the last two.
    fn settle(&self, vertex: usize, goals: &[Goal]) -> Point {
        let noisy = &self.noisy[vertex];
        let (mut at, mut goals) = (self.regions[vertex].clone(), goals.to_vec());
        let mut joint = self.joints[vertex];
        while goals.len() > 1 {
            if let Some(point) = joint
                && self.believed(vertex as u32, &at)
            {
                return point;
            }
            if goals.len() == 2 {
                break;
            }
            let far = furthest(noisy.position, &goals);
            at.remove(far);
            goals.remove(far);
            joint = noisy.joint(&goals);
        }
        noisy.alone(&goals)
    }

    /// Whether most vertices near one, along the crease of some surfaces, reach where they meet.
    fn believed(&self, vertex: u32, surfaces: &[u32]) -> bool {
        let along = self.along(vertex, surfaces);
        let witnesses = &along[1..];
        let reached = witnesses.iter().filter(|&&v| self.joints[v as usize].is_some()).count();
        reached > 0 && reached as f64 >= MOST * witnesses.len() as f64
    }

    /// Some vertices between these surfaces, connected with one, itself first.
    fn along(&self, vertex: u32, surfaces: &[u32]) -> Vec<u32> {
        let between = |v: u32| {
            let at = &self.regions[v as usize];
            at.len() > 1 && at.iter().all(|region| surfaces.contains(region))
        };
        let mut found = vec![vertex];
        let mut next = 0;
        while next < found.len() && found.len() <= WITNESSES {
            for &face in self.task.working.adjacency.around(found[next]) {
                for corner in self.task.working.mesh.faces[face as usize] {
                    if !found.contains(&corner) && between(corner) {
                        found.push(corner);
                    }
                }
            }
            next += 1;
        }
        found
    }
}
