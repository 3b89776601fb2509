//! Private elements of manufacturers, whose numbers depend on the block that a creator element reserves (PS3.5 section
//! 7.8.1): mosaics and diffusion b-values.

use super::element_value::ElementValue;
use super::tags::DicomTag;

/// Private elements that are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PrivateElement {
    /// Number of slices in a mosaic of Siemens.
    SiemensMosaicCount,
    /// Diffusion b-value of Siemens, as text.
    SiemensBValue,
    /// Diffusion b-value of GE, the first of several numbers as text; some versions add 10⁹.
    GeBValue,
    /// Diffusion b-value of Philips, a 32-bit float.
    PhilipsBValue,
}

/// Group of a private element, its creator, and its number within the creator's block.
struct PrivateElementKey {
    element: PrivateElement,
    creator: &'static str,
    group: u16,
    number: u8,
}

const KEYS: [PrivateElementKey; 4] = [
    PrivateElementKey {
        element: PrivateElement::SiemensMosaicCount,
        creator: "SIEMENS MR HEADER",
        group: 0x0019,
        number: 0x0a,
    },
    PrivateElementKey {
        element: PrivateElement::SiemensBValue,
        creator: "SIEMENS MR HEADER",
        group: 0x0019,
        number: 0x0c,
    },
    PrivateElementKey {
        element: PrivateElement::GeBValue,
        creator: "GEMS_PARM_01",
        group: 0x0043,
        number: 0x39,
    },
    PrivateElementKey {
        element: PrivateElement::PhilipsBValue,
        creator: "Philips Imaging DD 001",
        group: 0x2001,
        number: 0x03,
    },
];

/// Constant that GE adds to b-values to mark them.
const GE_B_VALUE_MARK: f64 = 1e9;

/// Maximum diffusion b-value, in s/mm²: scanners reach some tens of thousands.
const MAX_B_VALUE: f64 = 1e6;

/// Blocks of elements that creators have reserved in a data set.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PrivateBlocks([Option<u8>; KEYS.len()]);

impl PrivateBlocks {
    /// Returns true if an element may be one of those in use, or the creator of their block.
    pub(super) fn uses(tag: DicomTag) -> bool {
        let (group, [high, low]) = split(tag);
        KEYS.iter().any(|key| key.group == group && (high == 0 && low >= 0x10 || low == key.number))
    }

    /// Records a creator element, which reserves the block of its number.
    pub(super) fn record_creator(&mut self, tag: DicomTag, value: ElementValue<'_>) {
        let (group, [high, block]) = split(tag);
        if high != 0 || block < 0x10 {
            return;
        }
        for (key, reserved) in KEYS.iter().zip(&mut self.0) {
            if key.group == group && value.text() == key.creator {
                *reserved = Some(block);
            }
        }
    }

    /// Returns the private element that a tag stands for.
    pub(super) fn element(self, tag: DicomTag) -> Option<PrivateElement> {
        let (group, [block, number]) = split(tag);
        let mut known = KEYS.iter().zip(self.0);
        let found = known
            .find(|(key, reserved)| key.group == group && key.number == number && *reserved == Some(block));
        found.map(|(key, _)| key.element)
    }
}

/// Group of a tag, and both bytes of its element number.
fn split(tag: DicomTag) -> (u16, [u8; 2]) {
    ((tag >> 16) as u16, (tag as u16).to_be_bytes())
}

/// Diffusion b-value in s/mm² that a private element states.
pub(super) fn b_value(element: PrivateElement, value: ElementValue<'_>) -> Option<f64> {
    let found = match element {
        PrivateElement::SiemensBValue => return value.decimal(),
        PrivateElement::GeBValue => {
            value.decimal().map(|b| if b >= GE_B_VALUE_MARK { b - GE_B_VALUE_MARK } else { b })
        }
        PrivateElement::PhilipsBValue => value.f32().map(f64::from),
        PrivateElement::SiemensMosaicCount => None,
    };
    found.filter(|b| (0.0..=MAX_B_VALUE).contains(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Endian;

    fn value(bytes: &[u8]) -> ElementValue<'_> {
        ElementValue { bytes, endian: Endian::Little }
    }

    #[test]
    fn blocks_are_those_that_creators_reserve() {
        let mut blocks = PrivateBlocks::default();
        blocks.record_creator(0x0043_0012, value(b"GEMS_PARM_01"));
        blocks.record_creator(0x0043_0010, value(b"OTHER"));
        blocks.record_creator(0x2001_0003, value(b"Philips Imaging DD 001"));
        assert_eq!(blocks.element(0x0043_1239), Some(PrivateElement::GeBValue));
        for tag in [0x0043_1039, 0x0043_1238, 0x2001_0303, 0x2001_1003, 0x0019_1239] {
            assert_eq!(blocks.element(tag), None, "{tag:x}");
        }
        assert!(PrivateBlocks::uses(0x0043_0012) && PrivateBlocks::uses(0x2001_1003));
        assert!(!PrivateBlocks::uses(0x0043_1038) && !PrivateBlocks::uses(0x0045_0010));
    }

    #[test]
    fn b_values_are_cleaned() {
        let ge = |text: &str| b_value(PrivateElement::GeBValue, value(text.as_bytes()));
        assert_eq!(ge("1000\\8\\0\\0"), Some(1000.0));
        assert_eq!(ge("1000000050\\8\\0\\0 "), Some(50.0));
        assert_eq!(ge("1000000000"), Some(0.0));
        assert_eq!((ge("-1"), ge("5000000000"), ge("x")), (None, None, None));
        let philips = |number: f32| b_value(PrivateElement::PhilipsBValue, value(&number.to_le_bytes()));
        assert_eq!((philips(800.0), philips(f32::NAN), philips(-1.0)), (Some(800.0), None, None));
        assert_eq!(b_value(PrivateElement::PhilipsBValue, value(b"8")), None);
    }
}
