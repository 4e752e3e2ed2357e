//! Wire that freezes, thaws, slips, stretches and turns back.

#[path = "../common/mod.rs"]
mod common;
mod freezing;
mod frozen_slip;
mod slipping;
mod stretched;
mod thawing;
mod turned_back;
