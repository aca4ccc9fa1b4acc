//! GLB: a glTF and its first buffer in one file.

use super::{Loaded, Open, error, gltf};
use crate::error::Result;

pub(super) fn read(bytes: &[u8], open: &mut Open) -> Result<Loaded> {
    if !bytes.starts_with(b"glTF") {
        return Err(error("GLB", "the file does not begin with glTF"));
    }
    match (word(bytes, 4), word(bytes, 8)) {
        (Some(2), Some(length)) if (12..=bytes.len()).contains(&length) => {
            let (json, rest) = chunk(&bytes[12..length], b"JSON")?;
            let binary = if rest.is_empty() { None } else { chunk(rest, b"BIN\0").ok() };
            gltf::read(json, binary.map(|(binary, _)| binary), open)
        }
        (Some(2), Some(length)) => Err(error(
            "GLB",
            format!(
                "the header claims {length} bytes, but there are {}; was the file cut off?",
                bytes.len()
            ),
        )),
        (Some(version), _) => Err(error("GLB", format!("version {version} is not read, only 2"))),
        (None, _) => Err(error("GLB", "the file ends within its header; was it cut off?")),
    }
}

/// The content of the chunk that comes first, and what follows it.
fn chunk<'a>(bytes: &'a [u8], kind: &[u8; 4]) -> Result<(&'a [u8], &'a [u8])> {
    let name = kind[..3].escape_ascii();
    let Some(length) = word(bytes, 0).filter(|_| bytes.get(4..8) == Some(kind)) else {
        return Err(error("GLB", format!("there is no chunk {name}; was the file cut off?")));
    };
    let rest = &bytes[8..];
    rest.split_at_checked(length).ok_or_else(|| {
        let what = format!("chunk {name} claims {length} bytes, but {} are left", rest.len());
        error("GLB", format!("{what}; was the file cut off?"))
    })
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let word = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes(word.try_into().ok()?) as usize)
}
