//! What the nozzle must not meet: core, flanges and the coil.
//!
//! Without `nozzle.outer_diameter` the nozzle is a point, and the coil, at rest or not, must not reach as far out as it stands. With it the
//! nozzle has a body, a round rod from the exit outwards along +x. After every step the body is held against the core where
//! that stands at that instant, against frozen wire, and against live wire that is laid. The free span may pass beside it.

use crate::contact::ContactPoint;
use crate::geometry::{Nearness, RoundedRod};
use crate::math::{Spin, V3, polar_angle, wrap_to_pi};
use crate::measure::{DefectKind, OnTurn};
use crate::settings::Nozzle;
use crate::signals::Inputs;
use crate::simulation::Winding;
use crate::simulation::motion::nozzle_of;

/// What the nozzle's body met, and where.
struct Meeting {
    what: String,
    /// angle along the wire from the clamp, rad
    angle: f64,
    /// core frame, m
    place: V3,
}

/// The nozzle's body, its axis from the exit along +x; none of a nozzle that is a point.
fn body_of(nozzle: &Nozzle) -> Option<RoundedRod> {
    (nozzle.outer_diameter > 0.0).then_some(RoundedRod {
        radius: 0.5 * nozzle.outer_diameter,
        length: match nozzle.length {
            0.0 => f64::INFINITY,
            length => length,
        },
        edge_radius: nozzle.edge_radius,
    })
}

impl Winding {
    /// Distance from the axis that inputs must not send the nozzle within as long as there is wire to wind, m: there it would
    /// meet the core, its flanges or the wire on them.
    fn circle(&self) -> Option<f64> {
        let core = self.sys.model.core.as_ref().filter(|_| !self.run.over)?;
        Some(core.radius_max() + self.scene.wire.radius())
    }

    /// Share of the way to where the inputs `end` send the nozzle at which it comes within [`Self::circle`], if it does.
    pub(in crate::simulation) fn meets_circle(&self, end: &Inputs) -> Option<f64> {
        let circle = self.circle()?;
        let (from, to) = (self.sys.state.support[1].point, nozzle_of(&self.scene, end));
        let way = [to.x - from.x, to.z - from.z];
        // square of the distance from the axis over the share: a u^2 + 2 b u + c + circle^2
        let a = way[0] * way[0] + way[1] * way[1];
        let b = from.x * way[0] + from.z * way[1];
        let c = from.x * from.x + from.z * from.z - circle * circle;
        if c <= 0.0 {
            return Some(0.0);
        }
        let under = b * b - a * c;
        if b >= 0.0 || under < 0.0 {
            return None;
        }
        let share = (-b - under.sqrt()) / a;
        (share <= 1.0).then_some(share)
    }

    /// Ends winding where the nozzle is, on its way to where the inputs `end` send it.
    pub(in crate::simulation) fn note_circle_met(&mut self, end: &Inputs) {
        let Some(circle) = self.circle() else {
            return;
        };
        let text = format!(
            "nozzle_offset_x = {} m and nozzle_offset_z = {} m send the nozzle within {:.3} mm of the axis, into the circle that the core sweeps with its flanges and wire on it; keep it outside of that circle",
            end.nozzle_offset_x,
            end.nozzle_offset_z,
            1e3 * circle
        );
        let exit = self.sys.state.support[1].point;
        let place = Spin::new(self.sys.state.spindle.angle).to_core(exit);
        let (angle, _) = self.wound_to(self.laid_to());
        self.note_end_at(DefectKind::Collision, angle, place, text);
    }

    /// The coil must not reach the nozzle: no wire could leave it freely there.
    pub(super) fn check_clearance(&mut self) {
        let lift = self.lift_off();
        let node = self.sys.carried_by(lift);
        if node == 0 || node + 1 == self.sys.state.rod.nodes() {
            return;
        }
        // (wire that leaves what it lies on steeply stands off it at the node behind its last touch)
        let touch = match node > lift {
            true => ContactPoint::Edge(node - 1).place(&self.sys.state.rod.x),
            false => self.sys.touched_place(node),
        };
        let reach = libm::hypot(touch.x, touch.z) + self.scene.wire.radius();
        let distance = self.nozzle_distance();
        if reach < distance {
            return;
        }
        let (angle, _) = self.wound_to(node);
        let met = format!(
            "wire of turn {} reaches {:.3} mm from the axis, and the nozzle stands at {:.3} mm",
            OnTurn::at(angle).turn,
            1e3 * reach,
            1e3 * distance
        );
        let text = if distance < self.scene.nozzle.distance {
            format!(
                "the nozzle has met the coil: {met}; keep nozzle_offset_x and nozzle_offset_z such that it stays outside of the wire"
            )
        } else {
            format!(
                "the coil has grown into the nozzle: {met}; set nozzle.distance to more, or let the nozzle travel so that fewer turns lie on each other"
            )
        };
        self.note_end(DefectKind::Collision, node, text);
    }

    /// The nozzle's body must not meet core, flanges or laid wire.
    pub(super) fn check_body(&mut self) {
        if self.run.over {
            return;
        }
        let Some(body) = body_of(&self.scene.nozzle) else {
            return;
        };
        let exit = self.sys.state.support[1].point;
        let spin = Spin::new(self.sys.state.spindle.angle);
        let met = self
            .core_met(&body, exit, spin)
            .or_else(|| self.frozen_met(&body, exit, spin))
            .or_else(|| self.live_met(&body, exit, spin));
        let Some(Meeting { what, angle, place }) = met else {
            return;
        };
        let text = format!(
            "the nozzle's body has met {what} at ({:.3}, {:.3}, {:.3}) mm of the core's frame, with the spindle at {:.1} deg and the exit at ({:.3}, {:.3}, {:.3}) mm; keep the nozzle farther out or beside it, or set nozzle.outer_diameter to less",
            1e3 * place.x,
            1e3 * place.y,
            1e3 * place.z,
            (self.sys.state.spindle.angle - self.run.angle0).to_degrees(),
            1e3 * exit.x,
            1e3 * exit.y,
            1e3 * exit.z
        );
        self.note_end_at(DefectKind::Collision, angle, place, text);
    }

    /// Where the body meets the core; the turn is the one that is being laid.
    fn core_met(&self, body: &RoundedRod, exit: V3, spin: Spin) -> Option<Meeting> {
        // no point of the body is nearer to the axis
        let aside = (exit.z.abs() - body.radius).max(0.0);
        let least = libm::hypot(exit.x.max(0.0), aside);
        let sweeps = self.sys.model.core.as_ref()?.radius_max();
        if least > sweeps {
            return None;
        }
        let solid = |p: V3| self.sys.nearness_to_core(spin.to_core(p + exit));
        solid(V3::zeros())?;
        // from the axis beside the exit, and as far to either side of it as the body goes
        [0.0, -body.radius, body.radius].iter().find_map(|aside| {
            let start = V3::new(0.0, exit.y + aside, 0.0) - exit;
            let point = body.meets(start, |p| {
                let (near, _) = solid(p).expect("there is a core");
                Nearness {
                    normal: spin.to_lab(near.normal),
                    ..near
                }
            })?;
            let flange = solid(point).is_some_and(|(_, flange)| flange);
            Some(Meeting {
                what: if flange { "a flange" } else { "the core" }.to_owned(),
                angle: self.wound_to(self.laid_to()).0,
                place: spin.to_core(point + exit),
            })
        })
    }

    /// Where the body meets wire that came to rest.
    fn frozen_met(&self, body: &RoundedRod, exit: V3, spin: Spin) -> Option<Meeting> {
        let tube = &self.sys.state.frozen;
        let (node, _) = tube.nearest_by(self.scene.wire.radius(), |p| {
            body.distance(spin.to_lab(p) - exit)
        })?;
        let (end, mut last) = self.coil.end_angle()?;
        let direction = self.coil.spec().direction;
        let back = tube.points[node..].iter().rev().map(|p| {
            let polar = polar_angle(*p);
            let step = wrap_to_pi(last - polar);
            last = polar;
            direction * step
        });
        let angle = end - back.sum::<f64>();
        Some(Meeting {
            what: format!(
                "wire of turn {} that lies on the coil",
                OnTurn::at(angle).turn
            ),
            angle,
            place: tube.points[node],
        })
    }

    /// Where the body meets live wire that is laid.
    fn live_met(&self, body: &RoundedRod, exit: V3, spin: Spin) -> Option<Meeting> {
        let last = self.laid_to();
        let rod = &self.sys.state.rod;
        if last + 1 == rod.nodes() {
            return None;
        }
        let radius = self.scene.wire.radius();
        let node = (1..=last).find(|&i| body.distance(rod.x[i] - exit) < radius)?;
        let (angle, _) = self.wound_to(node);
        Some(Meeting {
            what: format!("wire of turn {} that is just laid", OnTurn::at(angle).turn),
            angle,
            place: spin.to_core(rod.x[node]),
        })
    }
}
