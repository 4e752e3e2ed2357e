//! Tests of an instance and of the C functions.

mod contract;
mod masters;
mod saving;
mod sequences;
mod told;
mod written_start_values;

use crate::instance::Instance;
use crate::message::Message;
use coilwind::variables::by_name;

fn reference(name: &str) -> u32 {
    by_name(name).expect("a variable").reference
}

fn set(instance: &mut Instance, name: &str, value: f64) {
    instance.set(&[reference(name)], [value]).expect("set");
}

/// Starts an instance at `time`, s, after `set_up`; returns the messages of the start too.
fn started(time: f64, set_up: impl Fn(&mut Instance)) -> (Instance, Vec<Message>) {
    let mut instance = Instance::for_tests();
    set_up(&mut instance);
    instance.setup_experiment(None, time, None).expect("valid");
    instance.enter_initialization_mode().expect("enters");
    instance.exit_initialization_mode().expect("starts");
    let messages = instance.end_call();
    (instance, messages)
}
