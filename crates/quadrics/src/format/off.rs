//! OFF and its variants with colours, normals and texture coordinates (`COFF`, `NOFF`, `STOFF`, ...).
//!
//! Whatever a variant adds comes after the three coordinates and after the indices of a face, so that
//! it can be passed over unread.

use super::Loaded;
use super::build::Builder;
use super::scan::{Scanner, parse_integer, quoted};
use crate::error::Result;

/// Whether the first word is a header, perhaps with the number of vertices glued to it.
pub(super) fn has_header(text: &[u8]) -> bool {
    header_length(text.split(u8::is_ascii_whitespace).next().unwrap_or_default()).is_some()
}

pub(super) fn read(bytes: &[u8]) -> Result<Loaded> {
    let mut scanner = Scanner::new("OFF", bytes);
    let (vertices, faces) = read_counts(&mut scanner)?;
    let mut builder = Builder::new("OFF", vertices, faces);
    for _ in 0..vertices {
        scanner.skip_comments();
        builder.vertex([scanner.number()?, scanner.number()?, scanner.number()?]);
        scanner.line();
    }
    let mut corners = Vec::new();
    for _ in 0..faces {
        scanner.skip_comments();
        let count = scanner.integer()?;
        if count < 0 || count as u64 > scanner.remaining() as u64 {
            return Err(scanner.error(format!("a face of {count} corners")));
        }
        corners.clear();
        for _ in 0..count {
            let index = scanner.integer()?;
            corners.push(builder.index(index)?);
        }
        scanner.line();
        builder.polygon(&corners)?;
    }
    builder.finish()
}

/// Vertices and faces, which the file has room for. The header may be missing, share the line with
/// the counts, or run into them.
fn read_counts(scanner: &mut Scanner) -> Result<(usize, usize)> {
    scanner.skip_comments();
    let start = scanner.clone();
    let word = scanner.word_on_line().unwrap_or_default();
    let vertices = match header_length(word) {
        Some(length) if length < word.len() => parse_integer(&word[length..]),
        Some(_) => None,
        None if word.first().is_some_and(u8::is_ascii_digit) => {
            *scanner = start;
            None
        }
        None => return Err(scanner.error(format!("{} where OFF should be", quoted(word)))),
    };
    scanner.skip_comments();
    if scanner.clone().word_on_line() == Some(b"BINARY") {
        return Err(scanner.error("binary OFF is not read: export as text, or as PLY"));
    }
    let vertices = match vertices {
        Some(vertices) => vertices,
        None => scanner.integer()?,
    };
    let faces = scanner.integer()?;
    scanner.line();
    // A vertex takes 6 bytes at least, a face 2.
    let room = scanner.remaining() as i64 + 1;
    if vertices < 0 || faces < 0 || vertices > room / 6 || faces > room / 2 {
        return Err(scanner.error(format!(
            "the header claims {vertices} vertices and {faces} faces, more than the file has room for; was it cut off?"
        )));
    }
    Ok((vertices as usize, faces as usize))
}

/// How much of a word is a header: `OFF` after any of the prefixes, and digits at most behind it.
fn header_length(word: &[u8]) -> Option<usize> {
    let end = word.windows(3).position(|three| three == b"OFF")? + 3;
    let prefix = &word[..end - 3];
    let known = matches!(prefix, b"" | b"C" | b"N" | b"CN" | b"ST" | b"STC" | b"STN" | b"STCN");
    (known && word[end..].iter().all(u8::is_ascii_digit)).then_some(end)
}
