//! A system as a saved state holds it: its [`State`] and nothing else.

use super::{ContactModel, ContactState, State, System};

impl System {
    /// Takes a saved state over in a fresh system of the same scene.
    ///
    /// Fails with what is impossible about it; the system is then useless.
    pub(crate) fn restore(&mut self, state: State) -> Result<(), &'static str> {
        state.check()?;
        if self.model.feed.is_some() != state.feed.is_some() {
            return Err("a feed is there in one of scene and state only");
        }
        let far = self.far().unwrap_or(f64::INFINITY);
        let (nodes, frozen) = (state.rod.nodes(), &state.frozen);
        if frozen.radius() != self.state.frozen.radius() || !frozen.lies_within(far) {
            return Err("frozen wire is not one");
        }
        match (&self.model.contact, &state.contact) {
            (ContactModel::None, ContactState::None) => {}
            (ContactModel::Nodal(model), ContactState::Nodal(nodal)) => {
                nodal.check(model, nodes, frozen.len())?;
            }
            (ContactModel::Line(_), ContactState::Line(line)) => {
                let last = frozen
                    .points
                    .last()
                    .copied()
                    .zip(frozen.arc.last().copied());
                line.check(nodes, frozen.len(), last, far)?;
            }
            _ => return Err("contact is of another kind in scene and state"),
        }
        self.state = state;
        let wire: Vec<_> = self
            .state
            .frozen
            .nodes()
            .map(|n| (n.point, n.arc))
            .collect();
        if let Some(mut line) = self.line_contact() {
            line.relay(wire.into_iter());
        }
        Ok(())
    }
}
