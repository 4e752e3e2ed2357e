//! Rows: wire that lies turn beside turn, one way along y.
//!
//! The wire trails behind the nozzle. When the nozzle turns, wire may still be laid on beside the row for a turn or more,
//! or may have climbed already. A pass is what the nozzle did, a row is what the wire made of it.

use super::passes::Pass;
use super::plumb::Plumb;

/// Way back along y by which wire has turned, diameters: more than jitter, less than the groove beside it.
const CAME_BACK: f64 = 0.5;

/// The row that a station belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Row {
    /// from 1
    pub(crate) number: u32,
    /// winding angle at which it begins, rad
    pub(crate) from: f64,
    /// its direction along y, +1 or -1
    pub(crate) sense: f64,
    /// farthest place along y in that direction, m
    farthest: f64,
    /// where the pass began in which wire climbed beside a flange, rad: the row is that of the pass to come
    ahead_of: Option<f64>,
    /// the row that wire left where it climbed beside a flange
    left: Option<Left>,
}

/// A row that wire has left, and may come down to again.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Left {
    number: u32,
    from: f64,
    farthest: f64,
    /// that of its wire
    layer: u32,
}

impl Row {
    /// The first row, in the direction of its pass, from a place along y, m.
    pub(crate) fn first(pass: Pass, y: f64) -> Self {
        Self {
            number: 1,
            from: f64::NEG_INFINITY,
            sense: pass.sense,
            farthest: y,
            ahead_of: None,
            left: None,
        }
    }

    /// Whether the nozzle goes the other way by now, so that the next row may begin.
    pub(crate) fn is_over_in(&self, pass: Pass) -> bool {
        self.sense != pass.sense && self.ahead_of != Some(pass.from)
    }

    /// The row after this one, which begins at `angle` (rad) and `y` (m) because wire has climbed from its `layer` beside a flange: the
    /// nozzle still goes the way of `pass`.
    pub(crate) fn beside_flange(self, pass: Pass, (angle, y): (f64, f64), layer: u32) -> Self {
        Self {
            number: self.number + 1,
            from: angle,
            sense: -self.sense,
            farthest: y,
            ahead_of: Some(pass.from),
            left: Some(Left {
                number: self.number,
                from: self.from,
                farthest: self.farthest,
                layer,
            }),
        }
    }

    /// The row that wire left beside a flange, with its layer, while the nozzle still goes the way of it.
    pub(crate) fn left_in(self, pass: Pass) -> Option<(Self, u32)> {
        let left = self.left.filter(|_| self.ahead_of == Some(pass.from))?;
        let row = Self {
            number: left.number,
            from: left.from,
            sense: -self.sense,
            farthest: left.farthest,
            ahead_of: None,
            left: None,
        };
        Some((row, left.layer))
    }

    /// The same with the place that it had got to `before`: wire that sank into a hole of the row below has not gone on there.
    pub(crate) fn no_farther_than(self, before: Self) -> Self {
        Self {
            farthest: before.farthest,
            ..self
        }
    }

    /// The row of the next station at `angle` (rad) and `y` (m): a new one once the nozzle has turned and wire has
    /// climbed or come back.
    pub(crate) fn next(self, pass: Pass, angle: f64, y: f64, climbed: bool, diameter: f64) -> Self {
        let back = (self.farthest - y) * self.sense > CAME_BACK * diameter;
        if self.is_over_in(pass) && (climbed || back) {
            return Self {
                number: self.number + 1,
                from: angle,
                sense: pass.sense,
                farthest: y,
                ahead_of: None,
                left: None,
            };
        }
        let farthest = if (y - self.farthest) * self.sense > 0.0 {
            y
        } else {
            self.farthest
        };
        Self { farthest, ..self }
    }
}

/// Where the wire of the next station lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowPlace {
    /// winding angle, rad
    pub(crate) angle: f64,
    /// of its polar angle and its place along y
    pub(crate) bucket: (usize, i64),
    /// m
    pub(crate) y: f64,
    /// over the core, m
    pub(crate) height: f64,
    /// way along y to the face of the flange beside it, m
    pub(crate) flange: Option<f64>,
    /// which way is down
    pub(crate) plumb: Plumb,
    /// it lies in its crossover or beside it, as far as the plan has one
    pub(crate) crosses: bool,
}

impl RowPlace {
    /// Whether a flange leaves no room for another turn of the row: wire that climbs here does so because it has to.
    ///
    /// Wire that lies half a diameter beside the turn that it climbs on, a diameter from the flange, has just as much room beside
    /// that turn as a turn needs.
    pub(crate) fn has_no_room_in(&self, row: Row, diameter: f64) -> bool {
        self.flange
            .is_some_and(|flange| flange * row.sense > 0.0 && flange.abs() < diameter)
    }
}
