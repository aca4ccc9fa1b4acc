//! One model of a 3MF: its objects, and what is built of them.

use std::collections::BTreeMap;

use nalgebra::Matrix4;
use quick_xml::events::{BytesStart, Event};

use crate::error::Result;
use crate::format::error;
use crate::format::scan::{parse_number, quoted};

/// A mesh, or other objects, or both.
#[derive(Debug, Default)]
pub struct Object {
    pub positions: Vec<[f64; 3]>,
    pub faces: Vec<[u32; 3]>,
    pub components: Vec<Instance>,
}

/// An object and where it goes.
#[derive(Debug, Clone)]
pub struct Instance {
    /// The model that has it, where it is another.
    pub path: Option<String>,
    pub id: String,
    pub matrix: Matrix4<f64>,
}

#[derive(Debug, Default)]
pub struct Model {
    pub unit: String,
    pub objects: BTreeMap<String, Object>,
    pub items: Vec<Instance>,
}

/// Builds a [`Model`] from the events of its XML.
#[derive(Debug, Default)]
pub struct Reader {
    model: Model,
    /// The object that is open, and its identifier.
    object: Option<(String, Object)>,
    /// Extensions have vertices of their own, outside meshes.
    in_mesh: bool,
}

impl Reader {
    pub fn event(&mut self, event: &Event, position: u64) -> Result<()> {
        match event {
            Event::Start(element) => self.start(element, position),
            Event::End(element) => {
                match element.local_name().as_ref() {
                    "object" => self.model.objects.extend(self.object.take()),
                    "mesh" => self.in_mesh = false,
                    _ => {}
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    pub fn finish(self) -> Model {
        self.model
    }

    fn start(&mut self, element: &BytesStart, position: u64) -> Result<()> {
        let name = element.local_name();
        match (name.as_ref(), &mut self.object) {
            ("model", _) => {
                let unit = attribute(element, "unit")?;
                self.model.unit = symbol(unit.as_deref().unwrap_or("millimeter")).into();
            }
            ("object", _) => {
                let id = attribute(element, "id")?.unwrap_or_default();
                self.object = Some((id, Object::default()));
            }
            ("mesh", _) => self.in_mesh = true,
            ("vertex", Some((_, object))) if self.in_mesh => {
                let [x, y, z] = values(element, ["x", "y", "z"], position, parse_number)?;
                object.positions.push([x, y, z]);
            }
            ("triangle", Some((_, object))) if self.in_mesh => {
                let index = |text: &[u8]| std::str::from_utf8(text).ok()?.trim().parse().ok();
                object.faces.push(values(element, ["v1", "v2", "v3"], position, index)?);
            }
            ("component", Some((_, object))) => {
                object.components.push(instance(element, position)?)
            }
            ("item", None) => self.model.items.push(instance(element, position)?),
            _ => {}
        }
        Ok(())
    }
}

/// Three attributes in one walk over all of them: this runs once a vertex and once a triangle.
fn values<T: Copy>(
    element: &BytesStart,
    names: [&str; 3],
    position: u64,
    parse: impl Fn(&[u8]) -> Option<T>,
) -> Result<[T; 3]> {
    let mut found = [None; 3];
    for attribute in element.attributes().with_checks(false) {
        let attribute =
            attribute.map_err(|cause| error("3MF", format!("byte {position}: {cause}")))?;
        if let Some(i) = names.iter().position(|name| attribute.key.as_ref() == *name) {
            let text = attribute.value.as_bytes();
            found[i] = Some(parse(text.trim_ascii()).ok_or_else(|| {
                error("3MF", format!("byte {position}: {}={} is no number", names[i], quoted(text)))
            })?);
        }
    }
    match found {
        [Some(a), Some(b), Some(c)] => Ok([a, b, c]),
        _ => Err(error("3MF", format!("byte {position}: one of {} is missing", names.join(", ")))),
    }
}

fn instance(element: &BytesStart, position: u64) -> Result<Instance> {
    let id = attribute(element, "objectid")?.unwrap_or_default();
    let path = attribute(element, "path")?;
    let matrix = match attribute(element, "transform")? {
        None => Matrix4::identity(),
        Some(text) => transform(&text).ok_or_else(|| {
            let what = format!("byte {position}: a transform needs twelve numbers");
            error("3MF", what)
        })?,
    };
    Ok(Instance { path, id, matrix })
}

/// Four rows of three, for row vectors: read by columns, they are the matrix for column vectors.
fn transform(text: &str) -> Option<Matrix4<f64>> {
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .map(|word| parse_number(word.as_bytes()))
        .collect::<Option<_>>()?;
    (numbers.len() == 12).then(|| {
        Matrix4::from_fn(|row, column| match row {
            3 => f64::from(u8::from(column == 3)),
            _ => numbers[3 * column + row],
        })
    })
}

/// An attribute by its name without prefix.
pub fn attribute(element: &BytesStart, name: &str) -> Result<Option<String>> {
    for attribute in element.attributes().with_checks(false) {
        let attribute =
            attribute.map_err(|cause| error("3MF", format!("bad attribute: {cause}")))?;
        if attribute.key.local_name().as_ref() == name {
            return Ok(Some(attribute.value.into_owned()));
        }
    }
    Ok(None)
}

/// The symbol of a unit that 3MF spells out.
fn symbol(unit: &str) -> &str {
    match unit {
        "micron" => "um",
        "millimeter" => "mm",
        "centimeter" => "cm",
        "inch" => "in",
        "foot" => "ft",
        "meter" => "m",
        other => other,
    }
}
