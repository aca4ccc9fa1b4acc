//! Equations in a step of the solver: what they ask of it, and what they say about the unknowns.

use nalgebra::{Cholesky, DMatrix, DVector, DVectorView, Dyn};

use super::equation::Equation;
use super::spread::Place;
use super::system::{State, System};

/// Relative ridge under equations that depend on each other; steps repeat until they hold exactly.
const DEPENDENT: f64 = 1e-12;

/// The equations seen from the shared unknowns: scaled rows and values.
pub struct Bounds {
    rows: Vec<Vec<(usize, f64)>>,
    values: DVector<f64>,
    /// The rows, turned by the covariance without equations.
    spread: DMatrix<f64>,
    missing: Cholesky<f64, Dyn>,
}

impl Bounds {
    /// Linearised at a state; `None` where they contradict each other to first order.
    pub fn new(
        factor: &Cholesky<f64, Dyn>,
        system: &System,
        state: &State,
        equations: &[Equation],
        place: &[Place],
    ) -> Option<Self> {
        let shared = |(unknown, value): (usize, f64)| match place[unknown] {
            Place::Shared(at) => Some((at, value)),
            _ => None,
        };
        let mut rows = Vec::with_capacity(equations.len());
        let mut values = DVector::<f64>::zeros(equations.len());
        let mut spread = DMatrix::<f64>::zeros(factor.l_dirty().nrows(), equations.len());
        for (e, equation) in equations.iter().enumerate() {
            let row = equation.row(system, state);
            let length = row.iter().map(|(_, v)| v * v).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            values[e] = equation.value(system, state) / length;
            let row: Vec<_> = row.into_iter().filter_map(shared).collect();
            row.iter().for_each(|&(at, value)| spread[(at, e)] = value / length);
            rows.push(row.into_iter().map(|(at, value)| (at, value / length)).collect());
        }
        factor.solve_mut(&mut spread);
        let mut bounds =
            Self { missing: DMatrix::identity(0, 0).cholesky()?, rows, values, spread };
        let mut missing = DMatrix::<f64>::zeros(equations.len(), equations.len());
        for e in 0..equations.len() {
            missing.set_column(e, &bounds.seen(bounds.spread.column(e)));
            // Equations that follow from others to first order do no harm as long as all can hold.
            missing[(e, e)] *= 1.0 + DEPENDENT;
        }
        bounds.missing = missing.cholesky()?;
        Some(bounds)
    }

    /// The rows times a vector.
    fn seen(&self, vector: DVectorView<f64>) -> DVector<f64> {
        let each = |row: &Vec<(usize, f64)>| row.iter().map(|&(at, x)| x * vector[at]).sum();
        DVector::from_iterator(self.rows.len(), self.rows.iter().map(each))
    }

    /// What is missing from a step for the equations to hold.
    pub fn correction(&self, change: &DVector<f64>) -> DVector<f64> {
        let lacking = self.seen(change.as_view()) + &self.values;
        &self.spread * self.missing.solve(&lacking)
    }

    /// What the equations take from the covariance.
    pub fn known(&self) -> DMatrix<f64> {
        &self.spread * self.missing.solve(&self.spread.transpose())
    }
}
