//! PLY, ASCII and binary of either endianness, with whatever else programs put into it.
//!
//! A header names elements (vertex, face, ...) and their properties, each a number or a list of
//! numbers; the rows follow. Of the vertices `x`, `y`, `z` are taken, of the faces the list
//! `vertex_indices` or `vertex_index`; all else is stepped over.

mod header;
mod plain;

use super::build::Builder;
use super::scan::Scanner;
use super::{Loaded, error};
use crate::error::{Error, Result};
use header::{Element, Encoding, Kind, Property, Scalar};

pub(super) fn read(bytes: &[u8]) -> Result<Loaded> {
    let (header, scanner) = header::parse(bytes)?;
    let find = |name: &str| header.elements.iter().find(|element| element.name == name);
    let Some(vertices) = find("vertex") else {
        return Err(error("PLY", "the header has no element vertex: is this a mesh?"));
    };
    let faces = find("face");
    if faces.is_none() && find("tristrips").is_some() {
        return Err(error("PLY", "triangle strips are not read: export the mesh with faces"));
    }
    let mut rows = match header.encoding {
        Encoding::Ascii => Rows::Text(scanner),
        Encoding::Little => Rows::Binary { bytes, pos: scanner.position(), big: false },
        Encoding::Big => Rows::Binary { bytes, pos: scanner.position(), big: true },
    };
    for element in &header.elements {
        check_room(element, &rows, header.encoding)?;
    }
    let mut builder = Builder::new("PLY", vertices.count, faces.map_or(0, |faces| faces.count));
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(element, &mut rows, &mut builder)?,
            "face" => read_faces(element, &mut rows, &mut builder)?,
            // Nothing that is needed comes after the faces in the files that have them.
            _ if builder.count() > 0 => break,
            _ => skip(element, &mut rows)?,
        }
    }
    builder.finish()
}

/// That the file is long enough for as many rows as its header claims, before memory is taken.
fn check_room(element: &Element, rows: &Rows, encoding: Encoding) -> Result<()> {
    let least = match encoding {
        // A digit and a blank or a line end each, the last line end may be missing.
        Encoding::Ascii => 2 * element.properties.len(),
        _ => element.properties.iter().map(|property| property.kind.least_size()).sum(),
    };
    let room = rows.remaining() + 1;
    if least == 0 || element.count.checked_mul(least).is_none_or(|size| size > room) {
        if element.count == 0 {
            return Ok(());
        }
        return Err(error(
            "PLY",
            format!(
                "the header claims {} rows of {}, more than the {} bytes after it can hold; was the file cut off?",
                element.count,
                element.name,
                rows.remaining()
            ),
        ));
    }
    Ok(())
}

fn read_vertices(element: &Element, rows: &mut Rows, builder: &mut Builder) -> Result<()> {
    let mut axes = [0; 3];
    for (axis, name) in axes.iter_mut().zip(["x", "y", "z"]) {
        *axis = element.position(name, false).ok_or_else(|| {
            error("PLY", format!("the vertices have no property {name}: is this a mesh?"))
        })?;
    }
    if builder.positions.is_empty()
        && let Some(positions) = plain::vertices(element, axes, rows)
    {
        builder.positions = positions;
        return Ok(());
    }
    for row in 0..element.count {
        let mut position = [0.0; 3];
        for (i, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::Scalar(scalar) => {
                    let value = rows.number(scalar).map_err(|e| rows.cut(e, element, row))?;
                    if let Some(axis) = axes.iter().position(|&axis| axis == i) {
                        position[axis] = value;
                    }
                }
                Kind::List { .. } => rows.skip(property).map_err(|e| rows.cut(e, element, row))?,
            }
        }
        rows.end_of_row();
        builder.vertex(position);
    }
    Ok(())
}

fn read_faces(element: &Element, rows: &mut Rows, builder: &mut Builder) -> Result<()> {
    let names = ["vertex_indices", "vertex_index"];
    let Some(indices) = names.iter().find_map(|name| element.position(name, true)) else {
        return Err(error("PLY", "the faces have no list vertex_indices: export the mesh again"));
    };
    if let Some(triangles) = plain::triangles(element, rows) {
        for [a, b, c] in triangles {
            builder.polygon(&[builder.index(a)?, builder.index(b)?, builder.index(c)?])?;
        }
        return Ok(());
    }
    let mut corners = Vec::new();
    for row in 0..element.count {
        for (i, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::List { count, item } if i == indices => {
                    corners.clear();
                    let length = rows.length(count).map_err(|e| rows.cut(e, element, row))?;
                    for _ in 0..length {
                        let index = rows.integer(item).map_err(|e| rows.cut(e, element, row))?;
                        corners.push(builder.index(index)?);
                    }
                }
                _ => rows.skip(property).map_err(|e| rows.cut(e, element, row))?,
            }
        }
        rows.end_of_row();
        builder.polygon(&corners)?;
    }
    Ok(())
}

fn skip(element: &Element, rows: &mut Rows) -> Result<()> {
    for row in 0..element.count {
        for property in &element.properties {
            rows.skip(property).map_err(|e| rows.cut(e, element, row))?;
        }
        rows.end_of_row();
    }
    Ok(())
}

/// What follows the header. `bytes` are those of the whole file, so that a place can be named.
enum Rows<'a> {
    Text(Scanner<'a>),
    Binary { bytes: &'a [u8], pos: usize, big: bool },
}

impl Rows<'_> {
    fn remaining(&self) -> usize {
        match self {
            Rows::Text(scanner) => scanner.remaining(),
            Rows::Binary { bytes, pos, .. } => bytes.len() - pos,
        }
    }

    #[inline]
    fn number(&mut self, scalar: Scalar) -> Result<f64> {
        match self {
            Rows::Text(scanner) => scanner.number(),
            Rows::Binary { bytes, pos, big } => {
                let value = scalar.decode(&bytes[*pos..], *big).ok_or_else(|| end(*pos))?;
                *pos += scalar.size();
                Ok(value)
            }
        }
    }

    #[inline]
    fn integer(&mut self, scalar: Scalar) -> Result<i64> {
        match self {
            Rows::Text(scanner) => scanner.integer(),
            // All indices up to 2^32 are exact in an f64.
            Rows::Binary { .. } => self.number(scalar).map(|value| value as i64),
        }
    }

    /// The length of a list, which the rest of the file has room for.
    fn length(&mut self, count: Scalar) -> Result<usize> {
        let length = self.integer(count)?;
        usize::try_from(length).ok().filter(|&length| length <= self.remaining()).ok_or_else(|| {
            let what = format!("a list of {length} values, more than the file has room for");
            match self {
                Rows::Text(scanner) => scanner.error(what),
                Rows::Binary { pos, .. } => error("PLY", format!("byte {pos}: {what}")),
            }
        })
    }

    fn skip(&mut self, property: &Property) -> Result<()> {
        match property.kind {
            Kind::Scalar(scalar) => self.number(scalar).map(drop),
            Kind::List { count, item } => {
                for _ in 0..self.length(count)? {
                    self.number(item)?;
                }
                Ok(())
            }
        }
    }

    /// In a text a row ends with its line, whatever else stands there.
    fn end_of_row(&mut self) {
        if let Rows::Text(scanner) = self {
            scanner.line();
        }
    }

    /// Adds to an error the row in which it happened.
    fn cut(&self, cause: Error, element: &Element, row: usize) -> Error {
        match cause {
            Error::Format { format, reason } => {
                let place = format!("row {row} of {} {}", element.count, element.name);
                error(format, format!("{reason} ({place})"))
            }
            other => other,
        }
    }
}

fn end(pos: usize) -> Error {
    error("PLY", format!("byte {pos}: the file ends in the middle of a row; was it cut off?"))
}
