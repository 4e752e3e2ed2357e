//! Saved states, in memory and as bytes.

use crate::error::Error;
use crate::ffi::{fmi2Byte, fmi2Component, fmi2FMUstate, fmi2Status};
use crate::guard;
use crate::lifecycle::Function;
use crate::pointers;
use libc::size_t;

/// Returns the saved state behind the importer's pointer.
///
/// # Safety
///
/// As for [`pointers::state`].
unsafe fn saved<'a>(state: fmi2FMUstate) -> Result<&'a mut pointers::Saved, Error> {
    let argument = "FMUstate";
    // SAFETY: passed on to the caller.
    unsafe { pointers::state(state) }.ok_or(Error::Null { argument })
}

/// `fmi2GetFMUstate`: copies everything that decides how the instance goes on.
///
/// The copy replaces the state that the importer's pointer leads to, if there is one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(
    c: fmi2Component,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the importer's pointer is NULL or points to NULL or a state.
    unsafe {
        guard::call(c, Function::GetFMUstate, |instance| {
            let target = pointers::target("FMUstate", FMUstate)?;
            pointers::put_state(target, instance.snapshot().into());
            Ok(())
        })
    }
}

/// `fmi2SetFMUstate`: goes back to a saved state, from any state but the lost one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: the importer's state is NULL or one of this library.
    unsafe {
        guard::call(c, Function::SetFMUstate, |instance| {
            instance.restore(&saved(FMUstate)?.snapshot);
            Ok(())
        })
    }
}

/// `fmi2FreeFMUstate`: frees a state and sets the importer's pointer to NULL.
///
/// NULL and a pointer to NULL are allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(
    c: fmi2Component,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the importer's pointer is NULL or points to NULL or a state, which nobody uses again.
    unsafe {
        guard::call(c, Function::FreeFMUstate, |_| {
            if let Some(state) = FMUstate.as_mut() {
                drop(pointers::take_state(std::mem::replace(
                    state,
                    std::ptr::null_mut(),
                )));
            }
            Ok(())
        })
    }
}

/// `fmi2SerializedFMUstateSize`: returns how many bytes a state takes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut size_t,
) -> fmi2Status {
    // SAFETY: the importer's state is NULL or one of this library, its pointer NULL or with room.
    unsafe {
        guard::call(c, Function::SerializedFMUstateSize, |instance| {
            let (saved, size) = (saved(FMUstate)?, pointers::target("size", size)?);
            let bytes = instance.bytes_of(&saved.snapshot)?;
            *size = bytes.len();
            saved.bytes = Some(bytes);
            Ok(())
        })
    }
}

/// `fmi2SerializeFMUstate`: writes the bytes of a state, then zeros to the end of the buffer.
///
/// A buffer of less than the size of the state is an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: size_t,
) -> fmi2Status {
    // SAFETY: the importer's state is NULL or one of this library, its array holds `size` bytes.
    unsafe {
        guard::call(c, Function::SerializeFMUstate, |instance| {
            let saved = saved(FMUstate)?;
            let bytes = match saved.bytes.take() {
                Some(bytes) => bytes,
                None => instance.bytes_of(&saved.snapshot)?,
            };
            let needed = bytes.len();
            if size < needed {
                return Err(Error::Buffer { size, needed });
            }
            let buffer = pointers::slice_mut("serializedState", serializedState.cast(), size)?;
            buffer[..needed].copy_from_slice(&bytes);
            buffer[needed..].fill(0);
            Ok(())
        })
    }
}

/// `fmi2DeSerializeFMUstate`: makes a state from bytes that any instance of this FMU wrote, also in
/// another process.
///
/// The bytes are checked. The importer's pointer stays as it is if they are not a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: size_t,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the importer's array holds `size` bytes, its pointer is NULL or points to NULL or a state.
    unsafe {
        guard::call(c, Function::DeSerializeFMUstate, |instance| {
            let target = pointers::target("FMUstate", FMUstate)?;
            let bytes = pointers::slice("serializedState", serializedState.cast(), size)?;
            pointers::put_state(target, instance.snapshot_from(bytes)?.into());
            Ok(())
        })
    }
}
