//! Line, pulley and tensioner behind the nozzle during one step.
//!
//! The tensioner's mass, damper and pull, and a line without mass, make the line's tension a straight line over the wire
//! passed. Mass of the line's wire, and a pulley with its bearing, make it a [`Curve`].

use super::scheme::{StepFormula, extrapolation};
use crate::feed::{Curve, Feed, FeedSpec, LineYield, Span};
use crate::system::Past;

/// A body on the line where the step's formula would have it without forces.
#[derive(Clone, Copy, Debug)]
struct Body {
    /// its place `s*`, m
    place: f64,
    /// its speed `u*`, m/s
    speed: f64,
    /// kg
    mass: f64,
}

impl Body {
    /// The force that moves it, over how much farther it gets, m, in a step with this gamma, s.
    fn inertia(&self, gamma: f64) -> [f64; 2] {
        [-self.mass * self.speed / gamma, self.mass / (gamma * gamma)]
    }
}

/// What stands behind the nozzle during one step: tensions over how much farther a place gets than without forces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chain {
    gamma: f64,
    nozzle: Body,
    guided: Body,
    tensioner: Body,
    /// tension at the nozzle, with the mass of the wire there
    at_nozzle: Curve,
    /// in the span before the nozzle, over the nozzle's place
    line: Curve,
    /// before the pulley, and behind it, over the pulley's place
    pulley: Option<[Curve; 2]>,
    /// at the tensioner, over its place
    pull: Curve,
    /// how the line's wire yields
    yields: LineYield,
}

impl Chain {
    /// `pull` is the tensioner's force, N; `yields` is how the line's wire yields, as if all of it lay at the nozzle.
    pub(super) fn new(
        spec: &FeedSpec,
        feed: &Feed,
        past: &Past,
        step: &StepFormula,
        (pull, yields): (f64, &LineYield),
    ) -> Self {
        let g = step.gamma;
        let body = |place: [f64; 2], speed: [f64; 2], mass: f64| Body {
            place: step.blend(place[0], place[1]),
            speed: step.blend(speed[0], speed[1]),
            mass,
        };
        let (front, rear) = match spec.pulley {
            Some(pulley) => (spec.span(pulley.share), spec.span(1.0 - pulley.share)),
            None => (spec.span(1.0), spec.span(1.0)),
        };
        let nozzle = body(
            [feed.fed, past.fed[0]],
            [feed.rate, past.fed_rate],
            front.half_mass,
        );
        // where the line would end at the nozzle if it had not got longer
        let end = Body {
            place: step.blend(feed.fed - feed.longer, past.fed[0] - past.longer),
            ..nozzle
        };
        let late = feed.longer - (nozzle.place - end.place);
        let guided = body(
            [feed.guided, past.guided[0]],
            [feed.guided_rate, past.guided_rate],
            front.half_mass + rear.half_mass + spec.pulley.map_or(0.0, |pulley| pulley.mass),
        );
        let tensioner = body(
            [feed.paid, past.paid[0]],
            [feed.paid_rate, past.paid_rate],
            rear.half_mass + spec.mass,
        );
        let before = |curve: Curve, span: Span, from: Body, to: Body| {
            let stiffness = span.stiffness + span.damping / g;
            curve
                .before_spring(stiffness, span.stiffness * (from.place - to.place))
                .never_pushing()
        };
        let [force, slope] = tensioner.inertia(g);
        let at_tensioner = Curve::straight(pull + force, feed.damping_on(spec) / g + slope);
        let (pulley, line) = match spec.pulley {
            Some(pulley) => {
                let behind = before(at_tensioner, rear, guided, tensioner);
                let [force, slope] = guided.inertia(g);
                let ahead = behind.plus(force, slope).with_friction(pulley.friction);
                (Some([ahead, behind]), before(ahead, front, end, guided))
            }
            None => (None, before(at_tensioner, front, end, tensioner)),
        };
        let line = line.before_yield(yields).moved(late);
        let [force, slope] = nozzle.inertia(g);
        Self {
            gamma: g,
            nozzle,
            guided,
            tensioner,
            at_nozzle: line.plus(force, slope).never_pushing(),
            line,
            pulley,
            pull: at_tensioner,
            yields: *yields,
        }
    }

    /// Tension at the nozzle over the wire passed there beyond the second number, m.
    pub(super) fn at_nozzle(&self) -> (&Curve, f64) {
        (&self.at_nozzle, self.nozzle.place)
    }

    /// The feed after the step, in which wire up to `fed`, m, came out under the tension `line`, N, at the nozzle.
    fn advance(&self, feed: &Feed, fed: f64, line: f64) -> Feed {
        let g = self.gamma;
        let farther = fed - self.nozzle.place;
        let tension = if line > 0.0 {
            let [force, slope] = self.nozzle.inertia(g);
            (line - force - slope * farther).max(0.0)
        } else {
            // nothing pulls at the wire there: it stops at the nozzle
            self.line.tension(farther)
        };
        let mut next = Feed {
            fed,
            rate: farther / g,
            longer: feed.longer + self.yields.longer(tension),
            line_tension: line,
            span_tension: tension,
            ..*feed
        };
        let mut behind = tension;
        if let Some([ahead, rear]) = &self.pulley {
            let farther = ahead.place(tension);
            (next.guided, next.guided_rate) = (self.guided.place + farther, farther / g);
            behind = rear.tension(farther);
        }
        let farther = self.pull.place(behind);
        (next.paid, next.paid_rate) = (self.tensioner.place + farther, farther / g);
        next
    }
}

/// Line tension at zero wire passed and its slope where the line has no mass: `T = t0 + slope * fed` at the end of the step, as long
/// as no wire of it yields.
pub(super) fn line_over_fed(
    spec: &FeedSpec,
    feed: &Feed,
    past: &Past,
    step: &StepFormula,
    pull: f64,
) -> (f64, f64) {
    let g = step.gamma;
    let fed = step.blend(feed.fed, past.fed[0]);
    // T = pull + c_t (fed - fed*) / g where the damper moves as the wire does
    let damping = feed.damping_on(spec);
    let drag = damping / g;
    if spec.mass == 0.0 {
        return (pull - drag * fed, drag);
    }
    let rate = step.blend(feed.paid_rate, past.paid_rate);
    if !spec.line_stiffness.is_finite() {
        // the mass sits at the nozzle: u = (fed - fed*) / g, m (u - u*) / g = T - pull - c_t u
        let slope = spec.mass / (g * g);
        return (pull - slope * (fed + g * rate) - drag * fed, slope + drag);
    }
    let paid = step.blend(feed.paid, past.paid[0]);
    let (k, c) = (spec.line_stiffness, spec.line_damping);
    let end = step.blend(feed.fed - feed.longer, past.fed[0] - past.longer);
    // T = k (x - s) + c (x' - u) with x = fed - longer, s = s* + g u, u damped = u* + g (T - pull) / m
    let brake = (k * g + c) / damped(damping, spec, g);
    let soft = 1.0 + brake * g / spec.mass;
    let slope = (k + c / g) / soft;
    let t0 = (-k * paid - c * end / g - brake * (rate - g * pull / spec.mass)) / soft;
    (t0 - slope * feed.longer, slope)
}

/// By how much a damper, N s/m, of a tensioner with mass lowers its speed in a step with this gamma, s.
fn damped(damping: f64, spec: &FeedSpec, gamma: f64) -> f64 {
    1.0 + gamma * damping / spec.mass
}

/// How far, m, the places of pulley and tensioner in `next`, after a step of `h`, s, are from where their ways up to the step lead.
///
/// Both ring on the line, and where a core turns slowly their wire hardly tells.
pub(super) fn difference(spec: &FeedSpec, feed: &Feed, past: &Past, h: f64, next: &Feed) -> f64 {
    let e = extrapolation(h, past);
    let off = |next: f64, (now, rate): (f64, f64), [one, two]: [f64; 2]| match past.known {
        0 => (next - now - rate * h).abs(),
        _ => (next - now * e[0] - one * e[1] - two * e[2]).abs(),
    };
    let mut largest: f64 = 0.0;
    if spec.mass > 0.0 {
        largest = off(next.paid, (feed.paid, feed.paid_rate), past.paid);
    }
    if spec.pulley.is_some_and(|pulley| pulley.mass > 0.0) {
        let guided = (feed.guided, feed.guided_rate);
        largest = largest.max(off(next.guided, guided, past.guided));
    }
    largest
}

/// The feed after a step that let the edge grow by `grown` under the line tension `line`.
pub(super) fn advance(
    spec: &FeedSpec,
    feed: &Feed,
    past: &Past,
    step: &StepFormula,
    (grown, line, pull): (f64, f64, f64),
    yields: &LineYield,
) -> Feed {
    let g = step.gamma;
    let fed = feed.fed + grown;
    if spec.has_chain() {
        return Chain::new(spec, feed, past, step, (pull, yields)).advance(feed, fed, line);
    }
    let rate = (fed - step.blend(feed.fed, past.fed[0])) / g;
    let has_spring = spec.has_spring();
    let (paid, paid_rate) = if has_spring {
        let undamped = step.blend(feed.paid_rate, past.paid_rate) + g * (line - pull) / spec.mass;
        let u = undamped / damped(feed.damping_on(spec), spec, g);
        (step.blend(feed.paid, past.paid[0]) + g * u, u)
    } else {
        (fed, rate)
    };
    Feed {
        fed,
        rate,
        paid,
        paid_rate,
        longer: match has_spring {
            true => feed.longer + yields.longer(line),
            false => feed.longer,
        },
        line_tension: line,
        span_tension: line,
        ..*feed
    }
}

#[cfg(test)]
mod tests {
    use super::super::scheme::Scheme;
    use super::*;
    use crate::feed::{LineWire, Pulley};
    use crate::rod::Law;

    const SET: f64 = 15.0;

    fn spec(friction: f64) -> FeedSpec {
        FeedSpec {
            mass: 2e-3,
            damping: 0.3,
            line_stiffness: 97_800.0,
            line_damping: 2.0,
            exit_friction: 0.0,
            exit_curvature: 0.0,
            line_length: 0.5,
            line_mass: 1.7e-3,
            pulley: Some(Pulley {
                mass: 3e-3,
                friction,
                share: 0.3,
            }),
        }
    }

    /// Wire drawn through the nozzle by `t` (s), m, and its speed, m/s: a mean speed, m/s, and a swing, m.
    fn drawn([mean, swing]: [f64; 2], t: f64) -> [f64; 2] {
        let w = 900.0;
        [
            mean * t + swing * (1.0 - libm::cos(w * t)),
            mean + swing * w * libm::sin(w * t),
        ]
    }

    /// A line that moves at this speed, m/s.
    fn moving(spec: &FeedSpec, speed: f64) -> (Feed, Past) {
        let mut feed = Feed::at_rest(spec, SET);
        (feed.rate, feed.guided_rate, feed.paid_rate) = (speed, speed, speed);
        let mut past = Past::default();
        past.keep_feed(&feed);
        (feed, past)
    }

    /// Tensions at the nozzle by the implicit chain at every 0.1 ms, N.
    fn implicit(spec: &FeedSpec, way: [f64; 2], h: f64, end: f64) -> Vec<f64> {
        let (mut feed, mut past) = moving(spec, way[0]);
        let (mut seen, steps) = (Vec::new(), (end / h).round() as usize);
        let each = (1e-4 / h).round() as usize;
        for k in 1..=steps {
            let step = StepFormula::new(Scheme::Bdf2, &past, h);
            let fed = drawn(way, k as f64 * h)[0];
            let chain = Chain::new(spec, &feed, &past, &step, (SET, &LineYield::default()));
            let (curve, passed) = chain.at_nozzle();
            let line = curve.tension(fed - passed);
            let next = advance(
                spec,
                &feed,
                &past,
                &step,
                (fed - feed.fed, line, SET),
                &LineYield::default(),
            );
            past.keep_feed(&feed);
            past.known = 1;
            past.h = [h, past.h[0]];
            feed = next;
            if k % each == 0 {
                seen.push(line);
            }
        }
        seen
    }

    /// The same by the equations of motion in short explicit steps.
    fn explicit(spec: &FeedSpec, way: [f64; 2], end: f64) -> Vec<f64> {
        let pulley = spec.pulley.expect("a pulley");
        let (share, h) = (pulley.share, 1e-8);
        let (k, c) = (spec.line_stiffness, spec.line_damping);
        let masses = [
            pulley.mass + 0.5 * spec.line_mass,
            spec.mass + 0.5 * spec.line_mass * (1.0 - share),
        ];
        let (mut x, mut v) = ([-share * SET / k, -SET / k], [way[0]; 2]);
        let (mut seen, steps) = (Vec::new(), (end / h).round() as usize);
        for n in 1..=steps {
            let [fed, speed] = drawn(way, n as f64 * h);
            x[0] += h * v[0];
            x[1] += h * v[1];
            let front = (k / share * (fed - x[0]) + c / share * (speed - v[0])).max(0.0);
            let rest = 1.0 - share;
            let rear = (k / rest * (x[0] - x[1]) + c / rest * (v[0] - v[1])).max(0.0);
            let free = v[0] + h * (front - rear) / masses[0];
            let held = h * pulley.friction / masses[0];
            v[0] = free.signum() * (free.abs() - held).max(0.0);
            v[1] += h * (rear - SET - spec.damping * v[1]) / masses[1];
            if n % 10_000 == 0 {
                let speeder = (drawn(way, n as f64 * h + h)[1] - speed) / h;
                seen.push((front + 0.5 * spec.line_mass * share * speeder).max(0.0));
            }
        }
        seen
    }

    /// The curve of a step is the chain's equations of motion: with wire that comes, goes back, is held and goes slack.
    #[test]
    fn a_chain_follows_its_equations_of_motion() {
        // (bearing friction, mean speed and swing, whether the line goes slack)
        for (friction, way, slack) in [
            (0.0, [4.0, 1e-3], false),
            (1.5, [4.0, 1e-3], false),
            (1.5, [0.0, 1e-3], false),
            (4.0, [0.3, 1e-3], false),
            (1.5, [-9.0, 5e-3], true),
        ] {
            let (spec, end) = (spec(friction), 0.01);
            let want = explicit(&spec, way, end);
            assert_eq!(want.contains(&0.0), slack, "{way:?}: {want:?}");
            let off = |h: f64| {
                let seen = implicit(&spec, way, h, end);
                assert_eq!(seen.len(), want.len());
                let off = seen.iter().zip(&want).map(|(a, b)| (a - b).abs());
                off.fold(0.0, f64::max)
            };
            let (long, short) = (off(1e-5), off(2e-6));
            let most = want.iter().copied().fold(0.0, f64::max);
            assert!(
                short < 0.005 * most && short < 0.4 * long,
                "{friction} N, {way:?}: {long} and {short} N off of {most}"
            );
        }
    }

    /// A tensioner that flies back is stopped by the line, which yields: its energy goes into stretched wire. The line pulled
    /// without yielding, and the wire was stretched for nothing.
    #[test]
    fn stretching_the_line_takes_work() {
        let law = Law::new(48_900.0, 1_100.0, 38.5, f64::INFINITY);
        let (mass, speed, h) = (2e-3, 6.0, 2e-7);
        for pulley in [None, spec(0.0).pulley] {
            let spec = FeedSpec {
                mass,
                damping: 0.0,
                line_damping: 0.0,
                line_mass: 0.0,
                pulley: pulley.map(|pulley| Pulley {
                    mass: 1e-9,
                    ..pulley
                }),
                ..spec(0.0)
            };
            let (mut feed, mut past) = moving(&spec, 0.0);
            (feed.paid_rate, past.paid_rate) = (-speed, -speed);
            let mut wire = LineWire::default();
            let (mut work, mut largest, began) = (0.0, 0.0_f64, feed);
            while feed.paid_rate < 0.0 {
                let step = StepFormula::new(Scheme::Bdf2, &past, h);
                let yields = wire.yields(&law, spec.line_length, feed.fed);
                let line = if spec.has_chain() {
                    let chain = Chain::new(&spec, &feed, &past, &step, (SET, &yields));
                    let (curve, passed) = chain.at_nozzle();
                    curve.tension(feed.fed - passed)
                } else {
                    let (t0, slope) = line_over_fed(&spec, &feed, &past, &step, SET);
                    yields.tension(t0 + slope * feed.fed, slope)[0]
                };
                let next = advance(&spec, &feed, &past, &step, (0.0, line, SET), &yields);
                work += 0.5 * (line + feed.line_tension) * (next.longer - feed.longer);
                wire.pull(&law, spec.line_length, next.fed, line);
                past.keep_feed(&feed);
                past.known = 1;
                past.h = [h, past.h[0]];
                feed = next;
                largest = largest.max(line);
            }
            let elastic = |tension: f64| 0.5 * tension * tension / spec.line_stiffness;
            let kinetic = 0.5 * mass * (speed * speed - feed.paid_rate.powi(2));
            let taken = elastic(feed.line_tension) - elastic(SET) + work;
            let given = kinetic + SET * (began.paid - feed.paid);
            assert!((taken / given - 1.0).abs() < 5e-3, "{taken} {given}");
            // (elastic, the line would pull by 99 N)
            assert!((38.5..45.0).contains(&largest), "{largest}");
            let strain = feed.longer / spec.line_length;
            assert!(
                (wire.next(0.0).strain / strain - 1.0).abs() < 1e-3,
                "{strain}"
            );
        }
    }

    /// At a steady speed nothing but friction and dampers counts.
    #[test]
    fn steady_wire_feels_friction_and_no_mass() {
        let spec = spec(1.5);
        let (mut feed, mut past) = moving(&spec, 0.0);
        for k in 1..=40_000 {
            let step = StepFormula::new(Scheme::Bdf2, &past, 5e-6);
            let grown = 3.0 * 5e-6 * f64::min(1.0, f64::from(k) / 2e3);
            let chain = Chain::new(&spec, &feed, &past, &step, (SET, &LineYield::default()));
            let (curve, passed) = chain.at_nozzle();
            let line = curve.tension(feed.fed + grown - passed);
            let next = advance(
                &spec,
                &feed,
                &past,
                &step,
                (grown, line, SET),
                &LineYield::default(),
            );
            past.keep_feed(&feed);
            past.known = 1;
            past.h = [5e-6, past.h[0]];
            feed = next;
        }
        let want = SET + 1.5 + spec.damping * 3.0;
        assert!((feed.line_tension - want).abs() < 1e-6, "{feed:?}");
        assert!((feed.guided_rate - 3.0).abs() < 1e-9 && (feed.paid_rate - 3.0).abs() < 1e-9);
    }
}
