//! Accepted instants before the present one, as the implicit method's formulas need them.

use crate::feed::Feed;
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// What a step of the wire needs to know of the time before it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Past {
    /// accepted instants on record before the present one, at most two
    pub known: usize,
    /// lab positions and velocities one instant back
    pub x: Vec<V3>,
    /// see `x`
    pub v: Vec<V3>,
    /// core-frame positions now, one back and two back
    pub q: [Vec<V3>; 3],
    /// twist of each edge's frame against parallel transport in the last step and in the one before, rad
    pub roll: [Vec<f64>; 2],
    /// spin of each edge one instant back, rad/s
    pub spin: Vec<f64>,
    /// wire passed by one and two instants back, m
    pub fed: [f64; 2],
    /// its rate one instant back, m/s
    pub fed_rate: f64,
    /// tensioner's way one and two instants back, m
    pub paid: [f64; 2],
    /// its speed one instant back, m/s
    pub paid_rate: f64,
    /// the pulley's way one and two instants back, m
    pub guided: [f64; 2],
    /// its speed one instant back, m/s
    pub guided_rate: f64,
    /// how much longer the line's wire was for good one instant back, m
    pub longer: f64,
    /// lengths of the last two steps, s
    pub h: [f64; 2],
}

impl Past {
    /// Becomes a copy of another, in the room that this one has.
    pub(super) fn copy_from(&mut self, other: &Self) {
        let Self {
            known,
            x,
            v,
            q,
            roll,
            spin,
            fed,
            fed_rate,
            paid,
            paid_rate,
            guided,
            guided_rate,
            longer,
            h,
        } = other;
        self.known = *known;
        self.x.clone_from(x);
        self.v.clone_from(v);
        self.q.clone_from(q);
        self.roll.clone_from(roll);
        self.spin.clone_from(spin);
        (self.fed, self.fed_rate) = (*fed, *fed_rate);
        (self.paid, self.paid_rate) = (*paid, *paid_rate);
        (self.guided, self.guided_rate) = (*guided, *guided_rate);
        (self.longer, self.h) = (*longer, *h);
    }

    /// Forgets everything before the present instant: the next step starts afresh.
    pub fn forget(&mut self) {
        self.known = 0;
    }

    /// Takes the present feed as that of one instant back.
    pub(crate) fn keep_feed(&mut self, feed: &Feed) {
        self.fed = [feed.fed, self.fed[0]];
        self.fed_rate = feed.rate;
        self.paid = [feed.paid, self.paid[0]];
        self.paid_rate = feed.paid_rate;
        self.guided = [feed.guided, self.guided[0]];
        self.guided_rate = feed.guided_rate;
        self.longer = feed.longer;
    }

    /// Takes `wire`, m, as passed everywhere.
    pub(crate) fn shift_feed(&mut self, wire: f64) {
        let places = [&mut self.fed, &mut self.paid, &mut self.guided];
        for place in places.into_iter().flatten() {
            *place += wire;
        }
    }

    /// Rolls before the present instant are not known.
    pub(crate) fn forget_rolls(&mut self, edges: usize) {
        for v in self.roll.iter_mut().chain([&mut self.spin]) {
            v.clear();
            v.resize(edges, 0.0);
        }
    }
}
