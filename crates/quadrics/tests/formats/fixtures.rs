//! One square pyramid without its base, in every spelling: four triangles over a square of side 2.

use std::io::Write;

pub const CORNERS: [[f32; 3]; 5] =
    [[0.0, 0.0, 0.5], [2.0, 0.0, 0.5], [2.0, 2.0, 0.5], [0.0, 2.0, 0.5], [1.0, 1.0, 1.25]];
pub const FACES: [[u32; 3]; 4] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];

/// The triangles that every fixture holds.
pub fn expected() -> Vec<[[f64; 3]; 3]> {
    FACES.iter().map(|face| face.map(|v| CORNERS[v as usize].map(f64::from))).collect()
}

/// Name, extension, bytes; all of them [`expected`].
pub fn all() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    vec![
        ("binary STL", "stl", binary_stl(b"made by a scanner")),
        ("binary STL that begins with solid", "stl", binary_stl(b"solid part")),
        ("binary STL that begins like an OFF", "STL", binary_stl(b"OFF the shelf")),
        ("ASCII STL", "stl", ascii_stl(&["part"]).into()),
        (
            "ASCII STL, upper case and CRLF",
            "stl",
            ascii_stl(&["A B"]).to_uppercase().replace('\n', "\r\n").into(),
        ),
        (
            "ASCII STL, several solids, one without a name",
            "stl",
            ascii_stl(&["facet", "", "vertex 1", "x"]).into(),
        ),
        (
            "ASCII STL on one line a facet",
            "stl",
            ascii_stl(&["p"]).replace("\n      ", " ").replace("\n    e", " e").into(),
        ),
        ("little-endian PLY", "ply", binary_ply(false)),
        ("big-endian PLY with normals, colours, flags and lists", "ply", binary_ply(true)),
        ("ASCII PLY", "ply", ASCII_PLY.into()),
        ("ASCII PLY with CRLF", "ply", ASCII_PLY.replace('\n', "\r\n").into()),
        ("OBJ", "obj", OBJ.into()),
        ("OBJ with CRLF", "obj", OBJ.replace('\n', "\r\n").into()),
        ("OFF", "off", OFF.into()),
        ("OFF with counts on the first line", "off", OFF.replacen('\n', " ", 1).into()),
        ("OFF with glued counts", "off", OFF.replacen('\n', "", 1).into()),
        ("OFF without a header", "off", OFF.replacen("OFF\n", "", 1).into()),
        ("COFF with comments and colours", "off", COFF.into()),
        ("GLB", "glb", glb()),
        ("glTF with its buffer inside", "gltf", gltf_with_data().into()),
        ("3MF", "3mf", threemf(&model(MESH, "<item objectid='1'/>"))),
    ]
}

pub fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend((FACES.len() as u32).to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        bytes.extend(face.iter().flat_map(|&v| CORNERS[v as usize]).flat_map(f32::to_le_bytes));
        bytes.extend([0, 0]);
    }
    bytes
}

/// The triangles dealt to solids of these names.
pub fn ascii_stl(solids: &[&str]) -> String {
    let mut text = String::new();
    for (name, faces) in solids.iter().zip(FACES.chunks(FACES.len() / solids.len())) {
        text += &format!("solid {name}\n");
        for face in faces {
            text += "  facet normal 0 -nan 1e0\n    outer loop\n";
            for [x, y, z] in face.map(|v| CORNERS[v as usize]) {
                text += &format!("      vertex {x} {y:e} {z}\n");
            }
            text += "    endloop\n  endfacet\n";
        }
        text += &format!("endsolid {name}\n");
    }
    text
}

pub fn binary_ply(big: bool) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_{}_endian 1.0\ncomment end_header is not yet\nelement camera 2\nproperty uchar a\n\
         property list uchar double b\nelement vertex 5\nproperty float nx\nproperty double y\nproperty float x\n\
         property uchar red\nproperty list ushort short tags\nproperty float z\nelement face 4\n\
         property uchar flags\nproperty list ushort uint vertex_index\nproperty list uchar float texcoord\n\
         element edge 1\nproperty int vertex1\nend_header\n",
        if big { "big" } else { "little" }
    )
    .into_bytes();
    let mut put = |little: &[u8]| match big {
        true => bytes.extend(little.iter().rev()),
        false => bytes.extend(little),
    };
    for _ in 0..2 {
        put(&[7]);
        put(&[1]);
        put(&2.5f64.to_le_bytes());
    }
    for [x, y, z] in CORNERS {
        put(&9f32.to_le_bytes());
        put(&f64::from(y).to_le_bytes());
        put(&x.to_le_bytes());
        put(&[255]);
        put(&2u16.to_le_bytes());
        put(&(-1i16).to_le_bytes());
        put(&3i16.to_le_bytes());
        put(&z.to_le_bytes());
    }
    for face in FACES {
        put(&[1]);
        put(&3u16.to_le_bytes());
        face.iter().for_each(|v| put(&v.to_le_bytes()));
        put(&[1]);
        put(&0.5f32.to_le_bytes());
    }
    put(&4i32.to_le_bytes());
    bytes
}

pub const ASCII_PLY: &str = "ply\nformat ascii 1.0\nobj_info none\nelement vertex 5\nproperty double x\n\
    property double y\nproperty double z\nproperty uchar red\nelement face 4\n\
    property list uint16 uint32 vertex_indices\nend_header\n0 0 0.5 1\n2 0 .5 1\n2 2 5e-1 1\n0 2 0.5 1\n\
    1 1 1.25 1\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";

pub const OBJ: &str = "# C:\\parts\\\nmtllib a.mtl\no pyramid\nv 0 0 0.5 1 0 0\nv 2 0 0.5 # corner\n  v\t2 2 0.5 1.0\n\
    v 0 2 \\\n0.5\nv 1 1 1.25\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 5/1 # mixed\nf -4 -3 -1\nusemtl x\ns off\n\
    f 3 4\\\n 5\nl 1 2\nf 4/1 1//1 5\n";

pub const OFF: &str = "OFF\n5 4 0\n0 0 0.5\n2 0 0.5\n2 2 0.5\n0 2 0.5\n1 1 1.25\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";

pub const COFF: &str = "COFF # colours\n\n# counts\n5 4 8 # the last is ignored\n0 0 0.5 255 0 0 255\n2 0 0.5 0 0 1 1\n\
    # more\n2 2 0.5 1 1 1 1\n0 2 0.5 0 0 0 0\n1 1 1.25 0 0 0 0\n3 0 1 4 255 0 0\n3 1 2 4\n\n3 2 3 4 0.5 0.5 0.5 1\n3 3 0 4 # end";

/// Two primitives under two nodes: the vertices are a tenth and mirrored, in a mesh of shorts and floats.
pub const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [1]}],
    "nodes": [{"mesh": 0, "translation": [0, 0, 0.05]},
              {"children": [0], "matrix": [10,0,0,0, 0,10,0,0, 0,0,10,0, 0,0,0,1]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1},
                               {"attributes": {"POSITION": 0, "NORMAL": 9}, "indices": 2, "mode": 6},
                               {"attributes": {"POSITION": 0}, "mode": 0}]}],
    "materials": [{"extensions": {"KHR_unknown": {}}}], "extensionsUsed": ["KHR_unknown"],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
                  {"bufferView": 1, "byteOffset": 12, "componentType": 5123, "count": 4, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 76, "byteStride": 16},
                    {"buffer": 0, "byteOffset": 80, "byteLength": 20}],
    "buffers": [{"byteLength": 100URI}]}"#;

/// Vertices at a stride of 16, then two triangles, then a fan of two around the tip.
pub fn gltf_buffer() -> Vec<u8> {
    let mut bytes = Vec::new();
    for [x, y, z] in CORNERS {
        bytes.extend(
            [x / 10.0, y / 10.0, (z - 0.5) / 10.0, 0.0].iter().flat_map(|x| x.to_le_bytes()),
        );
    }
    bytes.extend([0u16, 1, 4, 1, 2, 4, 4, 2, 3, 0].iter().flat_map(|i| i.to_le_bytes()));
    bytes
}

pub fn glb() -> Vec<u8> {
    let mut json = GLTF.replace("URI", "");
    while !json.len().is_multiple_of(4) {
        json.push(' ');
    }
    let buffer = gltf_buffer();
    let mut bytes = b"glTF".to_vec();
    let total = 12 + 8 + json.len() + 8 + buffer.len();
    for word in [2, total as u32, json.len() as u32] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(b"JSON");
    bytes.extend(json.as_bytes());
    bytes.extend((buffer.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(buffer);
    bytes
}

pub fn gltf_with_data() -> String {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in gltf_buffer().chunks(3) {
        let bits = group.iter().fold(0u32, |bits, &byte| bits << 8 | u32::from(byte))
            << (8 * (3 - group.len()));
        for i in 0..4 {
            let letter = letters[(bits >> (18 - 6 * i)) as usize & 63] as char;
            text.push(if i <= group.len() { letter } else { '=' });
        }
    }
    GLTF.replace("URI", &format!(r#", "uri": "data:application/octet-stream;base64,{text}""#))
}

pub const MESH: &str = "<object id='1' type='model'><mesh><vertices><vertex x='0' y='0' z='0.5'/>\
    <vertex z='0.5' x='2' y='0'/><vertex x='2' y='2' z='0.5'/><vertex x='0' y='2' z='0.5'></vertex>\
    <vertex x='1' y='1' z=' 1.25 '/></vertices><triangles><triangle v1='0' v2='1' v3='4' pid='3'/>\
    <triangle v1='1' v2='2' v3='4'/><triangle v1='2' v2='3' v3='4'/><triangle v1='3' v2='0' v3='4'/>\
    </triangles></mesh></object>";

/// A model of these objects and items, in inches.
pub fn model(objects: &str, items: &str) -> String {
    format!(
        "<?xml version='1.0' encoding='UTF-8'?>\n<model unit='inch' xmlns='http://schemas.microsoft.com/3dmanufacturing/core/2015/02' \
         xmlns:p='http://schemas.microsoft.com/3dmanufacturing/production/2015/06'>\
         <metadata name='Title'>a &amp; b</metadata><resources>{objects}</resources><build>{items}</build></model>"
    )
}

pub fn threemf(model: &str) -> Vec<u8> {
    zipped(&[
        (
            "_rels/.rels",
            "<Relationships><Relationship Id='r' Target='/3D/part.model' \
          Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/></Relationships>",
        ),
        ("3D/part.model", model),
    ])
}

pub fn zipped(files: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated);
    for (name, content) in files {
        zip.start_file(*name, options).unwrap();
        zip.write_all(content.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}
