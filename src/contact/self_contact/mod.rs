//! Live wire on live wire in the implicit method.
//!
//! Where wire lands before the turn below it is at rest, the younger wire's contact points touch the spline of the
//! older wire. Force and reaction go to the nodes of both. The bristle of friction grows with the relative
//! slide, so it travels with both partners. Such a pair couples nodes a whole turn apart, which no band holds. Its
//! share of the Hessian between the partners is kept as a [`Coupling`], and the linear system is solved by conjugate
//! gradients with the banded part as preconditioner.
//!
//! * [`SelfContact`]: the pairs, and how they follow changes of the wire; [`PairScratch`]: what they are worked on with
//! * `search`: which pairs a step has to look at; `by_place`: where loops make that another question than "a turn back"
//! * `response`: potential, gradient, Hessian and couplings, at an iterate and where an update leads
//! * `commit`: an iterate becomes the accepted instant; what was lost and is stored

mod by_place;
mod commit;
mod coupling;
mod pairs;
#[cfg(feature = "lab")]
mod probe;
mod response;
mod scratch;
mod search;

pub use coupling::{Coupling, add_couplings};
pub use pairs::SelfContact;
#[cfg(feature = "lab")]
pub use probe::HeldPair;
pub use response::PairConditions;
pub use scratch::PairScratch;
