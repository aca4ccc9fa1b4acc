//! Rows of a binary PLY that all have one size, as nearly all programs write them: read all at once.
//!
//! `None`, and nothing consumed, where they have not, or the file ends too early: then they are read
//! one by one, and an error is told with its place.

use rayon::prelude::*;

use super::Rows;
use super::header::{Element, Kind, Scalar};
use crate::math::Point;

/// Positions; `axes` are the places of x, y and z among the properties.
pub(super) fn vertices(element: &Element, axes: [usize; 3], rows: &mut Rows) -> Option<Vec<Point>> {
    let mut size = 0;
    let mut columns = Vec::with_capacity(element.properties.len());
    for property in &element.properties {
        let Kind::Scalar(scalar) = property.kind else { return None };
        columns.push((size, scalar));
        size += scalar.size();
    }
    let Rows::Binary { bytes, pos, big } = rows else { return None };
    let body = bytes.get(*pos..)?.get(..element.count.checked_mul(size)?)?;
    let number = |row: &[u8], axis: usize| {
        let (at, scalar) = columns[axis];
        // Adding zero turns -0.0 into 0.0.
        scalar.decode(&row[at..], *big).unwrap_or(f64::NAN) + 0.0
    };
    let position = |row: &[u8]| Point::from(axes.map(|axis| number(row, axis)));
    let positions = body.par_chunks_exact(size).map(position).collect();
    *pos += body.len();
    Some(positions)
}

/// Corners of faces that are all triangles and have no other property.
pub(super) fn triangles(element: &Element, rows: &mut Rows) -> Option<Vec<[i64; 3]>> {
    let Kind::List { count, item } = element.properties.first()?.kind else { return None };
    let Rows::Binary { bytes, pos, big } = rows else { return None };
    if element.properties.len() > 1
        || count.size() > 1
        || !matches!(item, Scalar::I32 | Scalar::U32)
    {
        return None;
    }
    let size = 1 + 3 * item.size();
    let body = bytes.get(*pos..)?.get(..element.count.checked_mul(size)?)?;
    if !body.par_chunks_exact(size).all(|row| row[0] == 3) {
        return None;
    }
    let corner = |row: &[u8], i: usize| {
        // All indices up to 2^32 are exact in an f64.
        item.decode(&row[1 + i * item.size()..], *big).map_or(-1, |index| index as i64)
    };
    let corners = body.par_chunks_exact(size).map(|row| [0, 1, 2].map(|i| corner(row, i)));
    let corners = corners.collect();
    *pos += body.len();
    Some(corners)
}
