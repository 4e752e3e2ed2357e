//! Tests of the C functions as an importer sees them in every state of an instance.
//!
//! States are planted, so that a failed step and a lost instance need no failing solver.

use crate::exports::*;
use crate::ffi::*;
use crate::guard;
use crate::instance::Instance;
use crate::lifecycle::{Function, State};
use crate::logger::Host;
use crate::pointers;
use coilwind_model_description::guid;
use libc::{c_void, size_t};
use std::ffi::CStr;
use std::ptr::{null, null_mut};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Messages of one instance.
type Log = Vec<(fmi2Status, String, String)>;

/// The logger with its one argument written out, since Rust cannot define variadic functions.
unsafe extern "C" fn record(
    environment: fmi2ComponentEnvironment,
    _name: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    format: fmi2String,
    text: fmi2String,
) {
    // SAFETY: the environment is the log of the test, the strings end with a NUL.
    unsafe {
        assert_eq!(CStr::from_ptr(format), c"%s");
        let owned = |text| CStr::from_ptr(text).to_string_lossy().into_owned();
        (*environment.cast::<Log>()).push((status, owned(category), owned(text)));
    }
}

/// Number of calls of the callbacks that `modelDescription.xml` promises not to use.
static UNWANTED: AtomicUsize = AtomicUsize::new(0);

unsafe extern "C" fn counted_calloc(number: size_t, size: size_t) -> *mut c_void {
    UNWANTED.fetch_add(1, Ordering::Relaxed);
    // SAFETY: any number and size are allowed.
    unsafe { libc::calloc(number, size) }
}

unsafe extern "C" fn counted_free(data: *mut c_void) {
    UNWANTED.fetch_add(1, Ordering::Relaxed);
    // SAFETY: NULL or from `counted_calloc`, as FMI demands of the FMU.
    unsafe { libc::free(data) }
}

unsafe extern "C" fn counted_step(_: fmi2ComponentEnvironment, _: fmi2Status) {
    UNWANTED.fetch_add(1, Ordering::Relaxed);
}

fn callbacks(log: &mut Log) -> fmi2CallbackFunctions {
    let record: unsafe extern "C" fn(_, _, _, _, _, _) = record;
    // SAFETY: on x86-64 and AArch64 Linux and on Windows x86-64, pointers and ints are passed to a
    // variadic function exactly as to one with that many arguments.
    let logger = unsafe {
        std::mem::transmute::<
            unsafe extern "C" fn(
                fmi2ComponentEnvironment,
                fmi2String,
                fmi2Status,
                fmi2String,
                fmi2String,
                fmi2String,
            ),
            fmi2CallbackLogger,
        >(record)
    };
    fmi2CallbackFunctions {
        logger: Some(logger),
        allocateMemory: Some(counted_calloc),
        freeMemory: Some(counted_free),
        stepFinished: Some(counted_step),
        componentEnvironment: std::ptr::from_mut(log).cast(),
    }
}

fn planted(state: State, log: &mut Log) -> fmi2Component {
    let callbacks = callbacks(log);
    // SAFETY: the log outlives the instance in every test.
    let host = unsafe { Host::new("planted", Some(&callbacks)) };
    guard::instantiate(host, || Ok(Instance::planted(state)))
}

/// Calls a function with arguments that ask for nothing.
unsafe fn call(function: Function, c: fmi2Component) -> fmi2Status {
    use Function as F;
    let (mut real, mut int, mut text) = (0.0, 0, null());
    let (mut size, mut got) = (0, null_mut());
    let snapshot = Instance::for_tests().snapshot();
    let mut bytes = snapshot
        .to_bytes(guid().expect("a description"))
        .expect("bytes");
    let mut state = pointers::give_state(snapshot.into());
    // SAFETY: arrays are empty, targets are locals, states are freed below.
    unsafe {
        let status = match function {
            F::SetDebugLogging => fmi2SetDebugLogging(c, 1, 0, null()),
            F::FreeInstance => unreachable!("frees the instance"),
            F::SetupExperiment => fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0),
            F::EnterInitializationMode => fmi2EnterInitializationMode(c),
            F::ExitInitializationMode => fmi2ExitInitializationMode(c),
            F::Terminate => fmi2Terminate(c),
            F::Reset => fmi2Reset(c),
            F::GetReal => fmi2GetReal(c, null(), 0, null_mut()),
            F::GetInteger => fmi2GetInteger(c, null(), 0, null_mut()),
            F::GetBoolean => fmi2GetBoolean(c, null(), 0, null_mut()),
            F::GetString => fmi2GetString(c, null(), 0, null_mut()),
            F::SetReal => fmi2SetReal(c, null(), 0, null()),
            F::SetInteger => fmi2SetInteger(c, null(), 0, null()),
            F::SetBoolean => fmi2SetBoolean(c, null(), 0, null()),
            F::SetString => fmi2SetString(c, null(), 0, null()),
            F::GetFMUstate => fmi2GetFMUstate(c, &mut got),
            F::SetFMUstate => fmi2SetFMUstate(c, state),
            F::FreeFMUstate => fmi2FreeFMUstate(c, &mut state),
            F::SerializedFMUstateSize => fmi2SerializedFMUstateSize(c, state, &mut size),
            F::SerializeFMUstate => {
                fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr().cast(), bytes.len())
            }
            F::DeSerializeFMUstate => {
                fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), bytes.len(), &mut got)
            }
            F::GetDirectionalDerivative => {
                fmi2GetDirectionalDerivative(c, null(), 0, null(), 0, null(), null_mut())
            }
            F::SetRealInputDerivatives => fmi2SetRealInputDerivatives(c, null(), 0, null(), null()),
            F::GetRealOutputDerivatives => {
                fmi2GetRealOutputDerivatives(c, null(), 0, null(), null_mut())
            }
            F::DoStep => fmi2DoStep(c, 0.0, 1e-5, 1),
            F::CancelStep => fmi2CancelStep(c),
            F::GetStatus => fmi2GetStatus(c, 0, &mut int),
            F::GetRealStatus => fmi2GetRealStatus(c, 2, &mut real),
            F::GetIntegerStatus => fmi2GetIntegerStatus(c, 0, &mut int),
            F::GetBooleanStatus => fmi2GetBooleanStatus(c, 3, &mut int),
            F::GetStringStatus => fmi2GetStringStatus(c, 1, &mut text),
        };
        drop((pointers::take_state(state), pointers::take_state(got)));
        status
    }
}

/// Returns the status of a call that the state allows.
fn expected(function: Function) -> fmi2Status {
    use Function as F;
    match function {
        F::GetStatus | F::GetIntegerStatus | F::GetStringStatus => Status::Discard.code(),
        _ => Status::Ok.code(),
    }
}

#[test]
fn every_function_in_every_state() {
    for state in State::ALL {
        for function in Function::ALL
            .iter()
            .filter(|f| **f != Function::FreeInstance)
        {
            let mut log = Log::new();
            let c = planted(state, &mut log);
            // SAFETY: the component lives until it is freed below.
            let status = unsafe { call(*function, c) };
            // SAFETY: not used again.
            unsafe { fmi2FreeInstance(c) };
            let refused = log
                .iter()
                .any(|entry| entry.2.contains("is not allowed: the instance"));
            assert_eq!(
                refused,
                !function.allowed_in(state),
                "{function:?} in {state:?}: {log:?}"
            );
            let wanted = if refused {
                Status::Error.code()
            } else {
                expected(*function)
            };
            assert_eq!(status, wanted, "{function:?} in {state:?}: {log:?}");
            if status != Status::Ok.code() {
                let (told, category, text) = log.last().expect("a reason");
                assert_eq!(*told, status);
                assert!(category.starts_with("logStatus"), "{category}");
                assert!(text.starts_with(function.name()), "{text}");
            }
        }
    }
    assert_eq!(UNWANTED.load(Ordering::Relaxed), 0);
}

#[test]
fn null_components_are_refused() {
    for function in Function::ALL
        .iter()
        .filter(|f| **f != Function::FreeInstance)
    {
        // SAFETY: NULL is one of the allowed arguments.
        let status = unsafe { call(*function, null_mut()) };
        assert_eq!(status, Status::Error.code(), "{function:?}");
    }
    // SAFETY: NULL is one of the allowed arguments.
    unsafe { fmi2FreeInstance(null_mut()) };
}

#[test]
fn instances_may_move_between_threads() {
    fn movable<T: Send>() {}
    movable::<Instance>();
}
