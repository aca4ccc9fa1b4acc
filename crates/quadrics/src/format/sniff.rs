//! Which format bytes are in: the extension proposes, the content decides where it is plain.

use super::{READABLE, error, off, scan, stl};
use crate::error::Result;

/// What can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Stl,
    Ply,
    Obj,
    Off,
    Glb,
    Gltf,
    ThreeMf,
}

/// The format of `bytes`; `extension` in lower case.
pub(super) fn format_of(extension: &str, bytes: &[u8]) -> Result<Format> {
    let proposed = match extension {
        "stl" => Some(Format::Stl),
        "ply" => Some(Format::Ply),
        "obj" => Some(Format::Obj),
        "off" | "coff" | "noff" => Some(Format::Off),
        "glb" => Some(Format::Glb),
        "gltf" => Some(Format::Gltf),
        "3mf" => Some(Format::ThreeMf),
        _ => None,
    };
    // The header of a binary STL is free text: it may begin like any other format.
    if stl::has_exact_size(bytes) && matches!(proposed, None | Some(Format::Stl)) {
        return Ok(Format::Stl);
    }
    plain(bytes).or(proposed).ok_or_else(|| {
        let reason = match extension {
            "step" | "stp" | "iges" | "igs" => {
                "it holds exact surfaces already: mesh it first, or use them as they are".into()
            }
            _ => format!("neither the name nor the content says which it is: give {READABLE}"),
        };
        error("format", reason)
    })
}

/// What the content says without a doubt.
fn plain(bytes: &[u8]) -> Option<Format> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = text.trim_ascii_start();
    if bytes.starts_with(b"glTF") {
        Some(Format::Glb)
    } else if bytes.starts_with(b"PK\x03\x04") {
        Some(Format::ThreeMf)
    } else if text.starts_with(b"ply\n") || text.starts_with(b"ply\r") {
        Some(Format::Ply)
    } else if off::has_header(text) {
        Some(Format::Off)
    } else if text.starts_with(b"{") && contains(text, b"\"asset\"") {
        Some(Format::Gltf)
    } else if stl::looks_like_text(text) {
        Some(Format::Stl)
    } else {
        looks_like_obj(text).then_some(Format::Obj)
    }
}

/// `v` and three numbers on the first line that says something.
fn looks_like_obj(text: &[u8]) -> bool {
    let mut lines = text[..text.len().min(1 << 16)].split(|&byte| byte == b'\n');
    lines.find_map(|line| {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next()? {
            b"v" => Some(words.filter_map(scan::parse_number).take(3).count() == 3),
            b"mtllib" | b"o" | b"g" | b"usemtl" | b"s" | b"vn" | b"vt" => None,
            comment => (!comment.starts_with(b"#")).then_some(false),
        }
    }) == Some(true)
}

fn contains(text: &[u8], what: &[u8]) -> bool {
    text.windows(what.len()).any(|window| window == what)
}
