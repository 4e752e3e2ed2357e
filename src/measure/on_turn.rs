//! Where on the wire something is, as people count: a turn and the angle in it.

use super::STATIONS_PER_TURN;
use std::f64::consts::TAU;
use std::fmt::{Display, Formatter, Result};

/// A place on the wire: `turn 3 at 210 deg`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OnTurn {
    /// from 1
    pub(crate) turn: u32,
    /// from the angle of the clamp on, below 360
    pub(crate) angle_deg: f64,
}

impl OnTurn {
    /// That of an angle along the wire from the clamp, rad. Before the clamp there is nothing: it counts as the clamp.
    pub(crate) fn at(angle: f64) -> Self {
        let angle = angle.max(0.0);
        Self {
            turn: (angle / TAU) as u32 + 1,
            angle_deg: (angle % TAU).to_degrees(),
        }
    }

    /// That of a station, from 0.
    pub(crate) fn of_station(station: usize) -> Self {
        Self {
            turn: (station / STATIONS_PER_TURN) as u32 + 1,
            angle_deg: (station % STATIONS_PER_TURN) as f64,
        }
    }
}

impl Display for OnTurn {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "turn {} at {:.0} deg", self.turn, self.angle_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_and_stations_count_from_the_clamp() {
        assert_eq!(OnTurn::at(TAU + 1.0).to_string(), "turn 2 at 57 deg");
        assert_eq!(OnTurn::of_station(721).to_string(), "turn 3 at 1 deg");
        assert_eq!(OnTurn::at(-0.1), OnTurn::of_station(0));
    }
}
