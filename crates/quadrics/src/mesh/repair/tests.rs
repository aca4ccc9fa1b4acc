use super::*;

/// A box of `n` x `n` squares a side, every square two triangles, wound outward.
fn cube(n: u32, low: f64, high: f64) -> Mesh {
    let mut welder = Welder::new();
    let mut faces = Vec::new();
    let at = |i: u32| low + (high - low) * f64::from(i) / f64::from(n);
    for axis in 0..3 {
        for (end, turn) in [(0, true), (n, false)] {
            for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
                let mut corner = |di: u32, dj: u32| {
                    let mut p = Point::origin();
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) =
                        (at(end), at(i + di), at(j + dj));
                    welder.add(p)
                };
                let (a, b, c, d) = (corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
                let square = [[a, b, c], [a, c, d]];
                faces.extend(square.map(|[a, b, c]| if turn { [a, c, b] } else { [a, b, c] }));
            }
        }
    }
    Mesh { positions: welder.into_positions(), faces }
}

fn joined(one: &Mesh, other: &Mesh) -> Mesh {
    let mut both = one.clone();
    let first = one.positions.len() as u32;
    both.positions.extend(&other.positions);
    both.faces.extend(other.faces.iter().map(|corners| corners.map(|v| v + first)));
    both
}

fn inverted(mesh: &Mesh) -> Mesh {
    let faces = mesh.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    Mesh { faces, ..mesh.clone() }
}

fn count(repaired: &Repaired, kind: &str) -> usize {
    repaired.repairs.iter().find(|repair| repair.kind == kind).map_or(0, |repair| repair.count)
}

#[test]
fn a_clean_mesh_stays_as_it_is_and_nothing_is_said() {
    let mesh = cube(3, -1.0, 2.0);
    let repaired = repair(&mesh).unwrap();
    assert_eq!(repaired.mesh, mesh);
    assert_eq!(repaired.parent, (0..108).collect::<Vec<_>>());
    assert_eq!(repaired.parent, repaired.representative);
    assert_eq!(repaired.repairs, []);
}

#[test]
fn repair_has_nothing_left_to_do_after_itself() {
    let mut mesh = joined(&cube(3, 0.0, 1.0), &inverted(&cube(2, 2.0, 3.0)));
    mesh.faces.extend([[0, 1, 1], [3, 3, 3], [2, 1, 0], [5, 7, 9]]);
    let once = repair(&mesh).unwrap();
    let twice = repair(&once.mesh).unwrap();
    assert_eq!(once.mesh, twice.mesh);
    assert_eq!((count(&twice, "flipped_faces"), count(&twice, "zero_area_faces")), (0, 0));
}

#[test]
fn a_soup_of_triangles_is_welded_into_a_closed_box() {
    let mesh = cube(2, 0.0, 1.0);
    let positions = mesh.faces.iter().flatten().map(|&v| mesh.positions[v as usize]).collect();
    let faces = (0..mesh.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let repaired = repair(&Mesh { positions, faces }).unwrap();
    assert_eq!(count(&repaired, "coincident_vertices"), 3 * 48 - 26);
    assert_eq!(repaired.mesh.positions.len(), 26);
    assert_eq!((count(&repaired, "border_edges"), repaired.census.closed_components), (0, 1));
}

#[test]
fn any_winding_of_a_closed_mesh_comes_out_outward() {
    let mesh = cube(3, 5.0, 6.0);
    for turn in [|_| true, |f| f % 2 == 0, |f| f % 7 == 3, |f| f > 2] as [fn(usize) -> bool; 4] {
        let mut turned = mesh.clone();
        for (_, corners) in turned.faces.iter_mut().enumerate().filter(|(f, _)| turn(*f)) {
            corners.swap(1, 2);
        }
        let repaired = repair(&turned).unwrap();
        assert_eq!(count(&repaired, "flipped_faces"), (0..108).filter(|&f| turn(f)).count());
        assert_eq!(repaired.mesh, mesh);
    }
}

#[test]
fn a_void_keeps_its_normals_inward_even_if_the_whole_file_is_inside_out() {
    let hollow = joined(&cube(2, 0.0, 3.0), &inverted(&cube(2, 1.0, 2.0)));
    assert_eq!(repair(&hollow).unwrap().mesh, hollow);
    assert_eq!(repair(&inverted(&hollow)).unwrap().mesh, hollow);
}

#[test]
fn an_open_sheet_keeps_the_winding_of_its_majority() {
    let mut sheet = cube(4, 0.0, 1.0);
    sheet.faces.truncate(32);
    let mut turned = inverted(&sheet);
    (0..10).for_each(|f| turned.faces[3 * f].swap(1, 2));
    let repaired = repair(&turned).unwrap();
    assert_eq!(count(&repaired, "flipped_faces"), 10);
    assert_eq!((count(&repaired, "border_edges"), repaired.mesh.faces.len()), (16, 32));
    assert_eq!(repaired.mesh, repair(&inverted(&sheet)).unwrap().mesh);
}

#[test]
fn left_out_faces_take_the_label_of_their_twin_or_neighbour() {
    let mut mesh = cube(1, 0.0, 1.0);
    let [a, b, c] = mesh.faces[4];
    let far = mesh.positions.len() as u32;
    mesh.positions.extend([Point::new(9.0, 9.0, 9.0), Point::new(8.0, 8.0, 8.0)]);
    // A repeated face, a needle at an edge, a point at a corner, a chain that leads away, and a speck.
    mesh.faces.extend([[b, a, c], [a, a, b], [c, c, c], [c, far, far], [far, far, far]]);
    mesh.faces.push([far + 1; 3]);
    let repaired = repair(&mesh).unwrap();
    assert_eq!((count(&repaired, "duplicate_faces"), count(&repaired, "zero_area_faces")), (1, 5));
    assert_eq!(repaired.mesh, cube(1, 0.0, 1.0));
    let took = |face: usize| repaired.mesh.faces[repaired.representative[face] as usize];
    assert_eq!(took(12), [a, b, c]);
    assert!(took(13).contains(&a) && took(13).contains(&b));
    assert!(took(14).contains(&c) && took(15).contains(&c));
    assert_eq!(
        (repaired.representative[16], repaired.representative[17]),
        (repaired.representative[15], repaired.representative[16])
    );
}

#[test]
fn what_no_face_uses_is_left_out_and_said() {
    let mut mesh = cube(1, 0.0, 1.0);
    mesh.positions.insert(0, Point::new(f64::NAN, 0.0, 0.0));
    mesh.positions.push(Point::new(7.0, 7.0, 7.0));
    mesh.faces.iter_mut().flatten().for_each(|v| *v += 1);
    let repaired = repair(&mesh).unwrap();
    assert_eq!(
        (count(&repaired, "unreferenced_vertices"), count(&repaired, "not_finite_vertices")),
        (2, 1)
    );
    assert_eq!(repaired.mesh, cube(1, 0.0, 1.0));
}

#[test]
fn three_sheets_at_an_edge_are_three_components() {
    let positions = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., -1., 0.]];
    let positions = positions.map(Point::from).to_vec();
    let repaired =
        repair(&Mesh { positions, faces: vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]] }).unwrap();
    assert_eq!((count(&repaired, "non_manifold_edges"), count(&repaired, "components")), (1, 3));
}

#[test]
fn a_moebius_strip_is_reported_and_kept() {
    let ring = |i: u32, up: f64| {
        let angle = std::f64::consts::TAU * f64::from(i) / 9.0;
        let across = 1.0 + 0.3 * up * (angle / 2.0).cos();
        Point::new(across * angle.cos(), across * angle.sin(), 0.3 * up * (angle / 2.0).sin())
    };
    let positions = (0..9).flat_map(|i| [ring(i, 1.0), ring(i, -1.0)]).collect();
    let rung = |i: u32| if i < 9 { [2 * i, 2 * i + 1] } else { [1, 0] };
    let faces = (0..9).flat_map(|i| {
        let ([a, b], [c, d]) = (rung(i), rung(i + 1));
        [[a, b, c], [c, b, d]]
    });
    let repaired = repair(&Mesh { positions, faces: faces.collect() }).unwrap();
    assert_eq!((count(&repaired, "unorientable_edges"), repaired.mesh.faces.len()), (1, 18));
}

#[test]
fn a_row_of_caps_does_not_leave_a_slit() {
    // Above the x axis one triangle, below it four; between them three faces without area.
    let on_axis = (0..5).map(|i| Point::new(f64::from(i), 0.0, 0.0));
    let positions =
        on_axis.chain([Point::new(2.0, 3.0, 0.0), Point::new(2.0, -3.0, 0.0)]).collect();
    let mut faces = vec![[0, 4, 5], [0, 3, 4], [0, 1, 3], [1, 2, 3]];
    faces.extend((0..4).map(|i| [i + 1, i, 6]));
    let repaired = repair(&Mesh { positions, faces }).unwrap();
    assert_eq!((count(&repaired, "zero_area_faces"), count(&repaired, "split_faces")), (3, 3));
    assert_eq!((count(&repaired, "border_edges"), count(&repaired, "flipped_faces")), (4, 0));
    assert_eq!(repaired.parent, [0, 0, 0, 0, 4, 5, 6, 7]);
    assert_eq!(repaired.representative, (0..8).collect::<Vec<_>>());
    let area: f64 = crate::mesh::Geometry::new(&repaired.mesh).areas.iter().sum();
    assert_eq!(area, 12.0);
}

#[test]
fn any_soup_is_repaired_and_every_face_gets_a_label() {
    use rand::Rng;
    let mut rng = rand_pcg::Pcg64Mcg::new(5);
    let mut below = |bound: u64| (rng.next_u64() % bound) as u32;
    for _ in 0..3000 {
        // Few places on few lines: full of flat, repeated and non-manifold faces.
        let positions: Vec<_> =
            (0..9).map(|_| Point::new(below(3).into(), below(3).into(), below(2).into())).collect();
        let faces: Vec<_> = (0..1 + below(24)).map(|_| [below(9), below(9), below(9)]).collect();
        let Ok(repaired) = repair(&Mesh { positions, faces: faces.clone() }) else { continue };
        let mesh = &repaired.mesh;
        assert_eq!(
            (repaired.parent.len(), repaired.representative.len()),
            (mesh.faces.len(), faces.len())
        );
        assert!(repaired.representative.iter().all(|&face| (face as usize) < mesh.faces.len()));
        assert!(repaired.parent.iter().all(|&face| (face as usize) < faces.len()));
        assert!((0..mesh.faces.len()).all(|face| !is_flat(mesh.corners(face))));
        let again = repair(mesh).unwrap();
        let mended =
            ["coincident_vertices", "unreferenced_vertices", "zero_area_faces", "duplicate_faces"];
        assert!(mended.iter().all(|kind| count(&again, kind) == 0), "{:?}", again.repairs);
        // A strip with a twist has its seam where the walk ends, and that is not the same twice.
        if repaired.census.unorientable == 0 {
            assert_eq!(&again.mesh, mesh);
        }
    }
}
