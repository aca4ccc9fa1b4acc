//! Wavefront OBJ: of its many statements `v` and `f`.
//!
//! Indices count from 1, or backwards from the last vertex; of `v/vt/vn` the first matters. A backslash
//! at the end of a line joins it with the next, `#` begins a comment anywhere.

use std::borrow::Cow;

use super::build::Builder;
use super::scan::{Scanner, parse_integer, parse_number, quoted};
use super::{Loaded, error};
use crate::error::Result;

pub(super) fn read(bytes: &[u8]) -> Result<Loaded> {
    let mut scanner = Scanner::new("OBJ", bytes);
    let mut builder = Builder::new("OBJ", 0, 0);
    let mut corners = Vec::new();
    loop {
        let start = scanner.clone();
        let Some(line) = logical_line(&mut scanner) else { break };
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => builder.vertex(position(words, &start)?),
            Some(b"f") => {
                corners.clear();
                for word in words {
                    corners.push(corner(word, &builder, &start)?);
                }
                builder.polygon(&corners)?;
            }
            _ => {}
        }
    }
    if builder.positions.is_empty() {
        return Err(error(
            "OBJ",
            "there is no vertex (a line that begins with v): is this an OBJ?",
        ));
    }
    builder.finish()
}

/// A line without its comment, joined with the next ones where it ends in a backslash.
fn logical_line<'a>(scanner: &mut Scanner<'a>) -> Option<Cow<'a, [u8]>> {
    let mut line = Cow::Borrowed(scanner.line()?);
    loop {
        // Looked for first: a comment may end in the backslash of a folder's name.
        if let Some(comment) = comment_start(&line) {
            match &mut line {
                Cow::Borrowed(line) => *line = &line[..comment],
                Cow::Owned(line) => line.truncate(comment),
            }
            return Some(line);
        }
        let Some(b'\\') = line.last() else { return Some(line) };
        let joined = line.to_mut();
        joined.pop();
        joined.push(b' ');
        match scanner.line() {
            Some(next) => joined.extend_from_slice(next),
            None => return Some(line),
        }
    }
}

fn comment_start(line: &[u8]) -> Option<usize> {
    let mut marks = (0..line.len()).filter(|&i| line[i] == b'#');
    // `1.#QNAN` is what Windows wrote for NaN: cut at its mark it would pass for 1.
    marks.find(|&i| i == 0 || line[i - 1] != b'.')
}

/// Three numbers; a weight or a colour may follow.
fn position<'a>(mut words: impl Iterator<Item = &'a [u8]>, at: &Scanner) -> Result<[f64; 3]> {
    let mut position = [0.0; 3];
    for x in &mut position {
        let word = words.next().ok_or_else(|| at.error("a vertex needs three numbers"))?;
        *x = parse_number(word)
            .ok_or_else(|| at.error(format!("{} is not a number", quoted(word))))?;
    }
    Ok(position)
}

/// The vertex of `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 0.
fn corner(word: &[u8], builder: &Builder, at: &Scanner) -> Result<u32> {
    let number = word.split(|&byte| byte == b'/').next().unwrap_or_default();
    let index = match parse_integer(number) {
        Some(index) if index > 0 => index - 1,
        Some(index) if index < 0 => builder.positions.len() as i64 + index,
        _ => {
            let what = format!("{} is not an index; OBJ counts from 1", quoted(word));
            return Err(at.error(what));
        }
    };
    builder.index(index)
}
