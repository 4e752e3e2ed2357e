//! Values that are possible but perhaps not meant.

use super::error::Warning;
use super::extent::{Extent, ROUNDING};
use super::impossible::{si, si_down};
use super::without_effect::Reader;
use super::{Core, NozzleLaw, Solver, Window};
use crate::geometry::{Crossing, Place};
use crate::measure::ALIGNED_RMS;
use crate::rod::{RoundLaws, Section, Twist};
use crate::settings::{NozzleFollows, SceneSettings};
use std::f64::consts::TAU;

/// Difference of a law to the curve's, in percent, from which on it is told. Chosen: a section that
/// yields bit by bit is off by some 12 % at the corner of any bilinear law.
const ROUGH: f64 = 15.0;

/// Young's modulus below which a curve is taken to be written in other units, Pa. Chosen: a seventh of aluminium's.
const SOFT: f64 = 10e9;

/// Turns beyond those that the layers hold from which on they are told. Chosen: a step to the next layer takes as many.
const MORE: f64 = 0.5;

const PER_TURN: &str = "traverse.per_turn";

impl SceneSettings {
    /// Whether it is known between which turns wire climbs to the next layer.
    pub(super) fn plans_layers(&self) -> bool {
        self.winds_layers() || self.winds_table() && self.winding.turns_per_layer > 0.0
    }

    /// A nozzle so far past a flange that wire from the last place beside it lies against the rim, and the key that sends it there.
    fn nozzle_past_a_flange(
        &self,
        wire: &Section,
        extent: &Extent,
        law: &NozzleLaw,
    ) -> Option<(&'static str, String)> {
        let room = extent.window?;
        let [low, high] = law.range();
        let [below, above] = [room.faces[0] - low, high - room.faces[1]];
        let (farthest, past) = match below > above {
            true => (low, below),
            false => (high, above),
        };
        if past <= 0.0 {
            return None;
        }
        let laid = extent.winding_radius + wire.radius();
        let at_face = laid + (self.nozzle.distance - laid) * wire.radius() / (past + wire.radius());
        if at_face >= extent.winding_radius + room.height {
            return None;
        }
        let key = match self.traverse.mode.as_str() {
            "table" => "traverse.file",
            _ if self.traverse.lead != 0.0 => "traverse.lead",
            _ if self.leads_trail() => "traverse.crossover",
            "by-angle" if self.nozzle.y_start != farthest => PER_TURN,
            _ => "nozzle.y_start",
        };
        // a nozzle that leads swings the farther the longer the free span is, and the faster the wire crosses
        let remedy = match self.leads_trail() {
            true => "it swings less with a longer traverse.crossover or nearer to the core, and not with traverse.trail = free".to_owned(),
            false => format!(
                "keep the nozzle between {} and {} m, or farther from the core",
                si(room.faces[0]),
                si(room.faces[1])
            ),
        };
        let message = format!(
            "the nozzle goes to {} m, {} m past the inner face of a flange: wire beside that flange lies against its rim or is wound over it; {remedy}",
            si(farthest),
            si(past)
        );
        Some((key, message))
    }

    /// What stands on a mesh in the way of wire that the nozzle lays, and is no flange all round; the message for the key of its file.
    fn in_the_way(&self, wire: &Section, extent: &Extent, law: &NozzleLaw) -> Option<String> {
        let met = extent.in_the_way.as_ref()?;
        let lead = self.traverse.lead.abs();
        let [low, high] = law.range();
        let mut laid = [low + lead - wire.radius(), high - lead + wire.radius()];
        if let Some(room) = extent.window {
            // (turns that go farther are told as past a flange)
            laid = [laid[0].max(room.faces[0]), laid[1].min(room.faces[1])];
        }
        let rounding = ROUNDING * (extent.y_max - extent.y_min);
        let found = [0, 1].map(|side| {
            let depth = |y: f64| [y - laid[0], laid[1] - y][side];
            let hit = met[side].iter().copied().filter(|&y| depth(y) > rounding);
            let first = hit.clone().max_by(|a, b| depth(*a).total_cmp(&depth(*b)));
            let share = hit.count() as f64 / met[side].len() as f64;
            first.map(|y| (y, laid[side], share))
        });
        let (y, end, share) = found
            .into_iter()
            .flatten()
            .max_by(|a, b| a.2.total_cmp(&b.2))?;
        Some(format!(
            "something stands on the core from {} m on, over {:.0} % of the way round it, as a shoe, a collar or a boss does; turns are laid as far as {} m, and those there lie on it",
            si(y),
            100.0 * share,
            si(end)
        ))
    }

    /// In the order in which they are told.
    pub(super) fn warnings(
        &self,
        solver: &Solver,
        wire: &Section,
        core: &Core,
        (extent, window): (&Extent, Option<Window>),
        (law, follows): (&NozzleLaw, NozzleFollows),
    ) -> Vec<Warning> {
        let reader = Reader {
            settings: self,
            integrator: solver.integrator,
            window,
            follows,
        };
        let mut survey = Survey {
            settings: self,
            solver,
            wire,
            core,
            extent,
            window,
            law,
            follows,
            found: reader.warnings(),
        };
        survey.surface();
        survey.nozzle_way();
        survey.coil_height();
        survey.turns_apart();
        survey.first_step();
        survey.turns_without_place();
        survey.past_a_flange();
        survey.clamp();
        survey.tension();
        survey.twist();
        survey.tightest_bend();
        survey.found
    }

    /// A curve of a wire as soft as no metal is: its strains are percents, or its stresses MPa.
    pub(super) fn soft_curve(&self, wire: &Section) -> Option<Warning> {
        let key = "wire.stress_strain";
        let modulus = wire.modulus();
        (!self.wire.stress_strain.is_empty() && modulus < SOFT).then(|| Warning {
            origin: self.told_origin(key),
            key,
            value: self.shown(key),
            message: format!(
                "the first point makes a modulus of {:.3} GPa, less than that of any metal that is wound: strains are ratios, 0.001 for \
                 0.1 %, and stresses are in Pa",
                1e-9 * modulus
            ),
        })
    }

    /// A curve that the laws of the mechanics follow badly: stretch is bilinear, as are laws with limits of the scene's own.
    pub(super) fn rough_laws(&self, laws: &RoundLaws) -> Option<Warning> {
        let key = "wire.stress_strain";
        let errors = [laws.stretch, laws.bend, laws.twist].map(|law| 100.0 * law.error);
        let worst = errors.iter().copied().fold(0.0, f64::max);
        (!self.wire.stress_strain.is_empty() && worst > ROUGH).then(|| Warning {
            origin: self.told_origin(key),
            key,
            value: self.shown(key),
            message: format!(
                "the laws of this section miss the curve's by up to {:.0} % of the force, {:.0} % of the moment and {:.0} % of the \
                 torque; end the points at the largest strain that winding reaches",
                errors[0], errors[1], errors[2]
            ),
        })
    }
}

/// What a scene is looked through by, and what was found.
struct Survey<'a> {
    settings: &'a SceneSettings,
    solver: &'a Solver,
    wire: &'a Section,
    core: &'a Core,
    extent: &'a Extent,
    window: Option<Window>,
    law: &'a NozzleLaw,
    follows: NozzleFollows,
    found: Vec<Warning>,
}

impl Survey<'_> {
    fn warn(&mut self, key: &'static str, message: String) {
        self.found.push(Warning {
            origin: self.settings.told_origin(key),
            key,
            value: self.settings.shown(key),
            message,
        });
    }

    /// A surface that crosses itself, or may.
    fn surface(&mut self) {
        match self.extent.crossing {
            Crossing::None => {}
            Crossing::At(place) => self.warn(
                "core.file",
                format!(
                    "the surface crosses itself at {}, and inside and outside are not told apart there: wire may sink in; mesh the body once more, or unite what crosses",
                    Place(place)
                ),
            ),
            Crossing::NotSearched => self.warn(
                "core.file",
                "whether the surface crosses itself is not known, since too many of its triangles are too long to look at all that may meet; mesh the body more coarsely, or with less narrow triangles".to_owned(),
            ),
        }
    }

    /// A nozzle that starts, ends or passes where wire has no place.
    fn nozzle_way(&mut self) {
        let ends = format!(
            "the core ends at {} and {} m",
            si(self.extent.y_min),
            si(self.extent.y_max)
        );
        if self.extent.is_beside(self.settings.nozzle.y_start) {
            self.warn(
                "nozzle.y_start",
                format!("the nozzle starts beside the core; {ends}"),
            );
        }
        if self.follows.is_law()
            && let Some(message) = self.settings.in_the_way(self.wire, self.extent, self.law)
        {
            self.warn("core.file", message);
        }
        let last = self.law.position(self.law.end());
        let by_angle =
            self.follows == NozzleFollows::Law && self.settings.traverse.mode == "by-angle";
        if by_angle
            && self.extent.is_beside(last)
            && !self.extent.is_beside(self.settings.nozzle.y_start)
        {
            let message = format!("the nozzle ends beside the core, at {} m; {ends}", si(last));
            self.warn(PER_TURN, message);
        }
    }

    /// A coil that meets the nozzle, or stands higher than its flanges or its limit line.
    fn coil_height(&mut self) {
        let table = self.settings.winds_table();
        if self.settings.winds_layers() || table {
            let layers = match self.settings.plans_layers() {
                true => self.settings.winding.layers,
                false => f64::from(self.law.passes(self.wire.diameter)),
            };
            // each layer of a table but the first is taken to lie in the grooves of the one below
            let in_grooves = || self.wire.diameter * (1.0 + (layers - 1.0) * 0.75_f64.sqrt());
            let planned = match self.settings.plans_layers() {
                true => self
                    .settings
                    .height_of_layers(self.wire.diameter, self.extent),
                false => None,
            };
            let coil = planned.unwrap_or_else(in_grooves);
            // where turns are planned in layers, a nozzle that they meet is refused
            if table && self.extent.winding_radius + coil >= self.settings.nozzle.distance {
                let message = format!(
                    "the coil meets the nozzle: the table goes over it {layers} times, and the wire stands up to {} m from the axis then",
                    si(self.extent.winding_radius + coil)
                );
                self.warn("nozzle.distance", message);
            }
            if let Some(room) = self.extent.window
                && coil > room.height
            {
                let (key, flanges) = match self.core.flange() {
                    Some(_) => ("core.flange.height", "the flanges".to_owned()),
                    None => (
                        "core.file",
                        format!("its flanges, which are {} m high", si(room.height)),
                    ),
                };
                let message = format!("the coil stands {} m high, above {flanges}", si(coil));
                self.warn(key, message);
            }
            if self.settings.core.window_height > 0.0
                && let Some(lowest) = self.window.map(|window| window.lowest())
                && coil > lowest
            {
                let message = format!(
                    "the coil stands {} m high, beyond the limit line, which is {} m high at its lowest",
                    si(coil),
                    si(lowest)
                );
                self.warn("core.window_height", message);
            }
        }
    }

    /// Whether turns lie side by side: layers of a single turn have no neighbours.
    fn has_neighbours(&self) -> bool {
        let held = self.law.held();
        held.is_none_or(|turns| turns > self.settings.winding.layers)
    }

    /// Turns with gaps by plan.
    fn turns_apart(&mut self) {
        let by_law = self.follows.is_law();
        if by_law
            && let Some(pitch) = self.law.pitch()
            && pitch > (1.0 + ALIGNED_RMS) * self.wire.diameter
            && self.has_neighbours()
        {
            let key = match self.settings.winding.pitch {
                0.0 => "winding.turns_per_layer",
                _ => "winding.pitch",
            };
            let gap = pitch / self.wire.diameter - 1.0;
            let what = match gap > self.settings.defects.gap {
                true => format!(
                    "which are judged as defects; set defects.gap to more than {gap:.2} if they are meant"
                ),
                false => format!(
                    "{gap:.3} diameters: in an aligned coil they are {ALIGNED_RMS} at most, so turns may be marginal"
                ),
            };
            let message = format!(
                "turns {} m apart leave gaps of {} m, {what}",
                si(pitch),
                si(pitch - self.wire.diameter)
            );
            self.warn(key, message);
        }
    }

    /// A nozzle so far away that turn 2 begins on turn 1.
    fn first_step(&mut self) {
        if self.follows.is_law()
            && self.has_neighbours()
            && let Some(message) = self
                .settings
                .late_first_step(self.wire, self.core, self.extent)
        {
            self.warn("nozzle.distance", message);
        }
    }

    /// Turns for which the layers have no place.
    fn turns_without_place(&mut self) {
        let by_law = self.follows.is_law();
        if let Some((room, turns)) = self.settings.place_left(self.wire.diameter, self.extent) {
            let message = format!(
                "the last turn of layer 1 leaves {} m to its flange, and the first of layer 2 falls in there; plan as many turns as fit, {turns}, or bring the flanges nearer",
                si(room)
            );
            self.warn("winding.turns_per_layer", message);
        }
        // what the nozzle takes for its way through the layers
        let planned = (self.law.travel_ends() + self.settings.traverse.advance) / TAU;
        if by_law && self.settings.winds_layers() {
            let more = self.law.turns() - planned;
            if more > MORE {
                let message = format!(
                    "the layers hold {} turns, and what is wound then has no place but on the last one; leave the key out, or plan more turns or layers",
                    si(self.law.held().unwrap_or(planned))
                );
                self.warn("spindle.turns", message);
            }
        }
        if by_law
            && self.settings.traverse.mode == "helical"
            && let Some(held) = self.law.held()
            && planned - held > MORE
        {
            let (lead, dwell) = (
                self.settings.traverse.lead.abs(),
                self.settings.traverse.dwell_turns,
            );
            let changes_sides = self
                .law
                .pitch()
                .is_some_and(|pitch| 2.0 * lead > dwell * pitch);
            let (key, does) = match changes_sides {
                true => ("traverse.lead", "changes sides"),
                false => ("traverse.dwell_turns", "stands"),
            };
            let message = format!(
                "the nozzle takes {} turns through the layers, which hold {} turns; the rest is laid over the ends of the layers, where it {does}",
                si(planned),
                si(held)
            );
            self.warn(key, message);
        }
    }

    /// A nozzle so far past a flange that wire beside it lies against the rim.
    fn past_a_flange(&mut self) {
        if self.follows.is_law()
            && let Some((key, message)) =
                self.settings
                    .nozzle_past_a_flange(self.wire, self.extent, self.law)
        {
            self.warn(key, message);
        }
    }

    /// A clamp beside the first turn.
    fn clamp(&mut self) {
        let first = self.settings.nozzle.y_start;
        if (self.settings.start.clamp_y - first).abs() > self.wire.diameter {
            let way = match self.settings.traverse.mode.as_str() {
                _ if self.settings.winds_layers() => {
                    Some("crosses the place of others on its way there")
                }
                "by-angle" if !self.extent.is_beside(first) => {
                    Some("comes there in steep turns with gaps between them")
                }
                _ => None,
            };
            if let Some(way) = way {
                let message = format!(
                    "the wire is clamped beside the first turn, which lies at {} m, and {way}; set it to nozzle.y_start",
                    si(first)
                );
                self.warn("start.clamp_y", message);
            }
        }
    }

    /// A tension at which the wire yields, or too low to hold it.
    fn tension(&mut self) {
        let tension = self.settings.tensioner.tension;
        if tension >= self.wire.n_y {
            let message = format!(
                "the wire yields in the free span; N_y is {} N",
                si(self.wire.n_y)
            );
            self.warn("tensioner.tension", message);
        }
        // what straightens gives its bend back, and the tension has to take as much to keep it on the core
        let bend = self.extent.winding_radius + self.wire.radius();
        let holds = 0.5 * self.wire.ei / (bend * bend);
        if !self.wire.m_y.is_finite() && tension < holds {
            let message = format!(
                "wire that does not yield springs off this core, and may jump over its end: no less than {} N hold it",
                si(holds)
            );
            self.warn("tensioner.tension", message);
        }
    }

    /// Wire that yields, without twist.
    fn twist(&mut self) {
        if self.solver.twist == Twist::Off
            && self.solver.integrator.is_implicit()
            && self.wire.m_y.is_finite()
        {
            let message = "the set of wire that yields turns with its roll; without twist its bends do not come to \
                           rest, and the method adds energy where they are sharp"
                .to_owned();
            self.warn("solver.twist", message);
        }
    }

    /// Nodes too far apart, or contact too soft, for the tightest bend.
    fn tightest_bend(&mut self) {
        if let Some(corner) = self.core.corner() {
            let bend = corner + self.wire.radius();
            let near = self.solver.spacing_near;
            if near > bend {
                let message = format!(
                    "coarser than the tightest bend of the wire, radius {} m",
                    si(bend)
                );
                self.warn("solver.spacing_near", message);
            }
            let (sag, least) = (
                near * near / (8.0 * bend),
                self.settings.defects.loose_height * self.wire.diameter,
            );
            if near <= bend && sag > least {
                let message = format!(
                    "wire between nodes so far apart cuts its tightest bend, radius {} m, by {} m, which is judged as wire that stands off; at most {} m",
                    si(bend),
                    si(sag),
                    si_down((8.0 * bend * least).sqrt())
                );
                self.warn("solver.spacing_near", message);
            }
            let depth = self.settings.tensioner.tension / bend / self.settings.contact.stiffness;
            if depth > 0.01 * self.wire.diameter {
                let message = format!(
                    "the wire sinks about {} m into the tightest bend, more than 1 % of its \
                     diameter",
                    si(depth)
                );
                self.warn("contact.stiffness", message);
            }
        }
    }
}
