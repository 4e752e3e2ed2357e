//! Tests with random calls: nothing crashes, and a refused call changes nothing.

use crate::exports::*;
use crate::ffi::*;
use crate::guard;
use crate::instance::Instance;
use crate::lifecycle::State;
use crate::logger::Host;
use crate::pointers;
use coilwind_model_description::guid;
use proptest::prelude::*;
use std::ptr::{null, null_mut};

/// Inputs, an output, an Integer, a fixed and a tunable parameter, a String and nothing.
const REFERENCES: [&str; 9] = [
    "spindle_speed",
    "nozzle_position",
    "tension_setpoint",
    "wire_tension",
    "layer",
    "wire.diameter",
    "friction.static",
    "core.shape",
    "",
];
const VALUES: [f64; 7] = [0.0, 0.3e-3, 0.25, 20.0, -1e9, f64::NAN, f64::INFINITY];
const STEPS: [f64; 6] = [1e-5, 1e-5, 3e-6, 0.0, -1e-5, f64::NAN];

/// A call. Its numbers choose arguments from the lists above, and one of two saved states.
#[derive(Clone, Copy, Debug)]
enum Call {
    Setup,
    Enter,
    Exit,
    Terminate,
    Reset,
    Get(usize),
    Set(usize, usize),
    Rates(usize, i32, usize),
    Slopes(usize, i32),
    Step {
        late: bool,
        step: usize,
    },
    Save(usize),
    Restore(usize),
    Free(usize),
    Carry {
        from: usize,
        to: usize,
        damage: usize,
    },
    Derivative,
    Status(i32),
}

fn call() -> impl Strategy<Value = Call> {
    let which = 0..REFERENCES.len();
    let value = 0..VALUES.len();
    let slot = 0..2usize;
    prop_oneof![
        1 => Just(Call::Setup),
        4 => Just(Call::Enter),
        4 => Just(Call::Exit),
        1 => Just(Call::Terminate),
        1 => Just(Call::Reset),
        3 => which.clone().prop_map(Call::Get),
        6 => (which.clone(), value.clone()).prop_map(|(w, v)| Call::Set(w, v)),
        3 => (which.clone(), 0..3, value).prop_map(|(w, o, v)| Call::Rates(w, o, v)),
        2 => (which, 0..3).prop_map(|(w, o)| Call::Slopes(w, o)),
        8 => (prop::bool::weighted(0.1), 0..STEPS.len())
            .prop_map(|(late, step)| Call::Step { late, step }),
        4 => slot.clone().prop_map(Call::Save),
        4 => slot.clone().prop_map(Call::Restore),
        1 => slot.clone().prop_map(Call::Free),
        4 => (slot.clone(), slot, 0..4usize)
            .prop_map(|(from, to, damage)| Call::Carry { from, to, damage }),
        1 => Just(Call::Derivative),
        2 => (0..5).prop_map(Call::Status),
    ]
}

fn reference(which: usize) -> u32 {
    coilwind::variables::by_name(REFERENCES[which]).map_or(u32::MAX, |v| v.reference)
}

/// Returns the instance as bytes. Before the start the simulation is left out, since a getter may
/// make it from the same settings.
fn bytes(c: fmi2Component) -> Vec<u8> {
    // SAFETY: the component is alive and nobody else looks at it.
    let component = unsafe { pointers::component(c) };
    let instance = &mut component.expect("alive").instance;
    let mut snapshot = instance.snapshot();
    if matches!(snapshot.state, State::Instantiated | State::Initialization) {
        snapshot.run = None;
    }
    let guid = guid().expect("a description");
    snapshot.to_bytes(guid).expect("bytes")
}

fn now(c: fmi2Component) -> f64 {
    let mut time = 0.0;
    // SAFETY: the component is alive, the target a local.
    let status = unsafe { fmi2GetRealStatus(c, LAST_SUCCESSFUL_TIME, &mut time) };
    if status == Status::Ok.code() {
        time
    } else {
        0.0
    }
}

fn perform(call: Call, c: fmi2Component, states: &mut [fmi2FMUstate; 2]) -> fmi2Status {
    let time = now(c);
    // SAFETY: the component is alive; arrays are locals of the length given; states are NULL or alive.
    unsafe {
        match call {
            Call::Setup => fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0),
            Call::Enter => fmi2EnterInitializationMode(c),
            Call::Exit => fmi2ExitInitializationMode(c),
            Call::Terminate => fmi2Terminate(c),
            Call::Reset => fmi2Reset(c),
            Call::Get(which) => fmi2GetReal(c, &reference(which), 1, &mut 0.0),
            Call::Set(which, value) => fmi2SetReal(c, &reference(which), 1, &VALUES[value]),
            Call::Rates(which, order, value) => {
                fmi2SetRealInputDerivatives(c, &reference(which), 1, &order, &VALUES[value])
            }
            Call::Slopes(which, order) => {
                fmi2GetRealOutputDerivatives(c, &reference(which), 1, &order, &mut 0.0)
            }
            Call::Step { late, step } => {
                fmi2DoStep(c, time + if late { 1.0 } else { 0.0 }, STEPS[step], 0)
            }
            Call::Save(slot) => fmi2GetFMUstate(c, &mut states[slot]),
            Call::Restore(slot) => fmi2SetFMUstate(c, states[slot]),
            Call::Free(slot) => {
                let status = fmi2FreeFMUstate(c, &mut states[slot]);
                assert!(states[slot].is_null());
                status
            }
            Call::Carry { from, to, damage } => carry(c, states, from, to, damage),
            Call::Derivative => {
                fmi2GetDirectionalDerivative(c, null(), 0, null(), 0, null(), null_mut())
            }
            Call::Status(kind) => {
                fmi2GetBooleanStatus(c, kind, &mut 0);
                fmi2GetRealStatus(c, kind, &mut 0.0);
                fmi2GetStatus(c, kind, &mut 0)
            }
        }
    }
}

/// Copies a state by way of its bytes, which are cut or damaged unless `damage` is 0.
unsafe fn carry(
    c: fmi2Component,
    states: &mut [fmi2FMUstate; 2],
    from: usize,
    to: usize,
    damage: usize,
) -> fmi2Status {
    let mut size = 0;
    // SAFETY: as for the caller.
    unsafe {
        let status = fmi2SerializedFMUstateSize(c, states[from], &mut size);
        if status != Status::Ok.code() {
            return status;
        }
        let mut data = vec![0; size];
        assert_eq!(
            fmi2SerializeFMUstate(c, states[from], data.as_mut_ptr(), size),
            Status::Ok.code()
        );
        match damage {
            1 => data[0] ^= 1,
            2 => data.truncate(size / 2),
            3 => data[size - 7] ^= 16,
            _ => {}
        }
        let before = states[to];
        let status = fmi2DeSerializeFMUstate(c, data.as_ptr(), data.len(), &mut states[to]);
        assert_eq!(status == Status::Ok.code(), damage == 0, "damage {damage}");
        assert!(damage == 0 || states[to] == before);
        status
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn nothing_crashes_and_errors_change_nothing(calls in prop::collection::vec(call(), 1..24)) {
        // SAFETY: without callbacks nothing is ever called.
        let host = unsafe { Host::new("random", None) };
        let c = guard::instantiate(host, || Ok(Instance::for_tests()));
        let mut states = [null_mut(); 2];
        for call in calls {
            let before = bytes(c);
            let status = perform(call, c, &mut states);
            prop_assert!(status < Status::Fatal.code(), "{call:?}");
            let reads = matches!(call, Call::Get(_) | Call::Slopes(..) | Call::Status(_));
            if status >= Status::Discard.code() || reads {
                prop_assert!(bytes(c) == before, "{call:?} with status {status} changed the instance");
            }
        }
        for mut state in states {
            // SAFETY: states and component are alive and not used again.
            unsafe { fmi2FreeFMUstate(c, &mut state) };
        }
        // SAFETY: not used again.
        unsafe { fmi2FreeInstance(c) };
    }
}
