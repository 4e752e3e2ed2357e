//! A loop of wire that is drawn tight round a core until it has a tension: without friction or inertia, and how high it stands then.

use crate::contact::{ContactLaw, LineModel};
use crate::geometry::Surface;
use crate::integrate::{Implicit, Scheme};
use crate::math::{V3, polar_angle, scaled};
use crate::measure::{Profile, STATION_STEP, STATIONS_PER_TURN};
use crate::rod::{Bend, Hardening, Section};
use crate::scene::Scene;
use crate::simulation::winding::core_shape;
use crate::system::System;
use std::sync::Arc;

/// Node spacing of the loop, m, for wire of 0.7 mm; half of it moves the heights by 4 um.
pub(super) const SPACING: f64 = 0.4e-3;
/// Most edges of the loop: fine wire on a core a thousand times as wide has a coarser one.
pub(super) const MOST_EDGES: f64 = 2e4;

/// Axial softening of the loop; the strain at 15 N stays below half a percent.
const SOFTER: f64 = 10.0;

/// Largest share of its length by which the loop is drawn tight at a time.
const DRAW: f64 = 0.01;
/// Draws after which there is no yardstick.
const MOST_DRAWS: usize = 60;
/// Share of its bending moments that a limp loop begins with, and the factor by which it grows at first.
const LIMP: f64 = 0.01;
const STIFFER: f64 = 2.0;
/// Error of the tension, as a share of it.
const TENSION: f64 = 1e-2;

/// The wire of a loop: how far it stretches does not matter for its shape, and a softer one that cannot yield so settles sooner.
pub(super) fn loop_section(scene: &Scene) -> Section {
    Section {
        ea: scene.wire.ea / SOFTER,
        n_y: f64::INFINITY,
        ..scene.wire.clone()
    }
}

/// Lets a loop touch the core, without friction.
pub(super) fn touching_core(mut sys: System, scene: &Scene, surface: &Arc<Surface>) -> System {
    let law = ContactLaw {
        stiffness: scene.contact.stiffness,
        damping_ratio: 0.0,
        mu_static: 0.0,
        mu_kinetic: 0.0,
        slip_speed: scene.friction.slip_speed,
    };
    let shape = core_shape(&scene.core, surface);
    sys.touch_along(LineModel::new(shape, law, scene.wire.radius()));
    sys.refresh();
    sys
}

/// Draws a loop to this tension, N, by taking wire out evenly; a loose one gives way, a tight one stretches.
///
/// `tolerance` is the error of its place, m, for wire of 0.7 mm. A draw after which the loop finds no rest is taken back and tried by half.
pub(super) fn draw_tight(mut sys: System, tension: f64, tolerance: f64) -> Option<System> {
    let section = sys.model.section.clone();
    let tolerance = scaled(tolerance, section.diameter);
    let mut method = Implicit::new(Scheme::Bdf2, tolerance, 1e-9, 1.0);
    let mut stiffness = section.ea;
    let mut before: Option<(f64, f64)> = None;
    let mut drawn = 0.0;
    // the loop at its last rest, and the draw that was tried from there
    let mut rest: Option<(System, f64)> = None;
    for _ in 0..MOST_DRAWS {
        // loading is monotonic: the law is a nonlinear elastic one from the virgin wire, not one that
        // remembers how wide the loop once was
        sys.state.rod.bend.fill(Bend::default());
        if method.equilibrate(&mut sys).is_err() {
            let (good, tried) = rest.as_mut()?;
            drawn -= 0.5 * *tried;
            *tried *= 0.5;
            sys = good.clone();
            draw(&mut sys, *tried);
            continue;
        }
        let pull = sys.state.load.tension.iter().sum::<f64>() / sys.state.rod.edges() as f64;
        let missing = tension - pull;
        if missing.abs() < TENSION * tension {
            return Some(sys);
        }
        if let Some((d, p)) = before
            && (pull - p) / (drawn - d) > 0.0
        {
            stiffness = ((pull - p) / (drawn - d)).min(section.ea);
        }
        before = Some((drawn, pull));
        let share = (missing / stiffness).clamp(-DRAW, DRAW);
        drawn += share;
        rest = Some((sys.clone(), share));
        draw(&mut sys, share);
    }
    None
}

/// Takes a share of its length out of every edge.
fn draw(sys: &mut System, share: f64) {
    let lengths = sys.state.rod.rest.iter_mut();
    lengths.for_each(|l| *l *= 1.0 - share);
}

/// Lets a limp loop that lies on the core become as stiff as `section`, at this tension, N.
///
/// A step that is too large for the loop to find rest is halved.
pub(super) fn stiffened(
    mut sys: System,
    section: &Section,
    tension: f64,
    tolerance: f64,
) -> Option<System> {
    draw(&mut sys, tension / section.ea);
    let (mut share, mut factor) = (LIMP, STIFFER);
    let mut reached: Option<(System, f64)> = None;
    for _ in 0..MOST_DRAWS {
        sys.model.section = with_bending(section, share);
        sys.refresh();
        match draw_tight(sys, tension, tolerance) {
            Some(found) if share >= 1.0 => return Some(found),
            Some(found) => reached = Some((found, share)),
            None => factor = factor.sqrt(),
        }
        let (good, at) = reached.as_ref()?;
        sys = good.clone();
        share = (at * factor).min(1.0);
    }
    None
}

/// The section with this share of its moments at every curvature.
fn with_bending(section: &Section, share: f64) -> Section {
    Section {
        ei: share * section.ei,
        ei_p: share * section.ei_p,
        m_y: share * section.m_y,
        moment_cap: share * section.moment_cap,
        hardening: Hardening {
            bend: section.hardening.bend.map(|pieces| pieces.scaled(share)),
            ..section.hardening
        },
        ..section.clone()
    }
}

/// Polar angle, rad, and height over the core, m, of wire with its centreline at these points.
pub(super) fn heights(scene: &Scene, surface: &Surface, points: &[V3]) -> Vec<(f64, f64)> {
    let radius = scene.wire.radius();
    let height = |p: V3| match scene.core.may_have_flanges() {
        true => surface.height_over_flank(p),
        false => surface.nearest(p).distance,
    };
    let at = |p: &V3| (polar_angle(*p), height(*p) - radius);
    points.iter().map(at).collect()
}

/// The profile over a whole turn from angles and heights by rising angle; `folded` says where among them an angle is, rad.
pub(super) fn profile_of(known: &[(f64, f64)], folded: impl Fn(f64) -> f64) -> Option<Profile> {
    let at = |angle: f64| {
        let a = folded(angle);
        let k = known.partition_point(|q| q.0 < a).clamp(1, known.len() - 1);
        let (p, q) = (known[k - 1], known[k]);
        p.1 + (q.1 - p.1) * ((a - p.0) / (q.0 - p.0)).clamp(0.0, 1.0)
    };
    Profile::new(
        (0..STATIONS_PER_TURN)
            .map(|k| at(k as f64 * STATION_STEP))
            .collect(),
    )
}
