//! What bulges are judged by: the height of wire at rest, or a limit of their own. And whether the run can be judged at all.

use crate::measure::BulgeLimit;
use crate::signals::EventKind;
use crate::simulation::winding::{Cause, DEEPEST, Doubt, UNEXPLAINED};
use crate::simulation::{Winding, quasi_static};

/// Share by which wire may be laid tighter than the tension that its height at rest is for, before that is told. The height falls
/// with the root of the tension, so it is off by a twentieth then.
const TIGHTER: f64 = 0.1;

/// Largest tension of a yardstick that a saved state may ask for, N: that of the input.
const MOST_TENSION: f64 = 1e4;

impl Winding {
    /// Takes the quasi-static height of wire under `tension`, N, as the yardstick where it is another than that of
    /// the scene.
    pub(in crate::simulation) fn take_yardstick_for(
        &mut self,
        tension: f64,
    ) -> Result<(), &'static str> {
        if tension == self.run.yardstick_tension {
            return Ok(());
        }
        if !(0.0..=MOST_TENSION).contains(&tension) {
            return Err("wire at rest has no such tension");
        }
        let surface = self.sys.model.core.clone().ok_or("there is no core")?;
        let profile = quasi_static::profile(&self.scene, &surface, tension);
        self.coil_mut().set_profile(tension, profile);
        Ok(())
    }

    /// Tells once where a turn was laid so much tighter than bulges are judged by that they seem smaller than they are.
    pub(in crate::simulation) fn watch_yardstick(&mut self) {
        if self.run.told_tighter || !matches!(self.bulge_limit(), BulgeLimit::OverRest { .. }) {
            return;
        }
        let meant = self.run.yardstick_tension;
        let laid = self.coil.tension_of_last_turn();
        let Some(laid) = laid.filter(|laid| *laid > (1.0 + TIGHTER) * meant) else {
            return;
        };
        self.run.told_tighter = true;
        self.report(
            EventKind::Judgement,
            format!(
                "the last turn at rest has {laid:.1} N on average, and bulges are judged by the height at rest under {meant:.1} N, which is larger; set tensioner.tension to that average where an input gives the tension, or defects.bulge_absolute"
            ),
        );
    }

    /// Looks for the first doubt at a communication point, where the energy balance leaves `residual`, J, and tells it.
    pub(in crate::simulation) fn watch_for_doubt(&mut self, residual: f64) {
        let b = self.sys.state.balance;
        self.run.throughput.add([b.spindle, b.nozzle]);
        if self.run.doubt.is_some() {
            return;
        }
        let Some(cause) = self.cause_for_doubt(residual) else {
            return;
        };
        let time = self.run.time;
        self.run.doubt = Some(Doubt { time, cause });
        self.report(EventKind::Judgement, cause.to_string());
    }

    fn cause_for_doubt(&self, residual: f64) -> Option<Cause> {
        let d = self.scene.wire.diameter;
        let depth = self.sys.state.deepest;
        if depth > DEEPEST * d {
            let share = depth / d;
            return Some(Cause::Depth { depth, share });
        }
        let pull = self.sys.state.set_tension.max(self.scene.tensioner.tension);
        let through = self.run.throughput.sum + pull * d;
        if residual.abs() <= UNEXPLAINED * through {
            return None;
        }
        // (what the wire holds is asked for only where it may decide)
        let share = residual.abs() / (through + self.sys.stored() + self.sys.kinetic());
        let unexplained = residual;
        (share > UNEXPLAINED).then_some(Cause::Energy { unexplained, share })
    }

    /// Why the verdict on this run, and its numbers, are not to be trusted, if they are not.
    ///
    /// The energy balance leaves more than 5 % of what went through it unexplained, or wire was more than half a diameter deep in
    /// what it touches. Or wire has left the core or got over a flange, and no defect tells so.
    pub fn doubt(&self) -> Option<String> {
        let since = |doubt: Doubt| format!("at t = {:.6} s {}", doubt.time, doubt.cause);
        self.run.doubt.map(since).or_else(|| self.left_its_room())
    }

    /// That wire lies where nothing judges it, unless a defect condemns the coil all the same.
    fn left_its_room(&self) -> Option<String> {
        let why = self.slipped_off().or_else(|| self.wire_on_a_rim())?;
        let condemned = self.verdict().is_defect() || !self.defects().is_empty();
        (!condemned).then(|| {
            format!("{why}; it is measured there as if it lay on the core, which judges nothing")
        })
    }

    /// What bulges are judged by.
    pub fn bulge_limit(&self) -> BulgeLimit {
        self.coil.bulge_limit()
    }

    /// What the reader of a verdict has to know about bulges, if anything.
    pub(in crate::simulation) fn doubt_about_bulge(&self) -> Option<(EventKind, String)> {
        let (d, tension) = (self.scene.wire.diameter, self.run.yardstick_tension);
        let limit = self.coil.bulge_limit();
        match limit {
            BulgeLimit::Fallback { limit_m } => Some((
                EventKind::Judgement,
                format!(
                    "the height of this wire at rest on this core is not known, so wire counts as a bulge where it stands off by more than {:.3} mm (one diameter); set defects.bulge_absolute to judge by another height",
                    1e3 * limit_m
                ),
            )),
            BulgeLimit::OverRest { highest_m, .. } if highest_m > d => Some((
                EventKind::Note,
                format!(
                    "this wire stands up to {:.3} mm ({:.1} d) off this core at rest under {tension} N, which is no bulge to the verdict; raise the tension, or set defects.bulge_absolute",
                    1e3 * highest_m,
                    highest_m / d
                ),
            )),
            _ => None,
        }
    }
}
