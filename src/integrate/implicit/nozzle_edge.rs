//! The edge at the nozzle together with line and tensioner, as one spring.
//!
//! How much wire passes the nozzle in a step follows from equal forces in the edge and in the
//! line. The line's tension is a straight line over the wire passed, or a few pieces of such lines. So the length of
//! the edge is the root of a quadratic and its tension has a closed potential: the feed costs no
//! unknown.

use super::scheme::StepFormula;
use super::tensioner::{Chain, line_over_fed};
use crate::feed::{Feed, FeedSpec, LineYield, MOST_CORNERS};
use crate::rod::Stretched;
use crate::system::Past;

/// The edge at the nozzle during one solve.
///
/// Friction at the exit holds back whichever way the wire moves. The tension is `grip` times the line's where
/// wire comes out in this step, and the line's over `grip` where it goes back. Between the two none passes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct NozzleEdge {
    /// the line's tension, in order of rest length
    pieces: [Piece; MOST_CORNERS],
    count: usize,
    /// elastic modulus, N
    ea: f64,
    /// `1 + plastic stretch` of the edge's wire
    set: f64,
    /// the same of wire that comes out
    coming: f64,
    /// how much longer the wire at the start is for its plastic stretch than if it were such wire, m
    longer: f64,
    /// rest length at the start of the step, m
    start: f64,
    /// tension after over tension before the exit while wire comes out, 1 or more
    grip: f64,
}

/// The edge at the start of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeAtStart {
    /// its unstretched length, m
    pub(super) rest: f64,
    /// the tensioner's force, N
    pub(super) pull: f64,
    /// tension after over tension before the exit where wire comes out
    pub(super) grip: f64,
    /// modulus of the wire, N
    pub(super) ea: f64,
    /// plastic stretch of the edge and of wire that comes out
    pub(super) plastic: [f64; 2],
}

/// The line's tension from some rest length of the edge on: `a + b * rest`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Piece {
    /// rest length where it begins, m; that of the first is where the line goes slack
    from: f64,
    /// N
    a: f64,
    /// N/m
    b: f64,
}

/// Which way wire passes the nozzle in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// out, and the tension is the line's times this
    Out(f64),
    /// back, and the tension is the line's times this
    Back(f64),
    /// held by friction
    Held,
}

impl NozzleEdge {
    /// The edge in a step; `yields` is how the line's wire yields.
    pub(super) fn new(
        spec: &FeedSpec,
        feed: &Feed,
        past: &Past,
        step: &StepFormula,
        edge: EdgeAtStart,
        yields: &LineYield,
    ) -> Self {
        let EdgeAtStart {
            rest,
            pull,
            grip,
            ea,
            plastic,
        } = edge;
        let (pieces, count) = if spec.has_chain() {
            let chain = Chain::new(spec, feed, past, step, (pull, yields));
            pieces_of(&chain, rest - feed.fed)
        } else {
            let (t0, slope) = line_over_fed(spec, feed, past, step, pull);
            // tension = t0 + slope * fed, fed = feed.fed + rest' - rest
            let a = t0 + slope * (feed.fed - rest);
            let from = if slope > 0.0 {
                -a / slope
            } else {
                f64::NEG_INFINITY
            };
            let mut pieces = [Piece::default(); MOST_CORNERS];
            pieces[0] = Piece { from, a, b: slope };
            yielding(pieces, yields)
        };
        Self {
            pieces,
            count,
            ea,
            set: 1.0 + plastic[0],
            coming: 1.0 + plastic[1],
            longer: rest * (plastic[0] - plastic[1]),
            start: rest,
            grip,
        }
    }

    /// The line's tension while no wire passes, N.
    fn line_at_start(&self) -> f64 {
        let pieces = &self.pieces[..self.count];
        let at = pieces[1..].partition_point(|p| p.from <= self.start);
        (pieces[at].a + pieces[at].b * self.start).max(0.0)
    }

    /// Tension of the edge were no wire to pass, N.
    fn held(&self, length: f64) -> f64 {
        self.ea * (length / self.start - self.set)
    }

    fn way(&self, length: f64) -> Way {
        let (held, line) = (self.held(length), self.line_at_start());
        if held > self.grip * line {
            Way::Out(self.grip)
        } else if self.grip == 1.0 || held < line / self.grip {
            Way::Back(1.0 / self.grip)
        } else {
            Way::Held
        }
    }

    /// Unstretched length of the edge when it is `length` long.
    pub(super) fn rest(&self, length: f64) -> f64 {
        match self.way(length) {
            Way::Held => self.start,
            way => self.balanced(length, way).0,
        }
    }

    /// The line's tension when the edge is `length` long, N, and its rise with wire that passes, N/m (0: friction lets none pass).
    pub(super) fn line(&self, length: f64) -> [f64; 2] {
        match self.way(length) {
            Way::Held => [self.line_at_start(), 0.0],
            way @ (Way::Out(grip) | Way::Back(grip)) => [
                self.free(length, way).tension / grip,
                self.pieces[self.balanced(length, way).1].b,
            ],
        }
    }

    /// Tension, stiffness and potential at a length.
    pub(super) fn stretched(&self, length: f64) -> Stretched {
        let way = self.way(length);
        let grip = match way {
            Way::Out(grip) | Way::Back(grip) => grip,
            Way::Held => return self.stretched_held(length),
        };
        let free = self.free(length, way);
        if self.grip == 1.0 && self.longer == 0.0 {
            // out and back are one law
            return free;
        }
        // the potential goes on where wire begins to pass
        let end = self.start * (self.set + grip * self.line_at_start() / self.ea);
        Stretched {
            energy: free.energy - self.free(end, way).energy + self.stretched_held(end).energy,
            ..free
        }
    }

    /// The edge while friction lets no wire pass.
    fn stretched_held(&self, length: f64) -> Stretched {
        let tension = self.held(length);
        Stretched {
            tension,
            stiffness: self.ea / self.start,
            energy: 0.5 * tension * tension * self.start / self.ea,
        }
    }

    /// Length of the edge less what makes its wire unlike that which passes, m; factor of the line's
    /// tension; `1 + plastic stretch` of wire that passes.
    fn alike(&self, length: f64, way: Way) -> (f64, f64, f64) {
        match way {
            Way::Out(grip) => (length - self.longer, grip, self.coming),
            Way::Back(grip) => (length, grip, self.set),
            Way::Held => (length, 1.0, self.set),
        }
    }

    /// Unstretched length at which the edge pulls as hard as the line does through the exit, and the piece on which that is.
    fn balanced(&self, length: f64, way: Way) -> (f64, usize) {
        let (length, grip, set) = self.alike(length, way);
        // where a piece begins, the edge still pulls harder than the line
        let reaches =
            |p: &Piece| self.ea * length >= p.from * (self.ea * set + grip * (p.a + p.b * p.from));
        let at = self.pieces[1..self.count].partition_point(reaches);
        let piece = self.pieces[at];
        let (a, b) = (grip * piece.a, grip * piece.b);
        let c = self.ea * set + a;
        let y = if b > 0.0 {
            // b y^2 + c y = EA length, the positive root in the form without cancellation
            let d = (c * c + 4.0 * b * self.ea * length).sqrt();
            if c > 0.0 {
                2.0 * self.ea * length / (c + d)
            } else {
                (d - c) / (2.0 * b)
            }
        } else {
            self.ea * length / c
        };
        if at == 0 && y <= piece.from || a + b * y < 0.0 {
            // the line is slack: the edge is as long as it likes
            (length / set, 0)
        } else {
            (y, at)
        }
    }

    /// The edge where wire passes.
    fn free(&self, length: f64, way: Way) -> Stretched {
        let (y, at) = self.balanced(length, way);
        let (_, grip, set) = self.alike(length, way);
        let piece = self.pieces[at];
        let (a, b) = (grip * piece.a, grip * piece.b);
        let tension = a + b * y;
        if tension <= 0.0 {
            return Stretched::default();
        }
        let c = self.ea * set + a;
        let slope = self.ea / (2.0 * b * y + c);
        let mut energy = self.work(at, y, grip, set);
        for k in 0..at {
            energy += self.work(k, self.pieces[k + 1].from, grip, set);
        }
        Stretched {
            tension,
            stiffness: if b > 0.0 { b * slope } else { 0.0 },
            energy,
        }
    }

    /// Integral of the tension over the edge's length along a piece, from where it begins to the rest length `to`, J.
    fn work(&self, piece: usize, to: f64, grip: f64, set: f64) -> f64 {
        let Piece { from, a, b } = self.pieces[piece];
        let (a, b) = (grip * a, grip * b);
        let c = self.ea * set + a;
        // d length = (2 b y + c) / EA dy
        let primitive = |y: f64| {
            (a * c * y + (2.0 * a * b + b * c) * y * y * 0.5 + 2.0 * b * b * y * y * y / 3.0)
                / self.ea
        };
        // the first begins where the line begins to pull, or at nothing where it always does: the constant
        // does not matter, but staying near keeps digits
        let from = if piece > 0 || from.is_finite() && from > 0.0 {
            from
        } else {
            0.0
        };
        primitive(to) - primitive(from)
    }
}

/// The first of `pieces`, and those on which more and more of the line yields; how many there are.
fn yielding(
    mut pieces: [Piece; MOST_CORNERS],
    yields: &LineYield,
) -> ([Piece; MOST_CORNERS], usize) {
    let (mut count, elastic) = (1, pieces[0].b);
    let mut compliance = 0.0;
    for [tension, more] in yields.levels() {
        let last = pieces[count - 1];
        if last.b <= 0.0 {
            break;
        }
        compliance += more;
        let from = (tension - last.a) / last.b;
        let b = 1.0 / (1.0 / elastic + compliance);
        pieces[count] = Piece {
            from,
            a: tension - b * from,
            b,
        };
        count += 1;
    }
    (pieces, count)
}

/// The line's tension over the edge's rest length, which is `ahead`, m, more than the wire passed; how many pieces it has.
fn pieces_of(chain: &Chain, ahead: f64) -> ([Piece; MOST_CORNERS], usize) {
    let (curve, passed) = chain.at_nozzle();
    let mut pieces = [Piece::default(); MOST_CORNERS];
    for (k, corner) in curve.corners().iter().enumerate() {
        let (from, b) = (corner[0] + (passed + ahead), curve.slope_after(k));
        pieces[k] = Piece {
            from,
            a: corner[1] - b * from,
            b,
        };
    }
    (pieces, curve.corners().len())
}

#[cfg(test)]
mod tests {
    use super::super::{scheme::Scheme, tensioner::advance};
    use super::*;

    fn setting() -> (FeedSpec, Feed, Past, StepFormula) {
        let spec = FeedSpec {
            mass: 1e-3,
            damping: 0.4,
            line_stiffness: 97_800.0,
            line_damping: 2.0,
            exit_friction: 0.0,
            exit_curvature: 0.0,
            line_length: 0.5,
            line_mass: 0.0,
            pulley: None,
        };
        let feed = Feed {
            fed: 0.012,
            rate: 3.0,
            paid: 0.012 - 14.0 / 97_800.0,
            paid_rate: 2.9,
            line_tension: 14.0,
            damping: 0.3,
            ..Feed::default()
        };
        let past = Past {
            known: 1,
            fed: [0.012 - 3e-4; 2],
            paid: [0.012 - 3e-4 - 14.0 / 97_800.0; 2],
            paid_rate: 2.9,
            h: [1e-4, 0.0],
            ..Past::default()
        };
        let step = StepFormula::new(Scheme::Bdf2, &past, 1.2e-4);
        (spec, feed, past, step)
    }

    /// The same at rest: a moving tensioner would leave the line slack if no wire came.
    fn at_rest() -> (FeedSpec, Feed, Past, StepFormula) {
        let (spec, mut feed, mut past, step) = setting();
        (feed.rate, feed.paid_rate) = (0.0, 0.0);
        past.fed = [feed.fed; 2];
        (past.paid, past.paid_rate) = ([feed.paid; 2], 0.0);
        (spec, feed, past, step)
    }

    /// An edge of such wire under the set force, 15 N.
    fn at_start(rest: f64, grip: f64, plastic: [f64; 2]) -> EdgeAtStart {
        EdgeAtStart {
            rest,
            pull: 15.0,
            grip,
            ea: 48_900.0,
            plastic,
        }
    }

    /// That edge behind a line that does not yield.
    fn edge(
        (spec, feed, past, step): (&FeedSpec, &Feed, &Past, &StepFormula),
        rest: f64,
        grip: f64,
        plastic: [f64; 2],
    ) -> NozzleEdge {
        let start = at_start(rest, grip, plastic);
        NozzleEdge::new(spec, feed, past, step, start, &LineYield::default())
    }

    /// The tension at `length` (m) is that of wire of the edge, with its plastic stretch, and wire that came, with its own.
    fn assert_pulls_by_its_wire(edge: &NozzleEdge, length: f64, plastic: [f64; 2]) {
        let (rest, tension) = (edge.rest(length), edge.stretched(length).tension);
        let came = rest - edge.start;
        let passing = if came > 0.0 { plastic[1] } else { plastic[0] };
        let free = edge.start * (1.0 + plastic[0]) + came * (1.0 + passing);
        let wire = edge.ea * (length - free) / rest;
        assert!((wire - tension).abs() < 1e-6, "{length}: {wire} {tension}");
    }

    #[test]
    fn wire_and_line_pull_alike() {
        let (spec, feed, past, step) = setting();
        let ea = 48_900.0;
        let edge = edge((&spec, &feed, &past, &step), 3e-3, 1.1, [1e-4; 2]);
        // so long that wire comes out
        let length = 3.36e-3 * (1.0 + 3e-4);
        let y = edge.rest(length);
        let s = edge.stretched(length);
        assert!((s.tension - ea * (length / y - 1.0 - 1e-4)).abs() < 1e-6);
        // the line's own law, step by step
        let [line, _] = edge.line(length);
        assert!((s.tension / line - 1.1).abs() < 1e-12);
        let next = advance(
            &spec,
            &feed,
            &past,
            &step,
            (y - 3e-3, line, 15.0),
            &LineYield::default(),
        );
        let law = spec.line_stiffness * (next.fed - next.paid)
            + spec.line_damping * (next.rate - next.paid_rate);
        assert!((law - line).abs() < 1e-6, "{law} {line}");
        // the tensioner's own
        let began = step.blend(feed.paid_rate, past.paid_rate);
        let inertia = spec.mass * (next.paid_rate - began) / step.gamma;
        let force = line - 15.0 - feed.damping_on(&spec) * next.paid_rate;
        assert!((inertia - force).abs() < 1e-9, "{inertia} {force}");
        let h = 1e-9;
        let d =
            (edge.stretched(length + h).tension - edge.stretched(length - h).tension) / (2.0 * h);
        assert!((d / s.stiffness - 1.0).abs() < 1e-5);
        let de =
            (edge.stretched(length + h).energy - edge.stretched(length - h).energy) / (2.0 * h);
        assert!((de / s.tension - 1.0).abs() < 1e-4, "{de}");
    }

    #[test]
    fn a_slack_line_does_not_push() {
        let (spec, feed, past, step) = setting();
        let edge = edge((&spec, &feed, &past, &step), 3e-3, 1.0, [0.0; 2]);
        let s = edge.stretched(1e-3);
        assert_eq!(s.tension, 0.0);
        assert!((edge.rest(1e-3) - 1e-3).abs() < 1e-15);
    }

    /// Tension is one branch of another with friction at the exit, never jumps, and derives from the potential.
    #[test]
    fn friction_at_the_exit_holds_wire_between_two_tensions() {
        let (spec, feed, past, step) = at_rest();
        let (ea, grip) = (48_900.0, 1.4);
        let edge = edge((&spec, &feed, &past, &step), 3e-3, grip, [1e-4; 2]);
        let line = edge.line_at_start();
        assert!(line > 5.0, "the line pulls by {line} N");
        let at = |tension: f64| 3e-3 * (1.0 + 1e-4 + tension / ea);
        for share in [1.0 / grip + 1e-6, 1.0, grip - 1e-6] {
            assert_eq!(edge.rest(at(share * line)), 3e-3);
            assert!((edge.stretched(at(share * line)).tension - share * line).abs() < 1e-9);
            assert_eq!(edge.line(at(share * line))[0], line);
        }
        assert!(edge.rest(at(2.0 * grip * line)) > 3e-3);
        assert!(edge.rest(at(0.2 * line)) < 3e-3);
        let out = at(3.0 * line);
        assert!((edge.stretched(out).tension / edge.line(out)[0] - grip).abs() < 1e-12);
        let mut before = edge.stretched(at(-line)).tension;
        let h = 1e-10;
        for k in 0..400 {
            let length = at(-line) + f64::from(k) * 2e-8;
            let s = edge.stretched(length);
            let slope =
                (edge.stretched(length + h).energy - edge.stretched(length - h).energy) / (2.0 * h);
            assert!(
                (slope - s.tension).abs() < 1e-2,
                "{k}: {slope} {}",
                s.tension
            );
            assert!(s.tension >= before && s.tension - before < 0.5);
            before = s.tension;
        }
        assert!(
            before > 1.02 * grip * line,
            "the last is well past letting go: {before}"
        );
    }

    /// Wire of the edge keeps its plastic stretch while virgin wire comes out.
    #[test]
    fn virgin_wire_comes_out_behind_stretched_wire() {
        let (spec, feed, past, step) = at_rest();
        let (ea, rest, plastic) = (48_900.0, 3e-3, [0.02, 0.001]);
        for grip in [1.0, 1.3] {
            let edge = edge((&spec, &feed, &past, &step), rest, grip, plastic);
            let turn = rest * (1.02 + edge.line_at_start() / ea);
            let mut before = edge.stretched(turn - 2e-5);
            for k in -199..400 {
                let length = turn + f64::from(k) * 1e-7;
                let s = edge.stretched(length);
                assert_pulls_by_its_wire(&edge, length, plastic);
                assert!((s.tension - before.tension).abs() < 2.5, "{k}: no jump");
                let work = s.energy - before.energy;
                let mean = 0.5 * (s.tension + before.tension) * 1e-7;
                assert!((work - mean).abs() < 1e-7 * 1.5, "{k}: {work} {mean}");
                before = s;
            }
            assert!(edge.rest(turn + 4e-5) > rest && edge.rest(turn - 2e-5) < rest);
        }
    }

    /// With mass in the line and a pulley, the edge pulls as the chain does, and its tension derives from its potential.
    #[test]
    fn the_edge_pulls_as_the_chain_behind_it() {
        let (mut spec, mut feed, mut past, step) = setting();
        (spec.line_mass, feed.rate, past.fed_rate) = (1.7e-3, 3.0, 3.0);
        spec.pulley = Some(crate::feed::Pulley {
            mass: 2e-4,
            friction: 1.0,
            share: 0.4,
        });
        // (at rest: its bearing holds it while the line pulls by 1 N more or less than behind it)
        feed.guided = feed.paid + 0.6 * 20.0 / 97_800.0;
        past.guided = [feed.guided; 2];
        (feed.paid_rate, past.paid_rate, past.paid) = (0.0, 0.0, [feed.paid; 2]);
        let (rest, plastic) = (3e-3, [0.02, 0.001]);
        for grip in [1.0, 1.3] {
            let edge = edge((&spec, &feed, &past, &step), rest, grip, plastic);
            let chain = Chain::new(&spec, &feed, &past, &step, (15.0, &LineYield::default()));
            assert!(edge.count >= 3, "back, held and out: {edge:?}");
            let (curve, passed) = chain.at_nozzle();
            let mut pieces = std::collections::BTreeSet::new();
            let mut before: Option<Stretched> = None;
            for k in 0..4000 {
                let length = rest * 1.02 - 1e-4 + f64::from(k) * 2e-7;
                let s = edge.stretched(length);
                let came = edge.rest(length) - rest;
                assert_pulls_by_its_wire(&edge, length, plastic);
                let line = curve.tension(feed.fed + came - passed);
                if came != 0.0 {
                    let held = if came > 0.0 { grip } else { 1.0 / grip };
                    assert!((s.tension - held * line).abs() < 1e-6, "{k}: {line} {s:?}");
                    pieces.insert(edge.balanced(length, edge.way(length)).1);
                }
                if let Some(before) = before {
                    assert!(s.tension >= before.tension - 1e-9);
                    let work = s.energy - before.energy;
                    let mean = 0.5 * (s.tension + before.tension) * 2e-7;
                    let within = 1e-7 * (s.tension - before.tension) + 1e-12;
                    assert!((work - mean).abs() <= within, "{k}: {work} {mean}");
                }
                before = Some(s);
            }
            assert_eq!(pieces.len(), edge.count, "{pieces:?}");
        }
    }

    /// The tension is the line's law with what has yielded under it, and derives from its potential.
    #[test]
    fn a_line_that_yields_is_longer_by_what_it_yields() {
        let (spec, mut feed, mut past, step) = setting();
        (feed.longer, past.longer) = (3e-4, 2e-4);
        let mut yields = LineYield::default();
        yields.push(30.0, 2e-4);
        yields.push(34.0, 3e-4);
        let state = at_start(3e-3, 1.0, [0.0; 2]);
        let edge = NozzleEdge::new(&spec, &feed, &past, &step, state, &yields);
        assert_eq!(edge.count, 3);
        let longest = 3e-3 * (1.0 + 15.0 / 48_900.0) + 2e-3;
        let (mut seen, h) = ([0; 3], 1e-9);
        for k in 0..2000 {
            let length = longest - f64::from(k) * 1e-6;
            let s = edge.stretched(length);
            if s.tension == 0.0 {
                continue;
            }
            let (rest, line) = (edge.rest(length), edge.line(length)[0]);
            seen[edge.balanced(length, edge.way(length)).1] += 1;
            let passed = (rest - 3e-3, line, 15.0);
            let next = advance(&spec, &feed, &past, &step, passed, &yields);
            let end = next.fed - next.longer;
            let began = step.blend(feed.fed - feed.longer, past.fed[0] - past.longer);
            let rate = (end - began) / step.gamma;
            let law = spec.line_stiffness * (end - next.paid)
                + spec.line_damping * (rate - next.paid_rate);
            assert!((law - line).abs() < 1e-6, "{length}: {law} {line}");
            let ends = [length - h, length + h].map(|length| edge.stretched(length).energy);
            let slope = (ends[1] - ends[0]) / (2.0 * h);
            assert!(
                (slope / s.tension - 1.0).abs() < 1e-4,
                "{length}: {slope} {s:?}"
            );
        }
        assert!(seen.iter().all(|times| *times > 10), "{seen:?}");
    }

    #[test]
    fn without_mass_and_damping_the_set_force_acts() {
        let (mut spec, mut feed, past, step) = setting();
        (spec.mass, spec.damping, feed.damping) = (0.0, 0.0, 0.0);
        let edge = edge((&spec, &feed, &past, &step), 3e-3, 1.0, [0.0; 2]);
        for length in [2e-3, 3e-3, 4e-3] {
            let s = edge.stretched(length);
            assert!((s.tension - 15.0).abs() < 1e-12 && s.stiffness == 0.0);
        }
    }
}
