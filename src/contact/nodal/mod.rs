//! Contact of the explicit methods: the paper's, with its errors removed.
//!
//! Each node is a sphere that touches the triangles of the core, prisms of frozen wire ([`NodalContact`]) and
//! segments of older live wire ([`LiveContact`]). The force of a touch is [`ContactLaw::force`], with a dashpot and
//! stick-slip friction.
//!
//! [`ContactLaw::force`]: super::ContactLaw::force

mod force;
mod live;
mod model;
mod nodal_contact;
mod node;
mod state;

#[cfg(feature = "lab")]
pub use force::TouchForce;
pub use live::LiveConditions;
#[cfg(feature = "lab")]
pub use live::{LiveContact, Wire};
pub use model::NodalModel;
pub use nodal_contact::NodalScratch;
pub(crate) use nodal_contact::far;
pub use nodal_contact::{Body, NodalContact};
#[cfg(feature = "lab")]
pub use node::NodeContact;
pub use state::NodalState;
