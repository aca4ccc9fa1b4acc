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

/// Names that [`part`] knows. `plate:N` is a plate of N bores, so of N + 6 regions.
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
/// [`Error::Option`] if there is no such part, or if its surfaces need more faces than that.
pub fn part(name: &str, faces: usize) -> Result<Part> {
    let make = recipe(name)?;
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
    let need = part.mesh.faces.len();
    Err(Error::Option(format!("{faces} faces are too few for the part '{name}': ask for {need}")))
}

type Recipe = Box<dyn Fn(&mut Builder)>;

fn recipe(name: &str) -> Result<Recipe> {
    Ok(match name {
        "demo" => Box::new(catalogue::demo),
        "shaft" => Box::new(catalogue::shaft),
        "draft" => Box::new(catalogue::draft),
        "quadrics" => Box::new(catalogue::quadrics),
        "open" => Box::new(catalogue::open),
        "plate" => Box::new(|part| catalogue::plate(part, 24)),
        _ => match name.strip_prefix("plate:").map(str::parse) {
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
