//! The four types of FMI variables as Rust types.

use coilwind::variables::{Kind, Value};

/// A type that variables can have.
pub(crate) trait Scalar: Sized {
    /// Its name in the table.
    const KIND: Kind;
    /// The value as this type; `None` if it is of another.
    fn from_value(value: Value) -> Option<Self>;
    /// The other way round.
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
