//! Contact and friction: of the wire with the core, with frozen wire and with live wire.
//!
//! All vectors are in the core frame, in which core and frozen wire are at rest. Units are SI.
//!
//! * [`ContactLaw`]: parameters of stiffness and friction, shared by both methods
//! * [`mod@line`]: contact of the implicit (production) method, with a smooth core and smooth frozen wire; the
//!   places of its [`ContactPoint`]s on the wire are those of `stencil`, its force law that of `friction`
//! * [`SelfContact`]: live wire on live wire in the implicit method
//! * [`nodal`]: contact of the explicit methods, the paper's, node by node with triangles and prisms

mod accepted_touch;
mod friction;
mod law;
pub mod line;
pub mod nodal;
mod own_wire;
mod self_contact;
mod slip_coupling;
mod stencil;
mod tolerance;

pub use accepted_touch::AcceptedTouch;
#[cfg(feature = "lab")]
pub use accepted_touch::TouchOwner;
#[cfg(feature = "lab")]
pub use friction::ContactResponse;
pub use friction::LimitFrom;
#[cfg(feature = "lab")]
pub use law::ContactLoss;
pub use law::{ContactLaw, damping_for_restitution};
pub use line::{ContactRecord, LineContact, LineModel, LineScratch, LineState, MostTurn};
#[cfg(feature = "lab")]
pub use line::{HeldBy, HeldTouch, TouchMark};
#[cfg(feature = "lab")]
pub use nodal::TouchForce;
pub(crate) use nodal::far;
pub use nodal::{Body, LiveConditions, NodalContact, NodalModel, NodalScratch, NodalState};
#[cfg(feature = "lab")]
pub use nodal::{LiveContact, NodeContact, Wire};
pub use own_wire::own_wire;
pub use self_contact::{Coupling, add_couplings};
#[cfg(feature = "lab")]
pub use self_contact::{HeldPair, PairConditions, PairScratch, SelfContact};
pub use slip_coupling::SlipCoupling;
pub use stencil::{ContactPoint, NodeWeights};
