//! The four types of FMI variables as Rust types, and variables looked up by reference and type.

use crate::error::Error;
use coilwind::variables::{Kind, Value, Variable, by_reference};

/// A Rust type that holds the values of one FMI type.
pub(crate) trait Scalar: Sized {
    /// The FMI type.
    const KIND: Kind;
    /// Returns the value as this type, or `None` if it is of another type.
    fn from_value(value: Value) -> Option<Self>;
    /// Returns the value as the variable table holds it.
    fn into_value(self) -> Value;
}

macro_rules! scalar {
    ($type:ty, $kind:ident) => {
        impl Scalar for $type {
            const KIND: Kind = Kind::$kind;

            fn from_value(value: Value) -> Option<Self> {
                match value {
                    Value::$kind(value) => Some(value),
                    _ => None,
                }
            }

            fn into_value(self) -> Value {
                Value::$kind(self)
            }
        }
    };
}

scalar!(f64, Real);
scalar!(i32, Integer);
scalar!(bool, Boolean);
scalar!(String, String);

/// Returns the variable of a reference.
///
/// # Errors
///
/// [`Error::UnknownReference`] if no variable of the FMU has it, [`Error::WrongType`] if the
/// variable is not of type `T`.
pub(crate) fn find<T: Scalar>(reference: u32) -> Result<&'static Variable, Error> {
    let variable = by_reference(reference)
        .filter(|variable| !variable.native_only)
        .ok_or(Error::UnknownReference { reference })?;
    if variable.kind == T::KIND {
        Ok(variable)
    } else {
        Err(wrong_type::<T>(variable))
    }
}

/// Returns the error of a call for type `T` on a variable of another type.
pub(crate) fn wrong_type<T: Scalar>(variable: &Variable) -> Error {
    Error::WrongType {
        name: variable.name,
        declared: variable.kind.as_str(),
        asked: T::KIND.as_str(),
    }
}
