//! What a benchmark is asked for, and which combinations make sense.

use super::BenchError;
use crate::math::simd::Width;
use crate::scene::assignment;
use clap::ValueEnum;
use std::path::PathBuf;

/// The problems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
pub enum Problem {
    /// cantilever under a dead force at its tip
    #[value(name = "P1", alias = "p1")]
    P1,
    /// cantilever vibration over ten periods of its first mode
    #[value(name = "P2", alias = "p2")]
    P2,
    /// capstan: half a turn of slipping wire
    #[value(name = "P3", alias = "p3")]
    P3,
    /// two turns wound on a cylinder
    #[value(name = "P4", alias = "p4")]
    P4,
    /// free wire: cost of a node and step
    #[value(name = "P5", alias = "p5")]
    P5,
    /// a whole scene
    #[value(name = "W", alias = "w")]
    W,
}

impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Debug::fmt(self, f)
    }
}

/// Which method moves the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// the production method
    Implicit,
    /// velocity Verlet
    Verlet,
    /// classical Runge-Kutta
    Rk4,
}

impl Method {
    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Implicit => "implicit",
            Self::Verlet => "verlet",
            Self::Rk4 => "rk4",
        }
    }
}

/// Arguments of `coilwind bench`.
#[derive(Clone, Debug, clap::Args)]
pub struct BenchArgs {
    /// P1 cantilever, P2 vibration, P3 capstan, P4 two turns on a cylinder, P5 free wire, W a whole scene
    #[arg(value_enum, value_name = "PROBLEM")]
    pub problem: Problem,
    /// Edges: of the wire (P1, P2, P3, P5), or of a turn of wire on the core (P4, W)
    #[arg(long, value_name = "N")]
    pub n: Option<usize>,
    /// Time step, s, held fixed (P1: pseudo-time of the whole load; P3: longest step)
    #[arg(long, value_name = "DT")]
    pub dt: Option<f64>,
    /// Tolerance of the implicit method, m [default of W: the scene's if it has one, else 1e-5, less for wire thinner
    /// than 0.7 mm]
    #[arg(long, value_name = "TOL")]
    pub tol: Option<f64>,
    /// Method: implicit, verlet or rk4
    #[arg(long, value_enum, value_name = "NAME")]
    pub integrator: Option<Method>,
    /// Most numbers worked on at once, as far as the machine can: 1, 4 (AVX2) or 8 (AVX-512); no result depends on
    /// it [default: 4]
    #[arg(long, value_enum, value_name = "N")]
    pub lanes: Option<Width>,
    /// Runs; the line has the median of their times [default: 1]
    #[arg(long, value_name = "K")]
    pub repeat: Option<usize>,
    /// P1: load P L^2/EI, 0.01 to 20 [default: 10]
    #[arg(long, value_name = "A")]
    pub a: Option<f64>,
    /// P4, W: spindle speed, rad/s [default: 500, or the scene's]
    #[arg(long, value_name = "W")]
    pub omega: Option<f64>,
    /// W: packed name or path of the scene [default: fig8]
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,
    /// W: another value of a scene variable (may be repeated)
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<(String, String)>,
    /// W: compare with the converged runs of this file instead of the packed ones
    #[arg(long, value_name = "FILE", conflicts_with = "store")]
    pub against: Option<PathBuf>,
    /// W: wind an ensemble of eight nozzle distances, +-0.35 mm about the scene's, with 0.25 mm edges and
    /// a tolerance of 2e-7 m unless --n and --tol say otherwise, and keep its means in this file (made,
    /// or this speed in it replaced) as what later runs are compared with
    #[arg(long, value_name = "FILE", conflicts_with_all = ["repeat", "integrator", "dt"])]
    pub store: Option<PathBuf>,
}

/// Fewest and most edges that can be asked for.
const EDGES: [usize; 2] = [4, 20_000];

impl BenchArgs {
    /// A problem with nothing else asked for.
    pub fn new(problem: Problem) -> Self {
        Self {
            problem,
            n: None,
            dt: None,
            tol: None,
            integrator: None,
            lanes: None,
            repeat: None,
            a: None,
            omega: None,
            scene: None,
            set: Vec::new(),
            against: None,
            store: None,
        }
    }

    /// The method asked for.
    pub fn method(&self) -> Method {
        self.integrator.unwrap_or(Method::Implicit)
    }

    /// An error about one of these options.
    pub(super) fn wrong(
        &self,
        option: impl Into<String>,
        reason: impl Into<String>,
        allowed: impl Into<String>,
    ) -> BenchError {
        BenchError::Option {
            problem: self.problem,
            option: option.into(),
            reason: reason.into(),
            allowed: allowed.into(),
        }
    }

    /// Ranges, and options that the problem does not know.
    pub(super) fn check(&self) -> Result<(), BenchError> {
        use Problem::{P1, P3, P4, W};
        if let Some(n) = self.n
            && !(EDGES[0]..=EDGES[1]).contains(&n)
        {
            let allowed = format!("{} to {}", EDGES[0], EDGES[1]);
            return Err(self.wrong(format!("--n {n}"), "out of range", allowed));
        }
        for (name, value) in [("dt", self.dt), ("tol", self.tol)] {
            if let Some(x) = value
                && !(x.is_finite() && x > 0.0)
            {
                let allowed = "a number above 0";
                return Err(self.wrong(format!("--{name} {x}"), "out of range", allowed));
            }
        }
        if self.repeat == Some(0) {
            return Err(self.wrong("--repeat 0", "nothing would run", "1 or more"));
        }
        let method = self.method();
        if method != Method::Implicit {
            let option = format!("--integrator {}", method.name());
            if matches!(self.problem, P1 | P3) {
                let reason = if self.problem == P1 {
                    "a static answer has no time to step through"
                } else {
                    "the line contact of this problem belongs to the implicit method"
                };
                return Err(self.wrong(option, reason, "implicit"));
            }
            if let Some(tol) = self.tol {
                let reason = format!("{option} takes steps by stability, not by error");
                return Err(self.wrong(format!("--tol {tol}"), reason, "no --tol, or implicit"));
            }
        }
        if let Some(a) = self.a {
            if self.problem != P1 {
                return Err(self.foreign("--a", "P1"));
            }
            if !(0.01..=20.0).contains(&a) {
                return Err(self.wrong(format!("--a {a}"), "out of range", "0.01 to 20"));
            }
        }
        if let Some(w) = self.omega {
            if !matches!(self.problem, P4 | W) {
                return Err(self.foreign("--omega", "P4 and W"));
            }
            if !(1.0..=2000.0).contains(&w) {
                return Err(self.wrong(format!("--omega {w}"), "out of range", "1 to 2000 rad/s"));
            }
        }
        for (given, name) in [
            (self.scene.is_some(), "--scene"),
            (!self.set.is_empty(), "--set"),
            (self.against.is_some(), "--against"),
            (self.store.is_some(), "--store"),
        ] {
            if given && self.problem != W {
                return Err(self.foreign(name, "W"));
            }
        }
        Ok(())
    }

    fn foreign(&self, option: &str, whose: &str) -> BenchError {
        self.wrong(
            option,
            format!("an option of {whose}"),
            "to leave it out here",
        )
    }
}
