//! What the fuzzer calls with the bytes of a serialised state, through the C boundary.
//!
//! Shared by the fuzz target and by a test of the boundary.

use CoilWinding::exports::{
    fmi2DeSerializeFMUstate, fmi2DoStep, fmi2EnterInitializationMode, fmi2ExitInitializationMode,
    fmi2FreeFMUstate, fmi2FreeInstance, fmi2Instantiate, fmi2SetFMUstate, fmi2SetupExperiment,
};
use CoilWinding::ffi::Status;
use coilwind_model_description::guid;
use std::ffi::CString;
use std::ptr::null_mut;

/// Either the bytes are refused and the instance goes on, or they make a state that can be set
/// and stepped from. Whatever happens, nothing is fatal.
pub fn deserialize(bytes: &[u8]) {
    let guid = CString::new(guid().expect("a description")).expect("no NUL");
    let (ok, error) = (Status::Ok.code(), Status::Error.code());
    // SAFETY: all strings and pointers live until the last call; the instance is used here only.
    unsafe {
        let c = fmi2Instantiate(
            c"fuzzed".as_ptr(),
            1,
            guid.as_ptr(),
            std::ptr::null(),
            std::ptr::null(),
            0,
            0,
        );
        assert!(!c.is_null());
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), ok);
        assert_eq!(fmi2EnterInitializationMode(c), ok);
        assert_eq!(fmi2ExitInitializationMode(c), ok);
        let mut state = null_mut();
        let status = fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), bytes.len(), &mut state);
        if status == ok {
            assert!(!state.is_null());
            assert_eq!(fmi2SetFMUstate(c, state), ok);
            assert_eq!(fmi2FreeFMUstate(c, &mut state), ok);
            assert!(state.is_null());
        } else {
            assert_eq!(status, error);
            assert!(state.is_null());
            assert_eq!(fmi2DoStep(c, 0.0, 1e-5, 1), ok);
        }
        fmi2FreeInstance(c);
    }
}
