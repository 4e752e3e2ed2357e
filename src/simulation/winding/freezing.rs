//! When a node counts as at rest (the paper's eq. 8 and 9, mended).
//!
//! The paper asks for a small velocity relative to the core and a place inside a region round
//! it. A threshold on the instantaneous speed passes at every turning point of a vibration.
//! Rest is therefore judged by the displacement in the core frame over a window of core angle, or
//! of time while the spindle stands. The region is every place whose wire surface is within
//! `margin` of the core, and every place at all beyond the patience behind lift-off. Nodes freeze in order from the clamp, and not before they are a bending
//! length behind lift-off.

use crate::math::{V3, scaled};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// The limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FreezePolicy {
    /// window of core angle, rad
    pub window: f64,
    /// window of time where the spindle stands, s
    pub time: f64,
    /// largest displacement over the window, m
    pub displacement: f64,
    /// polar angle behind lift-off from which on the displacement may be larger, rad
    pub patience: f64,
    /// largest displacement over the window however far behind lift-off, m
    pub most: f64,
    /// length behind lift-off that stays live, m
    pub keep_length: f64,
    /// largest height of the wire's surface over the core up to the patience behind lift-off, m
    pub margin: f64,
}

/// The displacement that counts as rest doubles with every quarter of a turn beyond the patience. Bows that
/// stand off the core never come quite to rest: every turn that lands shoves the ones before by some
/// micrometres. With one limit for all, live wire would grow with the number of turns.
const DOUBLING: f64 = 0.25 * std::f64::consts::TAU;

/// Largest displacement of wire at rest, in its diameters: a third of the gap that is a defect by default. Wire that moves
/// farther in a window may still become one, or cease to be one.
const MOST: f64 = 0.05;

/// Free spans behind lift-off beyond which nothing bends the wire that the span does, however little pulls at it. Bending dies
/// out over a length that goes with the inverse root of the tension; without a bound, wire that starts without any would never rest.
const SPANS: f64 = 4.0;

/// Periods of the free span's slowest ringing over which motion is judged while the spindle stands.
const PERIODS: f64 = 10.0;

impl FreezePolicy {
    /// That of a scene that starts with a free span of length `span`, m, under `tension`, N. What the scene leaves open goes with
    /// its wire.
    pub(in crate::simulation) fn of(scene: &Scene, span: f64, tension: f64) -> Self {
        let (given, wire) = (&scene.freeze, &scene.wire);
        let or = |given: f64, own: f64| if given > 0.0 { given } else { own };
        // slowest mode of a beam under tension on two bearings
        let holds = tension + wire.ei * (std::f64::consts::PI / span).powi(2);
        let period = 2.0 * span * (wire.mass_per_length() / holds).sqrt();
        let pull = tension.max(0.01 * scene.tensioner.tension);
        Self {
            window: given.window,
            time: or(given.time, PERIODS * period),
            displacement: given.window * or(given.creep, scaled(2e-6, wire.diameter)),
            patience: given.patience * std::f64::consts::TAU,
            most: MOST * wire.diameter,
            keep_length: or(
                given.keep_length,
                (1.75 * (wire.ei / pull).sqrt()).min(SPANS * span),
            ),
            margin: or(given.margin, scaled(5e-3, wire.diameter)),
        }
    }

    /// Largest displacement over the window of wire at rest that lies `behind` lift-off, rad; m.
    pub fn limit(&self, behind: f64) -> f64 {
        let grown = self.displacement * libm::exp2(((behind - self.patience) / DOUBLING).max(0.0));
        grown.min(self.most.max(self.displacement))
    }
}

/// Looks a window is split into; a check takes place at each.
const LOOKS: usize = 4;

/// Share of the window that the core turns by between two looks at most while it counts as standing.
/// Chosen: wire that creeps on with the core at the limit's rate would move by 9 nm.
const STANDING: f64 = 1e-3;

/// Relative shortfall that counts as reached. Round speeds and round communication steps end a step on the very
/// angle of a look, and the last bit of a sum must not decide whether wire joins in this step or the next.
const ROUNDED: f64 = 1e-9;

/// Remembers where each live node was, look by look.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Watch {
    /// positions at the last looks, newest last; one entry per live node
    seen: Vec<[V3; LOOKS]>,
    /// how many looks each node has had
    count: Vec<usize>,
    /// core angle of the last look, rad
    last: f64,
    /// time of the last look, s
    last_time: f64,
}

impl Watch {
    /// Watch over `nodes` live nodes from a core angle on, at time 0.
    pub fn new(nodes: usize, angle: f64) -> Self {
        Self {
            seen: vec![[V3::zeros(); LOOKS]; nodes],
            count: vec![0; nodes],
            last: angle,
            last_time: 0.0,
        }
    }

    /// Whether it watches over so many nodes.
    pub(crate) fn fits(&self, nodes: usize) -> bool {
        self.seen.len() == nodes && self.count.len() == nodes
    }

    /// A node was inserted before index `at`.
    pub fn insert(&mut self, at: usize) {
        self.seen.insert(at, [V3::zeros(); LOOKS]);
        self.count.insert(at, 0);
    }

    /// Adds `n` thawed nodes at the front, none of them seen at rest yet.
    pub fn insert_front(&mut self, n: usize) {
        let fresh = std::iter::repeat_n([V3::zeros(); LOOKS], n);
        self.seen.splice(0..0, fresh);
        self.count.splice(0..0, std::iter::repeat_n(0, n));
    }

    /// Node `i` was taken out.
    pub fn remove(&mut self, i: usize) {
        self.seen.remove(i);
        self.count.remove(i);
    }

    /// The first `n` nodes left.
    pub fn remove_front(&mut self, n: usize) {
        self.seen.drain(..n);
        self.count.drain(..n);
    }

    /// Whether the next look is due: by core angle, or by time where the spindle stands.
    pub fn due(&self, policy: &FreezePolicy, angle: f64, speed: f64, time: f64) -> bool {
        let reached = |passed: f64, asked: f64| passed >= (1.0 - ROUNDED) * asked;
        let turned = (angle - self.last).abs();
        let apart = policy.time / LOOKS as f64;
        let standing = speed.abs() * apart <= STANDING * policy.window;
        let passed = time - self.last_time;
        reached(turned, policy.window / LOOKS as f64) || (standing && reached(passed, apart))
    }

    /// Takes a look; returns how many nodes from the clamp on have stayed in place over the window.
    ///
    /// `position` gives the core-frame position of a live node, `behind` how far it lies behind lift-off, rad.
    pub fn look(
        &mut self,
        policy: &FreezePolicy,
        angle: f64,
        time: f64,
        position: impl Fn(usize) -> V3,
        behind: impl Fn(usize) -> f64,
    ) -> usize {
        self.last = angle;
        self.last_time = time;
        let mut still = 0;
        let mut in_order = true;
        for i in 0..self.seen.len() {
            let p = position(i);
            let seen = &mut self.seen[i];
            let full = self.count[i] >= LOOKS;
            let moved = seen
                .iter()
                .map(|q| (p - q).norm_squared())
                .fold(0.0, f64::max);
            if in_order && full && moved <= policy.limit(behind(i)).powi(2) {
                still = i + 1;
            } else {
                in_order = false;
            }
            seen.rotate_left(1);
            seen[LOOKS - 1] = p;
            self.count[i] += 1;
        }
        still
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn policy() -> FreezePolicy {
        FreezePolicy {
            window: 0.4,
            time: 1.0,
            displacement: 1e-6,
            patience: 4.0,
            most: 1e-5,
            keep_length: 0.0,
            margin: 1e-3,
        }
    }

    #[test]
    fn a_turning_point_is_not_rest() {
        let p = policy();
        let mut w = Watch::new(2, 0.0);
        let mut still = 0;
        for k in 1..=40 {
            let angle = 0.1 * k as f64;
            assert!(w.due(&p, angle + 1e-9, 1.0, 0.0));
            still = w.look(
                &p,
                angle,
                0.0,
                |i| {
                    V3::x()
                        * if i == 0 {
                            0.0
                        } else {
                            1e-4 * (angle * 9.0).sin()
                        }
                },
                |_| 0.0,
            );
            if k <= 4 {
                assert_eq!(still, 0, "a whole window must have been seen");
            }
        }
        assert_eq!(still, 1);
    }

    #[test]
    fn a_standing_spindle_is_judged_by_time() {
        let p = policy();
        let mut w = Watch::new(1, 0.0);
        for k in 1..=5 {
            let time = 0.25 * f64::from(k);
            assert!(
                !w.due(&p, 0.05, 0.2, time),
                "a turning core is judged by angle"
            );
            assert!(!w.due(&p, 0.0, 0.0, time - 0.01) && w.due(&p, 0.0, 0.0, time));
            let still = w.look(&p, 0.0, time, |_| V3::x(), |_| 0.0);
            assert_eq!(still, usize::from(k == 5));
        }
        w.insert_front(2);
        assert_eq!(
            w.look(&p, 0.0, 1.5, |_| V3::x(), |_| 0.0),
            0,
            "unseen wire is not at rest"
        );
    }

    #[test]
    fn the_last_bit_of_a_sum_decides_nothing() {
        let p = policy();
        let (look, apart) = (p.window / LOOKS as f64, p.time / LOOKS as f64);
        for start in [0.0, 0.1, 2.3, 1234.567] {
            let w = Watch::new(1, start);
            for bits in [-8.0, 0.0, 8.0] {
                let rounded = bits * f64::EPSILON * (start + look);
                assert!(w.due(&p, start + look + rounded, 1.0, 0.0));
                assert!(w.due(&p, start, 0.0, apart * (1.0 + bits * f64::EPSILON)));
            }
            assert!(!w.due(&p, start + 0.999 * look, 1.0, 0.0));
        }
    }

    #[test]
    fn nodes_leave_in_order() {
        let p = policy();
        let mut w = Watch::new(3, 0.0);
        let mut still = 9;
        for k in 1..=10 {
            still = w.look(
                &p,
                k as f64,
                0.0,
                |i| V3::x() * if i == 1 { k as f64 } else { 0.0 },
                |_| 0.0,
            );
        }
        assert_eq!(still, 1, "the third is at rest but behind a moving one");
    }

    #[test]
    fn limits_go_with_the_wire() {
        use crate::settings::SceneSettings;
        let of = |diameter: &str| {
            let mut settings = SceneSettings::load("fig8").expect("packed");
            settings.set_text("wire.material", "copper").expect("valid");
            settings.set_text("wire.diameter", diameter).expect("valid");
            settings
                .set_text("tensioner.tension", "0.1")
                .expect("valid");
            let scene = settings.build().expect("a valid scene");
            (FreezePolicy::of(&scene, 0.06, 15.0), scene)
        };
        let (usual, scene) = of("0.7e-3");
        assert_eq!(
            (usual.displacement, usual.margin, usual.most),
            (2e-6, 5e-3, 0.05 * 0.7e-3)
        );
        let (thin, _) = of("0.07e-3");
        for (thin, usual) in [
            (thin.displacement, usual.displacement),
            (thin.margin, usual.margin),
            (thin.most, usual.most),
        ] {
            assert!((10.0 * thin / usual - 1.0).abs() < 1e-12);
        }
        // a string of so much mass, a little faster for its stiffness
        let string = 2.0 * 0.06 * (scene.wire.mass_per_length() / 15.0).sqrt();
        assert!(usual.time < 10.0 * string && usual.time > 8.0 * string);
    }

    #[test]
    fn patience_ends() {
        let p = policy();
        assert_eq!(p.limit(3.9), 1e-6);
        assert!((p.limit(4.0 + std::f64::consts::PI) - 4e-6).abs() < 1e-20);
        assert_eq!(
            p.limit(100.0),
            1e-5,
            "wire that moves farther is not at rest"
        );
    }
}
