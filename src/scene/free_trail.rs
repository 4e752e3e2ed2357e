//! How far wire has come on its first step when turn 2 begins, behind a nozzle that does not lead it.
//!
//! Wire leaves the coil towards the nozzle, so it moves over by `dy/ds = (y_n - y) / S` along the wire laid, with the free span
//! `S`. Over a step of the nozzle that is even in `c` radians and ends `a` radians early, what is left of it at the place of turn 2 is
//!
//! `exp(-a / b) (1 - exp(-c / b)) b / c`, with `b = S / r` and the radius `r` of a circle as long as a turn.
//!
//! Wire that comes down near the top of turn 1 stays up there by friction: at the offset `d sin(p)` from the top, the flank is as
//! steep as the angle of friction `p`. A step of which more is left than `1 - sin(p)` begins turn 2 on turn 1.

use super::Core;
use super::extent::Extent;
use super::impossible::si_down;
use super::nozzle_trail::last_that_fits;
use crate::rod::Section;
use crate::settings::SceneSettings;
use std::f64::consts::TAU;

/// Largest angle by which a nozzle is told to step earlier, rad. Chosen: in half a turn it would step over the turn before the last.
const EARLIEST: f64 = 0.5 * TAU;

/// Share of a step by which winds miss the limit of friction. Measured: five cores, 194 winds, in `docs/notes/2026-12-01-first-step.md`.
const MISSED: f64 = 0.03;

/// A step of the nozzle before turn 2 begins, and a core.
#[derive(Clone, Copy, Debug)]
struct FirstStep {
    /// core angle in which the nozzle steps, rad
    crossover: f64,
    /// core angle from the end of the step to the place where turn 2 first lies on the core, rad
    early: f64,
    /// distance of the lay-on point from the axis, m
    radius: f64,
    /// radius of a circle as long as a turn, m
    girth: f64,
}

impl FirstStep {
    /// Share of the step that is left where turn 2 begins, with the nozzle at this distance from the axis, m.
    fn left(self, distance: f64) -> f64 {
        let span = (distance * distance - self.radius * self.radius)
            .max(0.0)
            .sqrt();
        let reach = span / self.girth;
        if reach == 0.0 {
            return 0.0;
        }
        // what an even step leaves so many radians after its beginning, while it lasts
        let during = |angle: f64| {
            let made = angle + reach * libm::expm1(-angle / reach);
            1.0 - made / self.crossover
        };
        match self.early < 0.0 {
            true => during((self.crossover + self.early).max(0.0)),
            false => during(self.crossover) * libm::exp(-self.early / reach),
        }
    }

    /// The same step made earlier by so many radians.
    fn earlier(self, by: f64) -> Self {
        Self {
            early: self.early + by,
            ..self
        }
    }
}

/// Core angle from the clamp to the first corner behind it, and the length of a turn of wire of diameter `d`, m: a flat face is laid from corner to corner.
fn corner_and_turn(core: &Core, d: f64) -> Option<[f64; 2]> {
    match core {
        Core::Cylinder { radius, .. } => Some([0.0, TAU * (radius + 0.5 * d)]),
        Core::RoundedBox {
            width_x,
            height_z,
            corner_radius,
            ..
        } => {
            let flats = 2.0 * (width_x + height_z) - 8.0 * corner_radius;
            let turn = flats + TAU * (corner_radius + 0.5 * d);
            Some([libm::atan2(*height_z, *width_x), turn])
        }
        // (how long a turn on a mesh is, no scene knows before it is wound)
        Core::Mesh { .. } => None,
    }
}

impl SceneSettings {
    /// A nozzle from which wire comes so late to its second place that it lies on turn 1 there; the message for the key of its distance.
    pub(super) fn late_first_step(
        &self,
        wire: &Section,
        core: &Core,
        extent: &Extent,
    ) -> Option<String> {
        if self.traverse.mode != "orthocyclic" || self.leads_trail() {
            return None;
        }
        let [corner, turn] = corner_and_turn(core, wire.diameter)?;
        let step = FirstStep {
            crossover: self.traverse.crossover,
            early: self.traverse.advance - self.traverse.crossover_delay + corner,
            radius: extent.winding_radius + wire.radius(),
            girth: turn / TAU,
        };
        let friction = match self.solver.friction.as_str() {
            "off" => 0.0,
            _ => self.friction.static_,
        };
        let slides = 1.0 - libm::sin(libm::atan(friction));
        let limit = slides - MISSED;
        let distance = self.nozzle.distance;
        let left = step.left(distance);
        if friction == 0.0 || left <= limit {
            return None;
        }
        let fits = |distance: f64| step.left(distance) <= limit;
        let nearest = self.nearest_nozzle(extent);
        let near = (nearest < distance && fits(nearest)).then(|| {
            let most = last_that_fits(nearest, distance, fits);
            format!("bring it to {} m or nearer", si_down(most))
        });
        let in_time = |by: f64| step.earlier(by).left(distance) <= limit;
        let early = in_time(EARLIEST).then(|| {
            let least = last_that_fits(EARLIEST, 0.0, in_time) + self.traverse.advance;
            format!(
                "set traverse.advance to {:.0} degrees or more",
                least.to_degrees().ceil()
            )
        });
        let led = matches!(core, Core::Cylinder { .. })
            .then(|| "lead the wire by traverse.trail = led".to_owned());
        let remedies: Vec<String> = [near, early, led].into_iter().flatten().collect();
        let remedy = match remedies.is_empty() {
            true => "bring it nearer".to_owned(),
            false => remedies.join(", or "),
        };
        Some(format!(
            "wire trails far behind the nozzle: where turn 2 begins it has made {:.0} % of its step, and friction holds wire on top of other wire up to some {:.0} %; the first turns may get gaps, overlaps or slack; {remedy}",
            100.0 * (1.0 - left),
            100.0 * (1.0 - slides),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slow twin: the equation of the module by small steps.
    #[test]
    fn what_is_left_of_a_step_is_that_of_wire_that_follows_the_nozzle() {
        for (crossover, early, distance) in [
            (0.8, 0.0, 20e-3),
            (0.8, 1.5, 60e-3),
            (2.4, 0.3, 35e-3),
            (2.4, -1.0, 35e-3),
        ] {
            let step = FirstStep {
                crossover,
                early,
                radius: 8e-3,
                girth: 9e-3,
            };
            let span = f64::sqrt(distance * distance - step.radius * step.radius);
            let (mut y, count) = (0.0, 100_000);
            let angle = (crossover + early) / f64::from(count);
            for k in 0..count {
                let nozzle = ((f64::from(k) + 0.5) * angle / crossover).min(1.0);
                y += (nozzle - y) * step.girth * angle / span;
            }
            let off = step.left(distance) - (1.0 - y);
            assert!(off.abs() < 1e-4, "{off} for {step:?} at {distance}");
        }
    }

    #[test]
    fn a_nozzle_at_the_core_leaves_nothing_and_one_far_away_all() {
        let step = FirstStep {
            crossover: 0.8,
            early: 0.0,
            radius: 8e-3,
            girth: 8e-3,
        };
        assert_eq!(step.left(8e-3), 0.0);
        assert!(step.left(1e3) > 0.999);
        let shares = [9e-3, 12e-3, 20e-3, 60e-3].map(|distance| step.left(distance));
        assert!(shares.is_sorted(), "{shares:?}");
    }
}
