//! Contact of the explicit methods: the paper's, with its errors removed.
//!
//! Each node is a sphere that touches the triangles of the core, prisms of frozen wire ([`Contacts`]) and
//! segments of older live wire ([`LiveContact`]). The force of a touch is [`ContactLaw::force`], with a dashpot and
//! stick-slip friction.
//!
//! [`ContactLaw::force`]: super::ContactLaw::force

mod contacts;
mod force;
mod live;
mod node;

pub use contacts::{Body, Contacts};
pub(crate) use contacts::{SavedContacts, far, restore_tube};
#[cfg(feature = "lab")]
pub use force::TouchForce;
pub use live::{LiveContact, Wire};
pub use node::NodeContact;
