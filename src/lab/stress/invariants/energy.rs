//! The energy balance explains all energy, and the method's own lines in it stay small.

use super::broken::{Broken, Found};
use crate::lab::stress::{Invariant, Measures};
use crate::simulation::{Simulation, UNEXPLAINED};

/// Share of what went through and what was dissipated that a line of the method's own may have.
const OWN: f64 = 0.05;

/// What landings or friction gave back may be this share of plastic work and the work that draws in a diameter of wire: touches begin
/// and end within steps.
const BELOW: f64 = 1e-3;

/// Remembers what went through the balance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energy {
    /// sums of what the spindle and the feed did, either way, J
    through: f64,
    /// both at the last look, J
    before: [f64; 2],
    /// sum of what came into motion, J
    moved: f64,
    /// motion at the last look, with what went with frozen wire, J
    motion: f64,
}

impl Energy {
    pub(super) fn new(sim: &Simulation) -> Self {
        Self {
            through: sim.system().stored(),
            before: [0.0; 2],
            moved: 0.0,
            motion: motion(sim),
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
        let motion = motion(sim);
        self.moved += (motion - self.motion).max(0.0);
        self.motion = motion;
        let residual = sys.energy_residual(None);
        let scale = self.through + sys.stored() + sys.kinetic() + draw(sim);
        self.lines(sim, scale, m)?;
        m.energy = m.energy.max((residual / scale).abs());
        if residual.abs() > UNEXPLAINED * scale {
            let text = format!("{residual:.3e} J unexplained of {scale:.3e} J that went through");
            return Err(Broken::new(Invariant::Energy, text));
        }
        Ok(())
    }

    /// The method's own lines, against what was dissipated and the `scale` of what went through, J; friction and blows take.
    ///
    /// The work that draws in a diameter of wire is allowed where next to nothing went through.
    /// Wire has no damping of its own, so steps may take from its motion what motion there was; they may not give any.
    fn lines(&self, sim: &Simulation, scale: f64, m: &mut Measures) -> Found {
        let b = sim.system().state.balance;
        let plastic = b.plastic.iter().sum::<f64>();
        let given = -b.damping.min(b.friction).min(0.0);
        m.given = m.given.max(given / (plastic + draw(sim)));
        if m.given > BELOW {
            let text = format!(
                "{:.3e} J of blows, {:.3e} J of friction: they gave energy",
                b.damping, b.friction
            );
            return Err(Broken::new(Invariant::Energy, text));
        }
        m.dissipated = plastic + b.friction + b.damping;
        let over = m.dissipated + draw(sim) + m.motion;
        m.numerical = b.numerical / over;
        m.remeshing = b.remeshing / over;
        let allowed = draw(sim) + OWN * (m.dissipated + scale);
        let taken = allowed + self.moved;
        let most = if b.numerical > 0.0 { taken } else { allowed };
        let own = [
            ("numerical", b.numerical, most),
            ("remeshing", b.remeshing, allowed),
        ];
        for (k, (name, energy, most)) in own.into_iter().enumerate() {
            let share = energy.abs() / most;
            m.own[k] = m.own[k].max(share);
            if share > 1.0 {
                let text = format!(
                    "{name} energy is {energy:.3e} J, {share:.2} of what is allowed ({:.3e} J dissipated)",
                    m.dissipated
                );
                return Err(Broken::new(Invariant::Energy, text));
            }
        }
        Ok(())
    }
}

/// Work that draws in a diameter of wire, J.
fn draw(sim: &Simulation) -> f64 {
    sim.scene().tensioner.tension * sim.system().model.section.diameter
}

/// Motion energy, of frozen wire too, J.
fn motion(sim: &Simulation) -> f64 {
    let sys = sim.system();
    sys.kinetic() + sys.state.balance.frozen_kinetic
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
    #[test]
    fn energy_of_the_steps_or_the_mesh_is_seen() {
        for line in 0..3 {
            let mut sim = planted::wound(0.5);
            let mut energy = Energy::new(&planted::wound(0.0));
            assert_eq!(energy.look(&sim, &mut Measures::default()), Ok(()));
            let balance = &mut sim.system_mut().state.balance;
            // (booked twice, so that nothing is unexplained)
            let much = balance.plastic.iter().sum::<f64>() + 0.2 * balance.spindle.abs();
            match line {
                0 => balance.numerical += much,
                1 => balance.numerical -= much,
                _ => balance.remeshing += much,
            }
            balance.inflow += if line == 1 { -much } else { much };
            planted::sees(
                energy.look(&sim, &mut Measures::default()),
                Invariant::Energy,
            );
        }
    }

    #[test]
    fn damping_below_nothing_is_seen() {
        let mut sim = planted::wound(0.5);
        let mut energy = Energy::new(&planted::wound(0.0));
        let balance = &mut sim.system_mut().state.balance;
        balance.damping -= 0.1 * balance.plastic.iter().sum::<f64>();
        planted::sees(
            energy.look(&sim, &mut Measures::default()),
            Invariant::Energy,
        );
    }
}
