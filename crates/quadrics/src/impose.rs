//! Constraints between the regions of a result: from regions to the surfaces that
//! [`crate::constrain`] sees, and back.

use crate::constrain::{self, Constrained, Demands, Fixed, Gate, Grid, KINDS, Link, Value};
use crate::describe::Recognised;
use crate::error::{Error, Result};
use crate::math::{Point, Similarity, Unit, Vector};
use crate::result::{Dimension, Parameter, Relation};
use crate::surface::{Condensed, Surface};

/// Moves the surfaces of the regions until their relations hold; relations and dimensions, in the
/// frame that `out` leads to, which is that of `demands` too.
///
/// # Errors
/// [`Error::Option`] with the first demand that does not fit the regions.
pub fn impose(
    fits: &mut [Recognised],
    neighbours: &[Vec<u32>],
    demands: &Demands,
    out: &Similarity,
) -> Result<(Vec<Relation>, Vec<Dimension>)> {
    let (mut at, mut items) = condensed(fits);
    let mut found = solved(fits, &at, &items, neighbours, demands, out)?;
    let stays =
        |(&i, surface): (&usize, &Surface)| demands.mention(i) || !is_torn(&fits[i], surface);
    let stay: Vec<bool> = at.iter().zip(&found.surfaces).map(stays).collect();
    if stay.contains(&false) {
        let pairs = at.into_iter().zip(items).zip(stay);
        (at, items) = pairs.filter(|(_, stays)| *stays).map(|(pair, _)| pair).unzip();
        found = solved(fits, &at, &items, neighbours, demands, out)?;
    }
    let Constrained { surfaces, links, dimensions, scatters } = found;
    at.iter().zip(surfaces).for_each(|(&i, surface)| fits[i].surface = surface);
    at.iter().zip(scatters).for_each(|(&i, scatter)| fits[i].scatter = Some(scatter));
    let regions = |surfaces: &[usize]| surfaces.iter().map(|&s| at[s] as u32).collect();
    let dimensions = dimensions.into_iter().map(|known| {
        let scale = if known.angular() { 1f64.to_degrees() } else { out.scaling() };
        Dimension {
            kind: known.kind,
            regions: regions(&known.surfaces),
            value: known.value * scale,
            uncertainty: known.sigma * scale,
            rounded: known.rounded,
        }
    });
    let relation = |link: Link| {
        let scale = if link.angular { 1.0 } else { out.scaling() };
        Relation {
            kind: link.kind,
            regions: regions(&link.surfaces),
            status: link.status,
            value: link
                .value
                .map(|value| value * if link.kind == "equal_angle" { 1.0 } else { out.scaling() }),
            parameters: outward(&link.parameters, out),
            residual_before: link.before * scale,
            residual_after: link.after * scale,
            residual_unit: if link.angular { "deg" } else { "length" },
            reason: link.reason,
        }
    };
    Ok((links.into_iter().map(relation).collect(), dimensions.collect()))
}

/// The relations between the regions that take part, in the unit cube.
fn solved(
    fits: &[Recognised],
    at: &[usize],
    items: &[Condensed],
    neighbours: &[Vec<u32>],
    demands: &Demands,
    out: &Similarity,
) -> Result<Constrained> {
    let demands = Places { at, fits }.inward(demands, out)?;
    let place = |region: &u32| at.binary_search(&(*region as usize)).ok();
    let beside: Vec<Vec<usize>> =
        at.iter().map(|&i| neighbours[i].iter().filter_map(place).collect()).collect();
    constrain::constrain(items, &beside, &demands)
        .map_err(|text| Error::Option(format!("constraints: {}", renamed(&text, at))))
}

/// A surface lies off its own points by more standard deviations than relations may cost: its form
/// speaks for a neighbourhood, and it was moved out of that (of 900 results on 23 shapes in four
/// variants two lie off by more, by 6 and by 1,800; the form of a patch of 49 faces let a torus turn by 13°).
const TORN: f64 = 3.0;

/// Whether relations have moved a surface off its points.
fn is_torn(fit: &Recognised, surface: &Surface) -> bool {
    let squared = |p: &Point| surface.distance(*p).map_or(0.0, |d| d * d);
    let mean = fit.support.iter().map(squared).sum::<f64>() / fit.support.len() as f64;
    mean > (TORN * fit.sigma).powi(2)
}

/// The surfaces of regions that still change, moved until what is equal among them is.
pub fn equalised(fits: &[Recognised]) -> Vec<Surface> {
    moved(fits, constrain::equalise)
}

/// The same for directions and axes alone.
pub fn aligned(fits: &[Recognised]) -> Vec<Surface> {
    moved(fits, constrain::align)
}

fn moved(fits: &[Recognised], by: fn(&[Condensed]) -> Vec<Surface>) -> Vec<Surface> {
    let (at, items) = condensed(fits);
    let mut surfaces: Vec<Surface> = fits.iter().map(|fit| fit.surface.clone()).collect();
    at.iter().zip(by(&items)).for_each(|(&i, new)| surfaces[i] = new);
    surfaces
}

/// The regions that can take part, and their surfaces.
fn condensed(fits: &[Recognised]) -> (Vec<usize>, Vec<Condensed>) {
    let known = |(i, fit): (usize, &Recognised)| {
        let condensed = match &fit.waves {
            Some(waves) => Condensed::under(&fit.surface, &fit.support, waves),
            None => Condensed::new(&fit.surface, &fit.support, fit.sigma),
        };
        Some((i, condensed?))
    };
    fits.iter().enumerate().filter_map(known).unzip()
}

/// Positions in braces become regions.
fn renamed(text: &str, at: &[usize]) -> String {
    let mut parts = text.split(['{', '}']);
    let mut words = parts.next().unwrap_or_default().to_owned();
    while let (Some(number), Some(rest)) = (parts.next(), parts.next()) {
        let region = number.parse().ok().and_then(|i: usize| at.get(i));
        words.push_str(&region.map_or_else(|| number.to_owned(), usize::to_string));
        words.push_str(rest);
    }
    words
}

fn outward(known: &[(&'static str, Value)], out: &Similarity) -> Vec<(&'static str, Parameter)> {
    let mut turned: Option<Unit> = None;
    let mut each = |&(name, value): &(&'static str, Value)| {
        let value = match value {
            Value::Count(count) => Parameter::Count(count),
            Value::Length(length) => Parameter::Length(length * out.scaling()),
            Value::Point(point) => Parameter::Vector((out * point).coords.into()),
            Value::Direction(direction) => {
                let direction = out.isometry.rotation * direction;
                turned = Some(direction);
                Parameter::Vector(direction.into_inner().into())
            }
            Value::Offset(offset) => {
                let shift =
                    turned.map_or(0.0, |normal| normal.dot(&out.isometry.translation.vector));
                Parameter::Length(offset * out.scaling() + shift)
            }
        };
        (name, value)
    };
    known.iter().map(&mut each).collect()
}

/// Which regions take part, and what they are.
struct Places<'a> {
    at: &'a [usize],
    fits: &'a [Recognised],
}

impl Places<'_> {
    /// Demands about regions as demands about positions, in the unit cube.
    fn inward(&self, demands: &Demands, out: &Similarity) -> Result<Demands> {
        let scale = out.scaling();
        let mut inside = demands.clone();
        for (number, demand) in inside.relations.iter_mut().enumerate() {
            let what = format!("relation {number} ({})", demand.kind);
            if !KINDS.contains(&demand.kind.as_str()) {
                let kinds = KINDS.join(", ");
                let text = format!(
                    "constraints: relation {number}: no kind {:?}: choose {kinds}",
                    demand.kind
                );
                return Err(Error::Option(text));
            }
            for region in &mut demand.regions {
                *region = self.place(*region, &what)?;
            }
        }
        for (number, fixed) in inside.fixed.iter_mut().enumerate() {
            let what = format!("fix {number} ({})", fixed.parameter);
            fixed.region = self.place(fixed.region, &what)?;
            fixed.value = moved_in(fixed, out, &what)?;
        }
        let short = |length: Option<f64>| length.map(|length| length / scale);
        inside.gate = Gate { length: short(demands.gate.length), ..demands.gate };
        inside.grid = Grid { length: short(demands.grid.length), ..demands.grid };
        Ok(inside)
    }

    fn place(&self, region: usize, what: &str) -> Result<usize> {
        let count = self.fits.len();
        if region >= count {
            let last = count.saturating_sub(1);
            let text = format!("constraints: {what}: no region {region}: they are 0 to {last}");
            return Err(Error::Option(text));
        }
        self.at.binary_search(&region).map_err(|_| {
            let name = self.fits[region].surface.class_name(1.0);
            let text =
                format!("constraints: {what}: region {region} ({name}) takes no part in relations");
            Error::Option(text)
        })
    }
}

/// A fixed value in the unit cube.
fn moved_in(fixed: &Fixed, out: &Similarity, what: &str) -> Result<Vec<f64>> {
    let wrong = |wanted: &str| Err(Error::Option(format!("constraints: {what}: give {wanted}")));
    let vector = ["axis", "normal", "center", "point"].contains(&fixed.parameter.as_str());
    if !vector && fixed.size().is_none() {
        return wrong(
            "radius, major_radius, minor_radius, half_angle_deg, offset, axis, normal, center or point",
        );
    }
    if fixed.value.len() != if vector { 3 } else { 1 } || !fixed.value.iter().all(|v| v.is_finite())
    {
        return wrong(if vector { "three numbers" } else { "one number" });
    }
    if vector {
        let given = Vector::from_row_slice(&fixed.value);
        if ["center", "point"].contains(&fixed.parameter.as_str()) {
            let point = out.inverse() * Point::from(given);
            return Ok(point.coords.as_slice().to_vec());
        }
        if given.norm() == 0.0 {
            return wrong("a direction, not zero");
        }
        let turned = out.isometry.rotation.inverse() * given;
        return Ok(turned.as_slice().to_vec());
    }
    let value = fixed.value[0];
    match fixed.parameter.as_str() {
        "half_angle_deg" if !(0.0..90.0).contains(&value) => wrong("an angle between 0 and 90"),
        "half_angle_deg" => Ok(vec![value.to_radians()]),
        "offset" => Ok(vec![value]),
        _ if value <= 0.0 => wrong("a length above 0"),
        _ => Ok(vec![value / out.scaling()]),
    }
}
