//! glTF 2: the triangles of the scene, each primitive moved by the nodes above it.
//!
//! Read straight from the JSON, of which a mesh needs little: the crate `gltf` refuses files for their
//! materials, and those whose positions are quantised, and leaves the bounds of its slices to us anyway.

mod accessor;
mod document;

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Matrix4, Point3};

use super::build::Builder;
use super::{Loaded, Open, error};
use crate::error::{Error, Result};
use crate::result::Repair;
use accessor::Buffers;
use document::{Document, Primitive};

/// Extensions without which the triangles cannot be had, and that are not read.
const COMPRESSED: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Every mesh may hang in every node: that is the square of what the file holds.
const MOST_PRIMITIVES: usize = 1_000_000;

/// `binary` is the buffer that comes with a GLB.
pub(super) fn read(json: &[u8], binary: Option<&[u8]>, open: &mut Open) -> Result<Loaded> {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    let document: Document =
        serde_json::from_slice(json).map_err(|cause| error("glTF", format!("{cause}")))?;
    if let Some(name) =
        document.extensions_required.iter().find(|name| COMPRESSED.contains(&name.as_str()))
    {
        return Err(error("glTF", format!("compression {name} is not read: export without it")));
    }
    let buffers = Buffers::open(&document, binary, open)?;
    let mut builder = Builder::new("glTF", 0, 0);
    // A strip of byte-sized indices has a triangle a byte; nothing is denser.
    builder.limit_copies(json.len() + buffers.size);
    let mut passed_over = 0;
    let mut visited = 0;
    for (mesh, matrix) in instances(&document)? {
        let mesh = lookup(&document.meshes, mesh, "mesh")?;
        visited += mesh.primitives.len();
        if visited > MOST_PRIMITIVES {
            return Err(error(
                "glTF",
                format!("more than {MOST_PRIMITIVES} primitives in the scene"),
            ));
        }
        passed_over += add(&mesh.primitives, &matrix, &buffers, &mut builder)?;
    }
    let mut loaded = builder.finish()?;
    // The format prescribes it.
    loaded.units = Some("m".into());
    if passed_over > 0 {
        let detail = format!("primitives of points or lines, passed over: {passed_over}");
        loaded.repairs.push(Repair { kind: "not_triangles", count: passed_over, detail });
    }
    Ok(loaded)
}

/// The meshes of the scene, each with the product of the matrices above it, in the order of the tree.
fn instances(document: &Document) -> Result<Vec<(usize, Matrix4<f64>)>> {
    let mut stack: Vec<_> =
        document.roots()?.into_iter().rev().map(|node| (node, Matrix4::identity())).collect();
    let mut seen = vec![false; document.nodes.len()];
    let mut found = Vec::new();
    while let Some((index, above)) = stack.pop() {
        let node = lookup(&document.nodes, index, "node")?;
        if std::mem::replace(&mut seen[index], true) {
            return Err(error("glTF", format!("node {index} has two parents, or is its own")));
        }
        let matrix = above * node.matrix();
        found.extend(node.mesh.map(|mesh| (mesh, matrix)));
        stack.extend(node.children.iter().rev().map(|&child| (child, matrix)));
    }
    Ok(found)
}

/// Adds a mesh, and tells how many of its primitives are no triangles.
fn add(
    primitives: &[Primitive],
    matrix: &Matrix4<f64>,
    buffers: &Buffers,
    builder: &mut Builder,
) -> Result<usize> {
    // Primitives that differ in their material only share their vertices.
    let mut placed = BTreeMap::new();
    let (triangular, other): (Vec<_>, Vec<_>) =
        primitives.iter().partition(|primitive| (4..=6).contains(&primitive.mode));
    for primitive in triangular {
        let Some(&accessor) = primitive.attributes.get("POSITION") else {
            return Err(error("glTF", "a primitive has no POSITION: export the mesh again"));
        };
        let vertices = match placed.get(&accessor) {
            Some(vertices) => Range::clone(vertices),
            None => place(accessor, matrix, buffers, builder)?,
        };
        placed.insert(accessor, vertices.clone());
        // A mirror turns the winding.
        let mirrored = matrix.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        add_faces(primitive, vertices, mirrored, buffers, builder)?;
    }
    Ok(other.len())
}

/// Adds vertices where the matrix takes them, and tells which they are.
fn place(
    accessor: usize,
    matrix: &Matrix4<f64>,
    buffers: &Buffers,
    builder: &mut Builder,
) -> Result<Range<usize>> {
    let positions = buffers.positions(accessor)?;
    let first = builder.positions.len();
    builder.check_limit(first + positions.len())?;
    for p in &positions {
        builder.vertex(matrix.transform_point(&Point3::from(*p)).into());
    }
    Ok(first..first + positions.len())
}

fn add_faces(
    primitive: &Primitive,
    vertices: Range<usize>,
    mirrored: bool,
    buffers: &Buffers,
    builder: &mut Builder,
) -> Result<()> {
    let indices: Vec<u32> = match primitive.indices {
        Some(accessor) => buffers.indices(accessor)?,
        None => (0..vertices.len() as u32).collect(),
    };
    let least = if primitive.mode == 4 { indices.len() / 3 } else { indices.len() };
    builder.check_limit(builder.count() + least)?;
    for mut corners in triangles(primitive.mode, &indices) {
        if mirrored {
            corners.swap(1, 2);
        }
        if let Some(&vertex) = corners.iter().find(|&&corner| corner as usize >= vertices.len()) {
            return Err(Error::IndexOutOfRange {
                face: builder.count(),
                vertex: i64::from(vertex),
                vertices: vertices.len(),
            });
        }
        builder.polygon(&corners.map(|corner| corner + vertices.start as u32))?;
    }
    Ok(())
}

/// The triangles of a list (mode 4), a strip (5) or a fan (6).
fn triangles(mode: u32, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        4 => indices.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect(),
        5 => {
            let turned = |(i, three): (usize, &[u32])| match i % 2 {
                0 => [three[0], three[1], three[2]],
                _ => [three[1], three[0], three[2]],
            };
            indices.windows(3).enumerate().map(turned).collect()
        }
        _ => {
            let rest = indices.get(1..).unwrap_or_default();
            rest.windows(2).map(|two| [indices[0], two[0], two[1]]).collect()
        }
    }
}

fn lookup<'a, T>(list: &'a [T], index: usize, what: &str) -> Result<&'a T> {
    let missing = || error("glTF", format!("{what} {index} is missing: there are {}", list.len()));
    list.get(index).ok_or_else(missing)
}
