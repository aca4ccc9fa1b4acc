use super::*;
use crate::mesh::Working;
use crate::mesh::samples::{Sample, can, cube};
use crate::partition::{components, region_count};

fn run(
    mesh: &Mesh,
    method: Method,
    regions: Option<usize>,
    start: Option<&[u32]>,
) -> Result<Found> {
    let options = Options { method, regions, tau: 20, ..Options::default() };
    baseline(&mut Context::new(3), mesh, &options, start)
}

const ALL: [Method; 4] = [Method::Vsa, Method::Qsf, Method::Hfp, Method::Ransac];

#[test]
fn every_method_finds_the_sides_of_a_cube() {
    let Sample { mesh, labels } = cube(10);
    for method in ALL {
        let found = run(&mesh, method, Some(6), None).unwrap();
        assert!(*found.energy.last().unwrap() < 1e-9, "{method:?} {:?}", found.energy);
        let pairs: std::collections::BTreeSet<_> = found.labels.iter().zip(&labels).collect();
        assert_eq!((region_count(&found.labels), pairs.len()), (6, 6), "{method:?}");
    }
}

#[test]
fn what_fits_cylinders_fits_a_can_better_than_planes_do() {
    let mesh = can(6).mesh;
    let energy = |method| *run(&mesh, method, Some(3), None).unwrap().energy.last().unwrap();
    let planes = energy(Method::Vsa);
    for method in [Method::Qsf, Method::Hfp, Method::Ransac] {
        assert!(energy(method) < planes, "{method:?}");
    }
    assert!(energy(Method::Hfp) < 0.01 * planes);
}

#[test]
fn regions_are_connected_and_as_many_as_wanted() {
    let mesh = can(8).mesh;
    let working = Working::new(mesh.clone());
    for method in [Method::Vsa, Method::Qsf, Method::Hfp] {
        for regions in [1, 4, 9] {
            let found = run(&mesh, method, Some(regions), None).unwrap();
            let (_, sizes) = components(&found.labels, &working.adjacency);
            assert_eq!((sizes.len(), found.proxies.len()), (regions, regions), "{method:?}");
        }
        assert!(matches!(run(&mesh, method, None, None), Err(Error::Option(_))));
    }
}

#[test]
fn labels_are_a_start_for_every_method() {
    let Sample { mesh, labels } = can(8);
    for method in [Method::Qsf, Method::Hfp, Method::Ransac] {
        let found = run(&mesh, method, Some(3), Some(&labels)).unwrap();
        assert_eq!(found.labels, labels, "{method:?}");
    }
}

#[test]
fn the_same_seed_gives_the_same_regions() {
    let mesh = can(8).mesh;
    for method in ALL {
        let [one, other] = [0, 1].map(|_| run(&mesh, method, Some(5), None).unwrap());
        assert_eq!((one.labels, one.energy), (other.labels, other.energy));
    }
}
