//! Whatever the bytes are, the answer is a mesh or one line.

use std::time::{Duration, Instant};

use quadrics::error::Error;
use quadrics::format;
use quadrics::mesh::repair;
use rand::Rng;
use rand_pcg::Pcg64Mcg;

use crate::fixtures::{self, glb, model, threemf, zipped};
use crate::{complaint, read};

/// Reads, repairs what was read, and asserts that an error is one line and all of it quick.
fn survives(extension: &str, bytes: &[u8]) {
    let start = Instant::now();
    let mut open = |_: &str| Some(fixtures::gltf_buffer());
    match format::read(extension, bytes, &mut open).and_then(|loaded| {
        assert_eq!(loaded.mesh.faces.len(), loaded.input_faces.of_triangle.len());
        repair(&loaded.mesh)
    }) {
        Ok(repaired) => assert!(!repaired.mesh.faces.is_empty()),
        Err(error) => {
            let line = error.to_string();
            assert!(!line.contains('\n') && line.len() < 400, "{line}");
        }
    }
    assert!(start.elapsed() < Duration::from_secs(5), "{extension} took {:?}", start.elapsed());
}

#[test]
fn no_flipped_deleted_or_repeated_byte_makes_a_reader_panic() {
    let mut rng = Pcg64Mcg::new(7);
    let mut below = move |bound: usize| (rng.next_u64() % bound.max(1) as u64) as usize;
    let telling = [0, 1, 2, 3, 9, 10, 32, 45, 46, 47, 48, 57, 63, 64, 101, 127, 128, 254, 255];
    for (_, extension, bytes) in fixtures::all() {
        for _ in 0..1500 {
            let mut bad = bytes.clone();
            for _ in 0..=below(4) {
                let at = below(bad.len());
                let end = (at + below(8)).min(bad.len());
                match below(6) {
                    0 => bad[at] ^= 1 << below(8),
                    1 => bad[at] = telling[below(telling.len())],
                    2 => bad[at..end].fill(255),
                    3 => drop(bad.drain(at..end)),
                    4 => bad
                        .splice(at..at, bytes[at.min(bytes.len() - 1)..].iter().copied().take(60))
                        .for_each(drop),
                    _ => bad[at..end].fill(b'9'),
                }
                if bad.is_empty() {
                    bad.push(0);
                }
            }
            survives(extension, &bad);
        }
    }
}

#[test]
fn a_3mf_may_be_damaged_inside_its_zip() {
    let mut rng = Pcg64Mcg::new(11);
    let objects = format!(
        "{}<object id='2'><components><component objectid='1'/></components></object>",
        fixtures::MESH
    );
    let good = model(&objects, "<item objectid='2' transform='1 0 0 0 1 0 0 0 1 0 0 0'/>");
    for _ in 0..1500 {
        let mut bad = good.clone().into_bytes();
        let at = rng.next_u64() as usize % bad.len();
        bad[at] = b"<>'\"/&=0129 -x"[rng.next_u64() as usize % 14];
        survives("3mf", &threemf(&String::from_utf8_lossy(&bad)));
    }
}

#[test]
fn a_file_that_is_cut_off_anywhere_is_read_or_refused() {
    for (_, extension, bytes) in fixtures::all() {
        (0..bytes.len()).for_each(|length| survives(extension, &bytes[..length]));
    }
}

#[test]
fn noise_is_no_mesh() {
    let mut rng = Pcg64Mcg::new(3);
    for extension in ["stl", "ply", "obj", "off", "glb", "gltf", "3mf", ""] {
        for length in [0, 1, 4, 83, 84, 133, 134, 4096] {
            let noise: Vec<u8> = (0..length).map(|_| rng.next_u64() as u8).collect();
            survives(extension, &noise);
            assert!(
                format::read(extension, &noise, &mut |_| None).is_err(),
                "{extension} {length}"
            );
        }
    }
}

#[test]
fn an_error_says_what_where_and_what_to_do() {
    let mut claims = fixtures::binary_stl(b"part");
    claims[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut uncounted = fixtures::binary_stl(b"part");
    uncounted[80] = 0;
    let ply = |from: &str, to: &str| fixtures::ASCII_PLY.replace(from, to);
    let off = |from: &str, to: &str| fixtures::OFF.replace(from, to);
    let table: &[(&str, Vec<u8>, &[&str])] = &[
        ("stl", vec![], &["STL", "0 bytes"]),
        ("stl", claims, &["claims 4294967295 triangles", "after 4", "cut off"]),
        ("stl", uncounted, &["claims no triangles", "4 follow"]),
        ("stl", fixtures::binary_stl(b"solid part")[..200].into(), &["claims 4", "after 2"]),
        (
            "stl",
            fixtures::ascii_stl(&["a"]).replace("vertex 1 1e0", "vertex 1 one").into(),
            &["STL: line 6", "\"one\" is not a number"],
        ),
        (
            "stl",
            b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n".into(),
            &["triangle 0", "cut off"],
        ),
        ("stl", b"solid\nfacett\n".into(), &["line 2", "\"facett\""]),
        (
            "ply",
            ply("vertex 5", "vertex 4000000000").into(),
            &["claims 4000000000 rows of vertex", "cut off"],
        ),
        ("ply", ply("vertex 5", "vertex -5").into(), &["line 4"]),
        ("ply", ply("double y", "double why").into(), &["no property y"]),
        ("ply", ply("double y", "quad y").into(), &["line 6", "\"quad\" is not a type"]),
        ("ply", ply("vertex_indices", "corners").into(), &["vertex_indices"]),
        ("ply", ply("3 2 3 4", "3 2 3").into(), &["line 19", "missing", "row 2 of 4 face"]),
        ("ply", ply("end_header", "").into(), &["header"]),
        ("ply", ply("ascii", "utf8").into(), &["\"utf8\" is not a format"]),
        ("ply", ply("3 0 1 4", "3000000000 0 1 4").into(), &["line 17", "3000000000 values"]),
        ("ply", fixtures::binary_ply(true)[..560].into(), &["cut off", "byte"]),
        ("off", off("5 4 0", "5 4000000 0").into(), &["4000000 faces", "room"]),
        ("off", off("OFF", "4OFF").into(), &["\"4OFF\""]),
        ("off", off("3 3 0 4", "").into(), &["end of the file"]),
        ("off", off("2 2 0.5", "2 2,0 0.5").into(), &["line 5", "\"2,0\" is not a number"]),
        ("off", off("5 4 0", "BINARY").into(), &["PLY"]),
        ("obj", b"\x00\x01\x02 hello".into(), &["no vertex"]),
        ("obj", b"v 1 2\n".into(), &["line 1", "three numbers"]),
        ("obj", b"v 1 2 3\nf 0 1 1\n".into(), &["line 2", "counts from 1"]),
        ("glb", glb()[..300].into(), &["claims", "300", "cut off"]),
        ("glb", b"glTF\x01\0\0\0\xff\0\0\0".into(), &["version 1"]),
        ("gltf", b"{\"asset\": ".into(), &["glTF", "line 1"]),
        ("3mf", fixtures::threemf("<model>")[..90].into(), &["zip", "cut off"]),
        ("3mf", threemf("<model><resources>"), &["cut off"]),
        ("3mf", zipped(&[("readme.txt", "hello")]), &["no model"]),
        ("3mf", threemf(&model("", "<item objectid='4'/>")), &["object 4 is missing"]),
        ("xyz", b"1 2 3\n4 5 6\n".into(), &["STL, PLY, OBJ"]),
        ("step", b"ISO-10303-21;".into(), &["surfaces already"]),
    ];
    for (extension, bytes, words) in table {
        let line = complaint(extension, bytes);
        assert!(
            words.iter().all(|word| line.contains(word)),
            "{extension}: {line} (wanted {words:?})"
        );
    }
}

#[test]
fn an_index_out_of_range_is_told_with_its_face() {
    let out = |face, vertex| Err(Error::IndexOutOfRange { face, vertex, vertices: 5 });
    let ply = |index: &str| fixtures::ASCII_PLY.replace("3 2 3 4", &format!("3 2 3 {index}"));
    assert_eq!(read("ply", ply("5").as_bytes()), out(2, 5));
    assert_eq!(read("ply", ply("-1").as_bytes()), out(2, -1));
    assert_eq!(read("ply", ply("99999999999").as_bytes()), out(2, 99_999_999_999));
    assert_eq!(read("off", fixtures::OFF.replace("3 3 0 4", "3 3 0 8").as_bytes()), out(3, 8));
    assert_eq!(read("obj", fixtures::OBJ.replace("-4 -3 -1", "-4 -9 -1").as_bytes()), out(1, -4));
    let bad = fixtures::MESH.replace("v2='3'", "v2='9'");
    assert_eq!(read("3mf", &threemf(&model(&bad, "<item objectid='1'/>"))), out(2, 9));
}

#[test]
fn a_buffer_outside_the_folder_is_never_asked_for() {
    for uri in
        ["../secret", "/etc/passwd", "a/../../b", "http://x/y", "C:/x", "..%2fsecret", "a\\\\b", ""]
    {
        let text = fixtures::GLTF.replace("URI", &format!(r#", "uri": "{uri}""#));
        assert!(complaint("gltf", text.as_bytes()).contains("refused"), "{uri}");
    }
}

#[test]
fn a_zip_bomb_is_refused_before_it_unpacks() {
    let blanks = " ".repeat(60 << 20);
    let bytes = threemf(&format!("<model>{blanks}</model>"));
    assert!(bytes.len() < 1 << 20);
    let start = Instant::now();
    assert!(complaint("3mf", &bytes).contains("refused"));
    assert!(start.elapsed() < Duration::from_secs(1));
}

#[test]
fn a_zip_bomb_that_lies_about_its_size_is_refused_too() {
    let model = format!("<model>{}</model>", "<a/>".repeat(5 << 20));
    let mut bytes = threemf(&model);
    let size = (model.len() as u32).to_le_bytes();
    let places: Vec<_> = (0..bytes.len() - 4).filter(|&at| bytes[at..at + 4] == size).collect();
    assert_eq!(places.len(), 2, "the local and the central header");
    places.iter().for_each(|&at| bytes[at..at + 4].copy_from_slice(&1000u32.to_le_bytes()));
    let line = complaint("3mf", &bytes);
    assert!(line.contains("refused") || line.contains("cut off"), "{line}");
}

#[test]
fn objects_made_of_each_other_come_to_an_end() {
    let twice = |id: u32, of: u32| {
        let one = format!("<component objectid='{of}'/>");
        format!("<object id='{id}'><components>{one}{one}</components></object>")
    };
    let ring = twice(1, 2) + &twice(2, 1);
    assert!(
        complaint("3mf", &threemf(&model(&ring, "<item objectid='1'/>"))).contains("each other")
    );
    let doubled: String = (2..60).map(|id| twice(id, id - 1)).collect();
    let laughs = format!("{}{doubled}", fixtures::MESH);
    let line = complaint("3mf", &threemf(&model(&laughs, "<item objectid='59'/>")));
    assert!(line.contains("each other"), "{line}");
}

#[test]
fn a_node_that_is_its_own_ancestor_is_refused() {
    let text = fixtures::gltf_with_data().replace(r#""children": [0]"#, r#""children": [0, 1]"#);
    assert!(complaint("gltf", text.as_bytes()).contains("node 1"));
}
