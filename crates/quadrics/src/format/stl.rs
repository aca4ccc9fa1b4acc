//! STL, ASCII and binary: triangles without indices, welded while they are read.
//!
//! Binary files may begin with `solid`, as ASCII ones must: the size of the file decides, which in a
//! binary one is 84 bytes and 50 a triangle.

use super::build::{Builder, MOST_FACES};
use super::scan::{Scanner, quoted};
use super::{InputFaces, Loaded, error};
use crate::error::Result;
use crate::math::Point;
use crate::mesh::Mesh;
use crate::mesh::weld::Welder;
use crate::result::Repair;

const HEADER: usize = 84;
const TRIANGLE: usize = 50;
/// Triangles that are welded at a time.
const BATCH: usize = 8;

pub(super) fn read(bytes: &[u8]) -> Result<Loaded> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    if has_exact_size(bytes) || !begins_with_solid(text) || !looks_like_text(text) {
        read_binary(bytes)
    } else {
        read_ascii(bytes)
    }
}

/// Whether this is a binary STL to the byte.
pub(super) fn has_exact_size(bytes: &[u8]) -> bool {
    claimed(bytes).is_some_and(|count| HEADER + TRIANGLE * count == bytes.len())
}

/// Whether it begins as an ASCII STL does, and is text.
pub(super) fn looks_like_text(text: &[u8]) -> bool {
    let start = &text[..text.len().min(1024)];
    begins_with_solid(text) && !start.contains(&0)
}

fn begins_with_solid(text: &[u8]) -> bool {
    let word = text.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    word.eq_ignore_ascii_case(b"solid")
}

/// Triangles according to a binary header.
fn claimed(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?;
    Some(u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize)
}

fn read_binary(bytes: &[u8]) -> Result<Loaded> {
    let Some(count) = claimed(bytes) else {
        return Err(error(
            "STL",
            format!(
                "{} bytes are less than a header: neither ASCII nor binary; was the file cut off?",
                bytes.len()
            ),
        ));
    };
    let body = &bytes[HEADER..];
    let room = body.len() / TRIANGLE;
    if count > room {
        return Err(error(
            "STL",
            format!(
                "the header claims {count} triangles, but the file ends after {room}; was it cut off?"
            ),
        ));
    }
    if count == 0 && room > 0 {
        let what = format!("the header claims no triangles, but {room} follow: export it again");
        return Err(error("STL", what));
    }
    if count > MOST_FACES {
        return Err(error("STL", format!("more than {MOST_FACES} triangles: split the mesh")));
    }
    let mut welder = Welder::new();
    // Of a triangle, the normal comes first and is not needed: it follows from the corners.
    let mut faces = Vec::with_capacity(count);
    let (batches, rest) = body[..TRIANGLE * count].as_chunks::<{ BATCH * TRIANGLE }>();
    for batch in batches {
        let corner = |i: usize| point(&batch[i / 3 * TRIANGLE + 12 + i % 3 * 12..]);
        let numbers: [u32; 3 * BATCH] = welder.add_all(std::array::from_fn(corner));
        faces.extend(numbers.as_chunks::<3>().0);
    }
    for triangle in rest.chunks_exact(TRIANGLE) {
        faces.push([12, 24, 36].map(|at| welder.add(point(&triangle[at..]))));
    }
    let mut repairs = Vec::new();
    let rest = body.len() - TRIANGLE * count;
    if rest > 0 {
        let detail = format!("bytes after the last triangle, passed over: {rest}");
        repairs.push(Repair { kind: "trailing_bytes", count: rest, detail });
    }
    Ok(Loaded {
        mesh: Mesh { positions: welder.into_positions(), faces },
        input_faces: InputFaces { of_triangle: (0..count as u32).collect(), count },
        units: None,
        repairs,
    })
}

fn point(bytes: &[u8]) -> Point {
    let at = |i: usize| f32::from_le_bytes([bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]]);
    Point::new(f64::from(at(0)), f64::from(at(4)), f64::from(at(8)))
}

fn read_ascii(bytes: &[u8]) -> Result<Loaded> {
    let mut scanner = Scanner::new("STL", bytes);
    let mut builder = Builder::new("STL", 0, 0);
    let mut welder = Welder::new();
    let mut corners: Vec<u32> = Vec::new();
    let mut inside = false;
    while let Some(word) = scanner.word() {
        match &lower(word) {
            // Names are free text: "facet" and "vertex" among them.
            b"solid\0\0\0" | b"endsolid" => {
                scanner.line();
            }
            b"facet\0\0\0" if !inside => inside = true,
            b"normal\0\0" | b"outer\0\0\0" if inside => skip_values(&mut scanner),
            b"vertex\0\0" if inside => {
                let position = [scanner.number()?, scanner.number()?, scanner.number()?];
                corners.push(welder.add(Point::from(position)));
            }
            b"endloop\0" if inside => {}
            b"endfacet" if inside => {
                builder.polygon(&corners)?;
                corners.clear();
                inside = false;
            }
            _ => return Err(scanner.error(format!("{} is out of place in an STL", quoted(word)))),
        }
    }
    if inside {
        return Err(scanner.error(format!("triangle {} is not complete", builder.count())));
    }
    builder.positions = welder.into_positions();
    builder.finish()
}

/// A keyword in lower case, filled up with zeros to the length of the longest; no keyword is longer.
fn lower(word: &[u8]) -> [u8; 8] {
    let mut lower = [0; 8];
    if let Some(start) = lower.get_mut(..word.len()) {
        start.copy_from_slice(word);
    }
    lower.make_ascii_lowercase();
    lower
}

/// The normal, whose numbers nobody needs (and which may be NaN), or `loop`.
fn skip_values(scanner: &mut Scanner) {
    let mut next = scanner.clone();
    while let Some(word) = next.word_on_line() {
        if word.eq_ignore_ascii_case(b"outer") || word.eq_ignore_ascii_case(b"vertex") {
            return;
        }
        *scanner = next.clone();
    }
}
