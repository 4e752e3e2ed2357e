//! Tensions of frozen wire differ from one node to the next by no more than friction holds.

use super::broken::{Broken, Found};
use crate::lab::stress::Invariant;
use crate::simulation::Simulation;
use crate::system::FrozenPull;

/// By which strain they may: the rounding of places and of a walk along the wire.
const ROUNDING: f64 = 1e-13;

/// Share below the yield limit from which on a tension yields: the rounding of a return to it.
const YIELDS: f64 = 1e-9;

/// Judges every pair of frozen edges, and the last with the first live one.
pub(super) fn look(sim: &Simulation) -> Found {
    let sys = sim.system();
    let Some(friction) = sys.friction_at_rest() else {
        return Ok(());
    };
    let pulls = &sys.state.frozen_pulls;
    let live = sys.state.load.tension.first().map_or(0.0, |t| t.max(0.0));
    // (an edge that yields pulls at frozen wire as it does where yield begins)
    let yields = sys.model.laws.stretch.limit + sys.state.rod.stretch[0].rise;
    let live = (live < (1.0 - YIELDS) * yields).then_some(live);
    let after = pulls.iter().skip(1).map(FrozenPull::pulls).chain(live);
    for (i, (pull, after)) in pulls.iter().zip(after).enumerate() {
        let own = pull.pulls();
        let most = pull.most(friction).at(after);
        let least = pull.least(friction).at(after).min(most);
        let rounding = ROUNDING * sys.model.laws.stretch.modulus;
        if own > most + rounding || own < least - rounding {
            let text = format!(
                "{own:.6} N beside {after:.6} N at frozen edge {i}, {least:.6} to {most:.6} N held"
            );
            return Err(Broken::new(Invariant::FrozenTension, text));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    #[test]
    fn a_tension_that_nothing_holds_is_seen() {
        let mut sim = planted::wound(2.5);
        assert_eq!(look(&sim), Ok(()));
        let pulls = &mut sim.system_mut().state.frozen_pulls;
        let middle = pulls.len() / 2;
        pulls.get_mut(middle).expect("frozen wire").tension *= 1.5;
        planted::sees(look(&sim), Invariant::FrozenTension);
    }
}
