//! Elastic wire drawn round a cylinder: the ratio of its end forces while it slips.
//!
//! The wire lies in the x-z plane. A dead force holds one end; the other is drawn along +x and is
//! free across it. Both far-field directions are therefore exact whatever the legs do, and the wrap
//! is the angle between them. Ends carry no moment; legs are several bending lengths long.

use super::bench::{SmoothMean, Stepper, law, mesh, stable_step};
use super::{Answer, Answers, Context, VerifyError};
use crate::contact::{LineModel, NodalModel};
use crate::geometry::Shape;
use crate::geometry::generate::cylinder;
use crate::integrate::{Explicit, ExplicitMethod};
use crate::math::V3;
use crate::rod::Twist;
use crate::rod::{Rod, Section};
use crate::scene::Integrator;
use crate::system::{Support, System};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Edge length of the explicit method as a share of the bending length `sqrt(EI/F0)` and of the bend radius.
const SPACING: [f64; 2] = [0.25, 0.1];

/// Leg length in bending lengths of the slack side: end effects fall to e^-5.
const LEG: f64 = 5.0;

/// Depth under the slack side's load as a share of the radius in explicit steps; many sagittas of the facets.
const DEPTH: f64 = 1e-5;

/// Stiffness, N/m^2, and longest step, s, of a wind.
const STIFFNESS: f64 = 1e10;
const LONGEST: f64 = 0.1;

/// Facets of the cylinder.
pub(super) const FACETS: usize = 4096;

/// Parts of a time that the production method is told to stop at.
const PARTS: usize = 200;

/// Drawing speed as a share of the speed of transverse waves on the slack side.
const SPEED: f64 = 1e-2;

/// Length drawn before the mean is taken, as a share of the bend radius and of the wire's stretch.
const RUN_IN: f64 = 0.08;
/// Edge lengths over which the mean is taken; touches come and go once per edge.
const MEAN_EDGES: f64 = 3.0;
/// Difference of means one after the other below which the slip is steady, and means until then at most.
const STEADY: f64 = 0.01;
const READINGS: u32 = 6;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    ratio_on(ctx, |radius, r| match ctx.integrator {
        Integrator::Implicit => Ok(Shape::Cylinder {
            radius,
            half_y: 20.0 * r,
        }),
        _ => mesh(cylinder(radius, 40.0 * r, FACETS)).map(|core| Shape::Mesh(Arc::new(core))),
    })
}

/// Force ratio on what `drum(R, r)` makes for wire of radius r, m, whose centreline it bends to R + r.
pub(super) fn ratio_on(
    ctx: &Context,
    drum: impl FnOnce(f64, f64) -> Result<Shape, VerifyError>,
) -> Result<Answers, VerifyError> {
    let (mu, wrap) = (ctx.number("mu")?, ctx.positive("wrap_rad")?);
    let (radius, hold) = (ctx.positive("R_m")?, ctx.positive("F0_N")?);
    let section = ctx.elastic();
    let drum = drum(radius, section.radius())?;
    let mut capstan = Capstan::new(ctx, &section, mu, wrap, radius, hold, drum)?;
    capstan.settle()?;
    let ratio = capstan.draw()?;
    Ok(vec![("stiff_ratio", Answer::Number(ratio))])
}

/// How much more the largest is than the least, as a share; without end where one is no number.
fn spread(values: &[f64]) -> f64 {
    if !values.iter().all(|x| x.is_finite()) {
        return f64::INFINITY;
    }
    let of = |pick: fn(f64, f64) -> f64, start: f64| values.iter().copied().fold(start, pick);
    of(f64::max, f64::NEG_INFINITY) / of(f64::min, f64::INFINITY) - 1.0
}

struct Capstan {
    sys: System,
    step: Stepper,
    dt: f64,
    hold: f64,
    bend: f64,
    leg: f64,
    edge: f64,
    wave: f64,
}

impl Capstan {
    /// Wire on the path of a string, stretched by the holding force.
    fn new(
        ctx: &Context,
        section: &Section,
        mu: f64,
        wrap: f64,
        radius: f64,
        hold: f64,
        drum: Shape,
    ) -> Result<Self, VerifyError> {
        let bend = radius + section.radius();
        let bending = (section.ei / hold).sqrt();
        let leg = LEG * bending;
        let fit = (SPACING[0] * bending).min(SPACING[1] * bend);
        let edge = ctx.spacing.unwrap_or(fit);
        let total = 2.0 * leg + wrap * bend;
        let edges = ctx.few_enough((total / edge).ceil())?;
        let h = total / edges as f64;
        // node 0 at the held end; the arc runs from pi/2 + wrap down to pi/2
        let point = |s: f64| {
            let on = |a: f64| V3::new(libm::cos(a), 0.0, libm::sin(a)) * bend;
            let start = FRAC_PI_2 + wrap;
            let out = V3::new(-libm::sin(start), 0.0, libm::cos(start));
            if s < leg {
                on(start) + out * (leg - s)
            } else if s < total - leg {
                on(start - (s - leg) / bend)
            } else {
                on(FRAC_PI_2) + V3::x() * (s - total + leg)
            }
        };
        let points: Vec<V3> = (0..=edges).map(|i| point(h * i as f64)).collect();
        let stretch = 1.0 + hold / section.ea;
        let rest = points
            .windows(2)
            .map(|p| (p[1] - p[0]).norm() / stretch)
            .collect();
        let mut sys = System::new(section.clone(), Rod::through(&points, Some(rest)));
        // plane, so untwisted
        sys.model.twist = Twist::Off;
        let implicit = ctx.integrator == Integrator::Implicit;
        let stiffness = if implicit {
            STIFFNESS
        } else {
            hold / (bend * bend * DEPTH)
        };
        let law = law(stiffness, 1.0, mu);
        let r = section.radius();
        let wave = (hold / section.mass_per_length()).sqrt();
        let step = if implicit {
            let line = LineModel::new(drum, law, r);
            sys.touch_along(line);
            Stepper::implicit(ctx.tolerance, LONGEST)
        } else {
            let Shape::Mesh(surface) = drum else {
                return Err(VerifyError::NoAnswer(
                    "the explicit method wants a mesh".to_owned(),
                ));
            };
            sys.touch_at_nodes(NodalModel {
                surface,
                law,
                radius: r,
                diameter: section.diameter,
            });
            Stepper::Explicit(Explicit::new(ExplicitMethod::Verlet))
        };
        let start = FRAC_PI_2 + wrap;
        let out = V3::new(-libm::sin(start), 0.0, libm::cos(start));
        sys.model.loads.nodal = vec![(0, out * hold)];
        sys.state.support[1] = Support {
            hold: [true, false, false],
            point: points[edges],
            ..Support::free()
        };
        sys.refresh();
        Ok(Self {
            step,
            dt: stable_step(section, h, stiffness, false),
            wave,
            sys,
            hold,
            bend,
            leg,
            edge: h,
        })
    }

    /// Lets the legs find their shape under drag.
    fn settle(&mut self) -> Result<(), VerifyError> {
        let transit = self.leg / self.wave;
        self.sys.model.loads.drag = 4.0 / transit;
        self.step
            .through(&mut self.sys, 4.0 * transit, self.dt)
            .map(|_| ())
    }

    /// Draws the wire at constant speed until the force ratio is steady; its mean.
    fn draw(&mut self) -> Result<f64, VerifyError> {
        let speed = SPEED * self.wave;
        let last = self.sys.state.rod.nodes() - 1;
        let run_in = RUN_IN * self.bend / speed;
        let (steps, dt) = self.parts(run_in);
        for i in 0..steps {
            // a sudden start would be a blow; drag fades out to where it takes nothing off
            let s = (i as f64 + 1.0) / steps as f64;
            self.sys.state.support[1].velocity.x = speed * (10.0 * s).min(1.0);
            self.sys.model.loads.drag = (1.0 - s) * self.wave / self.leg;
            self.step.through(&mut self.sys, dt, dt)?;
        }
        self.sys.model.loads.drag = 0.0;
        let mut means: Vec<f64> = Vec::new();
        for reading in 0..READINGS {
            // twice as long each time: in a longer one touches that come and go count for less
            let edges = MEAN_EDGES * (1 << (reading / 2)) as f64;
            let (steps, dt) = self.parts(edges * self.edge / speed);
            let mut mean = SmoothMean::over(steps);
            for _ in 0..steps {
                self.step.through(&mut self.sys, dt, dt)?;
                mean.add(-self.sys.state.load.force[last].x / self.hold);
            }
            means.push(mean.value());
            // (two alike at once are steady; two among others may be alike by chance, or creep)
            let last = match means.len() {
                0..=2 => &means[..],
                count => &means[count - 3..],
            };
            if last.len() > 1 && spread(last) < STEADY {
                return Ok(last.iter().sum::<f64>() / last.len() as f64);
            }
        }
        let told: Vec<String> = means.iter().map(|mean| format!("{mean:.4}")).collect();
        Err(VerifyError::NoAnswer(format!(
            "no steady slip: force ratios {} one after the other",
            told.join(", ")
        )))
    }

    /// Parts of a time after which loads change and readings are taken: explicit steps, or enough for
    /// the production method to choose its own in between.
    fn parts(&self, time: f64) -> (usize, f64) {
        match self.step {
            Stepper::Explicit(_) => ((time / self.dt) as usize, self.dt),
            Stepper::Implicit(_) => (PARTS, time / PARTS as f64),
        }
    }
}
