//! The two schemes as one solve: what a step does with history, and what it leaves behind.
//!
//! Both end in `m / gamma^2 (x - x*) = F(x)`. Where there is contact, variable-step BDF2 (backward
//! Euler on the first step after a start): L-stable, so an impact does not ring on. Where there is
//! none, the implicit midpoint rule: it loses no amplitude. History is kept in the lab frame, in
//! which it obeys Newton's law without fictitious forces; guesses are extrapolated in the core frame,
//! in which settled wire is exactly at rest.

use crate::system::Past;

/// How a step goes about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// variable-step BDF2
    Bdf2,
    /// implicit midpoint rule
    Midpoint,
}

/// The numbers of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepFormula {
    /// its length, s
    pub(super) h: f64,
    /// time over which the solve sees the forces act, s
    pub(super) gamma: f64,
    /// the solve's instant as a share of the step
    pub(super) share: f64,
    /// weights of the present and the instant before in `x*`
    pub(super) weight: [f64; 2],
    /// estimated error over the difference of solution and guess
    pub(super) error: f64,
    /// by how much the edge at the nozzle is likely to have grown at the solve's instant, m
    pub(super) grown: f64,
}

impl StepFormula {
    pub(super) fn new(scheme: Scheme, past: &Past, h: f64) -> Self {
        match scheme {
            Scheme::Midpoint => Self {
                h,
                gamma: 0.5 * h,
                share: 0.5,
                weight: [1.0, 0.0],
                // the rule is off by h^3/12 x''', the guess for the middle by 0.31 h^3 x'''
                error: 0.25,
                grown: 0.0,
            },
            Scheme::Bdf2 if past.known == 0 => Self {
                h,
                gamma: h,
                share: 1.0,
                weight: [1.0, 0.0],
                // guess x + h v is off by h^2/2 a, backward Euler by as much the other way
                error: 0.5,
                grown: 0.0,
            },
            Scheme::Bdf2 => {
                let h1 = past.h[0];
                let r = h / h1;
                let a0 = (1.0 + 2.0 * r) / (1.0 + r);
                let weight = [(1.0 + r) / a0, -(r * r / (1.0 + r)) / a0];
                // local errors of the formula and of the guess, over x'''
                let own = (h + h1) * (h + h1) * h * h / (6.0 * (2.0 * h + h1));
                let error = if past.known > 1 {
                    own / (own + h * (h + h1) * (h + h1 + past.h[1]) / 6.0)
                } else {
                    // the guess is a straight line, an order below the formula
                    0.2
                };
                Self {
                    h,
                    gamma: h / a0,
                    share: 1.0,
                    weight,
                    error,
                    grown: 0.0,
                }
            }
        }
    }

    /// The same with the edge at the nozzle, `rest` long now, growing as `fed`, the wire passed so far, has grown.
    ///
    /// With the length it has at the start, mass and curvature next to the nozzle are an order less exact than the rest.
    pub(super) fn with_feed(self, past: &Past, fed: f64, rest: f64) -> Self {
        if past.known == 0 {
            return self;
        }
        let e = extrapolation(self.share * self.h, past);
        let grown = (e[0] - 1.0) * fed + e[1] * past.fed[0] + e[2] * past.fed[1];
        Self {
            grown: grown.clamp(-0.5 * rest, 0.5 * rest),
            ..self
        }
    }

    /// `x*` or `v*` from the present and the instant before.
    pub(super) fn blend<T>(&self, now: T, before: T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        now * self.weight[0] + before * self.weight[1]
    }
}

/// Weights of the Lagrange polynomial through instants 0, -h1, -h1-h2 at `h`.
pub(super) fn extrapolation(h: f64, past: &Past) -> [f64; 3] {
    match past.known {
        0 => [1.0, 0.0, 0.0],
        1 => {
            let r = h / past.h[0];
            [1.0 + r, -r, 0.0]
        }
        _ => {
            let (a, b) = (past.h[0], past.h[0] + past.h[1]);
            [
                (h + a) * (h + b) / (a * b),
                -h * (h + b) / (a * (b - a)),
                h * (h + a) / (b * (b - a)),
            ]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_formulas_are_exact_for_a_parabola() {
        let x = |t: f64| 2.0 + 3.0 * t - 5.0 * t * t;
        let v = |t: f64| 3.0 - 10.0 * t;
        let (h, h1, h2) = (0.3, 0.2, 0.15);
        let past = Past {
            known: 2,
            h: [h1, h2],
            ..Past::default()
        };
        let w = extrapolation(h, &past);
        let guess = w[0] * x(0.0) + w[1] * x(-h1) + w[2] * x(-h1 - h2);
        assert!((guess - x(h)).abs() < 1e-13);
        let s = StepFormula::new(Scheme::Bdf2, &past, h);
        let star = s.blend(x(0.0), x(-h1));
        assert!((star + s.gamma * v(h) - x(h)).abs() < 1e-13);
    }

    #[test]
    fn the_error_constant_is_that_of_a_cubic() {
        let (h, h1, h2) = (0.3, 0.2, 0.15);
        let past = Past {
            known: 2,
            h: [h1, h2],
            ..Past::default()
        };
        let x = |t: f64| t * t * t;
        let w = extrapolation(h, &past);
        let guess = w[0] * x(0.0) + w[1] * x(-h1) + w[2] * x(-h1 - h2);
        let s = StepFormula::new(Scheme::Bdf2, &past, h);
        // x' = 3t^2 as the equation: the formula's own result
        let got = s.blend(x(0.0), x(-h1)) + s.gamma * 3.0 * h * h;
        let error = (got - x(h)).abs();
        assert!((s.error * (got - guess).abs() - error).abs() < 1e-13);
    }
}
