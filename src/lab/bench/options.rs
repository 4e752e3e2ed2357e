//! What a benchmark is asked for, and which combinations make sense.

use super::error::BenchError;
use super::problem::{Method, Problem};
use crate::math::simd::Width;
use std::path::PathBuf;

/// Options of a benchmark; an option that is `None` takes the value that the problem has by itself.
#[derive(Clone, Debug)]
pub struct BenchOptions {
    /// the problem
    pub problem: Problem,
    /// edges: of the wire (P1, P2, P3, P5), or of a turn of wire on the core (P4, W)
    pub n: Option<usize>,
    /// time step held fixed, s; P1: pseudo-time of the whole load; P3: longest step
    pub dt: Option<f64>,
    /// tolerance of the implicit method, m; W: the scene's if it has one, else 1e-5, less for wire thinner
    /// than 0.7 mm
    pub tol: Option<f64>,
    /// method that moves the wire; the implicit one by default
    pub integrator: Option<Method>,
    /// most numbers worked on at once, as far as the machine can; no result depends on it
    pub lanes: Option<Width>,
    /// runs, 1 by default; the record has the median of their times
    pub repeat: Option<usize>,
    /// P1: load P L^2/EI, 0.01 to 20; 10 by default
    pub a: Option<f64>,
    /// P4, W: spindle speed, rad/s; 500 or the scene's by default
    pub omega: Option<f64>,
    /// W: packed name or path of the scene; fig8 by default
    pub scene: Option<String>,
    /// W: other values of scene variables, by name
    pub set: Vec<(String, String)>,
    /// W: compare with the converged runs of this file instead of the packed ones
    pub against: Option<PathBuf>,
    /// W: wind an ensemble of eight nozzle distances, +-0.35 mm about the scene's, and write its means to
    /// this file as what later runs are compared with. The file is made, or this speed in it replaced.
    /// `n` and `tol` are 0.25 mm edges and 2e-7 m by default
    pub store: Option<PathBuf>,
}

/// Fewest and most edges that can be asked for.
const EDGES: [usize; 2] = [4, 20_000];

impl BenchOptions {
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
