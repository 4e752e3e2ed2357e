//! The nozzle never pushes wire out.

use super::broken::{Broken, Found};
use crate::lab::stress::{Invariant, Measures};
use crate::simulation::Simulation;

/// Compression that is allowed at the nozzle, as a share of the pull that the scene sets: what a slack line leaves when
/// the edge there is longer by the rounding of a solve.
const PUSHED: f64 = 1e-3;

/// Judges the tension of the edge at the nozzle as the forces have it; outputs are cut off at zero.
pub(super) fn look(sim: &Simulation, m: &mut Measures) -> Found {
    let tension = sim.system().state.load.tension.last().copied();
    let tension = tension.unwrap_or(0.0);
    let pushed = -tension / sim.scene().tensioner.tension;
    m.pushed = m.pushed.max(pushed);
    if pushed > PUSHED {
        let text = format!("the nozzle pushes wire out by {:.3e} N", -tension);
        return Err(Broken::new(Invariant::Tension, text));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    #[test]
    fn a_nozzle_that_pushes_is_seen() {
        let mut sim = planted::wound(0.5);
        assert_eq!(look(&sim, &mut Measures::default()), Ok(()));
        let pull = sim.scene().tensioner.tension;
        *sim.system_mut().state.load.tension.last_mut().unwrap() = -0.01 * pull;
        planted::sees(look(&sim, &mut Measures::default()), Invariant::Tension);
    }
}
