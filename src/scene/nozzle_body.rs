//! The nozzle's body, hole and exit: what does not fit together, and wire that yields over the edge of the exit.

use super::Integrator;
use super::error::Warning;
use super::extent::Extent;
use super::impossible::si;
use super::problems::Problems;
use crate::rod::{ExitBend, Laws, Section};
use crate::settings::SceneSettings;

impl SceneSettings {
    pub(super) fn check_nozzle_body(
        &self,
        diameter: f64,
        integrator: Integrator,
        problems: &mut Problems,
    ) {
        let n = &self.nozzle;
        if n.bore > 0.0 && n.bore <= diameter {
            problems.add(self.impossible(
                "nozzle.bore",
                format!("the wire, {} m, does not go through the hole", si(diameter)),
                format!("more than {} m, or 0: not said", si(diameter)),
            ));
        }
        if n.exit_radius > 0.0 && !integrator.is_implicit() {
            let reason = "the explicit methods do not bend wire over the exit";
            problems.add(self.impossible("nozzle.exit_radius", reason, "0"));
        }
        if n.outer_diameter == 0.0 {
            return;
        }
        let half = match n.length {
            0.0 => f64::INFINITY,
            length => 0.5 * length,
        };
        let most = half.min(0.5 * n.outer_diameter);
        if n.edge_radius > most {
            let reason = "the rims need more than the body's radius or half its length";
            let allowed = format!("0 to {} m", si(most));
            problems.add(self.impossible("nozzle.edge_radius", reason, allowed));
            return;
        }
        let hole = n.bore.max(diameter);
        let least = hole + 2.0 * (n.exit_radius + n.edge_radius);
        if n.outer_diameter < least {
            problems.add(self.impossible(
                "nozzle.outer_diameter",
                "the body has no room for the hole, the radius of its edge and that of the rim",
                format!("at least {} m, or 0: the nozzle is a point", si(least)),
            ));
        }
    }

    /// Wire that yields where it is drawn over the edge of the exit.
    ///
    /// It bends most where the free span just touches the circle that the core sweeps.
    pub(super) fn yielding_exit(&self, wire: &Section, extent: &Extent) -> Option<Warning> {
        let key = "nozzle.exit_radius";
        let edge = self.nozzle.exit_curvature(wire.radius());
        let sine = (extent.winding_radius + wire.radius()) / self.nozzle.distance;
        if edge == 0.0 || sine >= 1.0 {
            return None;
        }
        let (angle, tension) = (libm::asin(sine), self.tensioner.tension);
        let law = Laws::new(wire).bend;
        let bend = ExitBend::over(&law, edge, angle, tension);
        let (strain, yields) = (
            0.5 * wire.bare_diameter * bend.curvature,
            0.5 * wire.bare_diameter * law.limit / law.modulus,
        );
        (strain > yields).then(|| Warning {
            origin: self.told_origin(key),
            key,
            value: self.shown(key),
            message: format!(
                "the wire yields over the edge of the exit: at {:.0} deg and {} N it bends to a radius of {} m, a strain of {:.2} % \
                 at its surface, and yields from {:.2} % on; to bend it and to straighten it takes {} N, which the run counts, and \
                 it comes out with a set of radius {} m, which the run leaves out",
                angle.to_degrees(),
                si(tension),
                si(1.0 / bend.curvature),
                100.0 * strain,
                100.0 * yields,
                si(bend.work),
                si(1.0 / bend.set)
            ),
        })
    }
}
