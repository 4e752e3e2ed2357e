//! The command through its front door: exit codes, messages and the files left behind.

mod check;
mod cli;
#[path = "../common/command.rs"]
mod command;
mod ensemble;
mod faults;
mod find_max;
mod motion;
mod refused_inputs;
mod report;
mod resume;
#[path = "../common/stl.rs"]
mod stl;
#[path = "../common/stopping.rs"]
mod stopping;
mod sweep;
