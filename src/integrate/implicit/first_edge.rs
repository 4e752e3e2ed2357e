//! The first live edge together with the frozen wire before it, as one spring.
//!
//! Frozen wire keeps its place, but it slips along itself where the tension of the first live edge differs by more from its
//! own than friction holds. From node to node the ratio of tensions is then the largest that friction holds, so all of
//! them follow that of the first live edge. Up to where the wire slips they are in proportion to it. What the frozen wire
//! becomes longer the live edge gets. So the length of the edge is a quadratic in its tension, in pieces, and
//! the tension has a closed potential: slip costs no unknown.

use crate::rod::{Law, Scalar, Stretched, stretched};
use crate::system::{Beside, FrozenPulls, FrozenSlip, System};

/// The first live edge during one solve.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstEdge<'a> {
    pulls: &'a FrozenPulls,
    friction: f64,
    law: &'a Law,
    state: &'a Scalar,
    /// unstretched length at the start of the step, m
    rest: f64,
}

/// Frozen wire that slips, from the edge `from` on.
#[derive(Clone, Copy, Debug)]
struct Slipping {
    from: usize,
    /// wire that it gives over the tension of the first live edge, m/N
    a: f64,
    /// what it would give less at no tension, m
    b: f64,
    /// tension of the live edge from which on all of it slips, N
    begins: f64,
    /// work done on it up to there, J
    work: f64,
}

impl<'a> FirstEdge<'a> {
    /// The edge at the start of a step; none where nothing is frozen.
    pub(super) fn of(sys: &'a System) -> Option<Self> {
        let friction = sys.friction_at_rest()?;
        let state = &sys.state;
        Self::new(
            &state.frozen_pulls,
            friction,
            &sys.model.laws.stretch,
            (&state.rod.stretch[0], state.rod.rest[0]),
        )
    }

    /// An edge of the unstretched length `rest` (m) after frozen wire with these tensions.
    pub(super) fn new(
        pulls: &'a FrozenPulls,
        friction: f64,
        law: &'a Law,
        (state, rest): (&'a Scalar, f64),
    ) -> Option<Self> {
        (!pulls.is_empty()).then_some(Self {
            pulls,
            friction,
            law,
            state,
            rest,
        })
    }

    /// `1 + plastic stretch` of the edge.
    fn set(&self) -> f64 {
        1.0 + self.state.strain
    }

    /// Tension at which the edge yields, N.
    fn yields_at(&self) -> f64 {
        self.law.limit + self.state.rise
    }

    /// Tension of the edge were no wire to slip, N.
    fn held(&self, length: f64) -> f64 {
        self.law.modulus * (length / self.rest - self.set())
    }

    /// Tension and length of the edge, m, are in balance while it has `rest`, m, at no tension and `a`, m/N, more with it.
    fn length_at(&self, tension: f64, rest: f64, a: f64) -> f64 {
        (rest + tension * a) * (self.set() + tension / self.law.modulus)
    }

    /// Which of the frozen wire slips when the edge is `length` long, and whether its tension falls; none where friction holds.
    fn slips(&self, length: f64) -> Option<(Slipping, bool)> {
        let last = self.pulls.last()?;
        let held = self.held(length);
        let least = last.most(self.friction).other(last.pulls());
        let falls = held < least;
        // (an edge that yields pulls no harder than it yields at)
        let rises = held.min(self.yields_at()) > last.least(self.friction).other(last.pulls());
        if (falls && least > 0.0) || rises {
            let reached = |tension: f64, run: &Slipping| {
                let there = self.length_at(tension, self.rest - run.b, run.a);
                if falls {
                    there <= length
                } else {
                    there >= length
                }
            };
            return Some((self.run(falls, reached), falls));
        }
        None
    }

    /// Goes back along the frozen wire until the tension at which the next edge would slip is `reached`.
    fn run(&self, falls: bool, reached: impl Fn(f64, &Slipping) -> bool) -> Slipping {
        let modulus = self.law.modulus;
        let count = self.pulls.len();
        let mut run = Slipping {
            from: count,
            a: 0.0,
            b: 0.0,
            begins: 0.0,
            work: 0.0,
        };
        // the tension of a frozen edge that slips, by that of the live one
        let mut slipping = Beside::ITSELF;
        for i in (0..count).rev() {
            let Some(pull) = self.pulls.get(i) else {
                break;
            };
            slipping = pull.limit(falls, self.friction).after(&slipping);
            let first = run.from == count;
            // (friction that has been lowered holds less than there is: what is beyond stays until it slips)
            let tension = match falls {
                _ if first => pull.pulls(),
                true => pull.pulls().min(slipping.at(run.begins)),
                false => pull.pulls().max(slipping.at(run.begins)),
            };
            let begins = slipping.other(tension);
            if (falls && begins <= 0.0) || (!first && reached(begins, &run)) {
                break;
            }
            if !first {
                run.work += self.work(run.a, run.begins, begins);
            }
            (run.from, run.begins) = (i, begins);
            run.a += pull.rest * slipping.share / modulus;
            run.b += pull.rest * (tension - slipping.more) / modulus;
        }
        run
    }

    /// Work on frozen wire that gives `a`, m/N, while the live edge's tension goes from one value to another, N; J.
    fn work(&self, a: f64, from: f64, to: f64) -> f64 {
        let square = to * to - from * from;
        let cube = to * to * to - from * from * from;
        a * (0.5 * self.set() * square + cube / (6.0 * self.law.modulus))
    }

    /// Tension, stiffness and potential at a `length`, m; the branch of the stretch is that at the length `expected`, m.
    pub(super) fn stretched(&self, length: f64, expected: f64) -> Stretched {
        let Some((run, falls)) = self.slips(length) else {
            return stretched(self.law, self.state, self.rest, length, expected);
        };
        let (tension, rest, run, yields) = self.balanced(length, run, falls);
        let work = run.work + self.work(run.a, run.begins, tension.max(0.0));
        if yields || tension <= 0.0 {
            let own = stretched(self.law, self.state, rest, length, expected);
            return Stretched {
                energy: own.energy + work,
                ..own
            };
        }
        let (modulus, a) = (self.law.modulus, run.a);
        let per_tension = a * (self.set() + tension / modulus) + rest / modulus;
        Stretched {
            tension,
            stiffness: 1.0 / per_tension,
            energy: 0.5 * tension * tension / modulus * rest + work,
        }
    }

    /// Tension at which edge and frozen wire are in balance, N, the edge's unstretched length, m, what slips, and whether the edge
    /// yields. Frozen wire pulls no harder than the edge does where it begins to yield, and gives no more than it has.
    fn balanced(&self, length: f64, run: Slipping, falls: bool) -> (f64, f64, Slipping, bool) {
        let modulus = self.law.modulus;
        let rest = self.rest - run.b;
        let most = self.yields_at();
        // a quadratic, with its root in the form without cancellation
        let [c2, c1, c0] = [
            run.a / modulus,
            run.a * self.set() + rest / modulus,
            rest * self.set() - length,
        ];
        if c0 >= 0.0 {
            return (0.0, rest, run, false);
        }
        let tension = -2.0 * c0 / (c1 + (c1 * c1 - 4.0 * c2 * c0).sqrt());
        if tension <= most || falls {
            return (tension, rest + tension * run.a, run, false);
        }
        let run = self.run(falls, |begins, _| begins >= most);
        let rest = self.rest - run.b + most * run.a;
        (most, rest, run, true)
    }

    /// How frozen wire has slipped when the edge is `length` long, m, and the unstretched length that the edge then has, m.
    pub(super) fn slip(&self, length: f64) -> Option<(FrozenSlip, f64)> {
        let (run, falls) = self.slips(length)?;
        let (tension, rest, run, _) = self.balanced(length, run, falls);
        let slip = FrozenSlip {
            from: run.from,
            tension,
            falls,
            work: run.work + self.work(run.a, run.begins, tension),
        };
        Some((slip, rest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::FrozenPull;
    use proptest::prelude::*;

    const EA: f64 = 44_000.0;
    const REST: f64 = 1.2e-3;

    fn law() -> Law {
        Law::new(EA, 0.02 * EA, 60.0, f64::INFINITY)
    }

    /// Frozen wire of one tension as far as its nodes let it: they hold by their bends, by what the wire's stiffness presses, N, and
    /// by how much they hold tensions apart, N.
    fn wire(tension: f64, nodes: &[(f64, f64, f64)]) -> FrozenPulls {
        let mut after = tension;
        let mut all: Vec<FrozenPull> = Vec::new();
        for &(drawn, bent, apart) in nodes.iter().rev() {
            let [lowest, highest] = limits((drawn, bent, apart), 0.2, after);
            after = tension.clamp(lowest.max(0.0), highest);
            all.push(FrozenPull {
                tension: after,
                rest: 0.9e-3,
                turned: drawn,
                pressed: drawn,
                net: drawn,
                drawn,
                bent,
                apart,
            });
        }
        all.into_iter().rev().collect()
    }

    /// Between which tensions one lies that has another one after it, N.
    fn limits((drawn, bent, apart): (f64, f64, f64), friction: f64, after: f64) -> [f64; 2] {
        let (by_bends, by_stiffness) = (1.0 + friction * drawn, friction * bent);
        [
            (after - by_stiffness) / by_bends + apart,
            after * by_bends + (by_stiffness + apart).max(0.0),
        ]
    }

    fn edge<'a>(pulls: &'a FrozenPulls, law: &'a Law, state: &'a Scalar) -> FirstEdge<'a> {
        FirstEdge::new(pulls, 0.2, law, (state, REST)).expect("frozen wire")
    }

    /// Tensions of the frozen wire when the live edge has this one, edge by edge, and the wire that it gives, m.
    fn by_hand(pulls: &FrozenPulls, friction: f64, tension: f64) -> (Vec<f64>, f64) {
        let mut after = tension.max(0.0);
        let mut given = 0.0;
        let mut all = Vec::new();
        for pull in pulls.iter().rev() {
            let [lowest, highest] = limits((pull.drawn, pull.bent, pull.apart), friction, after);
            let now = pull.tension.clamp(lowest.min(highest), highest);
            given += pull.rest * (now - pull.tension) / EA;
            all.push(now);
            after = now;
        }
        all.reverse();
        (all, given)
    }

    /// The same edge by halving: the tension at which edge and frozen wire are together as long as is asked.
    fn slow_twin(edge: &FirstEdge<'_>, length: f64) -> f64 {
        let (mut low, mut high) = (-200.0, 2000.0);
        for _ in 0..200 {
            let tension = 0.5 * (low + high);
            let (_, given) = by_hand(edge.pulls, edge.friction, tension);
            let there = (edge.rest + given) * (edge.set() + tension / EA);
            *(if there < length { &mut low } else { &mut high }) = tension;
        }
        0.5 * (low + high)
    }

    fn length_of(tension: f64) -> f64 {
        REST * (1.0 + tension / EA)
    }

    proptest! {
        /// What slips is what a search over all of the frozen wire finds, step after step.
        #[test]
        fn it_slips_as_far_as_friction_lets_it(
            tension in 0.5..20.0_f64,
            nodes in proptest::collection::vec((0.0..0.3_f64, 0.0..2.0_f64, -0.5..0.5_f64), 1..40),
            ways in proptest::collection::vec(-40.0..60.0_f64, 1..8),
        ) {
            let (law, state) = (law(), Scalar::default());
            let mut pulls = wire(tension, &nodes);
            let mut rest = REST;
            for way in ways {
                let edge = FirstEdge { rest, ..edge(&pulls, &law, &state) };
                let length = length_of(way);
                let twin = slow_twin(&edge, length);
                // (the twin does not yield, neither drawn nor pushed)
                prop_assume!(twin.abs() < 55.0);
                let s = edge.stretched(length, length);
                prop_assert!((s.tension - twin).abs() < 1e-6 * (1.0 + twin.abs()), "{s:?} {twin}");
                let (tensions, given) = by_hand(&pulls, edge.friction, twin);
                if let Some((slip, after)) = edge.slip(length) {
                    prop_assert!((after - rest - given).abs() < 1e-12, "{after} {rest} {given}");
                    let mut after_it = slip.tension;
                    let mut changed: Vec<FrozenPull> = pulls.iter().copied().collect();
                    for pull in changed[slip.from..].iter_mut().rev() {
                        after_it = pull.limit(slip.falls, edge.friction).at(after_it);
                        pull.tension = after_it;
                    }
                    for (pull, tension) in changed.iter().zip(&tensions) {
                        prop_assert!((pull.tension - tension).abs() < 1e-6 * (1.0 + tension), "{pull:?} {tension}");
                    }
                    pulls = changed.into_iter().collect();
                    rest = after;
                } else {
                    prop_assert!(given.abs() < 1e-15);
                }
            }
        }

        /// Tension and stiffness are derivatives of the potential, and the potential goes on where wire begins to slip.
        #[test]
        fn tension_and_stiffness_are_derivatives(
            tension in 2.0..20.0_f64,
            nodes in proptest::collection::vec((0.0..0.3_f64, 0.0..2.0_f64, -0.5..0.5_f64), 1..40),
            at in 0.2..90.0_f64,
        ) {
            let (law, state) = (law(), Scalar::default());
            let pulls = wire(tension, &nodes);
            let edge = edge(&pulls, &law, &state);
            let length = length_of(at);
            let s = edge.stretched(length, length);
            let h = 2e-11;
            let [a, b] = [length - h, length + h].map(|l| edge.stretched(l, l));
            let slope = (b.energy - a.energy) / (2.0 * h);
            prop_assert!((slope - s.tension).abs() < 1e-3 * s.tension.abs().max(1.0), "{slope} {s:?}");
            let [below, above] = [(s.tension - a.tension) / h, (b.tension - s.tension) / h];
            // (at a kink it is that of either side)
            let near = [below, above].iter().any(|k| (k / s.stiffness - 1.0).abs() < 1e-2);
            prop_assert!(near, "{below} {above} {s:?}");
        }
    }

    /// Frozen wire that holds more than the edge yields at lost tension to it.
    #[test]
    fn an_edge_that_yields_first_draws_no_wire() {
        let (law, state) = (law(), Scalar::default());
        let pulls = wire(59.0, &[(0.1, 20.0, 0.0); 5]);
        let edge = edge(&pulls, &law, &state);
        let length = length_of(90.0);
        assert!(edge.slip(length).is_none(), "{:?}", edge.slip(length));
        let (own, s) = (
            stretched(&law, &state, REST, length, length),
            edge.stretched(length, length),
        );
        assert_eq!((own.tension, own.energy), (s.tension, s.energy));
        // wire that holds less gives what it can up to there
        let pulls = wire(50.0, &[(0.01, 0.0, 0.0); 5]);
        let (slip, _) = FirstEdge::new(&pulls, 0.2, &law, (&state, REST))
            .expect("frozen wire")
            .slip(length_of(400.0))
            .expect("it slips");
        assert!(
            (slip.tension - 60.0).abs() < 1e-12 && slip.from == 0,
            "{slip:?}"
        );
    }

    /// The work on frozen wire is what the edge passes on, and none of it is lost where nothing rubs.
    #[test]
    fn wire_that_nothing_holds_stores_all_the_work() {
        let (law, state) = (law(), Scalar::default());
        let pulls = wire(10.0, &[(0.0, 0.0, 0.0); 30]);
        let edge = edge(&pulls, &law, &state);
        let (slip, _) = edge.slip(length_of(60.0)).expect("it slips");
        let stored = |tension: f64, rest: f64| 0.5 * tension * tension * rest / EA;
        let gained: f64 = (0..30)
            .map(|_| {
                let shorter = 0.9e-3 * (1.0 - (slip.tension - 10.0) / EA);
                stored(slip.tension, shorter) - stored(10.0, 0.9e-3)
            })
            .sum();
        assert!((slip.work / gained - 1.0).abs() < 1e-3, "{slip:?} {gained}");
    }
}
