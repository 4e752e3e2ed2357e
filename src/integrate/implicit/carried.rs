//! What the wire carries of motion before and after impulses.

use crate::system::System;

/// Motion energy, J, and moment of momentum about the core's axis, N m s, before impulses of the core.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carried {
    pub(super) kinetic: f64,
    pub(super) momentum: f64,
}

impl Carried {
    pub(super) fn of(sys: &System) -> Self {
        Self {
            kinetic: sys.kinetic(),
            momentum: sys.momentum_about_core(),
        }
    }

    /// Motion energy that impulses have brought since then, J, as the turning core sees it; what the core gave with
    /// them becomes work of the spindle. What the wire carries `now` is what it carries before the next.
    pub(super) fn gained(&mut self, sys: &mut System, now: Self) -> f64 {
        let before = std::mem::replace(self, now);
        let work = sys.state.spindle.speed * (now.momentum - before.momentum);
        sys.state.balance.spindle += work;
        now.kinetic - before.kinetic - work
    }
}
