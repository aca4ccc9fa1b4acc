//! The zip around a 3MF, unpacked as a stream and never beyond a limit.

use std::io::{BufReader, Cursor, Read};

use quick_xml::events::Event;
use zip::ZipArchive;

use super::model::{Model, Reader, attribute};
use crate::error::{Error, Result};
use crate::format::error;

/// Models are text and shrink to a fifth or a tenth; what grows more than this is a bomb.
const RATIO: u64 = 40;
/// And so much is allowed to the smallest file.
const ALLOWANCE: u64 = 16 << 20;

/// The archive, and how much it may still unpack.
pub struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    budget: u64,
}

impl<'a> Package<'a> {
    pub fn open(bytes: &'a [u8]) -> Result<Self> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|cause| {
            error("3MF", format!("not a zip archive ({cause}); was it cut off?"))
        })?;
        Ok(Self { archive, budget: RATIO * bytes.len() as u64 + ALLOWANCE })
    }

    /// The part that the package names as its model, or the first that is called one.
    pub fn root(&mut self) -> Result<String> {
        let mut named = None;
        // A package without relationships is read all the same.
        if self.archive.index_for_name("_rels/.rels").is_some() {
            self.unpack("_rels/.rels", |event, _| {
                let Event::Start(element) = event else { return Ok(()) };
                let kind = attribute(element, "Type")?.unwrap_or_default();
                if element.local_name().as_ref() == "Relationship" && kind.ends_with("/3dmodel") {
                    named = attribute(element, "Target")?;
                }
                Ok(())
            })?;
        }
        let first = || {
            let mut names = self.archive.file_names().filter_map(|name| name.ok());
            names.find(|name| name.to_ascii_lowercase().ends_with(".model")).map(String::from)
        };
        named.or_else(first).ok_or_else(|| error("3MF", "the archive holds no model: is it a 3MF?"))
    }

    /// Reads one model of the package.
    pub fn model(&mut self, path: &str) -> Result<Model> {
        let mut model = Reader::default();
        self.unpack(path, |event, position| model.event(event, position))?;
        Ok(model.finish())
    }

    /// Hands every event of a part to `take`, with how many bytes were unpacked before it.
    fn unpack(
        &mut self,
        path: &str,
        mut take: impl FnMut(&Event, u64) -> Result<()>,
    ) -> Result<()> {
        let shown: String = path.escape_debug().take(60).collect();
        let file = self.archive.by_name(path.trim_start_matches('/')).map_err(|cause| {
            error("3MF", format!("{shown} cannot be unpacked ({cause}); was the file cut off?"))
        })?;
        let budget = self.budget;
        if file.size() > budget {
            return Err(bomb(&shown, budget));
        }
        let stream = BufReader::with_capacity(1 << 16, file.take(budget + 1));
        let mut reader = quick_xml::Reader::from_reader(stream);
        reader.config_mut().expand_empty_elements = true;
        let mut buffer = Vec::new();
        let mut depth = 0_i64;
        loop {
            buffer.clear();
            let event = reader.read_event_into(&mut buffer);
            let left = reader.get_ref().get_ref().limit();
            let position = reader.buffer_position();
            let cut = |cause: String| {
                error("3MF", format!("byte {position} of {shown}: {cause}; was the file cut off?"))
            };
            if left == 0 {
                return Err(bomb(&shown, budget));
            }
            let event = event.map_err(|cause| cut(cause.to_string()))?;
            match event {
                Event::Start(_) => depth += 1,
                Event::End(_) => depth -= 1,
                Event::Eof if depth > 0 => return Err(cut("the end within an element".into())),
                Event::Eof => {
                    self.budget = left.min(budget);
                    return Ok(());
                }
                _ => {}
            }
            take(&event, position)?;
        }
    }
}

fn bomb(path: &str, budget: u64) -> Error {
    error(
        "3MF",
        format!("{path} unpacks to more than {} MB, out of proportion: refused", budget >> 20),
    )
}
