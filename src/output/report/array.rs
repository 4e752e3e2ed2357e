//! Numbers for the page: little-endian bytes in base64, after the name of their type.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Serialize, Serializer};

/// An array as the page has it.
#[derive(Debug)]
pub(super) enum Array {
    /// measures: seven digits are more than a picture shows
    F32(Vec<f32>),
    /// indices
    U32(Vec<u32>),
    /// sums of codes
    U16(Vec<u16>),
    /// small numbers
    U8(Vec<u8>),
}

impl Array {
    /// Numbers of any size as 32-bit floats.
    pub(super) fn reals(values: impl IntoIterator<Item = f64>) -> Self {
        Self::F32(values.into_iter().map(|value| value as f32).collect())
    }

    /// Whole numbers from 0 to 65535, whose bits have meanings.
    pub(super) fn codes(values: impl IntoIterator<Item = f64>) -> Self {
        Self::U16(values.into_iter().map(|value| value as u16).collect())
    }

    /// Whole numbers from 0 to 255; larger ones become 255.
    pub(super) fn bytes(values: impl IntoIterator<Item = f64>) -> Self {
        Self::U8(values.into_iter().map(|value| value as u8).collect())
    }
}

impl Serialize for Array {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (kind, bytes) = match self {
            Self::F32(values) => ("f32", values.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Self::U32(values) => ("u32", values.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Self::U16(values) => ("u16", values.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Self::U8(values) => ("u8", values.clone()),
        };
        let bytes: Vec<u8> = bytes;
        serializer.serialize_str(&format!("{kind}:{}", STANDARD.encode(bytes)))
    }
}
