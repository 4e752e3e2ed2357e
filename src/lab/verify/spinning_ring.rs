//! A turn of wire on a turning core: hoop tension when free, load on the core, lift-off.
//!
//! The ring is one full turn of rod. Its ends meet in a clamp that turns with the core, each at
//! half a joint, so that the clamp does not act on a free ring. On the core the hoop tension is held by the feed
//! (a tensioner without mass lets the last edge grow), not the length.
//!
//! Explicit steps are Runge-Kutta's: the velocities of the staggered step are half a step old, and in a
//! turning frame the contact dashpot takes that for an approach at `omega^2 R dt / 2`.

use super::bench::{SmoothMean, Stepper, law, mesh, stable_step, touch_forces};
use super::{Answer, Answers, Context, VerifyError};
use crate::contact::{LineModel, NodalModel};
use crate::feed::{Feed, FeedSpec};
use crate::geometry::Shape;
use crate::geometry::generate::cylinder;
use crate::integrate::{Explicit, ExplicitMethod};
use crate::math::frame_along;
use crate::math::{V3, spin_velocity};
use crate::rod::Twist;
use crate::rod::{Rod, Section};
use crate::scene::Integrator;
use crate::system::{ContactModel, Spindle, Support, System};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Edges of the ring. Node forces balance as on the circle for any number.
const EDGES: usize = 48;

/// Stiffness, N/m^2, and longest step, s, of a wind; breaths between two looks at it.
const STIFFNESS: f64 = 1e10;
const LONGEST: f64 = 0.1;
const LOOK: f64 = 1.0;

/// Facets of the cylinder per edge. Nodes sit in the middle of a facet, where its normal is radial.
const FACETS: usize = 21;

/// Breaths of the ring over which a load is averaged: the one asked for, those of the search.
const ASKED: f64 = 50.0;
const SEARCH: f64 = 25.0;

/// Share of the lift-off speed at which the wire must still touch, only just. Any closer and the swing
/// about the clamp that the start sets off leaves and strikes the core.
const JUST_BELOW: f64 = 0.97;

/// Contact frequency over the highest axial one in explicit steps.
///
/// A turning ring is no state of rest for the step, and a stiffer spring makes an error of 1 %.
const SOFTNESS: f64 = 0.3;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (omega, radius) = (ctx.number("omega_rad_per_s")?, ctx.positive("R_m")?);
    let pull = ctx.positive("T0_N")?;
    let section = ctx.elastic();
    ctx.few_enough(edges(ctx, radius) as f64)?;
    let wound = Wound::settled(ctx, &section, radius, pull)?;
    let load = wound.load_at(omega, ASKED)?;
    // towards lift-off along the measured loads, which are close to linear in the squared speed
    let rest = (0.0, wound.load_at(0.0, SEARCH)?);
    let mut near = (omega * omega, load);
    for _ in 0..40 {
        if near.1 < 0.6 * rest.1 {
            break;
        }
        // a fall of a twentieth says that at least nineteen are left
        near.0 *= if near.1 > 0.95 * rest.1 { 8.0 } else { 1.5 };
        near.1 = wound.load_at(near.0.sqrt(), SEARCH)?;
    }
    let zero = |near: (f64, f64)| near.0 * rest.1 / (rest.1 - near.1);
    // closer, tension waves of the start would take the wire off for moments
    for share in [0.7, 0.9] {
        let square = share * zero(near);
        if square.is_nan() || square <= 0.0 {
            return Err(VerifyError::NoAnswer(
                "the load does not fall with speed".to_owned(),
            ));
        }
        near = (square, wound.load_at(square.sqrt(), SEARCH)?);
    }
    let liftoff = zero(near).sqrt();
    // the wire itself must agree: hardly loaded just below. (Above, it swings about the one point
    // that is held, and strikes the core now and then.)
    let left = wound.load_at(JUST_BELOW * liftoff, SEARCH)? / rest.1;
    let expected = 1.0 - JUST_BELOW * JUST_BELOW;
    if !(0.3 * expected..2.0 * expected).contains(&left) {
        return Err(VerifyError::NoAnswer(format!(
            "the wire does not leave the core at {liftoff} rad/s: {left} of its load is left"
        )));
    }
    Ok(vec![
        (
            "hoop_tension_free_ring_N",
            Answer::Number(free_tension(ctx, &section, radius, omega)?),
        ),
        ("contact_load_N_per_m", Answer::Number(load)),
        ("liftoff_speed_rad_per_s", Answer::Number(liftoff)),
    ])
}

/// Edges of a ring of this radius.
fn edges(ctx: &Context, radius: f64) -> usize {
    match (ctx.integrator, ctx.spacing) {
        (Integrator::Implicit, Some(spacing)) => {
            4 * (0.25 * TAU * radius / spacing).ceil() as usize
        }
        _ => EDGES,
    }
}

/// One turn of rod of centreline radius `radius`, stretched to `pull`, clamped where it closes.
fn ring(ctx: &Context, section: &Section, radius: f64, pull: f64) -> System {
    let edges = edges(ctx, radius);
    let at = |i: usize| {
        let a = TAU * ((i % edges) as f64 + 0.5 / FACETS as f64) / edges as f64;
        V3::new(libm::cos(a), 0.0, libm::sin(a)) * radius
    };
    let points: Vec<V3> = (0..=edges).map(at).collect();
    let stretch = 1.0 + pull / section.ea;
    let rest = points
        .windows(2)
        .map(|p| (p[1] - p[0]).norm() / stretch)
        .collect();
    let rod = Rod::through(&points, Some(rest));
    let frames = [rod.frame[0], rod.frame[edges - 1]];
    let along = V3::y().cross(&points[0]).normalize() * -1.0;
    let mut sys = System::new(section.clone(), rod);
    for end in 0..2 {
        sys.state.support[end] = Support {
            turning: true,
            ..Support::clamped(points[0], frame_along(&along, Some(&frames[end])))
        };
    }
    // a plane ring carries no twist
    sys.model.twist = Twist::Off;
    sys
}

/// Turns with the core at `omega` from now on.
fn spin(sys: &mut System, omega: f64) {
    sys.state.spindle = Spindle {
        angle: 0.0,
        speed: omega,
        acceleration: 0.0,
    };
    for i in 0..sys.state.rod.nodes() {
        sys.state.rod.v[i] += spin_velocity(omega, sys.state.rod.x[i]);
    }
    sys.place_supports();
    // what was before says nothing about what comes
    sys.state.past.forget();
    sys.refresh();
}

/// Time in which a ring breathes in and out, s.
fn breath(section: &Section, radius: f64) -> f64 {
    TAU * radius * (section.mass_per_length() / section.ea).sqrt()
}

/// Mean hoop tension of a ring that turns with nothing to hold it, N.
fn free_tension(
    ctx: &Context,
    section: &Section,
    radius: f64,
    omega: f64,
) -> Result<f64, VerifyError> {
    let mut sys = ring(ctx, section, radius, 0.0);
    spin(&mut sys, omega);
    let breath = breath(section, radius);
    let (mut step, dt) = stepper(ctx, breath, || {
        stable_step(section, sys.state.rod.rest[0], 0.0, false)
    });
    let steps = (200.0 * breath / dt) as usize;
    let mut mean = SmoothMean::over(steps);
    for _ in 0..steps {
        step.through(&mut sys, dt, dt)?;
        mean.add(sys.state.load.tension[sys.state.rod.edges() / 2]);
    }
    Ok(mean.value())
}

/// How to step, and the step.
fn stepper(ctx: &Context, breath: f64, stable: impl Fn() -> f64) -> (Stepper, f64) {
    if ctx.integrator != Integrator::Implicit {
        return (
            Stepper::Explicit(Explicit::new(ExplicitMethod::Rk4)),
            stable(),
        );
    }
    (Stepper::implicit(ctx.tolerance, LONGEST), LOOK * breath)
}

/// A ring at rest on its core.
struct Wound<'a> {
    ctx: &'a Context<'a>,
    sys: System,
    dt: f64,
    breath: f64,
}

impl<'a> Wound<'a> {
    /// Under hoop tension `pull`.
    fn settled(
        ctx: &'a Context<'a>,
        section: &Section,
        radius: f64,
        pull: f64,
    ) -> Result<Self, VerifyError> {
        let r = section.radius();
        let implicit = ctx.integrator == Integrator::Implicit;
        // the spline, which touches, is the ring; its nodes lie outside
        let outer = if implicit {
            radius / libm::cos(0.5 * TAU / edges(ctx, radius) as f64)
        } else {
            radius
        };
        let mut sys = ring(ctx, section, outer, pull);
        let edge = sys.state.rod.rest[0];
        let stiffness = if implicit {
            STIFFNESS
        } else {
            4.0 * section.ea * (SOFTNESS / edge).powi(2)
        };
        let law = law(stiffness, 1.0, 0.0);
        // the ring must not shrink onto its core
        if implicit {
            let core = Shape::Cylinder {
                radius: radius - r,
                half_y: 10.0 * r,
            };
            sys.touch_along(LineModel::new(core, law, r));
        } else {
            // the middles of the facets on the circle
            let flat = libm::cos(0.5 * TAU / (EDGES * FACETS) as f64);
            let core = mesh(cylinder((radius - r) / flat, 20.0 * r, EDGES * FACETS))?;
            let core = Arc::new(core);
            sys.touch_at_nodes(NodalModel {
                surface: core,
                law,
                radius: r,
                diameter: section.diameter,
            });
        }
        let spec = FeedSpec::DIRECT;
        sys.set_feed(spec, Feed::at_rest(&spec, pull));
        sys.state.set_tension = pull;
        let breath = breath(section, radius);
        let (mut step, dt) = stepper(ctx, breath, || stable_step(section, edge, stiffness, false));
        sys.model.loads.drag = 4.0 / breath;
        sys.refresh();
        step.through(&mut sys, 20.0 * breath, dt)?;
        sys.model.loads.drag = 0.0;
        Ok(Self {
            ctx,
            sys,
            dt,
            breath,
        })
    }

    /// Mean load per length on the core at `omega`, away from the clamp, over so many breaths, N/m.
    ///
    /// The tensioner is set such that the wanted tension acts away from the clamp, not at the last
    /// edge. The clamp does not grow with the ring, and bending beside it takes up some tension.
    fn load_at(&self, omega: f64, breaths: f64) -> Result<f64, VerifyError> {
        let steps = (breaths * self.breath / self.dt) as usize;
        let wanted = self.sys.state.set_tension;
        let mut set = wanted;
        let mut answer = 0.0;
        for _ in 0..2 {
            let mut sys = self.sys.clone();
            sys.state.set_tension = set;
            spin(&mut sys, omega);
            let (mut step, dt) = stepper(self.ctx, self.breath, || self.dt);
            let mut load = SmoothMean::over(steps);
            let mut tension = SmoothMean::over(steps);
            for _ in 0..steps {
                step.through(&mut sys, dt, dt)?;
                load.add(line_load(&sys));
                let edges = sys.state.rod.edges();
                let measured = &sys.state.load.tension[edges / 4..edges * 3 / 4];
                tension.add(measured.iter().sum::<f64>() / measured.len() as f64);
            }
            answer = load.value();
            set += wanted - tension.value();
        }
        Ok(answer)
    }
}

/// Contact force per length over the half of the ring opposite the clamp, N/m.
fn line_load(sys: &System) -> f64 {
    let (mut force, mut length) = (0.0, 0.0);
    let half = sys.state.rod.edges() / 4..=sys.state.rod.edges() * 3 / 4;
    if sys.model.contact.is_line() {
        for i in half {
            force += touch_forces(sys, i).iter().map(V3::norm).sum::<f64>();
            length += sys.state.rod.rest[i];
        }
        return force / length;
    }
    let (ContactModel::Nodal(model), Some(nodal)) =
        (&sys.model.contact, sys.state.contact.as_nodal())
    else {
        return 0.0;
    };
    let at_rest = V3::zeros();
    for i in half {
        let (l, m) = (
            sys.state.rod.voronoi(i),
            sys.state.rod.mass(&sys.model.section, i),
        );
        let depth = nodal.nodes[i].depth();
        if depth > 0.0 {
            force += model
                .law
                .force(V3::x(), depth, at_rest, at_rest, l, m)
                .force
                .x;
        }
        length += l;
    }
    force / length
}
