//! Platform, version, logging, and the calls that move an instance from state to state.

use crate::ffi::{
    fmi2Boolean, fmi2CallbackFunctions, fmi2Component, fmi2Real, fmi2Status, fmi2String, fmi2Type,
};
use crate::guard;
use crate::instance::Instance;
use crate::lifecycle::Function;
use crate::pointers;
use libc::size_t;

/// `fmi2GetTypesPlatform`: the platform that the C types are for, always `default`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
    c"default".as_ptr()
}

/// `fmi2GetVersion`: the version of the standard, always `2.0`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> fmi2String {
    c"2.0".as_ptr()
}

/// `fmi2SetDebugLogging`: switches categories of messages on or off, all of them where
/// `nCategories` is 0.
///
/// Errors pass in any case. A category that is not declared is an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: size_t,
    categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: the importer hands over `nCategories` strings.
    unsafe {
        guard::call(c, Function::SetDebugLogging, |instance| {
            let names = pointers::strings("categories", categories, nCategories)?;
            instance.set_debug_logging(loggingOn != 0, &names)
        })
    }
}

/// `fmi2Instantiate`: returns a new instance, or NULL and a message.
///
/// The name must not be empty, the type must be co-simulation, and the GUID must be that of this
/// library. Resources that cannot be found are no error: scenes then come from this library or
/// from paths.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: fmi2String,
    fmuType: fmi2Type,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: strings end with a NUL, callbacks stay callable until the instance is freed.
    unsafe {
        guard::instantiate(pointers::host(instanceName, functions), || {
            let name = pointers::string("instanceName", instanceName)?;
            let guid = pointers::string("fmuGUID", fmuGUID)?;
            let location = pointers::string("fmuResourceLocation", fmuResourceLocation).ok();
            Instance::new(&name, fmuType, &guid, location.as_deref(), loggingOn != 0)
        })
    }
}

/// `fmi2FreeInstance`: frees an instance in any state. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    // SAFETY: the importer does not use the component again.
    unsafe { guard::free(c) }
}

/// `fmi2SetupExperiment`: sets the start time and, if defined, the stop time, in s.
///
/// The tolerance is relative to the default experiment's: with that one the solver keeps the scene's `solver.tolerance`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    toleranceDefined: fmi2Boolean,
    tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(c, Function::SetupExperiment, |instance| {
            instance.setup_experiment(
                (toleranceDefined != 0).then_some(tolerance),
                startTime,
                (stopTimeDefined != 0).then_some(stopTime),
            )
        })
    }
}

/// `fmi2EnterInitializationMode`: from here on start values can be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(
            c,
            Function::EnterInitializationMode,
            Instance::enter_initialization_mode,
        )
    }
}

/// `fmi2ExitInitializationMode`: builds the scene. From here on steps can be made.
///
/// A scene that is not valid is an error, after which parameters can still be changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(
            c,
            Function::ExitInitializationMode,
            Instance::exit_initialization_mode,
        )
    }
}

/// `fmi2Terminate`: ends the run. Values can still be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe { guard::call(c, Function::Terminate, Instance::terminate) }
}

/// `fmi2Reset`: goes back to the state after `fmi2Instantiate`, also after a failed step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe { guard::call(c, Function::Reset, Instance::reset) }
}
