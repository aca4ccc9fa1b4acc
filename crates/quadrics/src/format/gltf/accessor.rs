//! Numbers out of a glTF's buffers, every slice checked.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::document::{Accessor, Document};
use super::lookup;
use crate::error::Result;
use crate::format::{Open, error};

/// The buffers and how they are cut.
pub struct Buffers<'a> {
    document: &'a Document,
    content: Vec<Rc<[u8]>>,
    /// Bytes in all of them, those that are one file counted once.
    pub size: usize,
}

impl<'a> Buffers<'a> {
    pub fn open(document: &'a Document, binary: Option<&'a [u8]>, open: &mut Open) -> Result<Self> {
        let mut content: Vec<Rc<[u8]>> = Vec::new();
        // A thousand buffers may name one file, which is fetched once.
        let mut fetched = BTreeMap::new();
        for (index, buffer) in document.buffers.iter().enumerate() {
            let bytes: Rc<[u8]> = match (&buffer.uri, binary) {
                (Some(uri), _) => match fetched.get(uri) {
                    Some(bytes) => Rc::clone(bytes),
                    None => fetch(uri, open)?.into(),
                },
                (None, Some(binary)) if index == 0 => binary.into(),
                _ => return Err(error("glTF", format!("buffer {index} is missing"))),
            };
            if bytes.len() < buffer.byte_length {
                let (claimed, held) = (buffer.byte_length, bytes.len());
                let what = format!("buffer {index} claims {claimed} bytes, but holds {held}");
                return Err(error("glTF", format!("{what}; was the file cut off?")));
            }
            if let Some(uri) = &buffer.uri {
                fetched.insert(uri, Rc::clone(&bytes));
            }
            content.push(bytes);
        }
        let inside = binary.map_or(0, <[u8]>::len);
        let size = inside + fetched.values().map(|bytes| bytes.len()).sum::<usize>();
        Ok(Self { document, content, size })
    }

    /// Positions; of integers too, as quantised files have them.
    pub fn positions(&self, accessor: usize) -> Result<Vec<[f64; 3]>> {
        let (rows, accessor) = self.rows(accessor, "VEC3")?;
        let (kind, normalized) = (accessor.component_type, accessor.normalized);
        let size = component_size(kind).unwrap_or(1);
        let position = |row: &[u8]| [0, 1, 2].map(|i| number(kind, normalized, &row[i * size..]));
        Ok(rows.map(position).collect())
    }

    pub fn indices(&self, accessor: usize) -> Result<Vec<u32>> {
        let (rows, accessor) = self.rows(accessor, "SCALAR")?;
        if !matches!(accessor.component_type, 5121 | 5123 | 5125) {
            let kind = accessor.component_type;
            return Err(error("glTF", format!("indices of component type {kind}")));
        }
        Ok(rows.map(|row| number(accessor.component_type, false, row) as u32).collect())
    }

    /// The elements of an accessor, as many as it claims and all inside their view.
    fn rows(&self, index: usize, shape: &str) -> Result<(impl Iterator<Item = &[u8]>, &Accessor)> {
        let accessor = lookup(&self.document.accessors, index, "accessor")?;
        let wrong = |what: String| error("glTF", format!("accessor {index}: {what}"));
        if accessor.shape != shape {
            return Err(wrong(format!("it is a {:.16}, not a {shape}", accessor.shape)));
        }
        if accessor.sparse.is_some() {
            return Err(wrong("sparse accessors are not read: export without them".into()));
        }
        let component = component_size(accessor.component_type)
            .ok_or_else(|| wrong(format!("component type {}", accessor.component_type)))?;
        let size = component * if shape == "VEC3" { 3 } else { 1 };
        let Some(view) = accessor.buffer_view else {
            return Err(wrong("it has no data: is the mesh compressed? Export without".into()));
        };
        let view = lookup(&self.document.buffer_views, view, "bufferView")?;
        let buffer = lookup(&self.content, view.buffer, "buffer")?;
        let stride = view.byte_stride.unwrap_or(size);
        if stride < size {
            return Err(wrong(format!("its elements of {size} bytes overlap")));
        }
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| buffer.get(view.byte_offset..end));
        let bytes = bytes.and_then(|bytes| bytes.get(accessor.byte_offset..));
        let needed = accessor.count.checked_sub(1).map_or(Some(0), |steps| {
            steps.checked_mul(stride).and_then(|length| length.checked_add(size))
        });
        match (bytes, needed) {
            (Some(bytes), Some(needed)) if needed <= bytes.len() => {
                Ok((bytes[..needed].chunks(stride), accessor))
            }
            _ => {
                let what = format!("{} elements, more than its buffer holds", accessor.count);
                Err(wrong(format!("{what}; was the file cut off?")))
            }
        }
    }
}

fn component_size(kind: u32) -> Option<usize> {
    match kind {
        5120 | 5121 => Some(1),
        5122 | 5123 => Some(2),
        5125 | 5126 => Some(4),
        _ => None,
    }
}

/// The number at the start of `bytes`, which are long enough.
fn number(kind: u32, normalized: bool, bytes: &[u8]) -> f64 {
    let two = || [bytes[0], bytes[1]];
    let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    let (value, unit) = match kind {
        5120 => (f64::from(bytes[0] as i8), 127.0),
        5121 => (f64::from(bytes[0]), 255.0),
        5122 => (f64::from(i16::from_le_bytes(two())), 32767.0),
        5123 => (f64::from(u16::from_le_bytes(two())), 65535.0),
        5125 => (f64::from(u32::from_le_bytes(four())), 1.0),
        _ => (f64::from(f32::from_le_bytes(four())), 1.0),
    };
    if normalized { (value / unit).max(-1.0) } else { value }
}

/// What a URI stands for: data of its own, or a file beside this one.
fn fetch(uri: &str, open: &mut Open) -> Result<Vec<u8>> {
    if let Some(data) = uri.strip_prefix("data:") {
        let decoded = data.split_once(";base64,").and_then(|(_, text)| base64(text.as_bytes()));
        return decoded.ok_or_else(|| error("glTF", "a data URI is not proper base64"));
    }
    let name = percent_decoded(uri);
    let shown: String = name.escape_debug().take(60).collect();
    let inside = |name: &str| {
        !name.contains([':', '\\', '\0'])
            && name.split('/').all(|step| !step.is_empty() && step != "..")
    };
    if !inside(&name) {
        return Err(error(
            "glTF",
            format!("refers to {shown}, which is not in its folder: refused"),
        ));
    }
    let missing =
        || error("glTF", format!("refers to {shown}, which cannot be read: put it beside"));
    open(&name).ok_or_else(missing)
}

fn percent_decoded(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = tail.get(..2).and_then(|hex| std::str::from_utf8(hex).ok());
        match code.and_then(|hex| u8::from_str_radix(hex, 16).ok()).filter(|_| *first == b'%') {
            Some(byte) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            None => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let text = text.trim_ascii();
    let text = text.strip_suffix(b"==").or(text.strip_suffix(b"=")).unwrap_or(text);
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    for group in text.chunks(4) {
        let mut bits = 0u32;
        for i in 0..4 {
            let value = match group.get(i) {
                Some(letter @ b'A'..=b'Z') => letter - b'A',
                Some(letter @ b'a'..=b'z') => letter - b'a' + 26,
                Some(digit @ b'0'..=b'9') => digit - b'0' + 52,
                Some(b'+' | b'-') => 62,
                Some(b'/' | b'_') => 63,
                Some(_) => return None,
                None => 0,
            };
            bits = bits << 6 | u32::from(value);
        }
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len().max(1)]);
    }
    Some(bytes)
}
