//! Long edges of the free span, halved before they touch and where wire bends.

use super::BENT;
use crate::math::{Spin, spin_velocity};
use crate::scene::Solver;
use crate::simulation::Winding;

/// Longest step over the one before it, rounded up: no step that lands before the next look is longer.
const AHEAD: f64 = 2.0;

/// Edges of at most so many spacings near the core are fine and are not halved.
const FINE: f64 = 1.5;

/// Shortest edge that wire has once it is refined, m: halves of edges from the free span may be shorter than the spacing near the core.
pub(in crate::simulation) fn shortest_edge(solver: &Solver) -> f64 {
    let mut half = solver.spacing_free;
    while half > FINE * solver.spacing_near {
        half *= 0.5;
    }
    half.min(solver.spacing_near)
}

impl Winding {
    /// Edges that are too long for where they came in a step of `dt`, s, or how they bend, ascending.
    pub(super) fn edges_to_refine(&mut self, dt: f64) -> Vec<usize> {
        let near = self.scene.solver.refine_distance;
        self.older_wire.measure(&self.sys);
        self.long_edges(|j| {
            self.is_bent(j)
                || self.comes_near_core(j, near.max(self.way_ahead(j, dt)))
                || self.older_wire.may_meet(&self.sys, j, AHEAD * dt)
        })
    }

    /// Halves long edges that a step after one of `dt`, s, may bring to the core or to older live wire until they are fine.
    ///
    /// At the next look it would be too late: new points between those that touch would lie deep in core or wire.
    pub(super) fn refine_ahead_of_touch(&mut self, dt: f64) {
        loop {
            self.older_wire.measure(&self.sys);
            let soon = self.long_edges(|j| {
                self.comes_near_core(j, self.way_ahead(j, dt))
                    || self.older_wire.may_meet(&self.sys, j, AHEAD * dt)
            });
            if soon.is_empty() {
                break;
            }
            for j in soon.into_iter().rev() {
                self.split(j);
            }
        }
    }

    /// Edges ahead of settled wire, but for that at the nozzle, that are longer than fine ones and `wanted`, ascending.
    fn long_edges(&self, wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        let solver = self.scene.solver;
        if solver.spacing_free < FINE * solver.spacing_near {
            return Vec::new();
        }
        let rod = &self.sys.state.rod;
        // the edge at the nozzle keeps its length for the feed
        let first = if self.stepper.is_implicit() {
            self.first_fine_edge()
        } else {
            0
        };
        (first..rod.edges() - 1)
            .filter(|&j| rod.rest[j] > FINE * solver.spacing_near && wanted(j))
            .collect()
    }

    /// How far edge `j` may come towards the core in a step after one of `dt`, s, m.
    fn way_ahead(&self, j: usize, dt: f64) -> f64 {
        let (rod, core) = (&self.sys.state.rod, self.sys.state.spindle);
        let speed = |i: usize| (rod.v[i] - spin_velocity(core.speed, rod.x[i])).norm();
        AHEAD * dt * speed(j).max(speed(j + 1))
    }

    /// Whether edge `j` comes so `near` (m) to the core or the layers below: looked at in places so close together that where it
    /// touches between them, one is.
    fn comes_near_core(&self, j: usize, near: f64) -> bool {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let rod = &self.sys.state.rod;
        let radius = self.scene.wire.radius();
        let reach = self.layers_below() + near + radius;
        let half = (rod.rest[j] / (4.0 * near.max(radius))).ceil().max(1.0);
        (-half as i32..=half as i32).any(|k| {
            let from_centre = f64::from(k) / half;
            let end = rod.x[if k < 0 { j } else { j + 1 }];
            let place = self.sys.centre(j).lerp(&end, from_centre.abs());
            self.sys.is_near_core(spin.to_core(place), reach)
        })
    }

    /// Whether the wire bends strongly at an end of edge `j`, and the edge there is no shorter than its neighbour.
    fn is_bent(&self, j: usize) -> bool {
        let rod = &self.sys.state.rod;
        [(j, j.wrapping_sub(1)), (j + 1, j + 1)]
            .into_iter()
            .any(|(node, next)| {
                node > 0
                    && node < rod.edges()
                    && rod.rest[j] >= rod.rest[next]
                    && self.bends_by(node, BENT)
            })
    }
}
