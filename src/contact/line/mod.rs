//! Contact of the implicit (production) method: smooth core, smooth frozen wire, friction with memory.
//!
//! The wire touches at its [`ContactPoint`](super::ContactPoint)s. Each has the core and up to four passages of
//! frozen wire near it. The normal force sets in smoothly. Friction is a bristle from an anchor, cut off at the
//! coefficient times a normal force that is held while the potential is differentiated: for given
//! limits both forces derive from one potential. The limits are renewed with every iterate: the converged
//! step has the limit of its own normal force.
//!
//! * [`LineModel`], [`LineState`], [`LineScratch`]: what the scene gives, what is remembered, what is worked with
//! * [`LineContact`]: the three as one, while they are worked on
//! * `search`: the surroundings of a point
//! * `response`: potential, gradient and Hessian at an iterate
//! * `prediction`: the same where an update leads
//! * `commit`: an iterate becomes the accepted instant; what was lost and is stored

mod commit;
mod line_contact;
mod model;
mod near;
mod point;
mod prediction;
#[cfg(feature = "lab")]
mod probe;
mod record;
mod response;
mod saved_touches;
mod scratch;
mod search;
mod state;
mod touch;

pub use line_contact::LineContact;
pub use model::LineModel;
#[cfg(feature = "lab")]
pub use probe::{HeldBy, HeldTouch, TouchMark};
pub use record::ContactRecord;
pub use scratch::LineScratch;
pub use search::MostTurn;
pub use state::LineState;
