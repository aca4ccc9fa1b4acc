//! Profiles: what a region of several swept surfaces is in the plane, cut into the lines and arcs that it is made of.
//!
//! All the way around a shaft its vertices say one thing, so a profile is known far better than any
//! neighbourhood; the best cuts are found by dynamic programming (Bellman 1961).

use std::f64::consts::TAU;

use super::arc::{Arc, Sums};
use super::curve::{Curve, Flat};

/// What parts cost, and how small they may be.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// A degree of freedom, in squared lengths.
    pub freedom: f64,
    /// A part beside its freedom.
    pub part: f64,
    /// Least radius of a circle.
    pub radius: f64,
    /// Least length of a part.
    pub length: f64,
}

/// Lines and arcs, one after the other.
#[derive(Debug, Clone)]
pub struct Profile {
    way: Way,
    /// Where one part ends and the next begins, ascending.
    ends: Vec<f64>,
    /// One more.
    pub curves: Vec<Curve>,
    /// Squared distances of all points, and what the parts cost.
    pub total: f64,
}

/// Places where a profile may be cut, at most.
const PLACES: usize = 24;
/// Points between two of them, and in a part, at least.
const BETWEEN: usize = 4;
const FEWEST: usize = 6;
/// Most parts: what is more is left to the next round.
const PARTS: usize = 3;
/// Least cosine between a part and the way through all of them: noise is wider than a short part is long.
const ALONG: f64 = 0.5;
/// Degrees of freedom.
const LINE: f64 = 2.0;
const CIRCLE: f64 = 3.0;

/// The first places of a profile, cut in the best way.
#[derive(Clone, Copy)]
struct Best {
    total: f64,
    parts: usize,
    /// Where the last part begins, and it.
    from: usize,
    last: Option<Arc>,
}

impl Profile {
    /// The best cut into two parts or three; `None` where no cut leaves parts that are large enough.
    pub fn of(points: &[Flat], limits: &Limits) -> Option<Self> {
        let places = PLACES.min(points.len() / BETWEEN);
        if places < 2 {
            return None;
        }
        let mut all = Sums::default();
        points.iter().for_each(|&p| all.add(p));
        let way = Way::through(&limits.fit(&all), points);
        let mut order: Vec<(f64, Flat)> = points.iter().map(|&p| (way.at(p), p)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let index = |place: usize| place * order.len() / places;
        let mut sums = vec![Sums::default()];
        for place in 0..places {
            let mut next = sums[place];
            order[index(place)..index(place + 1)].iter().for_each(|&(_, p)| next.add(p));
            sums.push(next);
        }
        let mut best = vec![Best { total: 0.0, parts: 0, from: 0, last: None }];
        for to in 1..=places {
            let mut found = Best { total: f64::INFINITY, parts: 0, from: 0, last: None };
            for from in usize::from(to == places)..to {
                let before = best[from];
                let (start, end) = (index(from), index(to));
                if before.parts == PARTS
                    || before.total >= found.total
                    || end - start < FEWEST
                    || way.length(order[start].0, order[end - 1].0) < limits.length
                {
                    continue;
                }
                let arc = limits.fit(&sums[to].less(&sums[from]));
                let total = before.total + arc.cost + limits.price(&arc.curve);
                if total < found.total && arc.along.dot(&way.tangent(arc.middle)).abs() > ALONG {
                    found = Best { total, parts: before.parts + 1, from, last: Some(arc) };
                }
            }
            best.push(found);
        }
        let mut profile =
            Self { way, ends: Vec::new(), curves: Vec::new(), total: best[places].total };
        let mut to = places;
        while to > 0 {
            profile.curves.push(best[to].last?.curve);
            to = best[to].from;
            let end = index(to);
            if to > 0 {
                profile.ends.push((order[end - 1].0 + order[end].0) / 2.0);
            }
        }
        profile.curves.reverse();
        profile.ends.reverse();
        Some(profile)
    }

    /// Which part a point is of.
    pub fn part(&self, p: Flat) -> usize {
        let at = self.way.at(p);
        self.ends.partition_point(|&end| end < at)
    }
}

impl Limits {
    fn fit(&self, sums: &Sums) -> Arc {
        sums.fit(self.freedom * (CIRCLE - LINE), self.radius)
    }

    fn price(&self, curve: &Curve) -> f64 {
        let freedom = if matches!(curve, Curve::Line { .. }) { LINE } else { CIRCLE };
        self.part + self.freedom * freedom
    }
}

/// The way through all parts: what orders their points.
#[derive(Debug, Clone, Copy)]
enum Way {
    Along(Flat),
    /// From an angle on.
    Around {
        center: Flat,
        radius: f64,
        zero: f64,
    },
}

impl Way {
    /// Along the curve through all points; around a circle it begins in the widest gap.
    fn through(whole: &Arc, points: &[Flat]) -> Self {
        let Curve::Circle { center, radius, .. } = whole.curve else {
            return Self::Along(whole.along);
        };
        let around = |zero| Self::Around { center, radius, zero };
        let mut angles: Vec<f64> = points.iter().map(|&p| around(0.0).at(p)).collect();
        angles.sort_by(f64::total_cmp);
        let next = angles.iter().skip(1).copied().chain(angles.first().map(|first| first + TAU));
        let gaps = angles.iter().zip(next).map(|(&angle, next)| (next - angle, angle));
        let widest = gaps.max_by(|a, b| a.0.total_cmp(&b.0));
        around(widest.map_or(0.0, |(gap, angle)| angle + gap / 2.0))
    }

    fn at(&self, p: Flat) -> f64 {
        match self {
            Self::Along(direction) => direction.dot(&p),
            Self::Around { center, zero, .. } => {
                let way = p - center;
                (way.y.atan2(way.x) - zero).rem_euclid(TAU)
            }
        }
    }

    fn length(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Along(_) => to - from,
            Self::Around { radius, .. } => (to - from) * radius,
        }
    }

    fn tangent(&self, p: Flat) -> Flat {
        match self {
            Self::Along(direction) => *direction,
            Self::Around { center, .. } => {
                let way = (p - center).normalize();
                Flat::new(-way.y, way.x)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIGMA: f64 = 0.002;

    fn limits() -> Limits {
        let freedom = 2.0 * 300f64.ln() * SIGMA * SIGMA;
        Limits { freedom, part: 20.0 * SIGMA * SIGMA, radius: 0.01, length: 0.01 }
    }

    /// Points that stray across and along, of no order that a curve could follow.
    fn strewn(curve: impl Fn(f64) -> Flat) -> Vec<Flat> {
        let stray = |i: usize| SIGMA * ((i % 17) as f64 / 5.0 - 1.6);
        (0..300).map(|i| curve(i as f64 / 300.0) + Flat::new(stray(i * 7), stray(i * 11))).collect()
    }

    #[test]
    fn a_chamfer_between_a_face_and_a_shaft_is_found() {
        let corners = [[0.2, 0.1], [0.3, 0.1], [0.33, 0.07], [0.33, -0.05]].map(Flat::from);
        let ends = [0.4, 0.57, 1.0];
        let points = strewn(|t| {
            let part = ends.partition_point(|&end| end < t);
            let from = if part == 0 { 0.0 } else { ends[part - 1] };
            corners[part].lerp(&corners[part + 1], (t - from) / (ends[part] - from))
        });
        let found = Profile::of(&points, &limits()).unwrap();
        assert_eq!(found.curves.len(), 3, "{found:?}");
        let mut parts = [[0.25, 0.1], [0.315, 0.085], [0.33, 0.0]].map(|at| {
            let part = found.part(at.into());
            assert!(found.curves[part].distance(at.into()).abs() < SIGMA);
            part
        });
        parts.sort_unstable();
        assert_eq!(parts, [0, 1, 2]);
    }

    #[test]
    fn a_line_that_runs_into_a_fillet_is_parted_where_it_begins() {
        let points = strewn(|t| {
            let turn = ((t - 0.5) * 3.0).max(0.0);
            Flat::new(0.3 * (t - 0.5).min(0.0), 0.0) + Flat::new(turn.sin(), 1.0 - turn.cos()) * 0.1
        });
        let found = Profile::of(&points, &limits()).unwrap();
        let [Curve::Line { .. }, Curve::Circle { radius, .. }] = found.curves[..] else {
            panic!("{found:?}")
        };
        assert!((radius - 0.1).abs() < 0.005, "{radius}");
    }

    #[test]
    fn one_arc_costs_more_in_parts() {
        let points = strewn(|t| Flat::new((2.0 * t).cos(), (2.0 * t).sin()) * 0.1);
        let mut all = Sums::default();
        points.iter().for_each(|&p| all.add(p));
        let whole = limits().fit(&all);
        assert!(matches!(whole.curve, Curve::Circle { .. }));
        let found = Profile::of(&points, &limits()).unwrap();
        assert!(found.total > whole.cost + limits().price(&whole.curve));
        assert!(Profile::of(&points[..9], &limits()).is_none());
        assert!(Profile::of(&[], &limits()).is_none());
    }
}
