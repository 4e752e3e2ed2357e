//! Wire paid out through the nozzle against the tensioner.
//!
//! The last edge ends at the nozzle and grows. A tensioner of equivalent mass `m` pulls back with
//! the set force; between it and the nozzle lies an elastic line `k = EA / length` with a
//! dashpot. Line and last edge are in series and massless between them, so the unstretched
//! length that passes the nozzle in a step follows from equal forces. It is solved for implicitly: the
//! last edge is much stiffer than the dashpot's share, and an explicit law would cut the step.
//!
//! ```text
//! m s_t'' = T_line - T_set - c_t s_t'     T_line = k (x - s_t) + c (x' - s_t'),  never below zero
//! x = s - s_p                             s_p: by how much the line's wire has got longer for good
//! T_nozzle = T_line exp(mu_exit beta)   beta: deflection at the exit, paying out
//! ```
//!
//! A slack line cannot push: below zero the last edge is free of tension and the wire waits.
//!
//! The line's wire may have its mass, and a pulley may guide it: half of a span's mass goes to either end. The implicit
//! method knows both, as a [`Curve`] of tension over wire passed.

mod curve;
mod line_wire;
mod line_yield;

use crate::rod::Law;
pub use curve::{Curve, MOST_CORNERS};
pub use line_wire::LineWire;
pub use line_yield::LineYield;
use serde::{Deserialize, Serialize};

/// Update of the wire that passes, over the length of the last edge, below which it fits. Chosen: some thousand roundings.
const FITS: f64 = 2e-12;

/// Constants of the feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedSpec {
    /// equivalent mass, kg (0: the set force acts at the nozzle)
    pub mass: f64,
    /// damper of the tensioner, N s/m, beside that of [`Feed::damping`]
    pub damping: f64,
    /// line stiffness, N/m (infinite: the tensioner's mass sits at the nozzle)
    pub line_stiffness: f64,
    /// line dashpot, N s/m
    pub line_damping: f64,
    /// exit friction coefficient
    pub exit_friction: f64,
    /// curvature of the wire on the edge of the exit, 1/m (0: bending over it does not count)
    pub exit_curvature: f64,
    /// length of the line, m: that much wire is as tight as the line
    pub line_length: f64,
    /// mass of the line's wire, kg (0: it does not count); needs a tensioner with mass and a line of some length
    pub line_mass: f64,
    /// a pulley that guides the line; needs the same
    pub pulley: Option<Pulley>,
}

/// A pulley that guides the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulley {
    /// moment of inertia over the square of its radius, kg
    pub mass: f64,
    /// friction of its bearing, as a force on the wire, N
    pub friction: f64,
    /// share of the line between nozzle and pulley, above 0 and below 1
    pub share: f64,
}

/// A stretch of the line without anything on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// its stiffness, N/m
    pub stiffness: f64,
    /// its dashpot, N s/m
    pub damping: f64,
    /// half the mass of its wire, kg
    pub half_mass: f64,
}

impl FeedSpec {
    /// The set force acts at the nozzle: no mass, no line, no friction.
    #[cfg(any(test, feature = "lab"))]
    pub const DIRECT: Self = Self {
        mass: 0.0,
        damping: 0.0,
        line_stiffness: f64::INFINITY,
        line_damping: 0.0,
        exit_friction: 0.0,
        exit_curvature: 0.0,
        line_length: 0.0,
        line_mass: 0.0,
        pulley: None,
    };

    /// The part of the line that has this share of its length.
    pub fn span(&self, share: f64) -> Span {
        Span {
            stiffness: self.line_stiffness / share,
            damping: self.line_damping / share,
            half_mass: 0.5 * self.line_mass * share,
        }
    }

    /// Whether an elastic line lies between the nozzle and a tensioner with mass.
    pub fn has_spring(&self) -> bool {
        self.mass > 0.0 && self.line_stiffness.is_finite()
    }

    /// Whether the line has anything with mass or friction between nozzle and tensioner.
    pub fn has_chain(&self) -> bool {
        self.pulley.is_some() || self.line_mass > 0.0
    }
}

/// State of the feed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Feed {
    /// unstretched wire that has passed the nozzle, m
    pub fed: f64,
    /// its rate over the last step, m/s
    pub rate: f64,
    /// wire let go by the tensioner beyond what preloads the line, m
    pub paid: f64,
    /// its rate, m/s
    pub paid_rate: f64,
    /// wire that has come over the pulley beyond what preloads the span before it, m; of no meaning without a pulley
    pub guided: f64,
    /// its rate, m/s
    pub guided_rate: f64,
    /// by how much longer the line's wire is for good than at the start, m
    pub longer: f64,
    /// tension in the line at the nozzle, N
    pub line_tension: f64,
    /// tension in the span of line before the nozzle, N: that at the nozzle but for what speeds up the wire there
    pub span_tension: f64,
    /// damper that the machine adds to the tensioner's own, N s/m
    pub damping: f64,
}

/// A step of the feed, and the last edge in it.
#[derive(Clone, Copy, Debug)]
pub struct EdgeStep<'a> {
    /// length of the step, s
    pub dt: f64,
    /// the tensioner's pull, N
    pub set: f64,
    /// unstretched length of the edge before the step, m
    pub rest: f64,
    /// its length after the step, m
    pub length: f64,
    /// plastic stretch of the edge and of wire that comes out
    pub plastic: [f64; 2],
    /// angle at the exit, rad
    pub deflection: f64,
    /// how the line's wire yields
    pub yields: &'a LineYield,
}

impl Feed {
    /// At rest with the line loaded to `tension`.
    pub fn at_rest(spec: &FeedSpec, tension: f64) -> Self {
        // (without a spring the tensioner lets go what passes the nozzle)
        let paid = if spec.has_spring() {
            -tension / spec.line_stiffness
        } else {
            0.0
        };
        Self {
            fed: 0.0,
            rate: 0.0,
            paid,
            paid_rate: 0.0,
            guided: spec.pulley.map_or(0.0, |pulley| pulley.share * paid),
            guided_rate: 0.0,
            longer: 0.0,
            line_tension: tension,
            span_tension: tension,
            damping: 0.0,
        }
    }

    /// Takes `wire`, m, as passed everywhere, so that each span pulls as before.
    pub fn shift(&mut self, wire: f64) {
        self.fed += wire;
        self.paid += wire;
        self.guided += wire;
    }

    /// All dampers on the tensioner, N s/m.
    pub fn damping_on(&self, spec: &FeedSpec) -> f64 {
        spec.damping + self.damping
    }

    /// Advances by a step; returns the unstretched length added to the last edge, m.
    pub fn step(&mut self, spec: &FeedSpec, stretch: &Law, step: &EdgeStep) -> f64 {
        let &EdgeStep {
            set,
            dt,
            rest,
            length,
            plastic,
            deflection,
            yields,
        } = step;
        // friction at the exit holds back whichever way the wire moves
        let grip =
            libm::exp(spec.exit_friction * deflection * if self.rate >= 0.0 { 1.0 } else { -1.0 });
        let elastic_line = spec.has_spring();
        let damping = self.damping_on(spec);
        let line = |grown: f64| -> (f64, f64) {
            // line tension and its slope with the wire grown in this step
            let drag = damping / dt;
            if spec.mass == 0.0 {
                return (set + drag * grown, drag);
            }
            if !elastic_line {
                // mass at the nozzle, backward Euler
                let slope = spec.mass / (dt * dt);
                let inertia = slope * (grown - self.rate * dt);
                return (set + inertia + drag * grown, slope + drag);
            }
            // the tensioner moves by its momentum in this step
            let paid = self.paid + dt * self.paid_rate;
            let t = spec.line_stiffness * (self.fed - self.longer + grown - paid)
                + spec.line_damping * (grown / dt - self.paid_rate);
            if t > 0.0 {
                yields
                    .tension(t, spec.line_stiffness + spec.line_damping / dt)
                    .into()
            } else {
                (0.0, 0.0)
            }
        };
        // equal forces by Newton; both branches are monotonic, so the clamp at zero is harmless
        let mut grown = self.rate * dt;
        let mut tension = 0.0;
        for _ in 0..8 {
            let l = rest + grown;
            let passing = if grown > 0.0 { plastic[1] } else { plastic[0] };
            let set = (rest * plastic[0] + grown * passing) / l;
            let wire = stretch.modulus * (length / l - 1.0 - set);
            let (t, slope) = line(grown);
            tension = t;
            let residual = wire - grip * t;
            let step = residual / (stretch.modulus * length / (l * l) + grip * slope);
            grown += step;
            if step.abs() <= FITS * rest {
                break;
            }
        }
        self.fed += grown;
        self.rate = grown / dt;
        self.line_tension = tension;
        self.span_tension = tension;
        if elastic_line {
            self.longer += yields.longer(tension);
            self.paid += dt * self.paid_rate;
            self.paid_rate += dt * (tension - set) / spec.mass;
            self.paid_rate /= 1.0 + dt * damping / spec.mass;
        } else {
            self.paid = self.fed;
            self.paid_rate = self.rate;
        }
        grown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> Law {
        Law::new(48900.0, 1100.0, 38.5, f64::INFINITY)
    }

    fn spec() -> FeedSpec {
        let (m, k) = (1e-3, 97_800.0_f64);
        FeedSpec {
            mass: m,
            damping: 0.0,
            line_stiffness: k,
            line_damping: 0.2 * (k * m).sqrt(),
            exit_friction: 0.0,
            exit_curvature: 0.0,
            line_length: 0.5,
            line_mass: 0.0,
            pulley: None,
        }
    }

    /// Pulls the far end of the last edge away at `speed(t)` and returns the tensions seen.
    fn pull(spec: &FeedSpec, speed: impl Fn(f64) -> f64, end: f64, dt: f64) -> (Feed, Vec<f64>) {
        let l = law();
        let mut feed = Feed::at_rest(spec, 15.0);
        let mut rest = 1e-3;
        let mut length = rest * (1.0 + 15.0 / l.modulus);
        let mut seen = Vec::new();
        let mut t = 0.0;
        while t < end {
            length += speed(t) * dt;
            let step = EdgeStep {
                dt,
                set: 15.0,
                rest,
                length,
                plastic: [0.0; 2],
                deflection: 0.0,
                yields: &LineYield::default(),
            };
            rest += feed.step(spec, &l, &step);
            // keep the edge short: drop whole wire behind it at the same strain
            let drop = rest - 1e-3;
            rest -= drop;
            length -= drop * (1.0 + l.modulus.recip() * feed.line_tension);
            seen.push(feed.line_tension);
            t += dt;
        }
        (feed, seen)
    }

    #[test]
    fn steady_pull_settles_at_the_set_force() {
        let (feed, seen) = pull(&spec(), |_| 2.0, 0.05, 1e-6);
        assert!((seen.last().expect("steps were taken") - 15.0).abs() < 0.05);
        assert!((feed.rate - 2.0 / (1.0 + 15.0 / 48900.0)).abs() < 1e-3);
    }

    #[test]
    fn a_damper_adds_its_share_of_the_speed() {
        for (mass, line_stiffness) in [(0.0, 97_800.0), (1e-3, 97_800.0), (1e-3, f64::INFINITY)] {
            let s = FeedSpec {
                mass,
                damping: 2.0,
                line_stiffness,
                ..spec()
            };
            let (feed, seen) = pull(&s, |_| 2.0, 0.05, 1e-6);
            let last = seen.last().expect("steps were taken");
            let expected = 15.0 + s.damping * feed.rate;
            assert!((last - expected).abs() < 0.05, "{last} {expected}");
        }
    }

    #[test]
    fn line_rings_at_its_own_frequency() {
        // a velocity step v excites the mass on the line: stretch x with x(0) = 0, x'(0) = v
        let s = spec();
        let (v, dt) = (0.2, 1e-7);
        let (_, seen) = pull(&s, |_| v, 1e-3, dt);
        let w = (s.line_stiffness / s.mass).sqrt();
        let zeta: f64 = 0.1;
        let wd = w * (1.0 - zeta * zeta).sqrt();
        let scale = v * (s.line_stiffness * s.mass).sqrt();
        for k in (200..seen.len()).step_by(100) {
            let t = (k + 1) as f64 * dt;
            let exact = scale
                * (-zeta * w * t).exp()
                * (2.0 * zeta * (wd * t).cos()
                    + (1.0 - 2.0 * zeta * zeta) / (1.0 - zeta * zeta).sqrt() * (wd * t).sin());
            // the last edge's own compliance is 1/500 of the line's
            assert!(
                (seen[k] - 15.0 - exact).abs() < 0.01 * scale,
                "{k}: {} {exact}",
                seen[k] - 15.0
            );
        }
    }

    /// Stretched wire of the edge and virgin wire that comes out pull as hard as the line.
    #[test]
    fn virgin_wire_comes_out_behind_stretched_wire() {
        let (s, l) = (spec(), law());
        let (rest, plastic) = (1e-3, [0.02, 0.0]);
        for longer in [-1e-6, 1e-6] {
            let mut feed = Feed::at_rest(&s, 15.0);
            let length = rest * (1.02 + 15.0 / l.modulus) + longer;
            let step = EdgeStep {
                dt: 1e-6,
                set: 15.0,
                rest,
                length,
                plastic,
                deflection: 0.0,
                yields: &LineYield::default(),
            };
            let grown = feed.step(&s, &l, &step);
            let passing = if longer > 0.0 { 0.0 } else { 0.02 };
            let free = rest * 1.02 + grown * (1.0 + passing);
            let tension = l.modulus * (length - free) / (rest + grown);
            let line = feed.line_tension;
            // (the length that passes is solved for to 1e-15 m, and the edge is as stiff as 5e7 N/m)
            assert!((tension - line).abs() < 5e-8, "{tension} {line}");
            assert!(grown * longer > 0.0);
        }
    }

    #[test]
    fn sudden_stop_goes_slack_and_never_pushes() {
        let (_, seen) = pull(&spec(), |t| if t < 0.01 { 8.0 } else { 0.0 }, 0.02, 1e-6);
        assert!(seen.iter().all(|t| *t >= 0.0));
        assert!(seen.contains(&0.0), "8 m/s on 1 g must overrun 15 N");
    }

    #[test]
    fn massless_tensioner_is_a_constant_pull() {
        let s = FeedSpec {
            mass: 0.0,
            ..spec()
        };
        let (_, seen) = pull(&s, |t| 3.0 * (900.0 * t).sin(), 0.01, 1e-6);
        assert!(seen.iter().all(|t| (t - 15.0).abs() < 1e-12));
    }
}
