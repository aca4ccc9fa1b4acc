//! How well the unknowns are known: the covariance of any function of them.

use nalgebra::{DMatrix, DVector};

/// One surface's part: its own unknowns, given the shared ones.
pub struct Own {
    /// Numbers of its own unknowns.
    pub unknowns: Vec<usize>,
    /// Places of the shared ones that it depends on.
    pub shared: Vec<usize>,
    /// Covariance of its own unknowns when the shared ones are held.
    pub inverse: DMatrix<f64>,
    /// `inverse * H_own,shared`.
    pub gain: DMatrix<f64>,
}

/// Covariance of any linear function of the unknowns.
pub struct Spread {
    /// Position of a shared unknown among the shared ones, or the surface that owns it.
    pub place: Vec<Place>,
    /// One for every surface.
    pub owns: Vec<Own>,
    /// Covariance of the shared unknowns, under the equations.
    pub shared: DMatrix<f64>,
}

/// Where an unknown stands.
#[derive(Clone, Copy, PartialEq)]
pub enum Place {
    /// Among the shared ones.
    Shared(usize),
    /// Among a surface's own ones: surface and place.
    Own(usize, usize),
    /// Nowhere: nothing depends on it.
    Unused,
}

impl Spread {
    /// Covariance of linear functions, each a list of unknowns and factors.
    pub fn of(&self, functions: &[Vec<(usize, f64)>]) -> DMatrix<f64> {
        let parts: Vec<_> = functions.iter().map(|f| self.split(f)).collect();
        DMatrix::from_fn(functions.len(), functions.len(), |a, b| {
            let (one, other) = (&parts[a], &parts[b]);
            let mut sum = 0.0;
            for &(i, x) in &one.0 {
                for &(j, y) in &other.0 {
                    sum += x * y * self.shared[(i, j)];
                }
            }
            for (i, x) in &one.1 {
                for (_, y) in other.1.iter().filter(|(j, _)| j == i) {
                    sum += x.dot(&(&self.owns[*i].inverse * y));
                }
            }
            sum
        })
    }

    /// A function's part in the shared unknowns, own ones replaced, and in each surface's own.
    #[allow(clippy::type_complexity)]
    fn split(&self, function: &[(usize, f64)]) -> (Vec<(usize, f64)>, Vec<(usize, DVector<f64>)>) {
        let mut shared: Vec<(usize, f64)> = Vec::new();
        let mut own: Vec<(usize, DVector<f64>)> = Vec::new();
        for &(unknown, factor) in function {
            match self.place[unknown] {
                Place::Shared(at) => shared.push((at, factor)),
                Place::Unused => {}
                Place::Own(i, at) => {
                    if own.iter().all(|(k, _)| *k != i) {
                        own.push((i, DVector::zeros(self.owns[i].unknowns.len())));
                    }
                    own.iter_mut().filter(|(k, _)| *k == i).for_each(|(_, v)| v[at] += factor);
                }
            }
        }
        for (i, part) in &own {
            let through = self.owns[*i].gain.transpose() * part;
            let at = self.owns[*i].shared.iter().zip(through.iter());
            shared.extend(at.map(|(&at, value)| (at, -value)));
        }
        (shared, own)
    }
}
