//! A nozzle that leads wire onto the places of an orthocyclic law, where wire trails behind a nozzle that only follows it.
//!
//! Wire between the lay-on point and the nozzle is a beam under tension, pinned at the nozzle. It leaves the coil at `y` with
//! the slope `y'` and the curvature `y''` of the wire laid. Solved for the place of its other end, with the free span `S` and
//! `l = sqrt(EI/T)`:
//!
//! `y_n = y + S y' + l (S coth(S/l) - l) y''`
//!
//! `EI` is the [rigidity](sideways) against bending aside. The last factor is `l (S - l)` for a span of many `l`, and `S^2 / 3` for wire that is stiffer than its span is long.
//! Primes are derivatives along the wire.

use super::SceneError;
use super::extent::Extent;
use super::impossible::si;
use crate::rod::Section;
use crate::settings::SceneSettings;
use std::f64::consts::TAU;

/// Largest angle between two points of a crossover, rad. Chosen: two degrees, in which the nozzle departs from its law by less
/// than a thousandth of a pitch.
const POINT: f64 = TAU / 180.0;

/// Longest crossover that `traverse.crossover` admits, rad.
const LONGEST: f64 = 6.0;

/// Pull below which the way of the nozzle is that for this pull, N: wire without tension is not led.
const LEAST_PULL: f64 = 1e-3;

/// Wire between the lay-on point and the nozzle, in one layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trail {
    /// travel of the nozzle per travel of the wire over a radian, rad: the span over the radius of the layer
    slope: f64,
    /// the same per change of that travel over a radian, rad2
    bend: f64,
}

impl Trail {
    /// That of a layer with its centreline at `radius` from the axis, with the nozzle at `distance` from there and wire whose
    /// bending reaches over `stiff`, the `l` of the module, all m.
    pub(super) fn of(radius: f64, distance: f64, stiff: f64) -> Self {
        let span = (distance * distance - radius * radius).sqrt();
        let bend = match stiff > 0.0 {
            true => stiff * (span / libm::tanh(span / stiff) - stiff),
            false => 0.0,
        };
        Self {
            slope: span / radius,
            bend: bend / (radius * radius),
        }
    }

    /// Share of a step to the next place at which the nozzle is after the share `u` of a crossover of so many rad.
    ///
    /// Wire crosses by `u - sin(2 pi u) / 2 pi`, without jumps of speed.
    pub(super) fn crossed(self, u: f64, crossover: f64) -> f64 {
        let (sin, cos) = (libm::sin(TAU * u), libm::cos(TAU * u));
        let wire = u - sin / TAU;
        wire + self.slope * (1.0 - cos) / crossover
            + self.bend * TAU * sin / (crossover * crossover)
    }

    /// Shares of a step at which the nozzle is at even shares of a crossover of so many rad, with those.
    pub(super) fn points(self, crossover: f64) -> impl Iterator<Item = [f64; 2]> {
        let count = (crossover / POINT - 1e-9).ceil().max(1.0) as u32;
        (0..=count).map(move |point| {
            let u = f64::from(point) / f64::from(count);
            // without what rounding leaves of a sine
            let share = if point == 0 || point == count {
                u
            } else {
                self.crossed(u, crossover)
            };
            [u, share]
        })
    }

    /// How far a nozzle swings beyond the places between which wire crosses, in steps: before the first and behind the last.
    pub(super) fn swing(self, crossover: f64) -> [f64; 2] {
        self.points(crossover)
            .fold([0.0; 2], |[before, behind], [_, share]| {
                [f64::max(before, -share), f64::max(behind, share - 1.0)]
            })
    }
}

/// Rigidity of wire against bending along the axis of a core that bends it to this radius, m, in N m2.
///
/// Where it yields on the core, the outer half of its section is stretched beyond yield and the inner half compressed. Bent aside,
/// half of either goes on yielding and the other half springs back: the mean of the two rigidities, as in Engesser and von
/// Karman's buckling beyond yield.
fn sideways(wire: &Section, radius: f64) -> f64 {
    match wire.ei > wire.m_y * radius {
        true => 0.5 * (wire.ei + wire.ei_p),
        false => wire.ei,
    }
}

impl SceneSettings {
    /// Whether the nozzle leads the wire onto its places.
    pub(super) fn leads_trail(&self) -> bool {
        self.traverse.mode == "orthocyclic" && self.traverse.trail == "led"
    }

    /// Refuses a core on which the free span changes within a turn.
    pub(super) fn check_led_core(&self) -> Result<(), SceneError> {
        if self.core.shape == "cylinder" {
            return Ok(());
        }
        Err(self.impossible(
            "traverse.trail",
            format!(
                "the free span of core.shape = {} changes within a turn, and the nozzle is led for one that does not",
                self.core.shape
            ),
            "free, or core.shape = cylinder",
        ))
    }

    /// The trail of this wire behind a nozzle at a distance, m, in each layer, from 0; layers rise by `rise`, m.
    pub(super) fn trails(
        &self,
        wire: &Section,
        extent: &Extent,
        rise: f64,
    ) -> impl Fn(f64, usize) -> Trail + use<> {
        let lowest = extent.winding_radius + 0.5 * wire.diameter;
        let stiff = (sideways(wire, lowest) / self.tensioner.tension.max(LEAST_PULL)).sqrt();
        move |distance, layer| Trail::of(lowest + layer as f64 * rise, distance, stiff)
    }

    /// As near to the axis as the coil and the turning core leave it room, m.
    pub(super) fn nearest_nozzle(&self, extent: &Extent) -> f64 {
        let d = self.wire.outer_diameter();
        let coil = extent.winding_radius + self.winding.layers * d;
        f64::max(coil, extent.turning_radius) + d
    }

    /// The nozzle swings past the places beside a flange, but not beyond the end of the core: `reach` says from where to where
    /// it goes at a distance, m, with a crossover of so many rad, m.
    pub(super) fn check_swing(
        &self,
        reach: impl Fn(f64, f64) -> [f64; 2],
        extent: &Extent,
    ) -> Result<(), SceneError> {
        let fits = |distance: f64, crossover: f64| {
            let [low, high] = reach(distance, crossover);
            low >= extent.y_min && high <= extent.y_max
        };
        let (distance, crossover) = (self.nozzle.distance, self.traverse.crossover);
        if fits(distance, crossover) {
            return Ok(());
        }
        let [low, high] = reach(distance, crossover);
        let end = match extent.window {
            Some(_) => "the outer face of a flange, over which it would draw the wire",
            None => "an end of the core",
        };
        let reason = format!(
            "the nozzle leads the wire by swinging from {} to {} m, past {end}",
            si(low),
            si(high)
        );
        if fits(distance, LONGEST) {
            let long = last_that_fits(LONGEST, crossover, |crossover| fits(distance, crossover));
            let allowed = format!(
                "{} to {} rad, or traverse.trail = free",
                si(long),
                si(LONGEST)
            );
            return Err(self.impossible("traverse.crossover", reason, allowed));
        }
        let nearest = self.nearest_nozzle(extent);
        let farthest = |crossover: f64| {
            let near = nearest < distance && fits(nearest, crossover);
            near.then(|| last_that_fits(nearest, distance, |distance| fits(distance, crossover)))
        };
        let nearer = match (farthest(crossover), farthest(LONGEST)) {
            (Some(most), _) => format!("a nozzle.distance of at most {} m, or ", si(most)),
            (None, Some(most)) => format!(
                "a nozzle.distance of at most {} m with a traverse.crossover of {} rad, or ",
                si(most),
                si(LONGEST)
            ),
            (None, None) => String::new(),
        };
        let allowed = format!("free; or {nearer}a core that reaches from there to there");
        Err(self.impossible("traverse.trail", reason, allowed))
    }
}

/// The last number from one that fits towards one that does not that fits as well, but for a ten-thousandth of their difference.
pub(super) fn last_that_fits(fit: f64, unfit: f64, fits: impl Fn(f64) -> bool) -> f64 {
    let (mut last, mut beyond) = (fit, unfit);
    while (beyond - last).abs() > 1e-4 * (unfit - fit).abs() {
        let middle = 0.5 * (last + beyond);
        match fits(middle) {
            true => last = middle,
            false => beyond = middle,
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The end of the beam by its equation: `EI w'''' = T w''`, solved by growing and fading exponentials for the four conditions.
    fn end_of_beam(span: f64, stiff: f64, [y, slope, curvature]: [f64; 3]) -> f64 {
        // w = a + b x + c cosh(x / l) + e sinh(x / l)
        let c = curvature * stiff * stiff;
        let (cosh, sinh) = (libm::cosh(span / stiff), libm::sinh(span / stiff));
        let e = -c * cosh / sinh;
        let (a, b) = (y - c, slope - e / stiff);
        a + b * span + c * cosh + e * sinh
    }

    /// The slow twin: derivatives of the wire's way by differences, its free end by the equation of the beam.
    #[test]
    fn the_nozzle_is_at_the_end_of_a_beam_under_tension() {
        let way = |u: f64| u - libm::sin(TAU * u) / TAU;
        for (radius, distance, stiff) in [
            (8e-3, 20e-3, 9.7e-3),
            (3e-3, 40e-3, 2e-3),
            (6e-3, 9e-3, 30e-3),
        ] {
            let span = f64::sqrt(distance * distance - radius * radius);
            let trail = Trail::of(radius, distance, stiff);
            for crossover in [0.5, 2.1, 4.0] {
                let length = radius * crossover;
                for k in 1..20 {
                    let (u, h) = (0.05 * f64::from(k), 1e-4);
                    let [before, now, after] = [u - h, u, u + h].map(way);
                    let slope = (after - before) / (2.0 * h) / length;
                    let curvature = (after - 2.0 * now + before) / (h * h) / (length * length);
                    let twin = end_of_beam(span, stiff, [now, slope, curvature]);
                    let off = trail.crossed(u, crossover) - twin;
                    assert!(off.abs() < 1e-4, "{off} at {u} of {crossover} rad");
                }
            }
        }
    }

    #[test]
    fn a_long_span_needs_the_formula_of_the_note_and_stiff_wire_a_third_of_the_square() {
        let (radius, distance) = (8e-3, 100e-3);
        let span = f64::sqrt(distance * distance - radius * radius);
        let factor = |stiff: f64| Trail::of(radius, distance, stiff).bend * radius * radius;
        let long = 6e-3 * (span - 6e-3);
        assert!((factor(6e-3) / long - 1.0).abs() < 1e-6);
        let stiff = factor(100.0) / (span * span / 3.0);
        assert!((stiff - 1.0).abs() < 1e-6, "{stiff}");
    }

    #[test]
    fn limp_wire_without_a_span_lies_where_the_nozzle_is() {
        let none = Trail {
            slope: 0.0,
            bend: 0.0,
        };
        for [u, share] in none.points(2.0) {
            assert!((share - (u - libm::sin(TAU * u) / TAU)).abs() < 1e-15);
        }
    }
}
