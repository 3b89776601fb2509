//! Types of elements and their fill values, in the names of both versions.

use serde_json::Value;

use super::{Endian, FileNumberType};

/// Type of an element, with its byte order where the type states one.
pub(super) struct ElementType {
    pub(super) number: FileNumberType,
    pub(super) endian: Option<Endian>,
}

impl ElementType {
    /// Parses a type code of NumPy, as version 2 has it.
    pub(super) fn parse_numpy(code: &str) -> Option<Self> {
        let (endian, name) = match code.split_at_checked(1)? {
            (">", name) => (Some(Endian::Big), name),
            ("<", name) => (Some(Endian::Little), name),
            ("|", name) => (None, name),
            _ => return None,
        };
        let number = match name {
            "b1" | "u1" => FileNumberType::U8,
            "i1" => FileNumberType::I8,
            "u2" => FileNumberType::U16,
            "i2" => FileNumberType::I16,
            "u4" => FileNumberType::U32,
            "i4" => FileNumberType::I32,
            "u8" => FileNumberType::U64,
            "i8" => FileNumberType::I64,
            "f2" => FileNumberType::F16,
            "f4" => FileNumberType::F32,
            "f8" => FileNumberType::F64,
            _ => return None,
        };
        Some(Self { number, endian })
    }

    /// Parses a name of version 3.
    pub(super) fn parse_name(name: &str) -> Option<Self> {
        let code = match name {
            "bool" | "uint8" => "|u1",
            "int8" => "|i1",
            "uint16" => "<u2",
            "int16" => "<i2",
            "uint32" => "<u4",
            "int32" => "<i4",
            "uint64" => "<u8",
            "int64" => "<i8",
            "float16" => "<f2",
            "float32" => "<f4",
            "float64" => "<f8",
            _ => return None,
        };
        Self::parse_numpy(code).map(|parsed| Self { endian: None, ..parsed })
    }
}

/// Names of the supported types, for messages.
pub(super) const SUPPORTED_TYPES: &str = "whole numbers of 8 to 64 bits, float16, float32 and float64";

/// Encodes a fill value as one element; `None` where it is no number of the type. Without a value it is 0.
pub(super) fn encode_fill(value: &Value, number: FileNumberType, endian: Endian) -> Option<Vec<u8>> {
    if let Some(bits) = value.as_str().and_then(|text| text.strip_prefix("0x")) {
        // Floats of version 3 by their bits.
        let bits = u64::from_str_radix(bits, 16).ok()?;
        return Some(ordered(&bits.to_le_bytes()[..number.bytes()], endian));
    }
    let real = match value {
        Value::Null => 0.0,
        Value::Bool(is_set) => f64::from(u8::from(*is_set)),
        Value::Number(value) => value.as_f64()?,
        Value::String(text) => match text.as_str() {
            "NaN" => f64::NAN,
            "Infinity" => f64::INFINITY,
            "-Infinity" => f64::NEG_INFINITY,
            _ => return None,
        },
        _ => return None,
    };
    // Whole numbers of 64 bits exceed the precision of floats.
    let whole = value.as_i64().or_else(|| value.as_u64().map(u64::cast_signed)).unwrap_or(real as i64);
    let bytes = match number {
        FileNumberType::F16 => half::f16::from_f64(real).to_le_bytes().to_vec(),
        FileNumberType::F32 => (real as f32).to_le_bytes().to_vec(),
        FileNumberType::F64 => real.to_le_bytes().to_vec(),
        _ => whole.to_le_bytes()[..number.bytes()].to_vec(),
    };
    Some(ordered(&bytes, endian))
}

/// Returns little-endian bytes in a byte order.
fn ordered(bytes: &[u8], endian: Endian) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if endian == Endian::Big {
        bytes.reverse();
    }
    bytes
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn fill_values_are_elements() {
        let fill = |value: Value, number| encode_fill(&value, number, Endian::Little);
        assert_eq!(fill(json!(null), FileNumberType::U16), Some(vec![0, 0]));
        assert_eq!(fill(json!(258), FileNumberType::U16), Some(vec![2, 1]));
        assert_eq!(encode_fill(&json!(258), FileNumberType::U16, Endian::Big), Some(vec![1, 2]));
        assert_eq!(fill(json!(-1), FileNumberType::I8), Some(vec![255]));
        assert_eq!(fill(json!(u64::MAX), FileNumberType::U64), Some(vec![255; 8]));
        assert_eq!(fill(json!(true), FileNumberType::U8), Some(vec![1]));
        assert_eq!(fill(json!(1.5), FileNumberType::F32), Some(1.5f32.to_le_bytes().to_vec()));
        assert_eq!(
            fill(json!("0x7fc00000"), FileNumberType::F32),
            Some(0x7fc0_0000u32.to_le_bytes().to_vec())
        );
        assert!(
            f64::from_le_bytes(fill(json!("NaN"), FileNumberType::F64).unwrap().try_into().unwrap()).is_nan()
        );
        assert_eq!(fill(json!("x"), FileNumberType::U8), None);
        assert_eq!(fill(json!([0]), FileNumberType::U8), None);
    }
}
