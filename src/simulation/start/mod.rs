//! The state at the start: wire clamped at mid-face, straight to the nozzle, at the set tension.

mod clamp_place;
mod straight_wire;

use crate::contact::{ContactLaw, LineModel, NodalModel, damping_for_restitution};
use crate::feed::{Feed, FeedSpec, LineWire, Pulley};
use crate::geometry::Surface;
use crate::integrate::{
    Explicit, ExplicitMethod, Implicit, Scheme, Stepper, highest_frequency, longest_step,
};
use crate::math::frame_along;
use crate::math::polar_angle;
use crate::math::turn_about_y;
use crate::math::{Spin, V3};
use crate::measure::{Coil, CoilSpec, Crossover};
use crate::rod::{Rod, Scalar, Section};
use crate::scene::{Core, Integrator, Scene, si};
use crate::signals::{EventKind, Inputs, Outputs};
use crate::simulation::motion::{beside_clamp, check_finite, nozzle_of};
use crate::simulation::remesh::shortest_edge;
use crate::simulation::winding::{
    FreezePolicy, OlderWire, RunState, Throughput, Traverse, Watch, core_flanges, core_shape,
    core_surface,
};
use crate::simulation::{MotionProfile, SimError, Winding};
use crate::system::{Spindle, Support, System};
use clamp_place::half_width;
use std::f64::consts::TAU;
use std::sync::Arc;
use straight_wire::{check_way, clear_angle};

/// What is left of the wire's mass where its inertia is left out: enough to keep a slack wire's motion unique.
const MASSLESS: f64 = 1e-6;

/// Shortest, first and longest step of the implicit method, in times that a wave along the wire takes for a diameter: 0.2 us
/// in the default wire. Chosen: a step of a nanosecond resolves any contact, and what fails there fails for another reason; a
/// tenth of a second is longer than any motion of a wire takes.
const STEPS: [f64; 3] = [0.005, 50.0, 5e5];

/// Turns from which on a run goes on after its planned layers. Chosen: a turn. Wire has to be wound after the last one until that comes
/// to rest, half a turn or more.
pub(super) const WOUND_AFTER: f64 = 1.0;

/// Straight wire before the first step: where it is clamped, where it leaves the nozzle, and how the core is turned.
struct FirstSpan {
    /// lab frame, m
    nozzle: V3,
    /// core frame, m
    clamp: V3,
    /// angle of the core, rad
    angle: f64,
    /// +1 or -1 as in [`CoilSpec::direction`]
    direction: f64,
    /// what is told of the way of the wire
    told: Option<String>,
}

impl FirstSpan {
    /// The core begins turned towards the nozzle, the way round on which its spindle lays wire.
    fn new(scene: &Scene, inputs: &Inputs, surface: &Surface) -> Result<Self, SimError> {
        let radius = scene.wire.radius();
        let half = half_width(scene, surface)?;
        let nozzle = nozzle_of(scene, inputs);
        let distance = libm::hypot(nozzle.x, nozzle.z);
        if surface.radius_max() + radius >= distance {
            let set = match (inputs.nozzle_offset_x, inputs.nozzle_offset_z) {
                (0.0, 0.0) => "nozzle.distance",
                _ => "nozzle.distance with nozzle_offset_x and nozzle_offset_z",
            };
            return Err(SimError::setup(format!(
                "{set} = {} m lies inside the circle of radius {} m that the core sweeps; allowed: more than that radius",
                si(distance),
                si(surface.radius_max() + radius)
            )));
        }
        let aside = libm::atan2(-nozzle.z, nozzle.x);
        let turned = crate::settings::Start::core_angle(half, radius, distance);
        let clamp = V3::new(half + radius, scene.start.clamp_y, 0.0);
        let direction = scene.spindle.sense_from(inputs.spindle_speed);
        let angle = match &scene.core {
            Core::Mesh { .. } => clear_angle(scene, surface, (clamp, nozzle), |back| {
                aside + direction * (turned - back)
            }),
            _ => aside + direction * turned,
        };
        let told = check_way(scene, surface, (clamp, nozzle), angle)?;
        Ok(Self {
            nozzle,
            clamp,
            angle,
            direction,
            told,
        })
    }
}

/// Builds the system at rest and an empty coil round the first span.
fn wound_from(
    scene: &Scene,
    inputs: &Inputs,
    surface: Arc<Surface>,
    span: &FirstSpan,
) -> (System, Coil) {
    let mut sys = strung(scene, &surface, span, inputs.tension_setpoint);
    let feed = feed_spec(scene, &sys.model.section);
    sys.set_feed(feed, Feed::at_rest(&feed, inputs.tension_setpoint));
    sys.damp_tensioner(inputs.tensioner_damping);
    touch(&mut sys, scene, &surface);
    let tension = yardstick_tension(scene, inputs);
    let coil = Coil::new(CoilSpec {
        diameter: scene.wire.diameter,
        limits: scene.defects,
        profile: crate::simulation::quasi_static::profile(scene, &surface, tension),
        tension,
        jumps: scene.nozzle_law.jumps().into(),
        full: scene.nozzle_law.full(),
        planned: planned_end(scene),
        layer_starts: scene.nozzle_law.layer_starts().into(),
        crossover: (scene.nozzle_law.crossover()).map(|[step, angle]| Crossover { step, angle }),
        start_angle: polar_angle(span.clamp),
        direction: span.direction,
        traverse: scene.nozzle_law.sense(),
        clamp_arc: 0.0,
        corner_angle: corner_angle(&scene.core),
    });
    sys.model.core = Some(surface);
    sys.model.twist = scene.solver.twist;
    (sys, coil)
}

/// Wire under this tension (N) along the first span, with nothing to touch and no feed.
fn strung(scene: &Scene, surface: &Surface, span: &FirstSpan, tension: f64) -> System {
    let mut section = scene.wire.clone();
    if !scene.solver.features.inertia {
        section.density *= MASSLESS;
        section.enamel_density *= MASSLESS;
    }
    let clamp = Spin::new(span.angle).to_lab(span.clamp);
    let points = line_of_nodes(scene, surface, clamp, span.nozzle, span.angle);
    let plastic = stretch_at(&section, tension);
    let stretch = 1.0 + tension / section.ea + plastic.strain;
    let rest = points
        .windows(2)
        .map(|p| (p[1] - p[0]).norm() / stretch)
        .collect();
    let mut rod = Rod::through(&points, Some(rest));
    rod.stretch.iter_mut().for_each(|s| *s = plastic);
    let direction = (span.nozzle - clamp).normalize();
    let frame = turn_about_y(-span.angle) * frame_along(&direction, Some(&rod.frame[0]));
    let mut sys = System::new(section, rod);
    sys.state.spindle = Spindle {
        angle: span.angle,
        speed: 0.0,
        acceleration: 0.0,
    };
    sys.state.support[0] = Support {
        hold: [true; 3],
        point: span.clamp,
        velocity: V3::zeros(),
        frame: Some(frame),
        turning: true,
    };
    sys.state.support[1] = Support::pinned(span.nozzle);
    sys.state.set_tension = tension;
    sys.state.line_wire = LineWire::at_rest(plastic);
    sys
}

/// Tensioner, line and nozzle of the scene.
fn feed_spec(scene: &Scene, section: &Section) -> FeedSpec {
    let t = scene.tensioner;
    let line_stiffness = if t.line_length > 0.0 {
        section.ea / t.line_length
    } else {
        f64::INFINITY
    };
    FeedSpec {
        mass: t.mass,
        damping: t.damping,
        line_stiffness,
        line_damping: if line_stiffness.is_finite() {
            2.0 * t.line_damping_ratio * (line_stiffness * t.mass).sqrt()
        } else {
            0.0
        },
        exit_friction: scene.nozzle.exit_friction,
        exit_curvature: scene.nozzle.exit_curvature(section.radius()),
        line_length: t.line_length,
        line_mass: if t.line_inertia {
            section.mass_per_length() * t.line_length
        } else {
            0.0
        },
        pulley: t.has_pulley().then_some(Pulley {
            mass: t.pulley_mass,
            friction: t.pulley_friction,
            share: t.pulley_place,
        }),
    }
}

/// Lets the wire touch core, flanges and laid wire, along its length or, with an explicit method, at its nodes.
fn touch(sys: &mut System, scene: &Scene, surface: &Arc<Surface>) {
    let radius = scene.wire.radius();
    let law = ContactLaw {
        stiffness: scene.contact.stiffness,
        damping_ratio: damping_for_restitution(scene.contact.restitution),
        mu_static: scene.friction.static_,
        mu_kinetic: scene.friction.kinetic,
        slip_speed: scene.friction.slip_speed,
    };
    if scene.solver.integrator.is_implicit() {
        let shape = core_shape(&scene.core, surface);
        sys.touch_along(LineModel {
            flanges: core_flanges(&scene.core),
            restitution: scene.contact.restitution,
            ..LineModel::new(shape, law, radius)
        });
    } else {
        sys.touch_at_nodes(NodalModel {
            surface: surface.clone(),
            law,
            radius,
            diameter: scene.wire.diameter,
        });
    }
}

/// Tension that coils are judged by, N: that of the scene, or that at the start where it is more. Wire that is wound looser than
/// the scene has it stands off more than it should. A scene that leaves its tension to the input has that at the start.
fn yardstick_tension(scene: &Scene, inputs: &Inputs) -> f64 {
    match inputs.tension_setpoint {
        start if start > 0.0 && !scene.tension_given => start,
        start => start.max(scene.tensioner.tension),
    }
}

/// Winding angle at which the planned layers end, rad, where the run ends with them: what is wound after them lies on the last one.
fn planned_end(scene: &Scene) -> Option<f64> {
    let ends_with = |turns: &f64| scene.spindle.turns < turns + WOUND_AFTER;
    scene
        .nozzle_law
        .held()
        .filter(ends_with)
        .map(|turns| turns * TAU)
}

/// Polar angle of the corner between the faces on +x and +z, rad.
fn corner_angle(core: &Core) -> f64 {
    match core {
        Core::RoundedBox {
            width_x, height_z, ..
        } => libm::atan2(*height_z, *width_x),
        Core::Cylinder { .. } | Core::Mesh { .. } => std::f64::consts::FRAC_PI_4,
    }
}

/// Plastic stretch that belongs to a tension above yield.
fn stretch_at(section: &Section, tension: f64) -> Scalar {
    let law = crate::rod::Laws::new(section).stretch;
    let over = tension - law.limit;
    if over <= 0.0 {
        return Scalar::default();
    }
    // on the loading branch: force = limit + H * plastic strain
    Scalar {
        strain: over / law.hardening,
        rise: over,
    }
}

/// Nodes on the straight line: near spacing by the core, free spacing beyond, and an edge of at
/// least one free spacing at the nozzle.
fn line_of_nodes(scene: &Scene, surface: &Surface, clamp: V3, nozzle: V3, angle: f64) -> Vec<V3> {
    let s = scene.solver;
    let spin = Spin::new(angle);
    let length = (nozzle - clamp).norm();
    let t = (nozzle - clamp) / length;
    let near_reach = s.refine_distance + scene.wire.radius();
    let mut at = 0.0;
    let mut points = vec![clamp];
    loop {
        let near = surface.nearest(spin.to_core(clamp + t * at)).distance < near_reach;
        let h = if near { s.spacing_near } else { s.spacing_free };
        if length - at - h < s.spacing_free {
            break;
        }
        at += h;
        points.push(clamp + t * at);
    }
    points.push(nozzle);
    points
}

impl Winding {
    /// Wire clamped to the core and straight to the nozzle at the set tension, everything at rest.
    pub(super) fn new(scene: &Scene) -> Result<Self, SimError> {
        Self::starting_with(scene, scene.start_inputs())
    }

    /// The same with these inputs at the start.
    pub(super) fn starting_with(scene: &Scene, inputs: Inputs) -> Result<Self, SimError> {
        check_finite(&inputs, 0.0)?;
        let surface = Arc::new(core_surface(scene)?);
        let span = FirstSpan::new(scene, &inputs, &surface)?;
        let (mut sys, coil) = wound_from(scene, &inputs, surface, &span);
        let (stepper, last_step) = stepper_for(scene)?;
        sys.refresh();
        sys.state.balance.initial = sys.stored() + sys.kinetic();
        let rest = &sys.state.rod.rest;
        let policy = FreezePolicy::of(scene, rest.iter().sum(), inputs.tension_setpoint);
        let run = RunState {
            watch: Watch::new(sys.state.rod.nodes(), sys.state.spindle.angle),
            policy,
            angle0: span.angle,
            last_step,
            acceleration: 0.0,
            time: 0.0,
            time_lost: 0.0,
            owed: 0.0,
            steps: 0,
            work: 0,
            outputs: Outputs::default(),
            rates: Outputs::default(),
            events: Vec::new(),
            rest_depth: 0.0,
            over: false,
            throughput: Throughput::default(),
            doubt: None,
            told_tighter: false,
            told_over: false,
            was_slack: false,
            slack_since: None,
            faults: Vec::new(),
            told_turns: 0,
            told_defects: Vec::new(),
            laid: 0.0,
            slipped: None,
            slack_at: None,
            quiet: 0.0,
            paid0: sys.state.feed.map_or(0.0, |feed| feed.paid),
            farthest: 0.0,
            traverse: Traverse::new(inputs.nozzle_position),
            nozzle_by_law: false,
            yardstick_tension: yardstick_tension(scene, &inputs),
        };
        let ends = winding_ends(scene, &sys);
        let mut sim = Self {
            scene: scene.clone(),
            motion_profile: MotionProfile::new(scene),
            sys,
            coil: Arc::new(coil),
            stepper,
            run,
            behind: Vec::new(),
            older_wire: OlderWire::default(),
            ends,
            most_work: u64::MAX,
            stop: None,
            #[cfg(feature = "lab")]
            trail: None,
        };
        sim.sys.state.spindle.speed = inputs.spindle_speed;
        sim.sys.place_supports();
        sim.reset_extremes();
        sim.update_outputs();
        let beside = beside_clamp(scene, span.nozzle.y);
        for text in span.told.into_iter().chain(beside) {
            sim.report(EventKind::Judgement, text);
        }
        if let Some((kind, text)) = sim.doubt_about_bulge() {
            sim.report(kind, text);
        }
        Ok(sim)
    }
}

/// Where wire can be wound along y, m: between the flanges that the scene or the mesh has, or up to the ends of the core.
fn winding_ends(scene: &Scene, sys: &System) -> [f64; 2] {
    let faces = scene.window.and_then(|window| window.faces);
    match (faces, &sys.model.core) {
        (Some(faces), _) => faces,
        (None, Some(surface)) => {
            let (low, high) = surface.bounds();
            [low.y, high.y]
        }
        (None, None) => [f64::MIN, f64::MAX],
    }
}

/// The method that a scene asks for, and the longest step of an explicit one on its wire, s.
fn stepper_for(scene: &Scene) -> Result<(Stepper, f64), SimError> {
    let solver = scene.solver;
    let method = match solver.integrator {
        Integrator::Rk4 => Some(ExplicitMethod::Rk4),
        Integrator::Verlet => Some(ExplicitMethod::Verlet),
        Integrator::Implicit => None,
    };
    let spacing = shortest_edge(&solver);
    let contact = scene.contact.stiffness;
    let twist = solver.twist.is_carried();
    let frequency = highest_frequency(&scene.wire, spacing, contact, twist);
    let damping = damping_for_restitution(scene.contact.restitution);
    let limit = method.unwrap_or(ExplicitMethod::Verlet).limit();
    let stable = longest_step(limit, frequency, damping, contact, &scene.wire);
    let longest = if solver.step > 0.0 {
        solver.step
    } else {
        stable * solver.step_share
    };
    let Some(method) = method else {
        let wave = (scene.wire.ea / scene.wire.mass_per_length()).sqrt();
        let [shortest, first, most] = STEPS.map(|share| share * (scene.wire.bare_diameter / wave));
        let mut method = Implicit::new(Scheme::Bdf2, solver.tolerance, shortest, most);
        method.next = first;
        method.fixed = (solver.step > 0.0).then_some(solver.step);
        return Ok((Stepper::Implicit(Box::new(method)), longest));
    };
    if longest > stable {
        return Err(SimError::setup(format!(
            "solver.step = {:.4e} s is too long for the explicit method: the limit of this wire at {} mm spacing is {:.4e} s; set 0 to take the step from the limit",
            solver.step,
            spacing * 1e3,
            stable
        )));
    }
    let method = Explicit::new(method);
    Ok((Stepper::Explicit { method, longest }, longest))
}
