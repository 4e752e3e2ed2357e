//! The spindle's speed over its angle that follows from a scene: from rest to its speed, but never faster than a table says or,
//! where wire climbs to the next layer, than the scene wants it there.
//!
//! The square of the speed is linear in the angle where acceleration is constant, so the lowest of such laws is one.

use super::angle_table::{AngleTable, Form};
use super::impossible::si;
use super::nozzle_law::NozzleLaw;
use super::problems::Problems;
use super::speed_law::SpeedLaw;
use crate::settings::SceneSettings;
use std::f64::consts::TAU;

/// Points nearer to each other are one, rad. Chosen: a millionth of a turn, which takes no solver's step at any speed.
const NEAR: f64 = 1e-6 * TAU;

/// Most points of a table that is repeated.
const MOST_POINTS: f64 = 1e6;

/// Share of a square of a speed by which rounding may miss it.
const ROUNDING: f64 = 1e-12;

/// Angle, rad, and square of the speed, (rad/s)^2, by rising angle; before the first and beyond the last it is constant.
type Points = Vec<[f64; 2]>;

impl SceneSettings {
    /// The spindle's speed over its angle, and what is wrong with it.
    pub(super) fn speed_law(
        &self,
        nozzle: &NozzleLaw,
        problems: &mut Problems,
    ) -> Option<SpeedLaw> {
        let s = &self.spindle;
        let top = s.speed * s.speed;
        let ramp = s.ramp_turns.min(nozzle.turns()) * TAU;
        let mut points = vec![[0.0, 0.0], [ramp, top]];
        if !s.file.is_empty() {
            let table = self.speed_table(nozzle.turns(), problems)?;
            points = lowest(&points, &table);
        }
        if s.flange_share < 1.0 {
            let (slow, way) = (top * s.flange_share * s.flange_share, s.flange_turns * TAU);
            for &[from, to] in nozzle.jumps() {
                let climb = [[from - way, top], [from, slow], [to, slow], [to + way, top]];
                points = lowest(&points, &climb);
            }
        }
        Some(SpeedLaw::through(&points))
    }

    /// What is wrong with the tables of a scene whose nozzle has no law.
    pub(super) fn check_tables(&self, problems: &mut Problems) {
        if self.winds_table() {
            self.law_of_table(problems);
        }
        if !self.spindle.file.is_empty() {
            self.speed_table(0.0, problems);
        }
    }

    /// The speed that a table allows, for so many turns where it is repeated.
    fn speed_table(&self, turns: f64, problems: &mut Problems) -> Option<Points> {
        let s = &self.spindle;
        let form = Form {
            key: "spindle.file",
            file: &s.file,
            columns: &[("share", ""), ("speed", "rad/s")],
            wrong: no_speed,
            allowed: "a CSV file, relative to the scene file, with the columns turns (or angle_deg, angle_rad) and share of spindle.speed (or speed_rpm, speed)",
        };
        let AngleTable { column, rows } = self.angle_table(form, problems)?;
        let of_share = column == "share";
        let speed = |value: f64| if of_share { value * s.speed } else { value };
        let once: Points = rows
            .iter()
            .map(|&[turns, value]| [turns * TAU, speed(value) * speed(value)])
            .collect();
        let period = s.repeat_turns;
        if period == 0.0 {
            return Some(once);
        }
        let [last, ended] = rows[rows.len() - 1];
        let wrong = if last > period {
            Some(format!(
                "the table of spindle.file goes on to {} turns",
                si(last)
            ))
        } else if last == period && ended != rows[0][1] {
            Some(format!(
                "at {} turns the table of spindle.file is not where it begins",
                si(last)
            ))
        } else if turns / period * rows.len() as f64 > MOST_POINTS {
            Some(format!(
                "{} turns would need more than {MOST_POINTS} rows",
                si(turns)
            ))
        } else {
            None
        };
        if let Some(reason) = wrong {
            let allowed = "0, or the turns of a whole round of the table";
            problems.add(self.impossible("spindle.repeat_turns", reason, allowed));
            return None;
        }
        let rounds = 0..(turns / period).ceil() as u32;
        let repeated = rounds.flat_map(|round| {
            let shift = f64::from(round) * period * TAU;
            let rows = once.iter().filter(move |row| row[0] < period * TAU);
            rows.map(move |row| [row[0] + shift, row[1]])
        });
        Some(repeated.collect())
    }
}

/// What is wrong with a share of the speed, or a speed, rad/s.
fn no_speed(column: &str, value: f64) -> Option<String> {
    let (most, range) = match column {
        "share" => (1.0, "above 0 to 1"),
        _ => (f64::INFINITY, "above 0"),
    };
    (value <= 0.0 || value > most).then(|| format!("{column} is {}; {range} is allowed", si(value)))
}

/// The lower of two laws at every angle from 0 on.
fn lowest(one: &[[f64; 2]], other: &[[f64; 2]]) -> Points {
    let mut angles: Vec<f64> = one.iter().chain(other).map(|point| point[0]).collect();
    angles.push(0.0);
    angles.retain(|angle| *angle >= 0.0);
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    let [mut one, mut other] = [one, other].map(Walk::new);
    let mut points: Points = Vec::with_capacity(2 * angles.len());
    let mut before: Option<[f64; 3]> = None;
    for angle in angles {
        let (a, b) = (one.at(angle), other.at(angle));
        if let Some([from, was_a, was_b]) = before
            && (was_a - was_b) * (a - b) < 0.0
        {
            let share = (was_a - was_b) / ((was_a - was_b) - (a - b));
            push(
                &mut points,
                [from + share * (angle - from), was_a + share * (a - was_a)],
            );
        }
        push(&mut points, [angle, a.min(b)]);
        before = Some([angle, a, b]);
    }
    points
}

/// Adds a point, in place of the last one where that lies on the way to it.
fn push(points: &mut Points, point: [f64; 2]) {
    if let [.., last] = points[..]
        && point[0] - last[0] < NEAR
    {
        // (the first says where the spindle begins)
        if points.len() > 1 {
            let end = points.len() - 1;
            points[end][1] = last[1].min(point[1]);
        }
        return;
    }
    if let [.., first, middle] = points[..] {
        let share = (middle[0] - first[0]) / (point[0] - first[0]);
        let straight = first[1] + share * (point[1] - first[1]);
        if (straight - middle[1]).abs() <= ROUNDING * (first[1] + point[1]) {
            points.pop();
        }
    }
    points.push(point);
}

/// A law whose values are asked for at rising angles.
struct Walk<'a> {
    points: &'a [[f64; 2]],
    next: usize,
}

impl<'a> Walk<'a> {
    fn new(points: &'a [[f64; 2]]) -> Self {
        Self { points, next: 0 }
    }

    fn at(&mut self, angle: f64) -> f64 {
        while self
            .points
            .get(self.next)
            .is_some_and(|point| point[0] < angle)
        {
            self.next += 1;
        }
        match (self.next, self.points.get(self.next)) {
            (0, Some(first)) => first[1],
            (next, Some(after)) => {
                let before = self.points[next - 1];
                let share = (angle - before[0]) / (after[0] - before[0]);
                before[1] + share * (after[1] - before[1])
            }
            (next, None) => self.points[next - 1][1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_law_is_the_lower_at_every_angle() {
        let one = vec![[0.0, 0.0], [1.0, 9.0], [4.0, 9.0], [5.0, 1.0]];
        let other = vec![[-1.0, 4.0], [2.0, 4.0], [2.5, 16.0], [4.5, 2.0]];
        let both = lowest(&one, &other);
        for k in 0..=700 {
            let angle = 0.01 * f64::from(k);
            let at = |points: &Points| Walk::new(points).at(angle);
            assert!(
                (at(&both) - at(&one).min(at(&other))).abs() < 1e-9,
                "{angle}"
            );
        }
    }

    #[test]
    fn points_on_the_way_between_others_go() {
        let flat = [[0.0, 0.0], [1.0, 9.0]];
        let table = [[0.0, 20.0], [0.5, 30.0], [2.0, 30.0], [3.0, 30.0]];
        assert_eq!(
            lowest(&flat, &table),
            vec![[0.0, 0.0], [1.0, 9.0], [3.0, 9.0]]
        );
    }
}
