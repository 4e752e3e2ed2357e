//! What machines do: brake, nozzle, tensioner, traverse, and trouble with them.

#[allow(dead_code, reason = "its measures are not needed here")]
#[path = "../common/bobbin.rs"]
mod bobbin;
mod brake;
#[path = "../common/mod.rs"]
mod common;
mod inputs;
mod laid_tension;
mod led_trail;
mod nozzle_aside;
mod nozzle_body;
mod set_by_input;
mod short_lines;
mod slack_place;
mod speed_profile;
mod tensioner_ringing;
mod traverse;
mod traverse_by_law;
mod trouble;
