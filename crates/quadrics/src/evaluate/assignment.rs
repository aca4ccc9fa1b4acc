//! The assignment of largest total weight, by shortest augmenting paths.
//!
//! D. F. Crouse, *On implementing 2D rectangular assignment algorithms*, IEEE Transactions on Aerospace
//! and Electronic Systems 52 (2016): cubic in the shorter side, exact, and of equal columns it
//! prefers one that is free.

/// No row, no column.
const FREE: usize = usize::MAX;

/// Pairs `(row, column)` of largest total weight, as many as the shorter side is long, by row.
///
/// `weights` has a row for every row, all of one length.
pub fn assign(weights: &[Vec<f64>]) -> Vec<(usize, usize)> {
    let (rows, columns) = (weights.len(), weights.first().map_or(0, Vec::len));
    if rows <= columns {
        let of_row = Search::new(rows, columns).run(|row, column| -weights[row][column]);
        return of_row.into_iter().enumerate().collect();
    }
    let of_column = Search::new(columns, rows).run(|column, row| -weights[row][column]);
    let mut pairs: Vec<_> = of_column.into_iter().enumerate().map(|(c, r)| (r, c)).collect();
    pairs.sort_unstable();
    pairs
}

/// Dual prices and the assignment so far; there are at least as many columns as rows.
struct Search {
    row_price: Vec<f64>,
    column_price: Vec<f64>,
    column_of_row: Vec<usize>,
    row_of_column: Vec<usize>,
    /// Of the present search: the shortest way to every column, and the row before it.
    shortest: Vec<f64>,
    before: Vec<usize>,
}

impl Search {
    fn new(rows: usize, columns: usize) -> Self {
        Self {
            row_price: vec![0.0; rows],
            column_price: vec![0.0; columns],
            column_of_row: vec![FREE; rows],
            row_of_column: vec![FREE; columns],
            shortest: vec![0.0; columns],
            before: vec![FREE; columns],
        }
    }

    fn run(mut self, cost: impl Fn(usize, usize) -> f64) -> Vec<usize> {
        for row in 0..self.column_of_row.len() {
            let end = self.reach(row, &cost);
            self.augment(row, end);
        }
        self.column_of_row
    }

    /// The free column that is nearest to `start`; prices stay tight along the way to it.
    fn reach(&mut self, start: usize, cost: &impl Fn(usize, usize) -> f64) -> usize {
        let mut open: Vec<usize> = (0..self.row_of_column.len()).rev().collect();
        let (mut rows, mut closed) = (vec![start], Vec::new());
        self.shortest.fill(f64::INFINITY);
        let mut length = 0.0;
        let end = loop {
            let row = *rows.last().expect("starts with one");
            let (mut least, mut place) = (f64::INFINITY, 0);
            for (i, &column) in open.iter().enumerate() {
                let reduced = cost(row, column) - self.row_price[row] - self.column_price[column];
                if length + reduced < self.shortest[column] {
                    self.shortest[column] = length + reduced;
                    self.before[column] = row;
                }
                let far = self.shortest[column];
                if far < least || (far == least && self.row_of_column[column] == FREE) {
                    (least, place) = (far, i);
                }
            }
            length = least;
            let column = open.swap_remove(place);
            closed.push(column);
            match self.row_of_column[column] {
                FREE => break column,
                next => rows.push(next),
            }
        };
        self.row_price[start] += length;
        for &row in &rows[1..] {
            self.row_price[row] += length - self.shortest[self.column_of_row[row]];
        }
        for &column in &closed {
            self.column_price[column] -= length - self.shortest[column];
        }
        end
    }

    /// Takes the way to `end` back to `start` and swaps what is assigned along it.
    fn augment(&mut self, start: usize, end: usize) {
        let mut column = end;
        loop {
            let row = self.before[column];
            self.row_of_column[column] = row;
            std::mem::swap(&mut self.column_of_row[row], &mut column);
            if row == start {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;

    /// The best of all injections of rows into columns.
    fn slowly(weights: &[Vec<f64>], row: usize, taken: u32) -> f64 {
        let Some(of_row) = weights.get(row) else { return 0.0 };
        let free = (0..of_row.len()).filter(|c| taken & (1 << c) == 0);
        let best = free.map(|c| of_row[c] + slowly(weights, row + 1, taken | 1 << c));
        best.fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn it_finds_what_trying_all_finds() {
        let mut rng = Context::new(5).rng;
        for _ in 0..300 {
            let (rows, columns) = (rng.random_range(1..6), rng.random_range(1..6));
            // Few values, so that there are ties.
            let mut row = || (0..columns).map(|_| f64::from(rng.random_range(0..6u32))).collect();
            let weights: Vec<Vec<f64>> = (0..rows).map(|_| row()).collect();
            let total: f64 = assign(&weights).iter().map(|&(r, c)| weights[r][c]).sum();
            let turned: Vec<Vec<f64>> =
                (0..columns).map(|c| weights.iter().map(|row| row[c]).collect()).collect();
            let best = if rows <= columns { slowly(&weights, 0, 0) } else { slowly(&turned, 0, 0) };
            assert_eq!((total, assign(&weights).len()), (best, rows.min(columns)));
        }
    }

    #[test]
    fn nothing_is_assigned_to_nothing() {
        assert_eq!(assign(&[]), []);
        assert_eq!(assign(&[vec![], vec![]]), []);
    }
}
