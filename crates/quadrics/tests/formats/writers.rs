//! What is written reads back.

use quadrics::Mesh;
use quadrics::format;
use quadrics::math::Point;

use crate::read;

/// A fan of `count` triangles whose coordinates no decimal fraction and no float holds exactly.
fn fan(count: u32) -> Mesh {
    let around =
        |i: u32| Point::new((f64::from(i) / 7.0).cos(), (f64::from(i) / 7.0).sin(), 1.0 / 3.0);
    let positions =
        std::iter::once(Point::new(1e-7, 0.1, -12345.678)).chain((0..=count).map(around));
    Mesh { positions: positions.collect(), faces: (1..=count).map(|i| [0, i, i + 1]).collect() }
}

#[test]
fn ply_obj_and_off_read_back_to_the_bit() {
    let mesh = fan(40);
    for extension in ["ply", "OBJ", "off"] {
        let bytes = format::write(extension, &mesh).unwrap();
        assert_eq!(read(extension, &bytes).unwrap().mesh, mesh, "{extension}");
    }
}

#[test]
fn a_mesh_of_floats_reads_back_from_every_format_and_in_half_the_bytes() {
    let mut mesh = fan(40);
    mesh.positions.iter_mut().for_each(|p| *p = p.map(|x| f64::from(x as f32)));
    for extension in ["ply", "stl", "obj", "off"] {
        let bytes = format::write(extension, &mesh).unwrap();
        assert_eq!(read(extension, &bytes).unwrap().mesh, mesh, "{extension}");
    }
    let size = |mesh: &Mesh| format::write("ply", mesh).unwrap().len();
    // Three numbers a vertex, and "double" is a letter longer than "float" in three places.
    assert_eq!(size(&fan(40)) - size(&mesh), 42 * 3 * 4 + 3);
}

#[test]
fn a_segmentation_is_the_mesh_with_a_colour_and_a_label_a_face() {
    let mesh = fan(3);
    let bytes = format::write_segmentation(&mesh, &[5, 0, -1], &[[1, 2, 3], [4, 5, 6], [7, 8, 9]]);
    assert_eq!(read("ply", &bytes).unwrap().mesh, mesh);
    assert!(bytes.ends_with(&[3, 0, 0, 0, 4, 0, 0, 0, 7, 8, 9, 255, 255, 255, 255]));
    let text = String::from_utf8_lossy(&bytes);
    assert!(
        text.contains("property uchar red\n") && text.contains("property int label\nend_header\n")
    );
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let mut mesh = fan(3);
    mesh.positions[2].x = 1e39;
    assert!(format::write("stl", &mesh).unwrap_err().to_string().contains("vertex 2"));
    assert!(format::write("step", &mesh).unwrap_err().to_string().contains(".ply"));
}
