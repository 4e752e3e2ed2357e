//! `coilwind bench`.

use super::choice::one_of;
use super::failure::Failure;
use super::terminal::print;
use clap::Args;
use coilwind::lab::bench::{BenchOptions, Method, Problem, run};
use coilwind::math::simd::Width;
use coilwind::scene::assignment;
use std::path::PathBuf;

/// Word, meaning and value of each problem.
const PROBLEMS: &[(&str, &str, Problem)] = &[
    (
        "P1",
        "cantilever under a dead force at its tip",
        Problem::P1,
    ),
    (
        "P2",
        "cantilever vibration over ten periods of its first mode",
        Problem::P2,
    ),
    ("P3", "capstan: half a turn of slipping wire", Problem::P3),
    ("P4", "two turns wound on a cylinder", Problem::P4),
    ("P5", "free wire: cost of a node and step", Problem::P5),
    ("W", "a whole scene", Problem::W),
];

const METHODS: &[(&str, &str, Method)] = &[
    ("implicit", "the production method", Method::Implicit),
    ("verlet", "velocity Verlet", Method::Verlet),
    ("rk4", "classical Runge-Kutta", Method::Rk4),
];

const WIDTHS: &[(&str, &str, Width)] = &[
    ("1", "any machine", Width::One),
    ("4", "AVX2", Width::Four),
    ("8", "AVX-512", Width::Eight),
];

/// Arguments of `bench`.
#[derive(Args, Debug)]
pub(super) struct BenchArgs {
    /// P1 cantilever, P2 vibration, P3 capstan, P4 two turns on a cylinder, P5 free wire, W a whole scene
    #[arg(value_name = "PROBLEM", ignore_case = true, value_parser = one_of(PROBLEMS))]
    problem: Problem,
    /// Edges: of the wire (P1, P2, P3, P5), or of a turn of wire on the core (P4, W)
    #[arg(long, value_name = "N")]
    n: Option<usize>,
    /// Time step, s, held fixed (P1: pseudo-time of the whole load; P3: longest step)
    #[arg(long, value_name = "DT")]
    dt: Option<f64>,
    /// Tolerance of the implicit method, m [default of W: the scene's if it has one, else 1e-5, less for wire thinner
    /// than 0.7 mm]
    #[arg(long, value_name = "TOL")]
    tol: Option<f64>,
    /// Method: implicit, verlet or rk4
    #[arg(long, value_name = "NAME", value_parser = one_of(METHODS))]
    integrator: Option<Method>,
    /// Most numbers worked on at once, as far as the machine can: 1, 4 (AVX2) or 8 (AVX-512); no result depends on
    /// it [default: 4]
    #[arg(long, value_name = "N", value_parser = one_of(WIDTHS))]
    lanes: Option<Width>,
    /// Runs; the line has the median of their times [default: 1]
    #[arg(long, value_name = "K")]
    repeat: Option<usize>,
    /// P1: load P L^2/EI, 0.01 to 20 [default: 10]
    #[arg(long, value_name = "A")]
    a: Option<f64>,
    /// P4, W: spindle speed, rad/s [default: 500, or the scene's]
    #[arg(long, value_name = "W")]
    omega: Option<f64>,
    /// W: packed name or path of the scene [default: fig8]
    #[arg(long, value_name = "NAME")]
    scene: Option<String>,
    /// W: another value of a scene variable (may be repeated)
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// W: compare with the converged runs of this file instead of the packed ones
    #[arg(long, value_name = "FILE", conflicts_with = "store")]
    against: Option<PathBuf>,
    /// W: wind an ensemble and keep its means in this file, for later runs to be compared with. Eight nozzle distances,
    /// +-0.35 mm about the scene's; 0.25 mm edges and a tolerance of 2e-7 m unless --n and --tol say otherwise. The file is
    /// made, or this speed in it replaced
    #[arg(long, value_name = "FILE", conflicts_with_all = ["repeat", "integrator", "dt"])]
    store: Option<PathBuf>,
}

impl BenchArgs {
    fn options(&self) -> BenchOptions {
        BenchOptions {
            problem: self.problem,
            n: self.n,
            dt: self.dt,
            tol: self.tol,
            integrator: self.integrator,
            lanes: self.lanes,
            repeat: self.repeat,
            a: self.a,
            omega: self.omega,
            scene: self.scene.clone(),
            set: self.set.clone(),
            against: self.against.clone(),
            store: self.store.clone(),
        }
    }
}

/// Runs a problem and prints its line; a run that stopped on the way has one as well.
pub(super) fn bench(args: &BenchArgs) -> Result<(), Failure> {
    let record = run(&args.options())?;
    print(&format!("{}\n", record.line()))?;
    match record.reason {
        Some(reason) => Err(Failure::BenchStopped { reason }),
        None => Ok(()),
    }
}
