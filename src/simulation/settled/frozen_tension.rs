//! Settled wire whose tension has changed is measured again.

use crate::simulation::Winding;
use std::sync::Arc;

/// Change of a tension, as a share of it, that is measured. Chosen: the report shows three digits of a turn's tension.
const MEASURED: f64 = 0.01;

impl Winding {
    /// Takes over the tensions of wire that has slipped along itself since the last look.
    pub(in crate::simulation) fn follow_slip(&mut self) {
        let Some(from) = self.sys.take_slipped() else {
            return;
        };
        let (pulls, measured) = (&self.sys.state.frozen_pulls, &self.sys.state.frozen.tension);
        let differs = |i: &usize| {
            let (now, before) = (pulls[*i].tension, measured[*i]);
            (now - before).abs() > MEASURED * now.abs().max(before.abs())
        };
        let Some(first) = (from..pulls.len()).find(differs) else {
            return;
        };
        let tensions: Vec<f64> = (first..pulls.len()).map(|i| pulls[i].tension).collect();
        Arc::make_mut(&mut self.sys.state.frozen).tension[first..].copy_from_slice(&tensions);
        self.coil_mut().set_tensions(first, &tensions);
        self.count_defects();
        self.tell_of_changes("its tension has changed since");
    }
}
