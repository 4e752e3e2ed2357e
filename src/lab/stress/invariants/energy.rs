//! The energy balance explains all energy, and the method's own lines in it stay small.

use super::broken::{Broken, Found};
use crate::lab::stress::{Invariant, Measures};
use crate::simulation::Simulation;

/// Energy that the balance may leave unexplained, as a share of the energy that went through it.
///
/// The work that draws in a diameter of wire is added to that energy, because it is near 0 in the
/// first steps of a run.
const UNEXPLAINED: f64 = 0.05;

/// Remembers what went through the balance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energy {
    /// sums of what the spindle and the feed did, either way, J
    through: f64,
    /// both at the last look, J
    before: [f64; 2],
}

impl Energy {
    pub(super) fn new(sim: &Simulation) -> Self {
        Self {
            through: sim.system().stored(),
            before: [0.0; 2],
        }
    }

    pub(super) fn look(&mut self, sim: &Simulation, m: &mut Measures) -> Found {
        let sys = sim.system();
        let b = sys.state.balance;
        let now = [b.spindle, b.nozzle];
        self.through += (0..2).map(|k| (now[k] - self.before[k]).abs()).sum::<f64>();
        self.before = now;
        m.through = self.through;
        m.motion = m.motion.max(sys.kinetic());
        lines(sim, m);
        let residual = sys.energy_residual(None);
        let scale = self.through + sys.stored() + sys.kinetic() + draw(sim);
        m.energy = m.energy.max((residual / scale).abs());
        if residual.abs() > UNEXPLAINED * scale {
            let text = format!("{residual:.3e} J unexplained of {scale:.3e} J that went through");
            return Err(Broken::new(Invariant::Energy, text));
        }
        Ok(())
    }
}

/// Work that draws in a diameter of wire, J.
fn draw(sim: &Simulation) -> f64 {
    sim.scene().tensioner.tension * sim.system().model.section.diameter
}

/// The method's own lines over what was dissipated.
///
/// Scenes that dissipate nothing have a floor: the work that draws in a diameter of wire, and the largest motion energy. Wire has
/// no damping of its own, so steps may take from its motion what motion there was.
fn lines(sim: &Simulation, m: &mut Measures) {
    let b = sim.system().state.balance;
    m.dissipated = b.plastic.iter().sum::<f64>() + b.friction + b.damping;
    let scale = m.dissipated + draw(sim) + m.motion;
    m.numerical = b.numerical / scale;
    m.remeshing = b.remeshing / scale;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    #[test]
    fn energy_from_nowhere_is_seen() {
        let mut sim = planted::wound(0.5);
        let mut energy = Energy::new(&planted::wound(0.0));
        assert_eq!(energy.look(&sim, &mut Measures::default()), Ok(()));
        let balance = &mut sim.system_mut().state.balance;
        balance.inflow += 0.1 * (balance.spindle.abs() + balance.nozzle.abs());
        planted::sees(
            energy.look(&sim, &mut Measures::default()),
            Invariant::Energy,
        );
    }
}
