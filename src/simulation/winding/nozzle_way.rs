//! The way of the nozzle: how far it went, and where it turned.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Share of the way back that counts, up to which the nozzle stands: more than rounding moves it by, and too little to be seen.
const STANDS: f64 = 1e-9;

/// Where the nozzle was farthest one way along y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct Farthest {
    /// m
    y: f64,
    /// turn of the core in the direction of winding when the nozzle came there, rad
    came: f64,
    /// the same when it left, rad; the nozzle stands there as long as it equals the present turn
    left: f64,
    /// winding angle of the wire laid at a turn of the core, less that turn, rad; once the nozzle has left
    pub(in crate::simulation) ahead: Option<f64>,
}

impl Farthest {
    fn at(y: f64, core: f64) -> Self {
        Self {
            y,
            came: core,
            left: core,
            ahead: None,
        }
    }

    /// Where that is along y, m.
    pub(in crate::simulation) fn place(&self) -> f64 {
        self.y
    }

    /// Winding angle of the wire that was laid as the nozzle turned here, rad.
    ///
    /// A nozzle may stand at the end of its way. In the first turn of that it completes its pass; wire laid there
    /// later has no room beside the wire before.
    pub(in crate::simulation) fn laid(&self, ahead: f64) -> f64 {
        self.left.min(self.came + TAU) + self.ahead.unwrap_or(ahead)
    }
}

/// The way of the nozzle so far, as far as passes need it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct Traverse {
    /// direction of the present pass along y; 0 until the nozzle has moved by the way that counts
    sense: f64,
    /// farthest towards -y and towards +y in this pass
    ends: [Farthest; 2],
    /// turn of the core at which each pass after the first began, rad
    began: Vec<f64>,
    /// turn of the core in the direction of winding at the last look, rad
    core: f64,
}

/// What a look at the nozzle found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulation) enum Found {
    Nothing,
    /// the first pass goes this way along y
    First(f64),
    /// the nozzle turned at this place and now goes this way along y
    Turned(Farthest, f64),
    /// the core has gone back to before the last turning point
    TakenBack,
}

impl Traverse {
    /// A nozzle at `y`, m.
    pub(in crate::simulation) fn new(y: f64) -> Self {
        Self {
            sense: 0.0,
            ends: [Farthest::at(y, 0.0); 2],
            began: Vec::new(),
            core: 0.0,
        }
    }

    /// Whether it goes with so many passes; bytes from elsewhere may say anything.
    pub(in crate::simulation) fn fits(&self, passes: usize) -> bool {
        [-1.0, 0.0, 1.0].contains(&self.sense) && self.began.len() + 1 == passes
    }

    /// Looks at the nozzle at `y` (m) when the core has turned by `core` (rad) in the direction of winding;
    /// `turned` (m) is the way back that counts.
    pub(in crate::simulation) fn look(&mut self, y: f64, core: f64, turned: f64) -> Found {
        let back = core < self.core;
        self.core = core;
        if self.began.last().is_some_and(|&began| core < began) {
            self.began.pop();
            self.sense = -self.sense;
            self.ends = [Farthest::at(y, core); 2];
            return Found::TakenBack;
        }
        for (end, sign) in self.ends.iter_mut().zip([-1.0, 1.0]) {
            let beyond = sign * (y - end.y);
            // What was laid since is being unwound, and the nozzle may start anew from where it is.
            if beyond > STANDS * turned || (back && core < end.left) {
                *end = Farthest::at(y, core);
            } else if beyond >= -STANDS * turned && end.ahead.is_none() {
                end.left = core;
            }
        }
        if back {
            return Found::Nothing;
        }
        let [low, high] = self.ends;
        let (rise, fall) = (y - low.y > turned, high.y - y > turned);
        if self.sense == 0.0 && (rise || fall) {
            self.sense = if rise { 1.0 } else { -1.0 };
            return Found::First(self.sense);
        }
        let turn = match self.sense {
            s if s > 0.0 && fall => high,
            s if s < 0.0 && rise => low,
            _ => return Found::Nothing,
        };
        self.sense = -self.sense;
        self.began.push(turn.left.min(turn.came + TAU));
        self.ends = [Farthest::at(y, core); 2];
        Found::Turned(turn, self.sense)
    }

    /// Ends that the nozzle has left, whose lay-on place is not on record yet.
    pub(in crate::simulation) fn just_left(&mut self) -> impl Iterator<Item = &mut Farthest> {
        let core = self.core;
        let ends = self.ends.iter_mut();
        ends.filter(move |end| end.ahead.is_none() && end.left < core)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the second pass begins when the nozzle comes, stands from 1 to 3 rad and goes back, off its place by rounding.
    fn began(rounding: f64) -> f64 {
        let mut way = Traverse::new(0.0);
        for k in 0..500 {
            let core = 0.01 * f64::from(k);
            let y = 1e-3 * (core.min(1.0) - (core - 3.0).max(0.0));
            let sign = f64::from(k % 3) - 1.0;
            if let Found::Turned(turn, sense) = way.look(y + sign * rounding, core, 3.5e-4) {
                assert_eq!(sense, -1.0);
                return turn.laid(0.0);
            }
        }
        panic!("it has turned");
    }

    #[test]
    fn rounding_moves_no_nozzle_that_stands() {
        assert_eq!(began(0.0), 3.0);
        assert_eq!(began(1e-18), 3.0);
    }
}
