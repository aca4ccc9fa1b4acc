//! Mechanical parts assembled from analytic surfaces, with the region of every face known.

use super::build::Builder;
use super::catalogue;
use crate::error::{Error, Result};
use crate::math::Similarity;
use crate::mesh::{Geometry, Mesh};
use crate::surface::Surface;

/// A mesh of which everything is known.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Part {
    /// Welded and oriented outward; lengths are in millimetres.
    pub mesh: Mesh,
    /// The region of every face, counted from 0; every region is connected.
    pub labels: Vec<u32>,
    /// The surface of every region. A plane's normal points outward.
    pub surfaces: Vec<Surface>,
}

impl Part {
    /// The same part in another frame and unit.
    pub fn transformed(&self, by: &Similarity) -> Self {
        let positions = self.mesh.positions.iter().map(|point| by * point).collect();
        let surfaces = self.surfaces.iter().map(|surface| surface.transformed(by)).collect();
        let mesh = Mesh { positions, faces: self.mesh.faces.clone() };
        Self { mesh, labels: self.labels.clone(), surfaces }
    }
}

/// How much more or fewer faces than asked for a part may have.
const TOLERANCE: f64 = 1.5;

/// Near enough to stop looking for the spacing.
const CLOSE: f64 = 1.1;

/// Edge length of the first trial, in millimetres; parts are about 100 mm long.
const TRIAL_SPACING: f64 = 4.0;

/// Trials until a part has the number of faces asked for.
const TRIALS: usize = 8;

/// More faces than this have more half-edges than 32 bits can number.
const MOST_FACES: usize = (u32::MAX / 3) as usize;

/// Faces that a bore takes at least: its own, and as many around it.
const FACES_OF_BORE: usize = 48;

/// Names that [`part`] knows.
///
/// | name | is | regions |
/// | --- | --- | --- |
/// | `demo` | a bearing housing on a bolted base: every typed surface | 82 |
/// | `shaft` | a stepped shaft with groove, fillet, taper and ball end | 15 |
/// | `plate` | a plate of 24 bores; `plate:N` has N of them and N + 6 regions | 30 |
/// | `draft` | a cast block: drafted sides, rounded edges, a pocket with a pin | 29 |
/// | `quadrics` | all nine general quadrics: saddle, hyperboloids, elliptic cone ... | 14 |
/// | `open` | a pressed cup: one skin with borders | 11 |
pub fn names() -> &'static [&'static str] {
    &["demo", "shaft", "plate", "draft", "quadrics", "open"]
}

/// The part of that name with about `faces` faces, nearly equilateral and of one size.
///
/// ```
/// let part = quadrics::synth::part("shaft", 5_000)?;
/// assert_eq!(part.labels.len(), part.mesh.faces.len());
/// # Ok::<(), quadrics::Error>(())
/// ```
///
/// # Errors
/// [`Error::Option`] if there is no such part, if its surfaces need more faces than that, or if
/// indices of 32 bits cannot number so many.
pub fn part(name: &str, faces: usize) -> Result<Part> {
    if faces > MOST_FACES {
        return Err(Error::Option(format!("{faces} faces are too many: {MOST_FACES} is the most")));
    }
    let make = recipe(name, faces)?;
    let target = faces.max(1) as f64;
    let mut spacing = TRIAL_SPACING;
    let mut part = build(&make, spacing);
    // Faces of one size: their area follows from their number.
    let area: f64 = Geometry::new(&part.mesh).areas.iter().sum();
    let even = (area / target * 4.0 / 3f64.sqrt()).sqrt();
    for trial in 0..TRIALS {
        let ratio = part.mesh.faces.len() as f64 / target;
        if (1.0 / CLOSE..CLOSE).contains(&ratio) {
            break;
        }
        spacing = if trial == 0 { even } else { spacing * ratio.sqrt() };
        part = build(&make, spacing);
    }
    let ratio = part.mesh.faces.len() as f64 / target;
    if (1.0 / TOLERANCE..TOLERANCE).contains(&ratio) {
        return Ok(part);
    }
    Err(too_few(name, faces, part.mesh.faces.len()))
}

fn too_few(name: &str, faces: usize, need: usize) -> Error {
    Error::Option(format!("{faces} faces are too few for the part '{name}': ask for {need}"))
}

type Recipe = Box<dyn Fn(&mut Builder)>;

fn recipe(name: &str, faces: usize) -> Result<Recipe> {
    Ok(match name {
        "demo" => Box::new(catalogue::demo),
        "shaft" => Box::new(catalogue::shaft),
        "draft" => Box::new(catalogue::draft),
        "quadrics" => Box::new(catalogue::quadrics),
        "open" => Box::new(catalogue::open),
        "plate" => Box::new(|part| catalogue::plate(part, 24)),
        _ => match name.strip_prefix("plate:").map(str::parse::<usize>) {
            Some(Ok(bores)) if bores > faces / FACES_OF_BORE => {
                let need = bores.saturating_mul(FACES_OF_BORE);
                return Err(too_few(name, faces, need));
            }
            Some(Ok(bores)) => Box::new(move |part| catalogue::plate(part, bores)),
            _ => {
                let known = names().join(", ");
                let text = format!("no part is called '{name}': there are {known}, plate:BORES");
                return Err(Error::Option(text));
            }
        },
    })
}

fn build(make: &Recipe, spacing: f64) -> Part {
    let mut builder = Builder::new(spacing);
    make(&mut builder);
    builder.part()
}
