//! Wire between clamp and nozzle is what there was and what was fed.

use super::broken::{Broken, Found};
use crate::lab::stress::Invariant;
use crate::simulation::Simulation;

/// Wire that is there may differ from what was fed by this share: rounding of sums; ...
const ROUNDING: f64 = 1e-9;
/// ... and so much of it may have gone where arcs became chords, node by node; ...
const JOINED: f64 = 2e-4;
/// ... or have come where chords became arcs, and gone where bent wire went back into the nozzle. Wire that bends by an angle from edge to
/// edge, rad, is longer than its chords by a 32nd of the square of that angle. All of this wire may bend by 0.2 rad, four times the angle
/// from which on coarse edges are halved.
const ARCS: f64 = 0.2 * 0.2 / 32.0;

/// Remembers how much wire there was.
#[derive(Clone, Copy, Debug)]
pub(super) struct Length {
    /// at the start, m
    start: f64,
    /// fed up to the last look, m
    fed: f64,
    /// wire that came out of the nozzle and wire that went back, m
    passed: [f64; 2],
}

impl Length {
    pub(super) fn new(sim: &Simulation) -> Self {
        Self {
            start: wire_length(sim),
            fed: sim.outputs().fed_length,
            passed: [0.0; 2],
        }
    }

    pub(super) fn look(&mut self, sim: &Simulation) -> Found {
        let (is, fed) = (wire_length(sim), sim.outputs().fed_length);
        let came = fed - self.fed;
        self.fed = fed;
        self.passed[usize::from(came < 0.0)] += came.abs();
        let joined = sim.system().state.joined_away;
        let [out, back] = self.passed;
        let all = self.start + out + back;
        if joined > JOINED * all + ARCS * back || -joined > ARCS * all {
            let text = format!("{joined:.3e} m of {all:.3e} m lost where nodes went and came");
            return Err(Broken::new(Invariant::Length, text));
        }
        if (is - self.start - fed).abs() > ROUNDING * all {
            let text = format!(
                "{is:.9} m of wire, {:.9} m at the start and {fed:.9} m fed",
                self.start
            );
            return Err(Broken::new(Invariant::Length, text));
        }
        Ok(())
    }
}

/// Unstretched wire from clamp to nozzle, m.
fn wire_length(sim: &Simulation) -> f64 {
    let sys = sim.system();
    sys.state.arc0 + sys.state.rod.rest.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    #[test]
    fn wire_from_nowhere_is_seen() {
        let mut sim = planted::wound(0.5);
        let mut length = Length::new(&planted::wound(0.0));
        assert_eq!(length.look(&sim), Ok(()));
        sim.system_mut().state.rod.rest[3] *= 1.0 + 1e-5;
        planted::sees(length.look(&sim), Invariant::Length);
    }

    #[test]
    fn wire_lost_to_chords_is_seen() {
        let mut sim = planted::wound(0.5);
        let mut length = Length::new(&planted::wound(0.0));
        let lost = 1e-3 * wire_length(&sim);
        for much in [lost, -3.0 * lost] {
            sim.system_mut().state.joined_away += much;
            planted::sees(length.look(&sim), Invariant::Length);
        }
    }
}
