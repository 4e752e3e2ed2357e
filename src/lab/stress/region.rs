//! Which part of the parameter space a case lies in, and what came of the cases of each.

use super::case::built;
use super::{Case, Mesh, Outcome, Verdict, Worst};
use crate::scene::Scene;
use std::fmt::Write;

/// One way to divide the parameter space.
struct Axis {
    name: &'static str,
    /// upper ends of all parts but the last
    ends: &'static [f64],
    /// the parts in words
    parts: &'static [&'static str],
    of: fn(&Case, &Scene) -> f64,
}

const AXES: &[Axis] = &[
    Axis {
        name: "wire diameter, mm",
        ends: &[0.1, 0.3, 1.0],
        parts: &["to 0.1", "0.1 to 0.3", "0.3 to 1", "1 to 3"],
        of: |_, s| s.wire.diameter * 1e3,
    },
    Axis {
        name: "tension / yield",
        ends: &[0.03, 0.1, 0.3, 1.0],
        parts: &[
            "below 0.03",
            "0.03 to 0.1",
            "0.1 to 0.3",
            "0.3 to 1",
            "above 1",
        ],
        of: |c, s| {
            let w = &c.settings.wire;
            let area = 0.25 * std::f64::consts::PI * w.diameter * w.diameter;
            s.tensioner.tension / (w.metal().yield_stress * area)
        },
    },
    Axis {
        name: "top speed, rad/s",
        ends: &[10.0, 100.0, 500.0],
        parts: &["1 to 10", "10 to 100", "100 to 500", "500 to 2000"],
        of: |c, _| c.settings.spindle.speed,
    },
    Axis {
        name: "corner radius / d",
        ends: &[1.0, 4.0, 16.0],
        parts: &["below 1", "1 to 4", "4 to 16", "above 16"],
        of: |c, s| {
            let core = &c.settings.core;
            let tightest = match core.shape.as_str() {
                "cylinder" => core.radius,
                _ => core.corner_radius,
            };
            tightest / s.wire.diameter
        },
    },
    Axis {
        name: "friction, static",
        ends: &[0.001, 0.3, 0.6],
        parts: &["0", "to 0.3", "0.3 to 0.6", "0.6 to 1"],
        of: |_, s| s.friction.static_,
    },
    Axis {
        name: "core",
        ends: &[0.5, 1.5, 2.5, 3.5],
        parts: &[
            "rounded box",
            "cylinder",
            "convex mesh",
            "bobbin",
            "hollow prism",
        ],
        of: |c, _| match (&c.mesh, c.settings.core.shape.as_str()) {
            (_, "rounded-box") => 0.0,
            (_, "cylinder") => 1.0,
            (Some(Mesh::Bobbin(_)), _) => 3.0,
            (Some(Mesh::Prism(prism)), _) if prism.dent > 0.0 => 4.0,
            _ => 2.0,
        },
    },
    Axis {
        name: "layers",
        ends: &[1.5, 2.5, 3.5],
        parts: &["1", "2", "3", "4"],
        of: |c, _| f64::from(c.layers.count),
    },
    Axis {
        name: "flanges",
        ends: &[0.5],
        parts: &["none, or a mesh", "beside the core"],
        of: |c, _| f64::from(u8::from(c.settings.core.flange.inner_distance > 0.0)),
    },
    Axis {
        name: "enamel",
        ends: &[0.5],
        parts: &["bare", "enamelled"],
        of: |c, _| f64::from(u8::from(c.settings.wire.enamelled_diameter > 0.0)),
    },
    Axis {
        name: "traverse",
        ends: &[0.5, 1.5],
        parts: &["by angle", "orthocyclic", "helical"],
        of: |c, _| match c.settings.traverse.mode.as_str() {
            "orthocyclic" => 1.0,
            "helical" => 2.0,
            _ => 0.0,
        },
    },
    Axis {
        name: "wire and twist",
        ends: &[0.5, 1.5, 2.5],
        parts: &[
            "yields, twist",
            "yields, twist off",
            "elastic, twist",
            "elastic, twist off",
        ],
        of: |c, _| {
            let off = c.settings.solver.twist == "off";
            2.0 * f64::from(u8::from(c.settings.wire.elastic)) + f64::from(u8::from(off))
        },
    },
    Axis {
        name: "signal",
        ends: &[0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5],
        parts: &[
            "ramp",
            "speed steps",
            "noise",
            "sudden stop",
            "reversal",
            "emergency stop",
            "nozzle jumps",
            "tension to zero",
        ],
        of: |c, _| c.kind as u8 as f64,
    },
];

/// What came of some cases.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tally {
    cases: u64,
    completed: u64,
    broke: u64,
    ended: u64,
    gave_up: u64,
    invariant: u64,
    turns: f64,
    steps: u64,
    most: f64,
    depth: f64,
    energy: f64,
}

impl Tally {
    fn add(&mut self, verdict: &Verdict) {
        self.cases += 1;
        match verdict.outcome {
            Outcome::Completed => self.completed += 1,
            Outcome::Broke { .. } => self.broke += 1,
            Outcome::Ended { .. } => self.ended += 1,
            Outcome::GaveUp { .. } => self.gave_up += 1,
            Outcome::Invariant { .. } => self.invariant += 1,
        }
        let m = &verdict.measures;
        self.turns += m.turns;
        self.steps += m.steps;
        // a case that broke at once has no steps per turn
        if m.turns > 0.1 {
            self.most = self.most.max(m.steps as f64 / m.turns);
        }
        if !verdict.outcome.is_trouble() {
            self.depth = self.depth.max(m.depth);
            self.energy = self.energy.max(m.energy);
        }
    }

    fn row(&self, name: &str) -> String {
        format!(
            "| {name} | {} | {} | {} | {} | {} | {} | {:.0} | {:.0} | {:.2} | {:.1} % |\n",
            self.cases,
            self.completed,
            self.broke,
            self.ended,
            self.gave_up,
            self.invariant,
            self.steps as f64 / self.turns.max(1e-9),
            self.most,
            self.depth,
            100.0 * self.energy
        )
    }
}

const HEAD: &str = "| cases | completed | wire broke | ran away, collided | gave up | invariant | steps/turn | at most | depth/d | energy |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|
";

/// Totals over all cases and by region.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Totals {
    all: Tally,
    by: Vec<Vec<Tally>>,
    worst: Worst,
}

impl Totals {
    /// Nothing yet.
    pub fn new() -> Self {
        Self {
            all: Tally::default(),
            by: AXES
                .iter()
                .map(|axis| vec![Tally::default(); axis.parts.len()])
                .collect(),
            worst: Worst::new(),
        }
    }

    /// Counts a case in.
    pub fn add(&mut self, case: &Case, verdict: &Verdict) {
        self.all.add(verdict);
        self.worst.add(case, verdict);
        // (the file of a mesh is gone once its case is done)
        let built = match &case.mesh {
            Some(mesh) => built(&mesh.stand_in(&case.settings)),
            None => built(&case.settings),
        };
        let Ok(scene) = built else {
            return;
        };
        for (axis, tallies) in AXES.iter().zip(&mut self.by) {
            let x = (axis.of)(case, &scene);
            let part = axis.ends.partition_point(|end| *end <= x);
            tallies[part].add(verdict);
        }
    }

    /// How many broke an invariant, and how many the solver gave up on.
    pub fn trouble(&self) -> (u64, u64) {
        (self.all.invariant, self.all.gave_up)
    }

    /// One line.
    pub fn line(&self) -> String {
        let t = &self.all;
        format!(
            "{} cases: {} completed, {} wire broke, {} ran away or collided, {} gave up ({:.1} %), {} broke an invariant",
            t.cases,
            t.completed,
            t.broke,
            t.ended,
            t.gave_up,
            100.0 * t.gave_up as f64 / (t.cases as f64).max(1.0),
            t.invariant
        )
    }

    /// The worst of each measure, and the cases beyond the marks, Markdown.
    pub fn worst(&self) -> String {
        self.worst.table() + &self.worst.beyond()
    }

    /// A table for each way to divide the space, Markdown.
    pub fn tables(&self) -> String {
        let mut text = String::new();
        // writing to a text cannot fail
        let _ = write!(text, "| {HEAD}{}", self.all.row("all"));
        for (axis, tallies) in AXES.iter().zip(&self.by) {
            let _ = write!(text, "\n| {} {HEAD}", axis.name);
            for (part, tally) in axis.parts.iter().zip(tallies) {
                text += &tally.row(part);
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::{Kind, Measures, draw};

    #[test]
    fn every_case_is_in_one_part_of_each_axis() {
        let mut totals = Totals::new();
        let mut count = 0;
        for number in 0..60 {
            let case = draw::case(1, number).unwrap();
            count += 1;
            let verdict = Verdict {
                outcome: Outcome::Completed,
                measures: Measures::default(),
            };
            totals.add(&case, &verdict);
        }
        for tallies in &totals.by {
            assert_eq!(tallies.iter().map(|t| t.cases).sum::<u64>(), count);
        }
        let rows = totals
            .tables()
            .lines()
            .filter(|l| l.starts_with("| all"))
            .count();
        assert_eq!(rows, 1);
        for (kind, part) in Kind::ALL.iter().zip(AXES[AXES.len() - 1].parts) {
            assert_eq!(kind.as_str(), *part);
        }
    }
}
