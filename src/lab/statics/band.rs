//! Banded linear equations, Gaussian elimination with row pivoting.

/// Unknowns per node: three coordinates and the roll of the edge after it.
pub(crate) const PER_NODE: usize = 4;

/// A square matrix whose entries vanish beyond `half` places from the diagonal.
#[derive(Clone, Debug)]
pub(crate) struct Band {
    size: usize,
    half: usize,
    /// rows of `3 half + 1` entries: the band and the room that row swaps fill
    entries: Vec<f64>,
}

impl Band {
    /// All zeros.
    pub(crate) fn new(size: usize, half: usize) -> Self {
        Self {
            size,
            half,
            entries: vec![0.0; size * (3 * half + 1)],
        }
    }

    /// The entry in row `i`, column `j`, which must lie in the band.
    #[inline]
    pub(crate) fn at(&mut self, i: usize, j: usize) -> &mut f64 {
        &mut self.entries[i * (3 * self.half + 1) + j + self.half - i]
    }

    /// Makes row `i` say that unknown `i` equals its right-hand side.
    pub(crate) fn fix(&mut self, i: usize) {
        let width = 3 * self.half + 1;
        self.entries[i * width..(i + 1) * width].fill(0.0);
        *self.at(i, i) = 1.0;
    }

    /// Solves in place, consuming the matrix; the row of a vanishing pivot if there is one.
    pub(crate) fn solve(mut self, b: &mut [f64]) -> Result<(), usize> {
        let n = self.size;
        for i in 0..n {
            let last_row = (i + self.half).min(n - 1);
            let last_column = (i + 2 * self.half).min(n - 1);
            let mut pivot = i;
            for p in i + 1..=last_row {
                if self.at(p, i).abs() > self.at(pivot, i).abs() {
                    pivot = p;
                }
            }
            let top = *self.at(pivot, i);
            if top == 0.0 || !top.is_finite() {
                return Err(i);
            }
            if pivot != i {
                for j in i..=last_column {
                    let (upper, lower) = (*self.at(i, j), *self.at(pivot, j));
                    *self.at(i, j) = lower;
                    *self.at(pivot, j) = upper;
                }
                b.swap(i, pivot);
            }
            for r in i + 1..=last_row {
                let factor = *self.at(r, i) / top;
                if factor != 0.0 {
                    for j in i + 1..=last_column {
                        let upper = *self.at(i, j);
                        *self.at(r, j) -= factor * upper;
                    }
                    b[r] -= factor * b[i];
                }
            }
        }
        for i in (0..n).rev() {
            let last_column = (i + 2 * self.half).min(n - 1);
            let mut sum = b[i];
            for j in i + 1..=last_column {
                sum -= *self.at(i, j) * b[j];
            }
            b[i] = sum / *self.at(i, i);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_the_dense_solve(seed in prop::collection::vec(-1.0..1.0f64, 12 * 12 + 12), half in 1usize..5) {
            let n = 12;
            let mut band = Band::new(n, half);
            let mut dense = nalgebra::DMatrix::<f64>::zeros(n, n);
            for i in 0..n {
                for j in i.saturating_sub(half)..(i + half + 1).min(n) {
                    *band.at(i, j) = seed[i * n + j];
                    dense[(i, j)] = seed[i * n + j];
                }
            }
            let b = nalgebra::DVector::from_column_slice(&seed[n * n..]);
            prop_assume!(dense.clone().svd(false, false).singular_values.min() > 1e-3);
            let expected = dense.lu().solve(&b).ok_or(TestCaseError::reject("singular"))?;
            let mut x = b.as_slice().to_vec();
            prop_assert!(band.solve(&mut x).is_ok());
            for i in 0..n {
                prop_assert!((x[i] - expected[i]).abs() < 1e-9 * (1.0 + expected[i].abs()));
            }
        }
    }

    #[test]
    fn a_singular_matrix_is_named_by_row() {
        let mut band = Band::new(3, 1);
        *band.at(0, 0) = 1.0;
        *band.at(2, 2) = 1.0;
        assert_eq!(band.solve(&mut [1.0; 3]), Err(1));
    }
}
