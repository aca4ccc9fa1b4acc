//! A coarser mesh of the same surface: vertices gathered in cells, one vertex standing for each.
//!
//! Cells of a fixed number of vertices are cut off breadth first; then all their sites spread at
//! once, so that every vertex joins the nearest by edges. The dual of these cells is the coarser
//! mesh: a face whose corners lie in three cells becomes the triangle of their sites (as Valette and
//! Chassery do, Eurographics 2004).
//!
//! Sites are vertices of the input, so the noise stays what it is. Where it is as large as the edges,
//! cells are made alike, and means of their vertices stand for them.
//!
//! Vertices where the surface bends come first: a vertex inside a flat facet, or on an edge between
//! two, lies on a chord that others span, off the surface that the facets were made from.

use rayon::prelude::*;

use super::nearest::nearest;
use super::relax::relax;
use crate::math::{Point, Vector};
use crate::mesh::{Mesh, Working};
use crate::partition::components;

/// Normals around a vertex that differ more make it a crease, in radians.
const CREASE: f64 = 0.5;
/// Where more than this share of the vertices seem to lie on creases, it is noise that bends them.
const MOST_CREASES: f64 = 0.3;
/// Normals that differ less are those of one facet, in radians: rounding of single precision.
const FLAT: f64 = 1e-3;
/// A component of fewer cells is kept as fine as it is: it would lose its shape.
const FEWEST_CELLS: usize = 400;

/// A coarser mesh and how it hangs together with the one that it was made of.
#[derive(Debug, Clone, Default)]
pub struct Coarse {
    /// Its vertices are sites; one that no face uses stands for a cell without three neighbours.
    pub mesh: Mesh,
    /// The site of every vertex of the finer mesh.
    pub site: Vec<u32>,
    /// A face of the finer mesh in the middle of every face.
    pub origin: Vec<u32>,
}

/// Coarsens a mesh to about so many faces, whose vertices are vertices of the finer one.
pub fn coarsen(fine: &Working, faces: usize) -> Coarse {
    let sites = sites(fine, size(fine, faces));
    let positions = sites.iter().map(|&v| fine.mesh.positions[v as usize]).collect();
    dual(fine, spread(fine, &sites), positions)
}

/// Coarsens a noisy mesh to about so many faces, whose vertices are means.
pub fn gather(fine: &Working, faces: usize) -> Coarse {
    let sites = sites(fine, size(fine, faces));
    let mut site = spread(fine, &sites);
    relax(fine, &mut site, sites.len());
    let mut sums = vec![(Vector::zeros(), 0.0); sites.len()];
    for (position, &site) in fine.mesh.positions.iter().zip(&site) {
        let (sum, count) = &mut sums[site as usize];
        *sum += position.coords;
        *count += 1.0;
    }
    let positions = sums.into_iter().map(|(sum, count)| Point::from(sum / count)).collect();
    dual(fine, site, positions)
}

/// Vertices of a cell where so many faces are left.
fn size(fine: &Working, faces: usize) -> usize {
    fine.len().div_ceil(faces.max(1))
}

/// The triangles of the sites whose cells meet in a face.
fn dual(fine: &Working, site: Vec<u32>, positions: Vec<Point>) -> Coarse {
    // Cells that meet twice would make the same triangle twice.
    let triangle = |(face, corners): (usize, &[u32; 3])| {
        let [a, b, c] = corners.map(|v| site[v as usize]);
        let least = a.min(b).min(c);
        let first = [[a, b, c], [b, c, a], [c, a, b]].into_iter().find(|t| t[0] == least)?;
        (a != b && b != c && c != a).then_some((first, face as u32))
    };
    let faces = fine.mesh.faces.par_iter().enumerate();
    let mut triangles: Vec<([u32; 3], u32)> = faces.filter_map(triangle).collect();
    triangles.par_sort_unstable();
    triangles.dedup_by_key(|(triangle, _)| *triangle);
    let (faces, origin) = triangles.into_iter().unzip();
    Coarse { mesh: Mesh { positions, faces }, site, origin }
}

/// The vertices that stand for cells of `size` vertices, ascending.
fn sites(fine: &Working, size: usize) -> Vec<u32> {
    let count = fine.mesh.positions.len();
    let ranks = ranks(fine);
    let kept = kept(fine, size);
    let mut taken = vec![false; count];
    let mut sites = Vec::with_capacity(count / size + 1);
    let mut cell = Vec::with_capacity(size);
    for rank in Rank::ALL {
        for site in (0..count as u32).filter(|&v| ranks[v as usize] == rank) {
            if kept[site as usize] {
                sites.push(site);
            } else if !std::mem::replace(&mut taken[site as usize], true) {
                sites.push(site);
                cut_off(fine, site, size, &mut taken, &mut cell);
            }
        }
        if rank == Rank::Bent {
            widen(fine, &sites, size, &mut taken);
        }
    }
    sites.sort_unstable();
    sites
}

/// Takes the `size` vertices nearest to a site that are not taken yet.
fn cut_off(fine: &Working, site: u32, size: usize, taken: &mut [bool], cell: &mut Vec<u32>) {
    cell.clear();
    cell.push(site);
    let mut next = 0;
    while next < cell.len() && cell.len() < size {
        fine.for_each_neighbour(cell[next], |other| {
            if cell.len() < size && !std::mem::replace(&mut taken[other as usize], true) {
                cell.push(other);
            }
        });
        next += 1;
    }
}

/// Takes what lies within a second cell's radius of sites where the surface bends: a facet's middle
/// needs no site of its own.
fn widen(fine: &Working, sites: &[u32], size: usize, taken: &mut [bool]) {
    // Within n edges of a vertex of six neighbours lie 3 n (n + 1) others.
    let radius = 2.0 * (size as f64 / 3.0).sqrt();
    let mut reached = vec![false; taken.len()];
    let mut wave = sites.to_vec();
    for _ in 0..radius.round() as usize {
        let mut next = Vec::new();
        for vertex in wave {
            fine.for_each_neighbour(vertex, |other| {
                if !std::mem::replace(&mut reached[other as usize], true) {
                    taken[other as usize] = true;
                    next.push(other);
                }
            });
        }
        wave = next;
    }
}

/// What a vertex says of the surface, the most telling first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rank {
    /// Where a crease bends.
    BentCrease,
    /// Three facets or more meet.
    Bent,
    /// On a straight crease.
    Crease,
    /// In a facet, or between two.
    Flat,
}

impl Rank {
    const ALL: [Self; 4] = [Self::BentCrease, Self::Bent, Self::Crease, Self::Flat];

    fn new(creased: bool, bent: bool) -> Self {
        match (creased, bent) {
            (true, true) => Self::BentCrease,
            (false, true) => Self::Bent,
            (true, false) => Self::Crease,
            (false, false) => Self::Flat,
        }
    }
}

/// The rank of every vertex; creases count for nothing where noise makes them everywhere.
fn ranks(fine: &Working) -> Vec<Rank> {
    let vertices = (0..fine.mesh.positions.len() as u32).into_par_iter().with_min_len(4096);
    let mut ranks: Vec<Rank> = vertices.map(|vertex| rank(fine, vertex)).collect();
    let creased = |rank: &Rank| matches!(rank, Rank::BentCrease | Rank::Crease);
    let count = ranks.iter().filter(|rank| creased(rank)).count();
    if count as f64 > MOST_CREASES * ranks.len() as f64 {
        let bent = |rank: &Rank| matches!(rank, Rank::BentCrease | Rank::Bent);
        ranks.iter_mut().for_each(|rank| *rank = Rank::new(false, bent(rank)));
    }
    ranks
}

fn rank(fine: &Working, vertex: u32) -> Rank {
    let (crease, flat) = (CREASE.cos(), FLAT.cos());
    let mut normals =
        fine.adjacency.around(vertex).iter().map(|&f| fine.geometry.normals[f as usize]);
    let Some(first) = normals.next() else { return Rank::Flat };
    let (mut second, mut creased, mut bent) = (None, false, false);
    for normal in normals.filter(|normal| first.dot(normal) < flat) {
        creased |= first.dot(&normal) < crease;
        bent |= second.get_or_insert(normal).dot(&normal) < flat;
    }
    Rank::new(creased, bent)
}

/// Fewest vertices where facets meet that speak, and the share of them that must be alone.
const MEETINGS: usize = 100;
const ALONE: f64 = 0.9;

/// Whether a mesh is made of flat facets of several faces each, as a coarse mesh is after its faces
/// were divided: where facets meet, no vertex has another such vertex beside it.
pub fn is_faceted(fine: &Working) -> bool {
    let ranks = ranks(fine);
    let bent = |vertex: u32| ranks[vertex as usize] == Rank::Bent;
    let alone = |vertex: u32| {
        let mut alone = true;
        fine.for_each_neighbour(vertex, |other| alone &= !bent(other));
        alone
    };
    let meetings: Vec<u32> = (0..ranks.len() as u32).filter(|&v| bent(v)).collect();
    let count = meetings.iter().filter(|&&v| alone(v)).count();
    meetings.len() >= MEETINGS && count as f64 >= ALONE * meetings.len() as f64
}

/// Whether each vertex is in a component that is too small to be coarsened.
fn kept(fine: &Working, size: usize) -> Vec<bool> {
    let (component, sizes) = components(&vec![0; fine.len()], &fine.adjacency);
    let mut kept = vec![false; fine.mesh.positions.len()];
    for (corners, component) in fine.mesh.faces.iter().zip(component) {
        let small = (sizes[component as usize] as usize) < 2 * size * FEWEST_CELLS;
        corners.iter().for_each(|&v| kept[v as usize] |= small);
    }
    kept
}

/// The place in `sites` of the site that is nearest to every vertex, by edges.
fn spread(fine: &Working, sites: &[u32]) -> Vec<u32> {
    let count = fine.mesh.positions.len();
    nearest(count, sites, |vertex, visit| fine.for_each_neighbour(vertex, visit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Adjacency;
    use crate::synth;

    #[test]
    fn a_closed_part_stays_closed_and_keeps_its_area() {
        let fine = Working::new(synth::part("demo", 60_000).unwrap().mesh);
        let coarse = coarsen(&fine, 6_000);
        let count = coarse.mesh.faces.len();
        assert!((4_000..9_000).contains(&count), "{count} faces");
        let coarse = Working::new(coarse.mesh);
        let open = |adjacency: &Adjacency| {
            adjacency.neighbours.iter().flatten().filter(|&&n| n == crate::mesh::NONE).count()
        };
        assert!(open(&coarse.adjacency) * 100 < count, "{} open edges", open(&coarse.adjacency));
        let area = |working: &Working| working.geometry.areas.iter().sum::<f64>();
        assert!((area(&coarse) / area(&fine) - 1.0).abs() < 0.03);
    }

    #[test]
    fn every_vertex_has_a_site_and_every_face_an_origin_between_its_sites() {
        let fine = Working::new(synth::part("demo", 20_000).unwrap().mesh);
        let coarse = coarsen(&fine, 3_000);
        assert!(coarse.site.iter().all(|&site| (site as usize) < coarse.mesh.positions.len()));
        for (face, &origin) in coarse.mesh.faces.iter().zip(&coarse.origin) {
            let mut sites = fine.mesh.faces[origin as usize].map(|v| coarse.site[v as usize]);
            let mut corners = *face;
            sites.sort_unstable();
            corners.sort_unstable();
            assert_eq!(sites, corners);
        }
    }

    #[test]
    fn cells_become_alike_and_none_empty() {
        let fine = Working::new(synth::part("demo", 60_000).unwrap().mesh);
        let coarse = gather(&fine, 10_000);
        let mut sizes = vec![0usize; coarse.mesh.positions.len()];
        coarse.site.iter().for_each(|&site| sizes[site as usize] += 1);
        let mean = sizes.iter().sum::<usize>() as f64 / sizes.len() as f64;
        let variance = sizes.iter().map(|&n| (n as f64 - mean).powi(2)).sum::<f64>();
        let deviation = (variance / sizes.len() as f64).sqrt();
        assert!(sizes.iter().all(|&n| n > 0));
        assert!(deviation < 0.25 * mean, "{mean} +- {deviation}");
    }

    #[test]
    fn a_mesh_whose_faces_were_divided_is_faceted() {
        let plain = synth::part("demo", 20_000).unwrap().mesh;
        let edge = plain.size() / 100.0;
        let divided = crate::prepare::subdivide(plain.clone(), edge).unwrap();
        assert!(!is_faceted(&Working::new(plain)));
        assert!(divided.mesh.faces.len() > 50_000);
        assert!(is_faceted(&Working::new(divided.mesh)));
    }

    #[test]
    fn small_components_are_kept_as_they_are() {
        let fine = Working::new(synth::part("demo", 2_000).unwrap().mesh);
        let coarse = coarsen(&fine, 200);
        assert_eq!(coarse.mesh.faces.len(), fine.len());
    }
}
