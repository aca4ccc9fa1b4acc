//! The header of a PLY: which rows of which numbers follow.

use super::super::error;
use super::super::scan::{Scanner, quoted};
use crate::error::Result;

/// How the rows are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    Ascii,
    Little,
    Big,
}

/// A type of number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// One number, or a counted list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Debug)]
pub struct Property {
    pub name: String,
    pub kind: Kind,
}

#[derive(Debug)]
pub struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

#[derive(Debug)]
pub struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

impl Element {
    /// Where the property of this name is.
    pub fn position(&self, name: &str, list: bool) -> Option<usize> {
        let fits = |kind| matches!(kind, Kind::List { .. }) == list;
        self.properties.iter().position(|property| property.name == name && fits(property.kind))
    }
}

impl Kind {
    /// Bytes that it takes at least, in a binary file.
    pub fn least_size(self) -> usize {
        match self {
            Kind::Scalar(scalar) | Kind::List { count: scalar, .. } => scalar.size(),
        }
    }
}

impl Scalar {
    fn parse(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Scalar::I8,
            b"uchar" | b"uint8" => Scalar::U8,
            b"short" | b"int16" => Scalar::I16,
            b"ushort" | b"uint16" => Scalar::U16,
            b"int" | b"int32" => Scalar::I32,
            b"uint" | b"uint32" => Scalar::U32,
            b"float" | b"float32" => Scalar::F32,
            b"double" | b"float64" => Scalar::F64,
            _ => return None,
        })
    }

    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The number at the start of `bytes`; `None` if they end before.
    #[inline]
    pub fn decode(self, bytes: &[u8], big: bool) -> Option<f64> {
        let mut raw = [0; 8];
        let raw = &mut raw[..self.size()];
        raw.copy_from_slice(bytes.get(..self.size())?);
        if big {
            raw.reverse();
        }
        Some(match (self, &*raw) {
            (Scalar::I8, &[a]) => f64::from(a as i8),
            (Scalar::U8, &[a]) => f64::from(a),
            (Scalar::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Scalar::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (Scalar::I32, &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
            (Scalar::U32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
            (Scalar::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            (_, all) => f64::from_le_bytes(all.try_into().ok()?),
        })
    }
}

/// The header, and a scanner that stands behind it.
pub fn parse(bytes: &[u8]) -> Result<(Header, Scanner<'_>)> {
    let mut scanner = Scanner::new("PLY", bytes);
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    if scanner.word() != Some(b"ply") {
        return Err(scanner.error("the file does not begin with ply"));
    }
    scanner.line();
    loop {
        let Some(word) = scanner.word() else {
            return Err(scanner.error("the header has no end_header"));
        };
        match word {
            b"format" => encoding = Some(parse_encoding(&mut scanner)?),
            b"element" => elements.push(parse_element(&mut scanner)?),
            b"property" => match elements.last_mut() {
                Some(element) => element.properties.push(parse_property(&mut scanner)?),
                None => return Err(scanner.error("a property before the first element")),
            },
            b"comment" | b"obj_info" => {}
            b"end_header" => break,
            word => return Err(scanner.error(format!("{} in the header", quoted(word)))),
        }
        scanner.line();
    }
    // Not a byte more: the first row may begin with a byte that looks like a blank.
    scanner.line();
    let Some(encoding) = encoding else {
        return Err(error("PLY", "the header does not name a format: export the mesh again"));
    };
    Ok((Header { encoding, elements }, scanner))
}

fn parse_encoding(scanner: &mut Scanner) -> Result<Encoding> {
    match scanner.word_on_line() {
        Some(b"ascii") => Ok(Encoding::Ascii),
        Some(b"binary_little_endian") => Ok(Encoding::Little),
        Some(b"binary_big_endian") => Ok(Encoding::Big),
        word => {
            let word = quoted(word.unwrap_or_default());
            Err(scanner.error(format!("{word} is not a format: ascii or binary_*_endian")))
        }
    }
}

fn parse_element(scanner: &mut Scanner) -> Result<Element> {
    let Some(name) = scanner.word_on_line() else {
        return Err(scanner.error("an element without a name"));
    };
    let name = String::from_utf8_lossy(&name[..name.len().min(64)]).into_owned();
    let count = scanner.integer()?;
    let count = usize::try_from(count)
        .map_err(|_| scanner.error(format!("{count} rows of {}", quoted(name.as_bytes()))))?;
    Ok(Element { name, count, properties: Vec::new() })
}

fn parse_property(scanner: &mut Scanner) -> Result<Property> {
    let kind = match scanner.word_on_line() {
        Some(b"list") => {
            let (count, item) = (parse_scalar(scanner)?, parse_scalar(scanner)?);
            if matches!(count, Scalar::F32 | Scalar::F64) {
                return Err(scanner.error("the length of a list cannot be a float"));
            }
            Kind::List { count, item }
        }
        word => Kind::Scalar(scalar(word, scanner)?),
    };
    let name = scanner.word_on_line().unwrap_or_default();
    Ok(Property { name: String::from_utf8_lossy(name).into_owned(), kind })
}

fn parse_scalar(scanner: &mut Scanner) -> Result<Scalar> {
    let word = scanner.word_on_line();
    scalar(word, scanner)
}

fn scalar(word: Option<&[u8]>, scanner: &Scanner) -> Result<Scalar> {
    let word = word.unwrap_or_default();
    Scalar::parse(word).ok_or_else(|| scanner.error(format!("{} is not a type", quoted(word))))
}
