//! Wire that slips off the end of the core: what goes slack, kinks or stretches then does so for that.

use crate::math::{Spin, V3};
use crate::measure::OnTurn;
use crate::scene::si;
use crate::signals::EventKind;
use crate::simulation::Winding;
use crate::simulation::winding::Slip;

impl Winding {
    /// Tells once that live wire has slipped off an end of the core.
    pub(in crate::simulation) fn watch_ends(&mut self) {
        if self.run.slipped.is_some() {
            return;
        }
        let now = self.arc_at(self.lift_off());
        let unwinds = self.sys.state.spindle.speed * self.coil.spec().direction < 0.0;
        self.run.laid = if unwinds { now } else { self.run.laid.max(now) };
        let Some((node, end)) = self.node_past_an_end() else {
            return;
        };
        let (angle, _) = self.wound_to(node.min(self.lift_off()));
        let turn = OnTurn::at(angle).turn;
        let time = self.sys.state.time;
        self.run.slipped = Some(Slip { time, turn, end });
        let nozzle = self.sys.state.support[1].point.y;
        let has_flanges = self.scene.core.flange().is_some();
        let or = match has_flanges {
            true => "give the flanges more core.flange.height",
            false => "put flanges beside it (core.flange.inner_distance), or make the core longer",
        };
        self.report(
            EventKind::Judgement,
            format!(
                "wire of turn {turn} has slipped off the end of the core at y = {} m, with the nozzle at {} m; keep the nozzle away from the end, or {or}",
                si(end),
                si(nozzle)
            ),
        );
    }

    /// A node past an end of the core and within the core's outline there, and where that end is along y, m.
    ///
    /// Only wire that has lain on the coil counts: it got there over the end. A free span that is slack may hang there as well.
    fn node_past_an_end(&self) -> Option<(usize, f64)> {
        let surface = self.sys.model.core.as_ref()?;
        let (low, high) = surface.bounds();
        let (radius, most) = (self.scene.wire.radius(), surface.radius_max());
        let spin = Spin::new(self.sys.state.spindle.angle);
        let x = &self.sys.state.rod.x;
        let is_past = |p: &V3| p.y > high.y || p.y < low.y;
        // (most wire never comes near)
        if !x[1..x.len() - 1].iter().any(is_past) {
            return None;
        }
        let was_laid = |node: &usize| self.arc_at(*node) < self.run.laid;
        (1..x.len() - 1).take_while(was_laid).find_map(|node| {
            let p = x[node];
            let (end, inside) = match p.y {
                y if y > high.y => (high.y, high.y - radius),
                y if y < low.y => (low.y, low.y + radius),
                _ => return None,
            };
            if libm::hypot(p.x, p.z) > most {
                return None;
            }
            let mut under = spin.to_core(p);
            under.y = inside;
            (surface.nearest(under).distance < 0.0).then_some((node, end))
        })
    }

    /// Unstretched wire from the clamp to a live node, m.
    fn arc_at(&self, node: usize) -> f64 {
        let live: f64 = self.sys.state.rod.rest[..node].iter().sum();
        self.sys.state.arc0 + live
    }

    /// That wire has slipped off the core, for the reasons of a verdict.
    pub(in crate::simulation) fn slipped_off(&self) -> Option<String> {
        let Slip { time, turn, end } = self.run.slipped?;
        Some(format!(
            "Wire slipped off the end of the core at y = {:.3} mm in turn {turn}, t = {time:.6} s",
            1e3 * end
        ))
    }
}
