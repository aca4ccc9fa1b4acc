//! Lines and circles in a plane: what surfaces are that extend in one direction or turn about one axis.

use nalgebra::Vector2;

/// A point or a way in the plane.
pub type Flat = Vector2<f64>;

/// Lines that meet at a lesser sine have no place in common that noise would not move.
const CROSS: f64 = 0.1;

/// A curve whose distances grow out of the part.
#[derive(Debug, Clone, Copy)]
pub enum Curve {
    /// `normal · p = offset`.
    Line { normal: Flat, offset: f64 },
    /// `outward` is +1 where the part is inside of the circle, else -1.
    Circle { center: Flat, radius: f64, outward: f64 },
}

impl Curve {
    /// Signed distance of a point.
    pub fn distance(&self, p: Flat) -> f64 {
        match self {
            Self::Line { normal, offset } => normal.dot(&p) - offset,
            Self::Circle { center, radius, outward } => outward * ((p - center).norm() - radius),
        }
    }

    /// All points at this distance; none where the circle would have vanished.
    pub fn offset(&self, by: f64) -> Option<Self> {
        match *self {
            Self::Line { normal, offset } => Some(Self::Line { normal, offset: offset + by }),
            Self::Circle { center, radius, outward } => {
                let radius = radius + outward * by;
                (radius > 0.0).then_some(Self::Circle { center, radius, outward })
            }
        }
    }

    /// The point of the curve that is nearest.
    pub fn foot(&self, p: Flat) -> Flat {
        match self {
            Self::Line { normal, .. } => p - normal * self.distance(p),
            Self::Circle { center, radius, .. } => center + (p - center).normalize() * *radius,
        }
    }
}

/// Where two curves meet.
pub fn meets(one: &Curve, other: &Curve) -> [Option<Flat>; 2] {
    match (*one, *other) {
        (Curve::Line { normal: n, offset: a }, Curve::Line { normal: m, offset: b }) => {
            let turn = n.perp(&m);
            let at = Flat::new(a * m.y - b * n.y, b * n.x - a * m.x) / turn;
            [(turn.abs() > CROSS).then_some(at), None]
        }
        (Curve::Line { normal, offset }, Curve::Circle { center, radius, .. })
        | (Curve::Circle { center, radius, .. }, Curve::Line { normal, offset }) => {
            beside(center, normal, offset - normal.dot(&center), radius)
        }
        (
            Curve::Circle { center, radius, .. },
            Curve::Circle { center: second, radius: other, .. },
        ) => {
            let way = second - center;
            let far = way.norm();
            let along = (far * far + radius * radius - other * other) / (2.0 * far);
            beside(center, way / far, along, radius)
        }
    }
}

/// The points of a circle at a distance from its centre along a direction; none where there are none.
fn beside(center: Flat, direction: Flat, along: f64, radius: f64) -> [Option<Flat>; 2] {
    let square = radius * radius - along * along;
    if square.is_nan() || square < 0.0 {
        return [None; 2];
    }
    let aside = Flat::new(-direction.y, direction.x) * square.sqrt();
    let middle = center + direction * along;
    [Some(middle + aside), Some(middle - aside)]
}
