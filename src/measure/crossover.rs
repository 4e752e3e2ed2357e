//! Crossovers: where wire steps from one place of its row to the next.
//!
//! Beside a crossover there are no grooves, and a turn that crosses a little before or after the one before it leaves room
//! between the two. That room is no gap of the winding, and closes where both lie in their places again.

use super::STATION_STEP;

/// Share of the planned slope from which on wire crosses. Chosen: half. Wire in its place runs straight, and wire that is drawn
/// through its crossover late does so more steeply than planned.
const STEEP: f64 = 0.5;
/// Longest crossover that is one to the measures, rad: a sixth of a turn, and usual ones take a twelfth to a sixth. In longer ones wire
/// moves no more steeply than wire that creeps to its place, and most of a turn would count as crossing.
const LONGEST: f64 = std::f64::consts::TAU / 6.0;
/// Stations over which the slope of the wire is taken.
pub(crate) const OVER: usize = 6;

/// The crossover that the scene plans for each turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossover {
    /// way along y, m
    pub step: f64,
    /// winding angle that it takes, rad
    pub angle: f64,
}

impl Crossover {
    /// Way along y from which on wire crosses, over [`OVER`] stations, m.
    pub(crate) fn steep(&self) -> f64 {
        STEEP * self.step / self.angle.min(LONGEST) * OVER as f64 * STATION_STEP
    }

    /// Gap beside a turn above which it is a hole, m. A turn that crosses half a crossover before or after the one before it leaves
    /// half a step between the two.
    pub(crate) fn hole(&self) -> f64 {
        0.5 * self.step.abs()
    }

    /// Stations up to which wire is beside its crossover, before it; after it, twice as many.
    pub(crate) fn beside(&self) -> usize {
        (0.5 * self.angle.min(LONGEST) / STATION_STEP).ceil() as usize
    }
}
