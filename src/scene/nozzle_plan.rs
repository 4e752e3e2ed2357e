//! The nozzle's way that follows from a scene: even travel, layers between flanges, or a table.
//!
//! Layered laws follow from turns, layers, pitch and the window between the flanges; each layer lies in the grooves of the one
//! below, half a pitch aside.

use super::SceneError;
use super::angle_table::Form;
use super::extent::{Extent, ROUNDING, between_turns};
use super::impossible::{si, si_down};
use super::nozzle_law::NozzleLaw;
use super::nozzle_trail::Trail;
use super::problems::Problems;
use crate::rod::Section;
use crate::settings::{NozzleFollows, SceneSettings};
use std::f64::consts::TAU;

/// Turns of a run by the law `by-angle` that does not say how many.
const TURNS: f64 = 2.5;

/// Most turns of a coil: those that `spindle.turns` admits.
const MOST_TURNS: f64 = 1e5;

/// A layer as the nozzle winds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layer {
    /// place of its first turn, m
    pub(super) first: f64,
    /// place of its last turn, m
    pub(super) last: f64,
    /// its turns
    pub(super) turns: u32,
    /// direction along y
    pub(super) sense: f64,
}

/// Turns side by side in layers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layers {
    /// from the core outwards, one at least
    pub(super) layers: Vec<Layer>,
    /// distance of neighbouring turns, m
    pub(super) pitch: f64,
}

impl Layers {
    /// The least and the largest place of a turn along y, m.
    fn range(&self) -> [f64; 2] {
        let places = || {
            self.layers
                .iter()
                .flat_map(|layer| [layer.first, layer.last])
        };
        [
            places().fold(f64::INFINITY, f64::min),
            places().fold(f64::NEG_INFINITY, f64::max),
        ]
    }

    /// Turns between which the wire climbs to each next layer, in a step that takes so many and comes so much later.
    fn jumps(&self, step: f64, delay: f64) -> Vec<[f64; 2]> {
        let mut done = 0.0;
        let mut ends: Vec<[f64; 2]> = Vec::new();
        for layer in &self.layers {
            done += f64::from(layer.turns);
            ends.push([done - step + delay, done + delay]);
        }
        ends.pop();
        ends
    }

    /// Turns of all layers.
    fn turns(&self) -> f64 {
        self.layers.iter().map(|layer| f64::from(layer.turns)).sum()
    }

    /// How far a layer rises over the one below, m, for wire of this diameter: it lies in the grooves, or turn on turn.
    fn rise(&self, d: f64) -> f64 {
        let aside = match self.layers[..] {
            [below, next, ..] => next.first - below.last,
            _ => 0.5 * self.pitch,
        };
        (d * d - aside * aside).max(0.0).sqrt()
    }

    /// From where to where a nozzle goes that leads wire with these trails through crossovers of so many rad, m.
    fn reach(&self, trail: impl Fn(usize) -> Trail, crossover: f64) -> [f64; 2] {
        let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
        let mut add = |y: f64| reach = [reach[0].min(y), reach[1].max(y)];
        for (number, layer) in self.layers.iter().enumerate() {
            let [before, behind] = trail(number).swing(crossover);
            let step = layer.sense * self.pitch * f64::from(u8::from(layer.turns > 1));
            add(layer.first - before * step);
            add(layer.last + behind * step);
            if let Some(next) = self.layers.get(number + 1) {
                let step = next.first - layer.last;
                add(layer.last - before * step);
                add(next.first + behind * step);
            }
        }
        reach
    }

    /// Places of all turns, m, each with its layer, from 0; `lead`, m, goes with the direction of each.
    fn places(&self, lead: f64) -> Vec<(usize, f64)> {
        let pitch = self.pitch;
        let layers = self.layers.iter().enumerate();
        layers
            .flat_map(|(number, layer)| {
                let place =
                    move |turn| layer.first + layer.sense * (f64::from(turn) * pitch + lead);
                (0..layer.turns).map(move |turn| (number, place(turn)))
            })
            .collect()
    }
}

impl SceneSettings {
    /// Whether the nozzle's way follows from turns and layers.
    pub(super) fn winds_layers(&self) -> bool {
        matches!(self.traverse.mode.as_str(), "orthocyclic" | "helical")
    }

    /// Whether the nozzle's way is a table.
    pub(super) fn winds_table(&self) -> bool {
        self.traverse.mode == "table"
    }

    /// The counts of turns and layers that are no whole numbers, where layers are planned.
    fn part_counts(&self) -> Vec<&'static str> {
        let w = &self.winding;
        let counts = [
            ("winding.layers", w.layers),
            ("winding.turns_per_layer", w.turns_per_layer),
        ];
        let parts = counts.iter().filter(|(_, count)| count.fract() != 0.0);
        parts
            .filter(|_| self.plans_layers())
            .map(|(key, _)| *key)
            .collect()
    }

    /// Turns and layers are counted in whole numbers, whatever core and wire are.
    pub(super) fn check_counts(&self, problems: &mut Problems) {
        for key in self.part_counts() {
            problems.add(self.impossible(key, "not a whole number", "whole numbers"));
        }
    }

    /// The nozzle's way; of a nozzle that leads this `wire`, where there is one. Of what is wrong, the second `problems` are those
    /// of where it goes.
    pub(super) fn nozzle_law(
        &self,
        wire: Option<&Section>,
        extent: &Extent,
        (problems, of_way): (&mut Problems, &mut Problems),
        follows: NozzleFollows,
    ) -> Option<NozzleLaw> {
        let t = &self.traverse;
        let diameter = self.wire.outer_diameter();
        let law = match t.mode.as_str() {
            "table" => {
                let law = self.law_of_table(problems)?;
                match self.winding.turns_per_layer {
                    0.0 => law,
                    _ => {
                        let stacked = self.layers(diameter, extent, problems)?;
                        law.with_steps_as_crossovers(stacked.pitch, stacked.turns())
                            .with_layers(&stacked.jumps(0.0, 0.0), stacked.turns(), stacked.turns())
                            .with_layer_starts(stacked.starts(diameter, extent, true))
                    }
                }
            }
            "orthocyclic" => {
                let layers = self.layers(diameter, extent, problems)?;
                // the wire stays in the window, and the nozzle may lead past its places
                self.check_way(layers.range(), Some(layers.pitch), extent, of_way);
                let law = match self.leads_trail() {
                    true => problems
                        .note(self.check_led_core())
                        .and_then(|()| problems.note(self.led(&layers, wire?, extent)))?,
                    false => self.orthocyclic(&layers),
                };
                let starts = layers.starts(diameter, extent, false);
                return Some(self.for_run(law.with_layer_starts(starts)));
            }
            "helical" => {
                let layers = self.layers(diameter, extent, problems)?;
                self.check_way(layers.range(), Some(layers.pitch), extent, of_way);
                let starts = layers.starts(diameter, extent, false);
                return Some(self.for_run(self.helical(&layers).with_layer_starts(starts)));
            }
            // without inputs the nozzle goes with the core's angle
            _ => {
                let travel = t.per_turn / TAU;
                let turns = match self.spindle.turns {
                    0.0 => TURNS,
                    turns => turns,
                };
                let law = NozzleLaw::even(self.nozzle.y_start + t.lead, travel, turns);
                if extent.window.is_some() {
                    // (inputs turn the core as far as they like, and at least begin a turn)
                    let judged = match follows {
                        NozzleFollows::LawByInputs => law.clone().for_turns(turns.min(1.0)),
                        NozzleFollows::Law | NozzleFollows::Input => law.clone(),
                    };
                    self.check_way(judged.range(), None, extent, of_way);
                }
                return Some(law);
            }
        };
        // The places of all turns, also those that a nozzle ahead of them leaves out.
        self.check_way(law.range(), None, extent, of_way);
        Some(self.for_run(law))
    }

    /// The law as a run follows it: ahead, and for as many turns as the run has.
    fn for_run(&self, law: NozzleLaw) -> NozzleLaw {
        let law = law.advanced(self.traverse.advance);
        let turns = match self.spindle.turns {
            0.0 => law.turns(),
            turns => turns,
        };
        law.for_turns(turns)
    }

    /// Height of the planned layers of wire of diameter `d`, both in m, where the scene has them.
    pub(super) fn height_of_layers(&self, d: f64, extent: &Extent) -> Option<f64> {
        let planned = self.layers(d, extent, &mut Problems::default())?;
        Some(d + (planned.layers.len() - 1) as f64 * planned.rise(d))
    }

    /// The layers that the nozzle winds, from the window between the flanges.
    pub(super) fn layers(
        &self,
        d: f64,
        extent: &Extent,
        problems: &mut Problems,
    ) -> Option<Layers> {
        let w = &self.winding;
        let distance = |[low, high]: [f64; 2]| high - low;
        // A table says itself where the nozzle goes; the plan then only says where wire is meant to climb.
        let by_table = self.winds_table() && self.core.flange.inner_distance == 0.0;
        let (width, widest) = match extent.window.filter(|_| !by_table) {
            Some(room) => (Some(distance(room.faces)), Some(distance(room.widest))),
            None => (None, None),
        };
        if !self.part_counts().is_empty() {
            // these are told already
            return None;
        }
        if w.pitch != 0.0 && !(d * (1.0 - ROUNDING)..=2.0 * d).contains(&w.pitch) {
            let reason = match w.pitch < d {
                true => "neighbouring turns would lie in each other",
                false => "another wire has room between neighbouring turns",
            };
            let allowed = format!(
                "{} to {} m (one to two diameters), or 0",
                si(d),
                si(2.0 * d)
            );
            problems.add(self.impossible("winding.pitch", reason, allowed));
            return None;
        }
        let least = w.pitch.max(d);
        let most_in =
            |width: f64| between_turns(width, d).map_or(0.0, |apart| (apart / least).floor() + 1.0);
        let (fit, most) = (width.map(most_in), widest.map(most_in));
        if most.is_some_and(|most| most < 1.0) {
            // flanges so near to each other are told already
            return None;
        }
        let turns = match (w.turns_per_layer, most) {
            (0.0, None) => {
                let (about, turned) = match extent.flanged_about {
                    Some(axis) => (
                        format!(" about y, only about {axis},"),
                        format!(", or core.file with the mesh turned so that its {axis} is y"),
                    ),
                    None => Default::default(),
                };
                problems.add(self.impossible(
                    "winding.turns_per_layer",
                    format!("there are no flanges{about} that would say how many turns fit"),
                    format!("1 or more, or core.flange.inner_distance{turned}"),
                ));
                return None;
            }
            (0.0, Some(most)) => fit.unwrap_or(most).max(1.0),
            (turns, Some(most)) if turns > most => {
                let reason = format!(
                    "so many turns {} m apart need {} m; there are {} m between the flanges",
                    si(least),
                    si(d + (turns - 1.0) * least),
                    si(widest.unwrap_or_default())
                );
                let or = match self.core.flange.inner_distance {
                    0.0 => "a core.file with flanges farther apart",
                    _ => "a larger core.flange.inner_distance",
                };
                let allowed = format!("at most {most}, or {or}");
                problems.add(self.impossible("winding.turns_per_layer", reason, allowed));
                // what fits must not meet the nozzle either
                let fits = self.stacked(most as u32, least, true);
                self.check_coil(&fits, d, extent, problems);
                return None;
            }
            (turns, _) => turns,
        };
        if turns * w.layers > MOST_TURNS {
            let reason = format!(
                "{turns} turns in {} layers are more than a run can have",
                w.layers
            );
            let allowed = format!("at most {MOST_TURNS} turns in all");
            problems.add(self.impossible("winding.turns_per_layer", reason, allowed));
            return None;
        }
        let room = width.map(|width| between_turns(width, d).unwrap_or(0.0));
        // with room for half a pitch more every layer has as many turns
        let has_half = |pitch: f64| room.is_none_or(|room| (turns - 0.5) * pitch <= room);
        let pitch = match (w.pitch, width) {
            (0.0, Some(width)) if has_half(d) => ((width - d) / (turns - 0.5)).min(2.0 * d),
            (0.0, Some(width)) if turns > 1.0 => (width - d) / (turns - 1.0),
            (0.0, _) => d,
            (pitch, _) => pitch,
        };
        let layers = self.stacked(turns as u32, pitch, has_half(pitch * (1.0 - ROUNDING)));
        self.check_coil(&layers, d, extent, problems);
        Some(layers)
    }

    /// Layers over each other, each half a pitch aside of the one below. Where there is no room for half a pitch more, every
    /// other layer has a turn less. Where a single turn has no such room, turn lies on turn.
    fn stacked(&self, turns: u32, pitch: f64, has_half: bool) -> Layers {
        let mut layers = Vec::new();
        let mut first = self.nozzle.y_start;
        let mut sense = if self.winding.direction == "-y" {
            -1.0
        } else {
            1.0
        };
        let aside = if turns > 1 || has_half { 0.5 } else { 0.0 };
        for number in 0..self.winding.layers as u32 {
            let between_flanges = number % 2 == 1 && !has_half && turns > 1;
            let turns = turns - u32::from(between_flanges);
            let last = first + sense * f64::from(turns - 1) * pitch;
            layers.push(Layer {
                first,
                last,
                turns,
                sense,
            });
            let on = match has_half || number % 2 == 1 {
                true => aside,
                false => -aside,
            };
            first = last + on * pitch * sense;
            sense = -sense;
        }
        Layers { layers, pitch }
    }

    /// Straight in its place for most of a turn, a step to the next in the rest.
    ///
    /// The step ends at the clamp's angle, where the next turn begins, or so much later as the scene says.
    fn orthocyclic(&self, stacked: &Layers) -> NozzleLaw {
        let places = stacked.places(self.traverse.lead);
        let [step, delay] =
            [self.traverse.crossover, self.traverse.crossover_delay].map(|angle| angle / TAU);
        let mut points = vec![[0.0, places[0].1]];
        for (turn, pair) in places.windows(2).enumerate() {
            let end = (turn + 1) as f64 + delay;
            points.push([end - step, pair[0].1]);
            points.push([end, pair[1].1]);
        }
        points.push([places.len() as f64, places[places.len() - 1].1]);
        NozzleLaw::through(&points)
            .with_layers(
                &stacked.jumps(step, delay),
                stacked.turns() + delay,
                stacked.turns(),
            )
            .with_crossovers(stacked.pitch, self.traverse.crossover)
    }

    /// The nozzle's way that lays this `wire` where the orthocyclic law of these layers says: it stands where that stands, and
    /// swings beyond its steps.
    fn led(
        &self,
        stacked: &Layers,
        wire: &Section,
        extent: &Extent,
    ) -> Result<NozzleLaw, SceneError> {
        let crossover = self.traverse.crossover;
        let trails = self.trails(wire, extent, stacked.rise(wire.diameter));
        let reach = |distance: f64, crossover: f64| {
            stacked.reach(|layer| trails(distance, layer), crossover)
        };
        self.check_swing(reach, extent)?;
        let trail = |layer: usize| trails(self.nozzle.distance, layer);
        let [step, delay] = [crossover, self.traverse.crossover_delay].map(|angle| angle / TAU);
        let places = stacked.places(self.traverse.lead);
        let mut points = vec![[0.0, places[0].1]];
        for (turn, pair) in places.windows(2).enumerate() {
            let [(below, from), (_, to)] = [pair[0], pair[1]];
            let end = (turn + 1) as f64 + delay;
            for [u, share] in trail(below).points(crossover) {
                points.push([end - (1.0 - u) * step, from + share * (to - from)]);
            }
        }
        points.push([places.len() as f64, places[places.len() - 1].1]);
        Ok(NozzleLaw::through(&points)
            .with_layers(
                &stacked.jumps(step, delay),
                stacked.turns() + delay,
                stacked.turns(),
            )
            .with_crossovers(stacked.pitch, crossover))
    }

    /// A pitch a turn, to and fro. The nozzle goes on to where the next layer begins and stands there until this one has its turns; one
    /// that leads changes sides meanwhile.
    fn helical(&self, stacked: &Layers) -> NozzleLaw {
        let Layers { layers, pitch } = stacked;
        let (lead, dwell) = (self.traverse.lead, self.traverse.dwell_turns);
        let mut points = vec![[0.0, layers[0].first + layers[0].sense * lead]];
        let mut jumps = Vec::new();
        // the turns at which it is there
        let mut go_to = |y: f64, least: f64| {
            let [turns, before] = points[points.len() - 1];
            let turned = ((y - before).abs() / pitch).max(least);
            if turned > 0.0 {
                points.push([turns + turned, y]);
            }
            turns + turned
        };
        let mut begun = 0.0;
        for (number, layer) in layers.iter().enumerate() {
            let lead = layer.sense * lead;
            go_to(layer.last + lead, 0.0);
            match layers.get(number + 1) {
                Some(next) => {
                    let from = go_to(next.first + lead, 0.0);
                    let missing = f64::from(layer.turns) - (from - begun);
                    // (what rounding leaves of the dwell itself is none)
                    let stands = match missing > dwell + ROUNDING {
                        true => missing,
                        false => dwell,
                    };
                    begun = go_to(next.first - lead, stands);
                    // (a single turn climbs when it has come round)
                    jumps.push([if layer.turns == 1 { begun } else { from }, begun]);
                }
                // the last turn has to be laid as well
                None => drop(go_to(layer.last + lead, 1.0)),
            }
        }
        let full = points[points.len() - 1][0];
        NozzleLaw::through(&points)
            .with_layers(&jumps, full, stacked.turns())
            .with_pitch(*pitch)
    }

    /// The coil has to stay clear of the nozzle in every layer.
    fn check_coil(&self, layers: &Layers, d: f64, extent: &Extent, problems: &mut Problems) {
        // where wire crosses wire a layer is a diameter high
        let top = |number: usize| extent.winding_radius + number as f64 * d;
        let count = layers.layers.len();
        let meets = (1..=count).find(|&number| top(number) + d >= self.nozzle.distance);
        if let Some(number) = meets {
            let below = &layers.layers[..number - 1];
            let turn = 1 + below.iter().map(|layer| layer.turns).sum::<u32>();
            let fewer = match number {
                1 => String::new(),
                _ => format!(", or at most {} winding.layers", number - 1),
            };
            problems.add(self.impossible(
                "nozzle.distance",
                format!(
                    "the coil meets the nozzle in layer {number}, from turn {turn} at y = {} m on: it stands up to {} m from the axis there, and the wire, {} m wide, has to pass",
                    si(layers.layers[number - 1].first),
                    si(top(number)),
                    si(d)
                ),
                format!("more than {} m{fewer}", si(top(count) + d)),
            ));
        }
    }

    /// Turns lie in the window from the least to the largest place, m. Without a pitch these are places of the nozzle, which may lead
    /// beyond it.
    fn check_way(
        &self,
        [least, largest]: [f64; 2],
        pitch: Option<f64>,
        extent: &Extent,
        problems: &mut Problems,
    ) {
        let t = &self.traverse;
        let lead = pitch.map_or(t.lead.abs(), |_| 0.0);
        let d = self.wire.outer_diameter();
        let (low, high) = match extent.window {
            Some(room) => (room.widest[0], room.widest[1]),
            None => (extent.y_min, extent.y_max),
        };
        let rounding = ROUNDING * (high - low);
        let mut ends = [low + 0.5 * d - lead, high - 0.5 * d + lead];
        let by_angle = t.mode == "by-angle";
        if by_angle {
            // a way that goes on evenly ends a turn behind the place of its last one
            let behind = t.per_turn;
            ends[usize::from(behind > 0.0)] += behind;
        }
        // (where the wire has no place at all, that has been told)
        let within = least >= ends[0] - rounding && largest <= ends[1] + rounding;
        if within || ends[1] < ends[0] - rounding {
            return;
        }
        let what = match extent.window {
            Some(_) => "a flange",
            None => "an end of the core",
        };
        // (what rounding leaves of the middle of the core)
        let told = |y: f64| si(if y.abs() > rounding { y } else { 0.0 });
        let reason = format!(
            "the nozzle goes from {} to {} m, past {what}",
            told(least),
            told(largest)
        );
        let room = rounding + (ends[1] - ends[0]) - (largest - least);
        let start = self.nozzle.y_start;
        let places = [ends[0] + (start - least), ends[1] - (largest - start)].map(si);
        let spread = |pitch: f64| self.winding.pitch == 0.0 && pitch > d * (1.0 + ROUNDING);
        let allowed = match room >= 0.0 {
            _ if self.winds_table() => {
                format!("positions from {} to {} m", si(ends[0]), si(ends[1]))
            }
            // a layer that fills the window leaves one place
            true if places[0] == places[1] => match pitch.filter(|pitch| spread(*pitch)) {
                Some(pitch) => {
                    // (the way shrinks with the pitch, and the start goes with the end of it that stays)
                    let spare = (largest - least) * (1.0 - d / pitch);
                    let low = ends[0] + (start - least) * d / pitch;
                    format!(
                        "{} m, since winding.pitch = 0 spreads the turns over the whole window; or {} to {} m with winding.pitch = {} m",
                        places[0],
                        si(low),
                        si(low + spare),
                        si(d)
                    )
                }
                None => format!("{} m", places[0]),
            },
            true => format!("{} to {} m", places[0], places[1]),
            false if by_angle => {
                let way = high - low - d + 2.0 * lead;
                let turns = (largest - least) / t.per_turn.abs();
                let first = match t.per_turn > 0.0 {
                    true => low + 0.5 * d - lead,
                    false => high - 0.5 * d + lead,
                };
                format!(
                    "at most {} m for {} turns from nozzle.y_start = {} m on, or fewer turns",
                    si_down(way / (turns - 1.0)),
                    si(turns),
                    si(first)
                )
            }
            false => format!("a way of {} m at most", si(ends[1] - ends[0])),
        };
        let key = match (t.mode.as_str(), room >= 0.0) {
            ("table", _) => "traverse.file",
            (_, true) => "nozzle.y_start",
            (_, false) if by_angle => "traverse.per_turn",
            (_, false) => "winding.turns_per_layer",
        };
        problems.add(self.impossible(key, reason, allowed));
    }

    /// The law in the file of a table.
    pub(super) fn law_of_table(&self, problems: &mut Problems) -> Option<NozzleLaw> {
        let form = Form {
            key: "traverse.file",
            file: &self.traverse.file,
            columns: &[("y", "m")],
            wrong: |_, _| None,
            allowed: "a CSV file, relative to the scene file, with the columns angle_deg (or angle_rad, turns) and y_mm (or y_m)",
        };
        if form.file.is_empty() {
            let reason = "traverse.mode = table needs a file";
            problems.add(self.impossible(form.key, reason, form.allowed));
            return None;
        }
        let mut points = self.angle_table(form, problems)?.rows;
        for point in &mut points {
            point[1] += self.traverse.lead;
        }
        Some(NozzleLaw::through(&points))
    }
}
