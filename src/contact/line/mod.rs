//! Contact of the implicit (production) method: smooth core, smooth frozen wire, friction with memory.
//!
//! The wire touches at its [`ContactPoint`](super::ContactPoint)s. Each has the core and up to four passages of
//! frozen wire near it. The normal force sets in smoothly. Friction is a bristle from an anchor, cut off at the
//! coefficient times a normal force that is held while the potential is differentiated: for given
//! limits both forces derive from one potential. The limits are renewed with every iterate: the converged
//! step has the limit of its own normal force.
//!
//! * [`LineContact`]: state, and changes of the wire
//! * `search`: the surroundings of a point
//! * `response`: potential, gradient and Hessian at an iterate
//! * `prediction`: the same where an update leads
//! * `commit`: an iterate becomes the accepted instant; what was lost and is stored
//! * `saved`: the state in bytes

mod commit;
mod line_contact;
mod near;
mod point;
mod prediction;
mod record;
mod response;
mod saved;
mod saved_touches;
mod search;
mod touch;

pub use line_contact::LineContact;
pub use record::ContactRecord;
pub(crate) use saved::SavedLine;
