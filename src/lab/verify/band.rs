//! Lowest eigenvalues of a symmetric matrix whose rows reach no farther than their neighbours.

use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::PI;

/// Vectors beyond those asked for: the farther their eigenvalues, the faster the others are found.
const MORE: usize = 5;
/// Change of the eigenvalues, relative, at which they are found, and rounds until then at most.
const FOUND: f64 = 1e-11;
const ROUNDS: usize = 200;

/// The lower half: entry `k` of row `i` stands in column `i - k`.
pub(super) struct Band {
    rows: Vec<Vec<f64>>,
    reach: usize,
}

impl Band {
    /// The symmetric part of a matrix given by its columns.
    pub(super) fn of(columns: &[Vec<f64>]) -> Self {
        let entries = columns.iter().enumerate();
        let reach = entries.fold(0, |reach, (j, column)| {
            let far = |i: usize| if column[i] == 0.0 { 0 } else { i.abs_diff(j) };
            (0..column.len()).map(far).fold(reach, usize::max)
        });
        let mean = |i: usize, j: usize| 0.5 * (columns[i][j] + columns[j][i]);
        let row = |i: usize| (0..=reach.min(i)).map(|k| mean(i, i - k)).collect();
        Self {
            rows: (0..columns.len()).map(row).collect(),
            reach,
        }
    }

    /// Its `count` lowest eigenvalues, ascending, with their vectors; none where one is not above 0.
    ///
    /// By inverse iteration of a few vectors at once.
    pub(super) fn lowest(&self, count: usize) -> Option<Vec<(f64, Vec<f64>)>> {
        let n = self.rows.len();
        if n < count {
            return None;
        }
        let factor = self.cholesky()?;
        let vectors = (count + MORE).min(n);
        let mut basis = DMatrix::from_fn(n, vectors, |i, j| {
            libm::sin(PI * (i as f64 + 1.0) * (j as f64 + 1.0) / (n as f64 + 1.0))
        });
        let mut before = vec![0.0; count];
        for _ in 0..ROUNDS {
            basis = basis.qr().q();
            let mut image = basis.clone();
            for mut vector in image.column_iter_mut() {
                factor.solve(vector.as_mut_slice());
            }
            // (of the inverse, whose largest eigenvalues are known to more digits than the lowest of the matrix)
            let eigen = SymmetricEigen::new(basis.transpose() * &image);
            let mut order: Vec<usize> = (0..vectors).collect();
            order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
            basis = image
                * DMatrix::from_fn(vectors, vectors, |i, j| eigen.eigenvectors[(i, order[j])]);
            let lowest = order[..count].iter();
            let now: Vec<f64> = lowest.map(|&k| 1.0 / eigen.eigenvalues[k]).collect();
            let changed = |(a, b): (&f64, &f64)| (a - b).abs() > FOUND * a.abs();
            let goes_on = now.iter().zip(&before).any(changed);
            before = now;
            if !goes_on {
                break;
            }
        }
        let vector = |k: usize| basis.column(k).normalize().iter().copied().collect();
        let found = before.into_iter().enumerate();
        Some(found.map(|(k, value)| (value, vector(k))).collect())
    }

    #[cfg(test)]
    fn times(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; vector.len()];
        for (i, row) in self.rows.iter().enumerate() {
            product[i] += row[0] * vector[i];
            for (k, entry) in row.iter().enumerate().skip(1) {
                product[i] += entry * vector[i - k];
                product[i - k] += entry * vector[i];
            }
        }
        product
    }

    /// Its lower triangular factor; none where it is not positive definite.
    fn cholesky(&self) -> Option<Self> {
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(self.rows.len());
        for (i, own) in self.rows.iter().enumerate() {
            let mut row = own.clone();
            for k in (0..row.len()).rev() {
                let j = i - k;
                // columns that both rows reach
                let shared: f64 = (k + 1..row.len())
                    .filter(|m| m - k < self.rows[j].len())
                    .map(|m| row[m] * if k == 0 { row[m] } else { rows[j][m - k] })
                    .sum();
                let rest = own[k] - shared;
                row[k] = match k {
                    0 if rest > 0.0 => rest.sqrt(),
                    0 => return None,
                    _ => rest / rows[j][0],
                };
            }
            rows.push(row);
        }
        Some(Self {
            rows,
            reach: self.reach,
        })
    }

    /// Solves with a factor, in place.
    fn solve(&self, vector: &mut [f64]) {
        for (i, row) in self.rows.iter().enumerate() {
            let below: f64 = (1..row.len()).map(|k| row[k] * vector[i - k]).sum();
            vector[i] = (vector[i] - below) / row[0];
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            vector[i] /= row[0];
            for k in 1..row.len() {
                vector[i - k] -= row[k] * vector[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of `n` rows that reach `reach` far, and its eigenvalues, ascending, by the dense method.
    fn matrix(n: usize, reach: usize, shift: f64) -> (Band, Vec<f64>) {
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 6.0 + shift + (i % 3) as f64,
            far if far <= reach => -1.5 / far as f64 - 0.1 * ((i + j) % 2) as f64,
            _ => 0.0,
        };
        let columns: Vec<Vec<f64>> = (0..n)
            .map(|j| (0..n).map(|i| entry(i, j)).collect())
            .collect();
        let dense = SymmetricEigen::new(DMatrix::from_fn(n, n, entry));
        let mut values: Vec<f64> = dense.eigenvalues.iter().copied().collect();
        values.sort_by(f64::total_cmp);
        (Band::of(&columns), values)
    }

    #[test]
    fn the_lowest_are_those_of_the_dense_method() {
        for (n, reach) in [(3, 1), (40, 1), (41, 2), (60, 3)] {
            let (band, values) = matrix(n, reach, 0.0);
            for (k, (value, vector)) in band.lowest(3).expect("positive").iter().enumerate() {
                assert!((value / values[k] - 1.0).abs() < 1e-8, "{n} {reach} {k}");
                let image = band.times(vector);
                let off = image.iter().zip(vector).map(|(a, x)| (a - value * x).abs());
                assert!(off.fold(0.0, f64::max) < 1e-3 * value);
            }
        }
    }

    #[test]
    fn one_below_zero_is_none() {
        let (_, values) = matrix(30, 2, 0.0);
        let (band, _) = matrix(30, 2, -1.01 * values[0]);
        assert!(band.lowest(2).is_none() && Band::of(&[]).lowest(1).is_none());
    }
}
