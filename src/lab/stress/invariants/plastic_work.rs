//! Plastic work never comes back, hardening never fades, and the work that was booked is what hardening says.
//!
//! A straight piece of hardening rises by `H` times the plastic strain it has gone through, either way. So the rise `q` of the
//! yield limit `Y` of a joint tells the plastic work done there since it was at `q0`, however many steps that took:
//! `(Y (q - q0) + (q^2 - q0^2) / 2) / H` per length and piece. Where the limit is at its cap, or does not rise, the way of the plastic
//! strain between two looks is a lower bound of what it has gone through.

use super::broken::{Broken, Found};
use crate::lab::stress::{Invariant, Measures};
use crate::rod::{Law, Rod};
use crate::simulation::Simulation;

/// Work that was booked may differ from that of the hardening by this share: rounding of the differences of two rises.
const OFF: f64 = 1e-6;

/// Remembers the plastic state of the wire.
#[derive(Clone, Debug)]
pub(super) struct PlasticWork {
    rod: Rod,
    /// plastic work of bending, twist and stretch so far, J
    booked: [f64; 3],
}

/// Plastic state of a joint or an edge: strain in one or two directions, rise of the limit.
#[derive(Clone, Copy)]
struct Set {
    strain: [f64; 2],
    rise: f64,
}

impl PlasticWork {
    pub(super) fn new(sim: &Simulation) -> Self {
        let state = &sim.system().state;
        Self {
            rod: state.rod.clone(),
            booked: state.balance.plastic,
        }
    }

    /// Judges what happened since the last look; with `same` nodes, joint by joint.
    pub(super) fn look(&mut self, sim: &Simulation, same: bool, m: &mut Measures) -> Found {
        let before = std::mem::replace(self, Self::new(sim));
        for kind in 0..3 {
            let (was, is) = (before.booked[kind], self.booked[kind]);
            // (rounding of sums)
            if is < was - 1e-12 * was.abs() {
                let text = format!("{:.3e} J of {was:.3e} J came back", was - is);
                return Err(Broken::new(Invariant::PlasticWork, text));
            }
        }
        if same && before.rod.nodes() == self.rod.nodes() {
            self.by_hardening(&before, sim, m)?;
        }
        Ok(())
    }

    fn by_hardening(&self, before: &Self, sim: &Simulation, m: &mut Measures) -> Found {
        let laws = &sim.system().model.laws;
        let twist = sim.system().model.twist.is_carried();
        let edges = self.rod.edges();
        // the edge at the nozzle grows, and the set of its joint with it; the first gets and gives what frozen wire gives and gets
        let inner = edges - 1;
        let kinds = [
            ("bending", laws.bend, 2..inner, 0),
            ("twist", laws.twist, if twist { 2..inner } else { 0..0 }, 1),
            ("stretch", laws.stretch, 1..inner, 2),
        ];
        for (name, law, joints, kind) in kinds {
            let (mut least, mut grain) = (0.0, 0.0);
            for i in joints {
                let (was, is) = (set(&before.rod, kind, i), set(&self.rod, kind, i));
                let length = match kind {
                    2 => self.rod.rest[i],
                    _ => self.rod.voronoi(i),
                };
                if law.hardening > 0.0 {
                    // (a rise is told from the one before to the rounding of the limit)
                    let limit = law.limit + is.rise;
                    grain += length * limit * (4.0 * f64::EPSILON * limit / law.hardening);
                }
                least += length
                    * work(&law, was, is).map_err(|text| {
                        Broken::new(Invariant::PlasticWork, format!("{name} at {i} {text}"))
                    })?;
            }
            let booked = self.booked[kind] - before.booked[kind];
            let over = (least - booked) / booked.max(least).max(f64::MIN_POSITIVE);
            m.plastic = m.plastic.max(over);
            let rounding = 1e-12 * self.booked[kind] + grain;
            if least - booked > OFF * least + rounding {
                let text = format!("{name}: {booked:.6e} J booked, {least:.6e} J by its hardening");
                return Err(Broken::new(Invariant::PlasticWork, text));
            }
        }
        Ok(())
    }
}

fn set(rod: &Rod, kind: usize, i: usize) -> Set {
    match kind {
        0 => Set {
            strain: rod.bend[i].curvature,
            rise: rod.bend[i].rise,
        },
        1 => Set {
            strain: [rod.twist[i].strain, 0.0],
            rise: rod.twist[i].rise,
        },
        _ => Set {
            strain: [rod.stretch[i].strain, 0.0],
            rise: rod.stretch[i].rise,
        },
    }
}

/// Plastic work at least that leads from one state to another, J/m.
fn work(law: &Law, was: Set, is: Set) -> Result<f64, String> {
    let rounding = 1e-12 * law.limit;
    if is.rise < was.rise - rounding {
        return Err(format!(
            "has lost {:.3e} of its hardening",
            was.rise - is.rise
        ));
    }
    let [a, b] = [0, 1].map(|k| is.strain[k] - was.strain[k]);
    let way = libm::hypot(a, b);
    let at_cap = law.limit + is.rise >= law.cap * (1.0 - 1e-12);
    if law.hardening == 0.0 || at_cap {
        // (a limit that never falls below what it was)
        return Ok((law.limit + was.rise) * way);
    }
    let (for_rise, work) = law.hardened(was.rise, is.rise);
    if way > for_rise * (1.0 + OFF) + rounding / law.hardening {
        return Err(format!(
            "has set by {way:.3e} with a rise of its limit for {for_rise:.3e}"
        ));
    }
    Ok(work)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    fn yielded() -> (PlasticWork, Simulation) {
        let sim = planted::wound(0.5);
        let plastic = PlasticWork::new(&sim);
        assert!(plastic.booked[0] > 0.0 && plastic.rod.bend[3].rise > 0.0);
        (plastic, sim)
    }

    fn look(mut plastic: PlasticWork, sim: &Simulation) -> Found {
        plastic.look(sim, true, &mut Measures::default())
    }

    #[test]
    fn what_did_not_change_is_sound() {
        let (plastic, sim) = yielded();
        assert_eq!(look(plastic, &sim), Ok(()));
    }

    #[test]
    fn work_that_comes_back_is_seen() {
        let (plastic, mut sim) = yielded();
        sim.system_mut().state.balance.plastic[0] *= 1.0 - 1e-9;
        planted::sees(look(plastic, &sim), Invariant::PlasticWork);
    }

    #[test]
    fn hardening_that_fades_is_seen() {
        let (plastic, mut sim) = yielded();
        sim.system_mut().state.rod.bend[3].rise *= 1.0 - 1e-6;
        planted::sees(look(plastic, &sim), Invariant::PlasticWork);
    }

    #[test]
    fn set_without_hardening_is_seen() {
        let (plastic, mut sim) = yielded();
        sim.system_mut().state.rod.bend[3].curvature[0] += 1.0;
        planted::sees(look(plastic, &sim), Invariant::PlasticWork);
    }

    /// A step that counts a tenth too little: the sum of all steps still rises.
    #[test]
    fn work_that_is_not_booked_is_seen() {
        for kind in 0..3 {
            let (plastic, mut sim) = yielded();
            let law = [0, 1, 2].map(|k| {
                let laws = &sim.system().model.laws;
                [laws.bend, laws.twist, laws.stretch][k]
            })[kind];
            let state = &mut sim.system_mut().state;
            let way = 1e-3 * law.limit / law.modulus;
            let rise = law.hardening * way;
            let before = set(&plastic.rod, kind, 3);
            let length = match kind {
                2 => state.rod.rest[3],
                _ => state.rod.voronoi(3),
            };
            let capped = law.limit + before.rise + rise >= law.cap;
            let share = if capped { 0.0 } else { 1.0 };
            let work = (law.limit + before.rise + 0.5 * rise * share) * way * length;
            match kind {
                0 => {
                    let [a, b] = before.strain;
                    let size = libm::hypot(a, b);
                    state.rod.bend[3].curvature = [a, b].map(|k| k * (1.0 + way / size));
                    state.rod.bend[3].rise += rise * share;
                }
                1 => {
                    state.rod.twist[3].strain += way;
                    state.rod.twist[3].rise += rise;
                }
                _ => {
                    state.rod.stretch[3].strain += way;
                    state.rod.stretch[3].rise += rise;
                }
            }
            state.balance.plastic[kind] += work;
            assert_eq!(look(plastic.clone(), &sim), Ok(()), "kind {kind}");
            sim.system_mut().state.balance.plastic[kind] -= 0.1 * work;
            planted::sees(look(plastic, &sim), Invariant::PlasticWork);
        }
    }
}
