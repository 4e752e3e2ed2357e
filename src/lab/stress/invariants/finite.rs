//! Every number is one.

use super::broken::{Broken, Found};
use crate::lab::stress::Invariant;
use crate::simulation::Simulation;

pub(super) fn look(sim: &Simulation) -> Found {
    let o = sim.outputs();
    let numbers = [
        ("wire_tension", o.wire_tension),
        ("wire_tension_max", o.wire_tension_max),
        ("bulge_height", o.bulge_height),
        ("gap_width", o.gap_width),
        ("turns_wound", o.turns_wound),
        ("turns_settled", o.turns_settled),
        ("spindle_torque", o.spindle_torque),
        ("feed_speed", o.feed_speed),
        ("fed_length", o.fed_length),
        ("free_length", o.free_length),
        ("layon_position", o.layon_position),
        ("layon_angle", o.layon_angle),
        ("coil_width", o.coil_width),
        ("mean_pitch", o.mean_pitch),
        ("fill_factor", o.fill_factor),
        ("wire_strain", o.wire_strain),
        ("penetration_max", o.penetration_max),
        ("energy_residual", o.energy_residual),
    ];
    if let Some((name, x)) = numbers.into_iter().find(|(_, x)| !x.is_finite()) {
        return Err(Broken::new(Invariant::Finite, format!("{name} = {x}")));
    }
    let rod = &sim.system().state.rod;
    let bad = |i: &usize| !(rod.x[*i].sum() + rod.v[*i].sum()).is_finite();
    match (0..rod.nodes()).find(bad) {
        Some(i) => Err(Broken::new(Invariant::Finite, format!("live node {i}"))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    #[test]
    fn a_node_that_is_nowhere_is_seen() {
        let mut sim = planted::wound(0.5);
        assert_eq!(look(&sim), Ok(()));
        sim.system_mut().state.rod.v[3].y = f64::NAN;
        planted::sees(look(&sim), Invariant::Finite);
    }
}
