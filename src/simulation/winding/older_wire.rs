//! Older live wire that an edge of the free span comes to: wire off the core, which how near the core is does not tell.

use crate::contact::own_wire;
use crate::math::{V3, nearest_shares};
use crate::rod::Rod;
use crate::system::System;

/// Length of wire over its unstretched length that no wire exceeds.
const MOST_STRETCHED: f64 = 2.0;

/// What a look needs to know of the live wire as a whole. Work space: it is measured before it is used.
#[derive(Clone, Debug, Default)]
pub(in crate::simulation) struct OlderWire {
    /// unstretched lengths of wire from the clamp to the nodes, m; none where live wire cannot touch live wire
    arcs: Vec<f64>,
    /// the highest speed of a node, m/s
    fastest: f64,
}

impl OlderWire {
    /// Measures the live wire as it is now.
    pub(in crate::simulation) fn measure(&mut self, sys: &System) {
        self.arcs.clear();
        if sys.state.contact.watches_live_wire() {
            self.take(&sys.state.rod);
        }
    }

    fn take(&mut self, rod: &Rod) {
        let mut arc = 0.0;
        self.arcs.extend(rod.rest.iter().map(|rest| {
            arc += rest;
            arc - rest
        }));
        let squares = rod.v.iter().map(V3::norm_squared);
        self.fastest = squares.fold(0.0, f64::max).sqrt();
    }

    /// Whether edge `j` comes to older live wire within `time`, s, at the speeds that they have.
    ///
    /// Contact points are as far apart as nodes, and wire would go through the older wire between two that are.
    pub(in crate::simulation) fn may_meet(&self, sys: &System, j: usize, time: f64) -> bool {
        let v = &sys.state.rod.v;
        let own = v[j].norm().max(v[j + 1].norm());
        self.is_by(
            sys,
            j,
            [0.0, time * (own + self.fastest)],
            |room, closing| room <= time * closing.max(0.0),
        )
    }

    /// Whether edge `j` lies so `near` (m) to touching older live wire.
    pub(in crate::simulation) fn lies_near(&self, sys: &System, j: usize, near: f64) -> bool {
        self.is_by(sys, j, [near; 2], |room, _| room <= near)
    }

    /// Whether there is older live wire such that `counts` holds of the room between it and edge `j` (m) and the speed (m/s) at
    /// which the room shrinks. It holds of wire that does not come nearer up to `near`, and of none beyond `far`, m.
    fn is_by(
        &self,
        sys: &System,
        j: usize,
        [near, far]: [f64; 2],
        counts: impl Fn(f64, f64) -> bool,
    ) -> bool {
        let Some(here) = self.arcs.get(j) else {
            return false;
        };
        let rod = &sys.state.rod;
        let edge = |k: usize| [rod.x[k], rod.x[k + 1]];
        let at = |x: &[V3], k: usize, share: f64| x[k].lerp(&x[k + 1], share);
        let length = |k: usize| (rod.x[k + 1] - rod.x[k]).norm();
        let (middle, half) = (at(&rod.x, j, 0.5), 0.5 * length(j));
        let diameter = sys.model.section.diameter;
        let touch = diameter + (sys.centre(j) - middle).norm();
        // Wire that leads to the edge is near it. To come back to it, wire makes a loop longer than twice its width.
        let leads = own_wire(*here, diameter) - 2.0 * (touch + near);
        let mut end = self.arcs[..j].partition_point(|arc| *arc < leads);
        while end > 1 {
            let k = end - 2;
            let from_ends = (middle - rod.x[k]).norm() - half - length(k) - touch;
            let room = if from_ends > far {
                from_ends
            } else {
                let [here, there] = nearest_shares(edge(j), edge(k));
                let apart = at(&rod.x, j, here) - at(&rod.x, k, there);
                let opening = at(&rod.v, j, here) - at(&rod.v, k, there);
                let room = apart.norm() - touch;
                if counts(room, -opening.dot(&apart) / apart.norm()) {
                    return true;
                }
                room
            };
            // past all wire that is too far off to come near
            let next = self.arcs[k] - (room - far) / MOST_STRETCHED;
            end = self.arcs[..k].partition_point(|arc| *arc < next) + 1;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::Section;

    /// Wire in loops that moves this way and that, with edges of very different lengths.
    fn loops() -> System {
        let section = Section::table1_elastic();
        let mut s = 0.0;
        let points: Vec<V3> = (0..240)
            .map(|k| {
                s += if (k / 30) % 3 == 2 { 0.25 } else { 0.03 };
                let out = 15e-3 + 4e-3 * libm::sin(2.3 * s);
                V3::new(
                    out * libm::cos(s),
                    2e-4 * s + 1e-3 * libm::sin(1.7 * s),
                    out * libm::sin(s),
                )
            })
            .collect();
        let mut sys = System::new(section, Rod::through(&points, None));
        for (k, v) in sys.state.rod.v.iter_mut().enumerate() {
            let k = k as f64;
            *v = V3::new(libm::sin(0.3 * k), libm::sin(0.7 * k), libm::cos(0.4 * k)) * 20.0;
        }
        sys
    }

    /// Slow twin of [`OlderWire::may_meet`]: every edge of the older wire is looked at.
    fn meets(older: &OlderWire, sys: &System, j: usize, time: f64) -> bool {
        let rod = &sys.state.rod;
        let at = |x: &[V3], k: usize, share: f64| x[k].lerp(&x[k + 1], share);
        let diameter = sys.model.section.diameter;
        let touch = diameter + (sys.centre(j) - at(&rod.x, j, 0.5)).norm();
        let leads = own_wire(older.arcs[j], diameter) - 2.0 * touch;
        let others = (0..j).filter(|k| older.arcs[k + 1] < leads);
        others.into_iter().any(|k| {
            let edges = [j, k].map(|k| [rod.x[k], rod.x[k + 1]]);
            let [s, t] = nearest_shares(edges[0], edges[1]);
            let apart = at(&rod.x, j, s) - at(&rod.x, k, t);
            let opening = at(&rod.v, j, s) - at(&rod.v, k, t);
            let closing = -opening.dot(&apart) / apart.norm();
            apart.norm() - touch <= time * closing.max(0.0)
        })
    }

    #[test]
    fn a_look_that_passes_over_far_wire_finds_what_a_look_at_all_finds() {
        let sys = loops();
        let mut older = OlderWire::default();
        older.take(&sys.state.rod);
        let (mut found, mut all) = (0, 0);
        for time in [1e-6, 2e-5, 1e-4] {
            for j in 40..sys.state.rod.edges() {
                let may = older.may_meet(&sys, j, time);
                assert_eq!(may, meets(&older, &sys, j, time), "edge {j}, {time} s");
                found += u32::from(may);
                all += 1;
            }
        }
        assert!(found > 20 && found < all - 20, "{found} of {all}");
    }

    #[test]
    fn where_wire_touches_no_wire_none_is_met() {
        let sys = loops();
        let mut older = OlderWire::default();
        older.measure(&sys);
        assert!((0..sys.state.rod.edges()).all(|j| !older.may_meet(&sys, j, 1.0)));
    }
}
