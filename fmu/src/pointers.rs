//! All work with the importer's pointers. Nothing here keeps one beyond its call.
//!
//! Instances and saved states are boxes that the importer holds as opaque pointers and gives back
//! to be freed. No other memory crosses the boundary.

use crate::error::Error;
use crate::ffi::{fmi2CallbackFunctions, fmi2Component, fmi2FMUstate, fmi2String};
use crate::instance::Instance;
use crate::logger::Host;
use crate::state::Snapshot;
use std::ffi::CStr;

/// What an `fmi2Component` points to.
pub(crate) struct Component {
    pub(crate) instance: Instance,
    pub(crate) host: Host,
}

/// What an `fmi2FMUstate` points to.
pub(crate) struct Saved {
    pub(crate) snapshot: Snapshot,
    /// The bytes of the snapshot, kept between `fmi2SerializedFMUstateSize` and
    /// `fmi2SerializeFMUstate` so that they are made once.
    pub(crate) bytes: Option<Vec<u8>>,
}

impl From<Snapshot> for Saved {
    fn from(snapshot: Snapshot) -> Self {
        Self {
            snapshot,
            bytes: None,
        }
    }
}

/// Turns an instance into a handle for the importer. [`take`] is the inverse.
pub(crate) fn give(component: Component) -> fmi2Component {
    Box::into_raw(Box::new(component)).cast()
}

/// Returns the instance behind a handle, or `None` for NULL.
///
/// # Safety
///
/// `c` is NULL or came from [`give`] and was not taken back, and the importer makes no second
/// call on it while the borrow lives. FMI 2.0.5, section 2.1.5, demands that calls on one instance
/// are made one after the other.
pub(crate) unsafe fn component<'a>(c: fmi2Component) -> Option<&'a mut Component> {
    // SAFETY: a pointer from `give` is aligned, initialised and, by the contract above, unshared.
    unsafe { c.cast::<Component>().as_mut() }
}

/// Takes an instance back from the importer, or returns `None` for NULL.
///
/// # Safety
///
/// As for [`component`], and the handle is not used again.
pub(crate) unsafe fn take(c: fmi2Component) -> Option<Box<Component>> {
    // SAFETY: a pointer from `give` came from `Box::into_raw` of this type.
    (!c.is_null()).then(|| unsafe { Box::from_raw(c.cast()) })
}

/// Turns a saved state into a handle for the importer. [`take_state`] is the inverse.
pub(crate) fn give_state(state: Saved) -> fmi2FMUstate {
    Box::into_raw(Box::new(state)).cast()
}

/// Returns the saved state behind a handle, or `None` for NULL.
///
/// # Safety
///
/// `state` is NULL or came from [`give_state`], was not taken back, and is used by one call at a
/// time.
pub(crate) unsafe fn state<'a>(state: fmi2FMUstate) -> Option<&'a mut Saved> {
    // SAFETY: a pointer from `give_state` is aligned, initialised and, by the contract above,
    // unshared.
    unsafe { state.cast::<Saved>().as_mut() }
}

/// Takes a saved state back from the importer, or returns `None` for NULL.
///
/// # Safety
///
/// As for [`state()`], and the handle is not used again.
pub(crate) unsafe fn take_state(state: fmi2FMUstate) -> Option<Box<Saved>> {
    // SAFETY: a pointer from `give_state` came from `Box::into_raw` of this type.
    (!state.is_null()).then(|| unsafe { Box::from_raw(state.cast()) })
}

/// Stores a state where the importer's pointer leads to: over the state that is there, or in a new
/// box if it is NULL.
///
/// # Safety
///
/// As for [`state()`] where `*target` is not NULL.
pub(crate) unsafe fn put_state(target: &mut fmi2FMUstate, saved: Saved) {
    // SAFETY: passed on to the caller.
    match unsafe { state(*target) } {
        Some(there) => *there = saved,
        None => *target = give_state(saved),
    }
}

/// Returns `n` values of the importer. With `n = 0` the pointer is not used.
///
/// # Safety
///
/// `data` is NULL or points to `n` initialised values that nobody writes while the borrow lives.
pub(crate) unsafe fn slice<'a, T>(
    argument: &'static str,
    data: *const T,
    n: usize,
) -> Result<&'a [T], Error> {
    match (n, data.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(Error::Null { argument }),
        // SAFETY: not NULL, and by the contract good for `n` values.
        (_, false) => Ok(unsafe { std::slice::from_raw_parts(data, n) }),
    }
}

/// Returns the importer's room for `n` values. With `n = 0` the pointer is not used.
///
/// # Safety
///
/// `data` is NULL or points to `n` values that nobody else touches while the borrow lives.
pub(crate) unsafe fn slice_mut<'a, T>(
    argument: &'static str,
    data: *mut T,
    n: usize,
) -> Result<&'a mut [T], Error> {
    match (n, data.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err(Error::Null { argument }),
        // SAFETY: not NULL, and by the contract good for `n` values and unshared.
        (_, false) => Ok(unsafe { std::slice::from_raw_parts_mut(data, n) }),
    }
}

/// Returns the importer's room for one value.
///
/// # Safety
///
/// As for [`slice_mut`] with `n = 1`.
pub(crate) unsafe fn target<'a, T>(
    argument: &'static str,
    data: *mut T,
) -> Result<&'a mut T, Error> {
    // SAFETY: passed on to the caller.
    unsafe { data.as_mut() }.ok_or(Error::Null { argument })
}

/// Returns a copy of a string.
///
/// # Safety
///
/// `text` is NULL or ends with a NUL.
pub(crate) unsafe fn string(argument: &'static str, text: fmi2String) -> Result<String, Error> {
    if text.is_null() {
        return Err(Error::Null { argument });
    }
    // SAFETY: not NULL, and by the contract NUL-terminated.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str()
        .map(str::to_owned)
        .map_err(|_| Error::Encoding { argument })
}

/// Returns copies of `n` strings.
///
/// # Safety
///
/// As for [`slice()`], and each element as for [`string`].
pub(crate) unsafe fn strings(
    argument: &'static str,
    data: *const fmi2String,
    n: usize,
) -> Result<Vec<String>, Error> {
    // SAFETY: passed on to the caller.
    let texts = unsafe { slice(argument, data, n) }?;
    // SAFETY: passed on to the caller.
    texts
        .iter()
        .map(|text| unsafe { string(argument, *text) })
        .collect()
}

/// Returns the importer's side of a new instance. A name that cannot be read is replaced.
///
/// # Safety
///
/// `name` as for [`string`]; `functions` is NULL or points to callbacks that stay callable until
/// the instance is freed.
pub(crate) unsafe fn host(name: fmi2String, functions: *const fmi2CallbackFunctions) -> Host {
    // SAFETY: passed on to the caller.
    let name = unsafe { string("instanceName", name) };
    // SAFETY: passed on to the caller; members are copied, the struct is not kept.
    unsafe { Host::new(name.as_deref().unwrap_or("CoilWinding"), functions.as_ref()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ptr::{null, null_mut};

    #[test]
    fn nothing_may_be_null_something_may_not() {
        // SAFETY: NULL is allowed everywhere here, the rest are live locals.
        unsafe {
            assert!(slice::<f64>("vr", null(), 0).is_ok_and(<[f64]>::is_empty));
            assert!(matches!(
                slice::<f64>("vr", null(), 1),
                Err(Error::Null { argument: "vr" })
            ));
            assert!(slice_mut::<f64>("value", null_mut(), 0).is_ok_and(|s| s.is_empty()));
            assert!(slice_mut::<f64>("value", null_mut(), 2).is_err());
            assert!(target::<f64>("value", null_mut()).is_err());
            assert!(component(null_mut()).is_none());
            assert!(take(null_mut()).is_none());
            let numbers = [1.0, 2.0];
            assert_eq!(slice("vr", numbers.as_ptr(), 2).expect("two"), [1.0, 2.0]);
        }
    }

    #[test]
    fn strings_are_copied_and_checked() {
        let bad = [b'a' as i8, -1_i8, 0].map(|byte| byte as libc::c_char);
        let good = c"Wicklung \xc3\xbc";
        let list = [good.as_ptr(), c"".as_ptr()];
        // SAFETY: all of them end with a NUL or are NULL.
        unsafe {
            assert_eq!(string("s", good.as_ptr()).expect("UTF-8"), "Wicklung ü");
            assert!(matches!(
                string("s", bad.as_ptr()),
                Err(Error::Encoding { argument: "s" })
            ));
            assert!(matches!(
                string("s", null()),
                Err(Error::Null { argument: "s" })
            ));
            assert_eq!(
                strings("s", list.as_ptr(), 2).expect("two"),
                ["Wicklung ü", ""]
            );
            assert_eq!(strings("s", null(), 0).expect("none"), Vec::<String>::new());
            assert!(strings("s", [null()].as_ptr(), 1).is_err());
        }
    }
}
