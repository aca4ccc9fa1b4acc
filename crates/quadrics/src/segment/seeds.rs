//! Where a region grows from: a seed region instead of a seed triangle (paper, section 4.3(1)).

use rayon::prelude::*;

use super::Task;
use super::fit::Fitted;
use crate::options::Seeds;

/// The seed of every region: connected faces, the one that it was found from first.
pub fn seeds(task: &Task, labels: &[u32], regions: &[Fitted]) -> Vec<Vec<u32>> {
    let one = |region: usize| seed(task, labels, region as u32, &regions[region]).to_vec();
    (0..regions.len()).into_par_iter().map(one).collect()
}

/// The seed of one region; its faces are those that bear its label.
pub fn seed<'r>(task: &Task, labels: &[u32], region: u32, fitted: &'r Fitted) -> &'r [u32] {
    fitted.seed.get_or_init(|| search(task, labels, region, fitted))
}

/// Of the neighbourhoods of the m faces of least error the one of least area-averaged error.
fn search(task: &Task, labels: &[u32], region: u32, fitted: &Fitted) -> Vec<u32> {
    let errors = &fitted.errors;
    let (candidates, size) = match task.options.seeds {
        Seeds::Triangle => (1, 1),
        Seeds::Region => {
            let share = task.options.seed_fraction * fitted.faces.len() as f64;
            (task.options.seed_candidates.max(1), (share as usize).max(1))
        }
    };
    let around = Around { task, labels, region, faces: &fitted.faces };
    let mut marks = vec![0u32; fitted.faces.len()];
    let average = |places: &[u32]| {
        let area =
            |&place: &u32| task.working.geometry.areas[fitted.faces[place as usize] as usize];
        let error: f64 = places.iter().map(|&place| errors[place as usize]).sum();
        let total: f64 = places.iter().map(area).sum();
        if total > 0.0 { error / total } else { f64::INFINITY }
    };
    let best = least(errors, candidates)
        .into_iter()
        .enumerate()
        .map(|(i, start)| around.nearest(start, size, &mut marks, i as u32 + 1))
        .min_by(|one, other| average(one).total_cmp(&average(other)))
        .expect("a region has a face");
    best.into_iter().map(|place| fitted.faces[place as usize]).collect()
}

/// The places of the `count` smallest errors, smallest first, ties by place.
fn least(errors: &[f64], count: usize) -> Vec<u32> {
    let mut places: Vec<u32> = (0..errors.len() as u32).collect();
    let by_error = |one: &u32, other: &u32| {
        errors[*one as usize].total_cmp(&errors[*other as usize]).then(one.cmp(other))
    };
    if count < places.len() {
        places.select_nth_unstable_by(count, by_error);
        places.truncate(count);
    }
    places.sort_unstable_by(by_error);
    places
}

/// Searches inside one region.
struct Around<'a> {
    task: &'a Task<'a>,
    labels: &'a [u32],
    region: u32,
    faces: &'a [u32],
}

impl Around<'_> {
    /// The places of the `size` faces nearest to `start`, breadth first. `marks` hold the number
    /// of the search that last came by; `mark` is this one's.
    fn nearest(&self, start: u32, size: usize, marks: &mut [u32], mark: u32) -> Vec<u32> {
        let mut found = vec![start];
        marks[start as usize] = mark;
        let mut next = 0;
        while next < found.len() && found.len() < size {
            let face = self.faces[found[next] as usize] as usize;
            next += 1;
            for other in self.task.working.adjacency.across(face) {
                if self.labels[other] != self.region || found.len() == size {
                    continue;
                }
                // Faces are ascending, so that a search finds a face's place among them.
                let place = self.faces.binary_search(&(other as u32)).expect("its own region's");
                if marks[place] != mark {
                    marks[place] = mark;
                    found.push(place as u32);
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_errors_come_first_and_ties_by_place() {
        let errors = [3.0, 1.0, 2.0, 1.0, 0.5];
        assert_eq!(least(&errors, 3), [4, 1, 3]);
        assert_eq!(least(&errors, 9), [4, 1, 3, 2, 0]);
    }
}
