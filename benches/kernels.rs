//! The kernels of the implicit step, each alone.
//!
//! `cargo bench --bench kernels` prints time per call and throughput in nodes per second; the
//! reciprocal of the throughput is the time per node.
#![allow(missing_docs)]

use coilwind::linalg::Banded;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

/// Diagonally dominant, every entry of the band taken.
fn full_band<const D: usize>(nodes: usize) -> Banded<D> {
    let wave =
        |i: usize, a: usize, b: usize| (1.3 * i as f64 + 0.7 * a as f64 + 2.1 * b as f64).sin();
    let mut matrix = Banded::new();
    matrix.reset(nodes);
    for i in 0..nodes {
        for k in 0..(nodes - i).min(3) {
            let block: [[f64; 3]; 3] =
                std::array::from_fn(|a| std::array::from_fn(|b| wave(3 * i + k, a, b)));
            if k == 0 {
                matrix.add_diagonal(i, &block);
            } else {
                matrix.add(i, k, &block);
            }
        }
        for a in 0..D {
            matrix.add_to_entry(i, a, 5.0 * D as f64);
        }
    }
    matrix
}

fn factor_and_solve_of<const D: usize>(c: &mut Criterion) {
    let mut group = c.benchmark_group("factor_and_solve");
    group.sample_size(20);
    group.warm_up_time(std::time::Duration::from_millis(300));
    group.measurement_time(std::time::Duration::from_secs(1));
    for nodes in [50usize, 100, 200, 400, 800, 1600] {
        let mut matrix = full_band::<D>(nodes);
        let b: Vec<f64> = (0..nodes * D).map(|i| (0.7 * i as f64).sin()).collect();
        let mut x = b.clone();
        group.throughput(Throughput::Elements(nodes as u64));
        group.bench_function(
            BenchmarkId::new(format!("{D}_per_node"), nodes),
            |bencher| {
                bencher.iter(|| {
                    x.copy_from_slice(&b);
                    black_box(&mut matrix).factor().expect("dominant diagonal");
                    matrix.solve(black_box(&mut x));
                });
            },
        );
    }
    group.finish();
}

fn factor_and_solve(c: &mut Criterion) {
    factor_and_solve_of::<3>(c);
    factor_and_solve_of::<4>(c);
}

criterion_group!(kernels, factor_and_solve);
criterion_main!(kernels);
