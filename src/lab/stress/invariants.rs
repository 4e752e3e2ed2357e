//! Runs a case and judges it at every communication point.

use super::{Case, Invariant, Measures, Outcome, Verdict};
use crate::math::{Spin, V3};
use crate::math::{polar_angle, wrap_to_pi};
use crate::scene::{Core, Scene};
use crate::signals::EventKind;
use crate::simulation::{SimError, Simulation};
use std::f64::consts::{PI, TAU};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Energy that the balance may leave unexplained, as a share of the energy that went through it.
///
/// The work that draws in a diameter of wire is added to that energy, because it is near 0 in the
/// first steps of a run.
const ENERGY: f64 = 0.05;
/// Centreline may be deeper in the core than its contact says by this share of the diameter: it is
/// looked at between the points that touch.
const SUNK: f64 = 0.3;
/// Wire may be deeper in wire than its contact says by this share of the diameter.
const CROSSED: f64 = 0.5;
/// Friction may be above its limit by this share: rounding, and a node put in or taken out since.
const CONE: f64 = 1e-2;
/// Wire that is there may differ from what was fed by this share: rounding of sums; ...
const LENGTH: f64 = 1e-9;
/// ... and so much of it may have gone where arcs became chords, node by node.
const JOINED: f64 = 2e-4;
/// Steps tried that are enough for a turn, and half of them for the start or a stop, which turn nothing; ...
const STEPS_PER_TURN: f64 = 30_000.0;
/// ... with so many nodes (more nodes, fewer steps: the bound is on the work).
const NODES: f64 = 200.0;
/// Communication points between looks at every frozen node.
const LOOK: usize = 16;

/// Runs a case whose mesh, if it has one, is on disk.
pub fn judge(case: &Case) -> Verdict {
    let mut measures = Measures::default();
    let run = catch_unwind(AssertUnwindSafe(|| wind(case, &mut measures)));
    let outcome = run.unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or(panic.downcast_ref::<&str>().copied());
        Outcome::Invariant {
            time: measures.time,
            what: Invariant::Panic,
            text: said.unwrap_or("without a word").to_owned(),
        }
    });
    Verdict { outcome, measures }
}

fn wind(case: &Case, measures: &mut Measures) -> Outcome {
    let started = case
        .settings
        .build()
        .map_err(|e| SimError::setup(e.to_string()))
        .and_then(|scene| Ok((Simulation::starting_with(&scene, case.inputs[0])?, scene)));
    let (mut sim, scene) = match started {
        Ok(pair) => pair,
        Err(e) => return gave_up(&e, None),
    };
    let mut watch = Watch::new(&sim);
    let mut end = 0.0;
    for (k, inputs) in case.inputs[..case.inputs.len() - 1].iter().enumerate() {
        // times as `coilwind run --inputs` makes them, so that it repeats this run to the bit
        let start = end;
        end = (k + 1) as f64 * case.step;
        let turned = (inputs.spindle_speed * (end - start)).abs() / TAU;
        // one step is always allowed: the bound grows with what is turned, and this is not yet
        sim.limit_work(work_allowed(measures.turns + turned));
        let advanced = sim.advance(*inputs, end - start);
        measures.turns += turned;
        measures.time = end;
        watch.measure(&sim, measures);
        if let Err(e) = advanced {
            if sim.work() > work_allowed(measures.turns) {
                let text = format!(
                    "{} steps tried in {:.3} turns, {} live nodes, {:.3} m of wire fed",
                    measures.attempts(),
                    measures.turns,
                    sim.system().state.rod.nodes(),
                    sim.outputs().fed_length
                );
                return broken(e.time, Invariant::Steps, text);
            }
            return gave_up(&e, Some(&sim));
        }
        // (parted wire stays as it is while core and nozzle go on: nothing balances from there)
        let mut events = sim.drain_events().into_iter();
        if let Some(event) = events.find(|e| e.kind == EventKind::Break) {
            return Outcome::Broke {
                time: event.time,
                text: event.text,
            };
        }
        let last = k + 2 == case.inputs.len();
        if let Err((what, text)) = watch.look(&sim, &scene, measures, last) {
            return broken(end, what, text);
        }
    }
    Outcome::Completed
}

/// Node steps that are enough for so many turns.
fn work_allowed(turns: f64) -> u64 {
    (STEPS_PER_TURN * NODES * (0.5 + turns)) as u64
}

fn broken(time: f64, what: Invariant, text: String) -> Outcome {
    Outcome::Invariant { time, what, text }
}

fn gave_up(error: &SimError, sim: Option<&Simulation>) -> Outcome {
    let place = sim.zip(error.node).map(|(sim, node)| {
        let sys = sim.system();
        sys.state.arc0 + sys.state.rod.rest.iter().take(node).sum::<f64>()
    });
    Outcome::GaveUp {
        time: error.time,
        place,
        reason: error.reason.clone(),
    }
}

impl Measures {
    fn attempts(&self) -> u64 {
        self.steps + self.rejects + self.newton_failures
    }
}

/// What is remembered from one communication point to the next.
struct Watch {
    /// wire at the start, m
    length: f64,
    /// plastic work so far, J
    plastic: f64,
    /// frozen wire at the last look, core frame, m
    frozen: Vec<V3>,
    looks: usize,
    /// sums of what the spindle and the feed did, either way, J
    through: f64,
    before: [f64; 2],
    /// which nodes there were at the last look
    nodes: Vec<u64>,
}

type Found = Result<(), (Invariant, String)>;

impl Watch {
    fn new(sim: &Simulation) -> Self {
        Self {
            length: wire_length(sim),
            plastic: 0.0,
            frozen: Vec::new(),
            looks: 0,
            through: sim.system().stored(),
            before: [0.0; 2],
            nodes: Vec::new(),
        }
    }

    fn measure(&mut self, sim: &Simulation, m: &mut Measures) {
        let statistics = sim.statistics();
        (m.steps, m.rejects, m.newton_failures) = (
            statistics.steps,
            statistics.rejects,
            statistics.newton_failures,
        );
        m.evaluations = statistics.evaluations;
        let sys = sim.system();
        m.nodes = m.nodes.max(sys.state.rod.nodes());
        m.depth = sys.state.deepest / sys.model.section.diameter;
        let b = sys.state.balance;
        let now = [b.spindle, b.nozzle];
        self.through += (0..2).map(|k| (now[k] - self.before[k]).abs()).sum::<f64>();
        self.before = now;
    }

    fn look(&mut self, sim: &Simulation, scene: &Scene, m: &mut Measures, last: bool) -> Found {
        self.looks += 1;
        finite(sim)?;
        self.energy(sim, m)?;
        self.plastic_work(sim)?;
        self.wire(sim)?;
        // nodes put in or taken out move the points that touch and share out tension; the next step brings
        // that in line
        let nodes = nodes_of(sim);
        let same = self.nodes == nodes;
        self.nodes = nodes;
        if same {
            cone(sim, m)?;
            tension(sim)?;
        }
        if last || self.looks.is_multiple_of(LOOK) {
            penetration(sim, scene, m)?;
            wire_in_wire(sim, scene, m)?;
        }
        self.frozen_wire(sim)
    }

    fn energy(&self, sim: &Simulation, m: &mut Measures) -> Found {
        let sys = sim.system();
        let residual = sys.energy_residual(None);
        let draw = sim.scene().tensioner.tension * sys.model.section.diameter;
        let scale = self.through + sys.stored() + sys.kinetic() + draw;
        m.energy = m.energy.max((residual / scale).abs());
        let balance = sys.state.balance;
        m.added = m
            .added
            .max(-(balance.numerical + balance.remeshing) / scale);
        if residual.abs() > ENERGY * scale {
            let text = format!("{residual:.3e} J unexplained of {scale:.3e} J that went through");
            return Err((Invariant::Energy, text));
        }
        Ok(())
    }

    fn plastic_work(&mut self, sim: &Simulation) -> Found {
        let now: f64 = sim.system().state.balance.plastic.iter().sum();
        let before = std::mem::replace(&mut self.plastic, now);
        // (rounding of sums)
        if now < before - 1e-12 * before.abs() {
            let text = format!("{:.3e} J of {before:.3e} J came back", before - now);
            return Err((Invariant::PlasticWork, text));
        }
        Ok(())
    }

    fn wire(&self, sim: &Simulation) -> Found {
        let (is, fed) = (wire_length(sim), sim.outputs().fed_length);
        let joined = sim.system().state.joined_away;
        let all = self.length + fed.abs();
        if joined > JOINED * all {
            let text = format!("{joined:.3e} m of {all:.3e} m lost where nodes went");
            return Err((Invariant::Length, text));
        }
        if (is + joined - self.length - fed).abs() > LENGTH * all {
            let text = format!(
                "{is:.9} m of wire, {:.9} m at the start and {fed:.9} m fed",
                self.length
            );
            return Err((Invariant::Length, text));
        }
        Ok(())
    }

    fn frozen_wire(&mut self, sim: &Simulation) -> Found {
        let Some(line) = sim.system().line_scratch() else {
            return Ok(());
        };
        let now = line.tube.points();
        // wire that thawed may freeze again elsewhere
        let stayed = sim.outputs().feed_speed >= 0.0 && now.len() >= self.frozen.len();
        let mut both = self.frozen.iter().zip(now).enumerate();
        if stayed && let Some((i, (a, b))) = both.find(|(_, (a, b))| a != b) {
            let text = format!("frozen node {i} moved by {:.3e} m", (a - b).norm());
            return Err((Invariant::Frozen, text));
        }
        self.frozen.clear();
        self.frozen.extend_from_slice(now);
        Ok(())
    }
}

/// Unstretched wire from clamp to nozzle, m.
fn wire_length(sim: &Simulation) -> f64 {
    let sys = sim.system();
    sys.state.arc0 + sys.state.rod.rest.iter().sum::<f64>()
}

fn finite(sim: &Simulation) -> Found {
    let o = sim.outputs();
    let numbers = [
        ("wire_tension", o.wire_tension),
        ("wire_tension_max", o.wire_tension_max),
        ("bulge_height", o.bulge_height),
        ("gap_width", o.gap_width),
        ("turns_wound", o.turns_wound),
        ("turns_settled", o.turns_settled),
        ("spindle_torque", o.spindle_torque),
        ("feed_speed", o.feed_speed),
        ("fed_length", o.fed_length),
        ("free_length", o.free_length),
        ("layon_position", o.layon_position),
        ("layon_angle", o.layon_angle),
        ("coil_width", o.coil_width),
        ("mean_pitch", o.mean_pitch),
        ("fill_factor", o.fill_factor),
        ("wire_strain", o.wire_strain),
        ("penetration_max", o.penetration_max),
        ("energy_residual", o.energy_residual),
    ];
    if let Some((name, x)) = numbers.into_iter().find(|(_, x)| !x.is_finite()) {
        return Err((Invariant::Finite, format!("{name} = {x}")));
    }
    let rod = &sim.system().state.rod;
    let bad = |i: &usize| !(rod.x[*i].sum() + rod.v[*i].sum()).is_finite();
    match (0..rod.nodes()).find(bad) {
        Some(i) => Err((Invariant::Finite, format!("live node {i}"))),
        None => Ok(()),
    }
}

/// Tells nodes from others: their number may be the same where one came and one went. The unstretched lengths between them
/// are theirs, but for the last, which grows.
fn nodes_of(sim: &Simulation) -> Vec<u64> {
    let rest = &sim.system().state.rod.rest;
    let lengths = rest[..rest.len() - 1].iter().map(|l| l.to_bits());
    lengths.chain([sim.centreline().frozen as u64]).collect()
}

fn tension(sim: &Simulation) -> Found {
    let o = sim.outputs();
    let at_nozzle = sim
        .system()
        .state
        .load
        .tension
        .last()
        .copied()
        .unwrap_or(0.0);
    let strength = sim.scene().wire.strength;
    // (a slack line lets the wire hang: what is left is what the solve left)
    let least = -1e-3 * strength.min(1e3);
    if at_nozzle < least || o.wire_tension_min < 0.0 {
        let text = format!("the nozzle pushes wire out by {:.3e} N", -at_nozzle);
        return Err((Invariant::Tension, text));
    }
    Ok(())
}

fn cone(sim: &Simulation, m: &mut Measures) -> Found {
    let sys = sim.system();
    let (Some(model), Some(line)) = (sys.model.contact.as_line(), sys.state.contact.as_line())
    else {
        return Ok(());
    };
    let (point, share) = line.friction_over_limit(model);
    m.cone = m.cone.max(share);
    if share > 1.0 + CONE {
        let text = format!("friction of contact point {point} is {share:.4} of its limit");
        return Err((Invariant::Cone, text));
    }
    Ok(())
}

fn penetration(sim: &Simulation, scene: &Scene, m: &mut Measures) -> Found {
    let sys = sim.system();
    let (r, d) = (scene.wire.radius(), scene.wire.diameter);
    let spin = Spin::new(sys.state.spindle.angle);
    // the stiffness allows for so much where the wire is drawn round the tightest bend, within reason
    let bend = match scene.core {
        Core::RoundedBox { corner_radius, .. } => corner_radius + r,
        Core::Cylinder { radius, .. } => radius + r,
        Core::Mesh { .. } => r,
    };
    let pull = sys.state.load.tension.iter().copied().fold(0.0, f64::max);
    let soft = (pull / bend / scene.contact.stiffness).min(0.2 * d);
    let allowed = SUNK * d + soft;
    for i in 1..sys.state.rod.nodes() - 1 {
        let depth = r - sys.distance_to_core(spin.to_core(sys.centre(i)));
        m.sunk = m.sunk.max(depth / d);
        if depth > allowed {
            let text = format!(
                "live node {i} is {:.1} um in the core, {:.2} d",
                depth * 1e6,
                depth / d
            );
            return Err((Invariant::Penetration, text));
        }
    }
    Ok(())
}

/// Wire through wire: every live node against all that lies half a turn or more behind it, whatever the
/// method's own search found.
fn wire_in_wire(sim: &Simulation, scene: &Scene, m: &mut Measures) -> Found {
    let sys = sim.system();
    let Some(line) = sys.line_scratch() else {
        return Ok(());
    };
    let d = scene.wire.diameter;
    let spin = Spin::new(sys.state.spindle.angle);
    let frozen = line.tube.points();
    let live = (0..sys.state.rod.nodes()).map(|i| spin.to_core(sys.state.rod.x[i]));
    let all: Vec<V3> = frozen.iter().copied().chain(live).collect();
    // polar angle along the wire from its end
    let mut turned = vec![0.0];
    for pair in all.windows(2) {
        let step = wrap_to_pi(polar_angle(pair[1]) - polar_angle(pair[0]));
        turned.push(turned[turned.len() - 1] + step);
    }
    for i in frozen.len().max(1)..all.len() - 1 {
        let p = spin.to_core(sys.centre(i - frozen.len()));
        for j in 1..i {
            if (turned[i] - turned[j]).abs() < PI {
                break;
            }
            // far away for the length of an edge: the wire between is straight enough
            let (a, b) = ((all[j - 1] + all[j]) * 0.5, (all[j] + all[j + 1]) * 0.5);
            let depth = d - distance_to_segment(p, a, b);
            m.crossed = m.crossed.max(depth / d);
            if depth > CROSSED * d {
                let text = format!(
                    "live node {} is {:.2} d in the wire {:.2} turns behind it",
                    i - frozen.len(),
                    depth / d,
                    (turned[i] - turned[j]).abs() / TAU
                );
                return Err((Invariant::Crossing, text));
            }
        }
    }
    Ok(())
}

/// Distance of a point from a segment, m.
fn distance_to_segment(p: V3, a: V3, b: V3) -> f64 {
    let along = b - a;
    let share = (p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
    (p - a - along * share.clamp(0.0, 1.0)).norm()
}
