//! Frozen wire stays where it is.

use super::broken::{Broken, Found};
use crate::lab::stress::Invariant;
use crate::math::V3;
use crate::simulation::Simulation;

/// Remembers where frozen wire was.
#[derive(Clone, Debug, Default)]
pub(super) struct Frozen {
    /// at the last look, core frame, m
    last: Vec<V3>,
}

impl Frozen {
    pub(super) fn look(&mut self, sim: &Simulation) -> Found {
        let Some(line) = sim.system().line_scratch() else {
            return Ok(());
        };
        let now = line.tube.points();
        // wire that thawed may freeze again elsewhere
        let stayed = sim.outputs().feed_speed >= 0.0 && now.len() >= self.last.len();
        let mut both = self.last.iter().zip(now).enumerate();
        if stayed && let Some((i, (a, b))) = both.find(|(_, (a, b))| a != b) {
            let text = format!("frozen node {i} moved by {:.3e} m", (a - b).norm());
            return Err(Broken::new(Invariant::Frozen, text));
        }
        self.last.clear();
        self.last.extend_from_slice(now);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    #[test]
    fn frozen_wire_that_moved_is_seen() {
        let sim = planted::wound(1.5);
        let mut frozen = Frozen::default();
        assert_eq!(frozen.look(&sim), Ok(()));
        assert!(frozen.last.len() > 3, "nothing froze");
        assert_eq!(frozen.look(&sim), Ok(()));
        frozen.last[2].y += 1e-15;
        planted::sees(frozen.look(&sim), Invariant::Frozen);
    }
}
