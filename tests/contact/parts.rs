//! Contact along a wire on its own, without a system round it.

use coilwind::contact::{ContactLaw, LineContact, LineModel, LineScratch, LineState};
use coilwind::geometry::Shape;

/// What contact along the wire is made of.
pub struct Parts {
    pub model: LineModel,
    pub state: LineState,
    pub scratch: LineScratch,
}

impl Parts {
    /// Contact of a wire with so many nodes and this `radius` (m), which touches nothing yet.
    pub fn new(shape: Shape, law: ContactLaw, radius: f64, nodes: usize) -> Self {
        Self {
            model: LineModel::new(shape, law, radius),
            state: LineState::new(nodes),
            scratch: LineScratch::new(radius),
        }
    }

    /// The parts as one.
    pub fn contact(&mut self) -> LineContact<'_> {
        LineContact {
            model: &self.model,
            state: &mut self.state,
            scratch: &mut self.scratch,
        }
    }
}
