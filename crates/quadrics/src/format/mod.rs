//! Bytes to meshes and back, one file a format.
//!
//! The core knows no file system: who calls brings the bytes, and answers where a file refers to
//! another. Lengths stay as the file has them. Whatever the bytes are, the answer is a mesh or one
//! line that says what is wrong; memory is taken for what the file holds, not for what it claims.

mod build;
mod glb;
mod gltf;
mod obj;
mod off;
mod ply;
mod scan;
mod sniff;
mod stl;
mod threemf;
mod write;

pub use write::{write, write_segmentation};

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::result::Repair;
use sniff::{Format, format_of};

/// The formats that can be read, as the user may be told.
pub const READABLE: &str = "STL, PLY, OBJ, OFF, glTF/GLB or 3MF";

/// Answers with the content of a file that the one being read refers to, if it may be read.
pub type Open<'a> = dyn FnMut(&str) -> Option<Vec<u8>> + 'a;

/// What a file holds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Loaded {
    /// Its faces, polygons cut into fans, in the order of the file.
    pub mesh: Mesh,
    /// Which triangle is a piece of which face of the file.
    pub input_faces: InputFaces,
    /// The unit of length that the file names or its format prescribes: `m`, `mm`, `in`, ...
    pub units: Option<String>,
    /// What was odd about the file and was read all the same.
    pub repairs: Vec<Repair>,
}

/// How triangles and the faces of the file hang together. Every face of the file has a triangle, if
/// need be one without area.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct InputFaces {
    /// The face of the file that a triangle is a piece of; ascending.
    pub of_triangle: Vec<u32>,
    /// How many faces the file has.
    pub count: usize,
}

impl InputFaces {
    /// Labels of the file's faces from those of its triangles: of each face the label of most area, and
    /// the least of several such.
    pub fn labels(&self, of_triangle: &[u32], areas: &[f64]) -> Vec<u32> {
        let mut labels = Vec::with_capacity(self.count);
        let mut first = 0;
        let mut pieces = Vec::new();
        for same in self.of_triangle.chunk_by(|one, other| one == other) {
            pieces.clear();
            pieces.extend((first..first + same.len()).map(|t| (of_triangle[t], areas[t])));
            pieces.sort_by_key(|piece| piece.0);
            let area = |label: &[(u32, f64)]| label.iter().map(|piece| piece.1).sum::<f64>();
            let per_label = pieces.chunk_by(|one, other| one.0 == other.0);
            let most =
                per_label.reduce(|best, next| if area(next) > area(best) { next } else { best });
            labels.extend(most.map(|pieces| pieces[0].0));
            first += same.len();
        }
        labels
    }
}

/// Reads a mesh. `extension` is that of the file's name, in any case and without the dot; where the
/// content says plainly that it is another format, the content is believed.
///
/// `open` is asked for the files that this one names (buffers of a glTF).
///
/// # Errors
/// [`Error::Format`] with the place, or [`Error::IndexOutOfRange`]. Whether the mesh is of use is for
/// [`crate::mesh::validate`] to say.
pub fn read(extension: &str, bytes: &[u8], open: &mut Open) -> Result<Loaded> {
    match format_of(&extension.to_ascii_lowercase(), bytes)? {
        Format::Stl => stl::read(bytes),
        Format::Ply => ply::read(bytes),
        Format::Obj => obj::read(bytes),
        Format::Off => off::read(bytes),
        Format::Glb => glb::read(bytes, open),
        Format::Gltf => gltf::read(bytes, None, open),
        Format::ThreeMf => threemf::read(bytes),
    }
}

/// An [`Error::Format`] on one line, even where it quotes the file: a terminal obeys control characters.
fn error(format: &'static str, reason: impl AsRef<str>) -> Error {
    let plain = |letter: char| if letter.is_control() { '?' } else { letter };
    Error::Format { format, reason: reason.as_ref().chars().take(300).map(plain).collect() }
}
