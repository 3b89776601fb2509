//! Value of a data element (PS3.5 chapter 6): numbers are text or binary, depending on the value representation.

use super::tags::DicomTag;
use crate::Endian;

/// Maximum number of characters kept of a text.
const MAX_TEXT_CHARS: usize = 256;

/// Maximum number of bytes parsed as a decimal string: the representation allows 16, files have more.
const MAX_DECIMAL_BYTES: usize = 64;

/// Bytes of a value, with their byte order.
#[derive(Debug, Clone, Copy)]
pub(super) struct ElementValue<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) endian: Endian,
}

impl ElementValue<'_> {
    /// Returns the text without padding: UTF-8, or else Latin-1, as other character sets share its ASCII letters.
    pub(super) fn text(&self) -> String {
        let bytes = &self.bytes[..self.bytes.len().min(4 * MAX_TEXT_CHARS)];
        let text = match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => bytes.iter().copied().map(char::from).collect(),
        };
        text.trim_matches(|c: char| c == '\0' || c.is_whitespace()).chars().take(MAX_TEXT_CHARS).collect()
    }

    /// Parses the backslash-separated decimal strings.
    fn each_decimal(&self) -> impl Iterator<Item = Option<f64>> {
        self.bytes.split(|&byte| byte == b'\\').map(|text| {
            let text = std::str::from_utf8(text.get(..text.len().min(MAX_DECIMAL_BYTES))?).ok()?;
            let number = text.trim_matches(|c: char| c == '\0' || c.is_whitespace()).parse().ok()?;
            Some(number).filter(|number: &f64| number.is_finite())
        })
    }

    /// Parses the first decimal string.
    pub(super) fn decimal(&self) -> Option<f64> {
        self.each_decimal().next().flatten()
    }

    /// Parses the first `N` decimal strings; later ones are ignored.
    pub(super) fn decimal_array<const N: usize>(&self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        let mut found = self.each_decimal();
        for number in &mut numbers {
            *number = found.next()??;
        }
        Some(numbers)
    }

    /// Parses all decimal strings, at most `most`; empty if one is invalid.
    pub(super) fn decimals(&self, most: usize) -> Vec<f64> {
        self.each_decimal().take(most).collect::<Option<_>>().unwrap_or_default()
    }

    /// Parses a time of day, `HHMMSS.F`, in seconds.
    pub(super) fn time_s(&self) -> Option<f64> {
        let text = self.text();
        let part = |from: usize, to: usize| text.get(from..to).and_then(|digits| digits.parse::<f64>().ok());
        let seconds = text.get(4..).and_then(|digits| digits.parse::<f64>().ok()).unwrap_or(0.0);
        Some(part(0, 2)? * 3600.0 + part(2, 4).unwrap_or(0.0) * 60.0 + seconds)
    }

    fn first_bytes<const N: usize>(&self) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = self.bytes.get(..N)?.try_into().ok()?;
        if self.endian == Endian::Big {
            bytes.reverse();
        }
        Some(bytes)
    }

    /// Returns the first 16-bit integer.
    pub(super) fn u16(&self) -> Option<u16> {
        self.first_bytes().map(u16::from_le_bytes)
    }

    /// Returns the first 32-bit integer.
    pub(super) fn u32(&self) -> Option<u32> {
        self.first_bytes().map(u32::from_le_bytes)
    }

    /// Returns the first `N` 16-bit integers; later ones are ignored.
    pub(super) fn u16_array<const N: usize>(&self) -> Option<[u16; N]> {
        let mut numbers = [0; N];
        for (number, bytes) in numbers.iter_mut().zip(self.bytes.get(..2 * N)?.as_chunks::<2>().0) {
            *number = ElementValue { bytes, ..*self }.u16()?;
        }
        Some(numbers)
    }

    /// Returns the tag that the value refers to.
    pub(super) fn tag(&self) -> Option<DicomTag> {
        let [group, element] = self.u16_array()?;
        Some(DicomTag::from(group) << 16 | DicomTag::from(element))
    }

    /// Returns the first `N` 64-bit floats; later ones are ignored.
    pub(super) fn f64_array<const N: usize>(&self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (number, bytes) in numbers.iter_mut().zip(self.bytes.get(..8 * N)?.as_chunks::<8>().0) {
            *number = ElementValue { bytes, ..*self }.f64()?;
        }
        Some(numbers)
    }

    /// Returns the first 64-bit float, if it is finite.
    pub(super) fn f64(&self) -> Option<f64> {
        self.first_bytes().map(f64::from_le_bytes).filter(|number| number.is_finite())
    }

    /// Returns the first 32-bit float, if it is finite.
    pub(super) fn f32(&self) -> Option<f32> {
        self.first_bytes().map(f32::from_le_bytes).filter(|number| number.is_finite())
    }

    /// Returns 64-bit integers, at most `most`.
    pub(super) fn u64s(&self, most: usize) -> Vec<u64> {
        let each = self.bytes.chunks_exact(8).take(most);
        each.filter_map(|bytes| ElementValue { bytes, ..*self }.first_bytes().map(u64::from_le_bytes))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(bytes: &[u8]) -> ElementValue<'_> {
        ElementValue { bytes, endian: Endian::Little }
    }

    #[test]
    fn numbers_in_text_are_read_and_nothing_else() {
        assert_eq!(value(b" -1.5e2 \\2\\+3 ").decimal_array(), Some([-150.0, 2.0, 3.0]));
        assert_eq!(value(b"1\\2\0").decimal_array::<2>(), Some([1.0, 2.0]));
        for bytes in [&b"1"[..], b"1\\", b"1\\x", b"1\\inf", b"1\\nan", b"", b"\xff\\1"] {
            assert_eq!(value(bytes).decimal_array::<2>(), None, "{bytes:?}");
        }
        assert_eq!(value(b"1\\2\\x").decimals(9), Vec::<f64>::new());
        assert_eq!(value(b"013015.5").time_s(), Some(5415.5));
        assert_eq!(value(b"01").time_s(), Some(3600.0));
        assert_eq!(value(b"\xc3\xa91:02").time_s(), None);
    }

    #[test]
    fn text_is_cut_and_of_any_alphabet() {
        assert_eq!(value(b" T1 \0").text(), "T1");
        assert_eq!(value(b"Sch\xe4del").text(), "Schädel");
        assert_eq!(value("Schädel".as_bytes()).text(), "Schädel");
        assert_eq!(value(&[b'x'; 9999]).text().len(), MAX_TEXT_CHARS);
    }

    #[test]
    fn binary_numbers_have_an_order() {
        let big = ElementValue { bytes: &[0, 0, 1, 2], endian: Endian::Big };
        assert_eq!((big.u16(), big.u32(), big.f64()), (Some(0), Some(258), None));
        assert_eq!(value(&[1, 2, 0, 0]).u32(), Some(513));
        assert_eq!((big.u16_array(), big.u16_array::<3>(), big.tag()), (Some([0, 258]), None, Some(258)));
        assert_eq!(value(&[0x18, 0, 0x63, 0x10]).tag(), Some(0x0018_1063));
        let doubles = [1.5f64, -2.0].map(f64::to_le_bytes).concat();
        assert_eq!(
            (value(&doubles).f64_array(), value(&doubles).f64_array::<3>()),
            (Some([1.5, -2.0]), None)
        );
    }
}
