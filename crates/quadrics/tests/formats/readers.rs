//! Every spelling of a part reads as that part.

use quadrics::format;
use quadrics::math::Point;

use crate::fixtures::{self, expected, model, threemf, zipped};
use crate::{read, triangles};

/// The same triangles, beginning at whichever corner, within the rounding of the fixtures.
fn near(one: &[[[f64; 3]; 3]], other: &[[[f64; 3]; 3]]) -> bool {
    let distance = |a: &[f64; 3], b: &[f64; 3]| (Point::from(*a) - Point::from(*b)).norm();
    let same = |one: &[[f64; 3]; 3], other: &[[f64; 3]; 3]| {
        (0..3).any(|turn| (0..3).all(|i| distance(&one[i], &other[(i + turn) % 3]) < 1e-6))
    };
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| same(one, other))
}

#[test]
fn every_spelling_of_a_part_reads_as_the_same_part() {
    for (name, extension, bytes) in fixtures::all() {
        let loaded = read(extension, &bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(near(&triangles(&loaded), &expected()), "{name}: {:?}", triangles(&loaded));
        assert_eq!(loaded.mesh.positions.len(), 5, "{name} has shared vertices");
        assert_eq!(loaded.input_faces.of_triangle, [0, 1, 2, 3], "{name}");
        assert_eq!(loaded.input_faces.count, 4, "{name}");
        let unit = match extension {
            "3mf" => Some("in"),
            "glb" | "gltf" => Some("m"),
            _ => None,
        };
        assert_eq!(loaded.units.as_deref(), unit, "{name}");
    }
}

#[test]
fn the_content_is_believed_where_the_extension_lies() {
    for (name, extension, bytes) in fixtures::all() {
        for lie in ["", "dat", "ply", "glb"] {
            let plain = name != "OFF without a header"
                && !(extension == "STL" && lie != "dat" && !lie.is_empty());
            let binary = name.starts_with("binary STL") && !matches!(lie, "" | "dat");
            if plain && !binary {
                let loaded =
                    read(lie, &bytes).unwrap_or_else(|error| panic!("{name} as {lie}: {error}"));
                assert!(near(&triangles(&loaded), &expected()), "{name} as {lie}");
            }
        }
    }
}

#[test]
fn a_polygon_is_a_fan_and_remembers_its_face() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
        element face 4\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n.5 2 0\n0 1 0\n\
        5 0 1 2 3 4\n3 0 1 2\n2 3 4\n4 0 1 2 4\n";
    let off =
        "OFF 5 4 0\n0 0 0\n1 0 0\n1 1 0\n.5 2 0\n0 1 0\n5 0 1 2 3 4\n3 0 1 2\n2 3 4\n4 0 1 2 4\n";
    let obj =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv .5 2 0\nv 0 1 0\nf 1 2 3 4 5\nf 1 2 3\nf 4 5\nf 1 2 3 5\n";
    for (extension, text) in [("ply", ply), ("off", off), ("obj", obj)] {
        let loaded = read(extension, text.as_bytes()).unwrap();
        let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 1, 2], [3, 4, 4], [0, 1, 2], [0, 2, 4]];
        assert_eq!(loaded.mesh.faces, fan, "{extension}");
        assert_eq!(loaded.input_faces.of_triangle, [0, 0, 0, 1, 2, 3, 3]);
        assert_eq!(loaded.input_faces.count, 4);
        let kinds: Vec<_> = loaded.repairs.iter().map(|r| (r.kind, r.count)).collect();
        assert_eq!(kinds, [("polygons", 2), ("stunted_faces", 1)]);
    }
}

#[test]
fn a_face_of_the_file_takes_the_label_of_most_of_its_area() {
    let of_triangle = vec![0, 1, 1, 1, 2, 2];
    let faces = format::InputFaces { of_triangle, count: 3 };
    assert_eq!(faces.labels(&[9, 4, 5, 4, 8, 7], &[0.0, 1.0, 1.5, 1.0, 2.0, 2.0]), [9, 4, 7]);
}

#[test]
fn a_buffer_is_asked_for_by_its_decoded_name() {
    let text = fixtures::GLTF.replace("URI", r#", "uri": "my%20part/b%C3%BCffer.bin""#);
    let mut asked = Vec::new();
    let loaded = format::read("gltf", text.as_bytes(), &mut |name| {
        asked.push(name.to_string());
        Some(fixtures::gltf_buffer())
    });
    assert!(near(&triangles(&loaded.unwrap()), &expected()));
    assert_eq!(asked, ["my part/b\u{fc}ffer.bin"]);
}

#[test]
fn quantised_positions_and_mirrors_are_undone() {
    // A short of 32767 is one; the node mirrors x, which must not turn the faces inside out.
    let text = r#"{"asset": {}, "extensionsRequired": ["KHR_mesh_quantization"],
        "nodes": [{"mesh": 0, "scale": [-2, 1, 1]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 24, "byteStride": 8}], "buffers": [{"byteLength": 24, "uri": "b"}]}"#;
    let rows = [[0i16, 0, 0, 0], [32767, 0, 0, 0], [0, -32767, 0, 0]];
    let buffer: Vec<u8> = rows.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
    let loaded = format::read("gltf", text.as_bytes(), &mut |_| Some(buffer.clone())).unwrap();
    assert_eq!(triangles(&loaded), [[[0., 0., 0.], [0., -1., 0.], [-2., 0., 0.]]]);
}

#[test]
fn components_and_items_of_a_3mf_are_moved_and_copied() {
    // Twice as large and 10 up, then a quarter turn about z (row vectors: x goes to y) and 1 along x.
    let objects = format!(
        "{}<object id='7'><components><component objectid='1' transform='2 0 0 0 2 0 0 0 2 0 0 10'/></components></object>",
        fixtures::MESH
    );
    let items = "<item objectid='7' transform='0 1 0 -1 0 0 0 0 1 1 0 0'/><item objectid='1'/>";
    let loaded = read("3mf", &threemf(&model(&objects, items))).unwrap();
    let moved = |[x, y, z]: [f64; 3]| [1.0 - 2.0 * y, 2.0 * x, 2.0 * z + 10.0];
    let mut both: Vec<_> = expected().iter().map(|corners| corners.map(moved)).collect();
    both.extend(expected());
    assert!(near(&triangles(&loaded), &both));
}

#[test]
fn an_object_of_a_3mf_may_stand_in_another_model() {
    let root = model("", "<item objectid='1' p:path='/3D/other.model'/>");
    let bytes = zipped(&[("3D/root.model", &root), ("3D/other.model", &model(fixtures::MESH, ""))]);
    assert!(near(&triangles(&read("3mf", &bytes).unwrap()), &expected()));
}

#[test]
fn a_binary_stl_of_any_length_is_welded() {
    let triangle = fixtures::binary_stl(b"")[84..134].to_vec();
    for count in 0..40u32 {
        let mut bytes = vec![0; 80];
        bytes.extend(count.to_le_bytes());
        (0..count).for_each(|_| bytes.extend(&triangle));
        assert_eq!(read("stl", &bytes).unwrap().mesh.faces, vec![[0, 1, 2]; count as usize]);
    }
}

#[test]
fn minus_zero_does_not_open_a_crack() {
    let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
        facet normal 0 0 1\nouter loop\nvertex -0 0 -0.0\nvertex 0 1 -0\nvertex -1 0 0\nendloop\nendfacet\nendsolid\n";
    assert_eq!(read("stl", text.as_bytes()).unwrap().mesh.positions.len(), 4);
}

#[test]
fn windows_spells_nan_in_its_own_way() {
    for nan in ["nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "NaN"] {
        let loaded = read("obj", format!("v 0 0 {nan}\nv 1 0 0\n").as_bytes()).unwrap();
        assert!(loaded.mesh.positions[0].z.is_nan(), "{nan}");
    }
}
