//! Factors, solutions and products against dense twins.

use super::{Banded, SingularPivot};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Adds the blocks of a dense matrix, with rubbish where nothing may be read.
fn banded<const D: usize>(dense: &DMatrix<f64>) -> Banded<D> {
    let nodes = dense.nrows() / D;
    let mut matrix = Banded::new();
    matrix.reset(nodes);
    let block = |i: usize, j: usize| -> [[f64; D]; D] {
        std::array::from_fn(|a| std::array::from_fn(|b| dense[(i * D + a, j * D + b)]))
    };
    for i in 0..nodes {
        let mut own = block(i, i);
        for a in 0..D {
            own[a][a + 1..].fill(f64::NAN);
        }
        matrix.add_diagonal(i, &own);
        for k in 1..(nodes - i).min(3) {
            matrix.add(i, k, &block(i, i + k));
        }
    }
    matrix
}

/// `R^T R` of a banded triangle, lifted so that its condition number stays below some hundreds.
fn positive_definite(nodes: usize, d: usize, seed: &[f64]) -> DMatrix<f64> {
    let n = nodes * d;
    let r = DMatrix::from_fn(n, n, |i, j| {
        let in_band = j >= i && j / d <= i / d + 2;
        if in_band {
            seed[(i * 3 * d + j - i) % seed.len()]
        } else {
            0.0
        }
    });
    r.transpose() * r + DMatrix::identity(n, n) * 0.5
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// Factors, solves and multiplies, and compares each with the dense twin.
fn compare<const D: usize>(dense: &DMatrix<f64>, matrix: &mut Banded<D>, b: &[f64]) {
    let mut product = vec![f64::NAN; b.len()];
    matrix.multiply(b, &mut product);
    let expected = dense * DVector::from_column_slice(b);
    for i in 0..b.len() {
        assert!((product[i] - expected[i]).abs() < 1e-12 * (1.0 + expected[i].abs()));
    }
    matrix.factor().expect("positive definite");
    let mut x = b.to_vec();
    matrix.solve(&mut x);
    let right = DVector::from_column_slice(b);
    let expected = dense
        .clone()
        .cholesky()
        .expect("positive definite")
        .solve(&right);
    for i in 0..b.len() {
        assert!(
            (x[i] - expected[i]).abs() < 1e-11 * (1.0 + expected.amax()),
            "unknown {i}: {} against {}",
            x[i],
            expected[i]
        );
    }
}

/// Seeds for the matrix, right-hand side, and a few unknowns to pin.
fn problem() -> impl Strategy<Value = (usize, Vec<f64>, Vec<f64>, Vec<usize>)> {
    (1usize..=40).prop_flat_map(|nodes| {
        (
            Just(nodes),
            prop::collection::vec(-1.0..1.0f64, 1009),
            prop::collection::vec(-1.0..1.0f64, nodes * 4),
            prop::collection::vec(0..nodes * 3, 0..8),
        )
    })
}

proptest! {
    #[test]
    fn agrees_with_the_dense_solve((nodes, seed, b, _) in problem()) {
        let dense = positive_definite(nodes, 3, &seed);
        compare::<3>(&dense, &mut banded(&dense), &b[..nodes * 3]);
        let dense = positive_definite(nodes, 4, &seed);
        compare::<4>(&dense, &mut banded(&dense), &b);
    }

    #[test]
    fn a_pinned_unknown_keeps_its_right_hand_side((nodes, seed, b, pins) in problem()) {
        let mut dense = positive_definite(nodes, 3, &seed);
        let mut matrix = banded::<3>(&dense);
        for &unknown in &pins {
            dense.row_mut(unknown).fill(0.0);
            dense.column_mut(unknown).fill(0.0);
            dense[(unknown, unknown)] = 1.0;
            matrix.pin(unknown / 3, unknown % 3);
        }
        compare(&dense, &mut matrix, &b[..nodes * 3]);
        let mut x = b[..nodes * 3].to_vec();
        matrix.solve(&mut x);
        for &unknown in &pins {
            prop_assert_eq!(x[unknown], b[unknown]);
        }
    }

    #[test]
    fn the_first_loose_unknown_is_named(
        nodes in 1usize..40,
        at in 0usize..120,
        bad in prop::sample::select(vec![0.0, -1.0, f64::NAN, f64::INFINITY]),
    ) {
        let (node, coordinate) = (at / 3 % nodes, at % 3);
        let mut matrix = Banded::<3>::new();
        matrix.reset(nodes);
        for i in 0..nodes {
            for a in 0..3 {
                matrix.add_to_entry(i, a, if (i, a) == (node, coordinate) { bad } else { 2.0 });
            }
        }
        prop_assert_eq!(matrix.factor(), Err(SingularPivot { node, coordinate }));
    }
}

/// A bent wire: stiff along its edges, soft across, held by inertia alone.
fn beam(nodes: usize, stretch: f64, inertia: f64) -> Banded<3> {
    let mut matrix = Banded::new();
    matrix.reset(nodes);
    for i in 0..nodes {
        for a in 0..3 {
            matrix.add_to_entry(i, a, inertia);
        }
    }
    let scaled = |factor: f64, t: [f64; 3]| -> [[f64; 3]; 3] {
        std::array::from_fn(|a| std::array::from_fn(|b| factor * t[a] * t[b]))
    };
    for i in 0..nodes - 1 {
        let (sin, cos) = (0.3 * i as f64).sin_cos();
        let t = [0.6 * cos, 0.8 * cos, sin];
        matrix.add_diagonal(i, &scaled(stretch, t));
        matrix.add_diagonal(i + 1, &scaled(stretch, t));
        matrix.add(i, 1, &scaled(-stretch, t));
    }
    for i in 0..nodes - 2 {
        let c = [1.0, -2.0, 1.0];
        for k in 0..3 {
            for l in k..3 {
                let mut block = [[0.0; 3]; 3];
                for a in 0..3 {
                    block[a][a] = c[k] * c[l];
                }
                if k == l {
                    matrix.add_diagonal(i + k, &block);
                } else {
                    matrix.add(i + k, l - k, &block);
                }
            }
        }
    }
    matrix
}

#[test]
fn a_stiff_wire_is_solved_to_rounding() {
    let stretch = 1e8;
    for nodes in [3, 4, 5, 50, 401] {
        let mut matrix = beam(nodes, stretch, 1.0);
        matrix.factor().expect("inertia holds it");
        let b: Vec<f64> = (0..nodes * 3).map(|i| (1.7 * i as f64).cos()).collect();
        let mut x = b.clone();
        matrix.solve(&mut x);
        let mut rest = vec![0.0; b.len()];
        matrix.multiply(&x, &mut rest);
        for i in 0..b.len() {
            rest[i] = b[i] - rest[i];
        }
        // Backward error: a few rounding units of the largest row sum, 4 stretches.
        let scale = 4.0 * stretch * largest(&x) + largest(&b);
        assert!(largest(&rest) < 8.0 * f64::EPSILON * scale, "{nodes} nodes");
        // The correction is the error: condition number 4e8 times the rounding unit.
        matrix.solve(&mut rest);
        assert!(largest(&rest) < 1e-7 * largest(&x), "{nodes} nodes");
    }
}

#[test]
fn a_free_wire_without_inertia_is_loose() {
    for nodes in 3..30 {
        assert!(beam(nodes, 1.0, 0.0).factor().is_err(), "{nodes} nodes");
    }
}

#[test]
fn a_pivot_lost_to_cancellation_is_loose() {
    let mut matrix = Banded::<1>::new();
    for nodes in [2, 3, 8] {
        matrix.reset(nodes);
        for i in 0..nodes {
            matrix.add_to_entry(i, 0, 1.0);
        }
        matrix.add_to_entry(1, 0, 4.0 * f64::EPSILON);
        matrix.add(0, 1, &[[1.0]]);
        let loose = SingularPivot {
            node: 1,
            coordinate: 0,
        };
        assert_eq!(matrix.factor(), Err(loose), "{nodes} nodes");
    }
}

#[test]
fn a_matrix_used_again_stays_in_its_memory_and_forgets() {
    let mut matrix = beam(40, 1e3, 1.0);
    matrix.factor().expect("inertia holds it");
    let places = (matrix.steps.as_ptr(), matrix.step_factors.as_ptr());
    matrix.reset(31);
    for i in 0..31 {
        for a in 0..3 {
            matrix.add_to_entry(i, a, 2.0);
        }
    }
    matrix.factor().expect("diagonal");
    let mut x = vec![1.0; 93];
    matrix.solve(&mut x);
    assert!(x.iter().all(|&value| value == 0.5));
    assert_eq!(
        places,
        (matrix.steps.as_ptr(), matrix.step_factors.as_ptr())
    );
}

#[test]
fn no_nodes_are_no_trouble() {
    let mut matrix = Banded::<3>::new();
    matrix.reset(0);
    assert_eq!(matrix.factor(), Ok(()));
    matrix.solve(&mut []);
}

/// After a change only the steps from it on are done again: the same factors to the bit as of a new
/// matrix.
#[test]
fn factors_are_those_of_the_whole() {
    for nodes in [2, 3, 7, 8, 23, 40] {
        let seed: Vec<f64> = (0..97)
            .map(|k| f64::from(k * 37 % 97) / 97.0 - 0.4)
            .collect();
        let dense = positive_definite(nodes, 4, &seed);
        let bits = |matrix: &mut Banded<4>| {
            matrix.factor().expect("positive definite");
            let mut x: Vec<f64> = (0..4 * nodes).map(|k| (k as f64).sin()).collect();
            matrix.solve(&mut x);
            x.into_iter().map(f64::to_bits).collect::<Vec<_>>()
        };
        for i in 0..nodes {
            let mut kept = banded::<4>(&dense);
            let before = bits(&mut kept);
            assert_eq!(kept.ends_changed(), nodes < 4);
            let mut new = banded::<4>(&dense);
            for matrix in [&mut kept, &mut new] {
                matrix.add_to_entry(i, 1, 0.3);
                if i + 1 < nodes {
                    matrix.add(i, 1, &[[0.01; 4]; 4]);
                }
                if i == 1 {
                    matrix.pin(0, 2);
                }
            }
            let after = bits(&mut kept);
            assert!(
                after == bits(&mut new) && after != before,
                "node {i} of {nodes}"
            );
            assert!(after == bits(&mut kept), "nothing changed");
        }
    }
}
