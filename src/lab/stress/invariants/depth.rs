//! Wire stays out of the core, and no touch is ever so deep that its law means nothing.

use super::broken::{Broken, Found};
use crate::lab::stress::{Invariant, Measures};
use crate::math::Spin;
use crate::scene::{Core, Scene};
use crate::simulation::{DEEPEST, Simulation};

/// Centreline may be deeper in the core than its contact says by this share of the diameter: it is
/// looked at between the points that touch.
const SUNK: f64 = 0.3;

pub(super) fn look(sim: &Simulation, m: &mut Measures) -> Found {
    let sys = sim.system();
    let d = sys.model.section.diameter;
    m.depth = sys.state.deepest / d;
    if m.depth > DEEPEST {
        let text = format!("a touch was {:.2} d deep", m.depth);
        return Err(Broken::new(Invariant::Penetration, text));
    }
    in_core(sim, m)
}

/// The live centreline against the core, whatever the method's own touches say.
fn in_core(sim: &Simulation, m: &mut Measures) -> Found {
    let (sys, scene) = (sim.system(), sim.scene());
    let (r, d) = (scene.wire.radius(), scene.wire.diameter);
    let spin = Spin::new(sys.state.spindle.angle);
    let pull = sys.state.load.tension.iter().copied().fold(0.0, f64::max);
    let allowed = SUNK * d + softness(scene, pull);
    for i in 1..sys.state.rod.nodes() - 1 {
        let depth = r - sys.distance_to_core(spin.to_core(sys.centre(i)));
        m.sunk = m.sunk.max(depth / d);
        if depth > allowed {
            let text = format!(
                "live node {i} is {:.1} um in the core, {:.2} d",
                depth * 1e6,
                depth / d
            );
            return Err(Broken::new(Invariant::Penetration, text));
        }
    }
    Ok(())
}

/// Depth that the stiffness allows where the wire is drawn round the tightest bend, within reason, m.
fn softness(scene: &Scene, pull: f64) -> f64 {
    let r = scene.wire.radius();
    let bend = match scene.core {
        Core::RoundedBox { corner_radius, .. } => corner_radius + r,
        Core::Cylinder { radius, .. } => radius + r,
        Core::Mesh { .. } => r,
    };
    (pull / bend / scene.contact.stiffness).min(0.2 * scene.wire.diameter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;
    use crate::math::V3;

    #[test]
    fn wire_in_the_core_is_seen() {
        let mut sim = planted::wound(0.5);
        assert_eq!(look(&sim, &mut Measures::default()), Ok(()));
        for x in &mut sim.system_mut().state.rod.x[2..5] {
            *x -= V3::new(x.x, 0.0, x.z) * 0.1;
        }
        planted::sees(look(&sim, &mut Measures::default()), Invariant::Penetration);
    }

    #[test]
    fn a_touch_too_deep_in_the_middle_of_a_landing_is_seen() {
        let mut sim = planted::wound(0.5);
        sim.system_mut().state.deepest = 0.51 * sim.scene().wire.diameter;
        planted::sees(look(&sim, &mut Measures::default()), Invariant::Penetration);
    }
}
