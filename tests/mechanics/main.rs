//! The mechanics against exact answers, balances and other methods.

#[path = "../common/mod.rs"]
mod common;
mod energy_balance;
mod exit_friction;
mod lanes;
mod static_equilibrium;
mod table1;
mod twist;
#[path = "../common/verified.rs"]
mod verified;
mod verify_contact;
mod verify_rod;
