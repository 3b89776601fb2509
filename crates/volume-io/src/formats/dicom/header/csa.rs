//! CSA header, which Siemens scanners store in a private element (0029,1010): named values as text, after
//! <https://nipy.org/nibabel/dicom/siemens_csa.html>.

/// Magic bytes of the newer of its two layouts (CSA2).
const CSA2_MAGIC: &[u8] = b"SV10";

/// Size of the head of a named value: name (64 bytes), then multiplicity, representation, type, number of items, and
/// a mark, of four bytes each.
const HEAD_BYTES: usize = 84;

/// Size of the head of an item: four numbers, one of which is the item's length.
const ITEM_HEAD_BYTES: usize = 16;

/// Maximum number of named values examined: files have about a hundred.
const MAX_VALUES: usize = 1024;

/// Maximum number of items of a value examined: lists of slice times have one for each of some hundred slices.
const MAX_ITEMS: usize = 4096;

/// Returns the first `N` numbers of a named value; `None` if it has fewer, or if the header is corrupt before it.
pub(crate) fn csa_numbers<const N: usize>(header: &[u8], name: &str) -> Option<[f64; N]> {
    let is_csa2 = header.starts_with(CSA2_MAGIC);
    // The newer layout has four more bytes behind its magic; in both, the number of values and a mark of four bytes
    // follow.
    let mut at = if is_csa2 { 8 } else { 0 };
    let count = usize::try_from(u32_at(header, at)?).ok()?.min(MAX_VALUES);
    at += 8;
    // In the older layout, lengths of items are offset by the first value's number of items.
    let mut first_items = None;
    for _ in 0..count {
        let head = header.get(at..at + HEAD_BYTES)?;
        let items = u32_at(head, 76)? as usize;
        let base = *first_items.get_or_insert(items);
        at += HEAD_BYTES;
        let is_requested = head[..64].split(|&byte| byte == 0).next() == Some(name.as_bytes());
        let mut found = [None; N];
        for item in 0..items.min(MAX_ITEMS) {
            let length = if is_csa2 {
                u32_at(header, at + 4)? as usize
            } else {
                (u32_at(header, at)? as usize).checked_sub(base)?
            };
            at += ITEM_HEAD_BYTES;
            let value = header.get(at..at.checked_add(length)?)?;
            if let (true, Some(number)) = (is_requested, found.get_mut(item)) {
                let text = value.split(|&byte| byte == 0).next().unwrap_or_default();
                let text = std::str::from_utf8(text).ok()?.trim();
                *number = text.parse::<f64>().ok().filter(|number| number.is_finite());
            }
            at += length.next_multiple_of(4);
        }
        if is_requested {
            let mut numbers = [0.0; N];
            for (number, found) in numbers.iter_mut().zip(found) {
                *number = found?;
            }
            return Some(numbers);
        }
    }
    None
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|&word| u32::from_le_bytes(word))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Returns a header of the newer layout with these named values.
    pub(crate) fn header(values: &[(&str, &[&str])]) -> Vec<u8> {
        let mut bytes =
            [CSA2_MAGIC, &[4, 3, 2, 1], &(values.len() as u32).to_le_bytes(), &77u32.to_le_bytes()].concat();
        for (name, items) in values {
            let mut head = vec![0; HEAD_BYTES];
            head[..name.len()].copy_from_slice(name.as_bytes());
            head[76..80].copy_from_slice(&(items.len() as u32).to_le_bytes());
            bytes.extend(head);
            for item in *items {
                let length = item.len() as u32 + 1;
                bytes.extend([length, length, 77, length].into_iter().flat_map(u32::to_le_bytes));
                bytes.extend(item.as_bytes());
                bytes.resize(bytes.len() + length.next_multiple_of(4) as usize - item.len(), 0);
            }
        }
        bytes
    }

    #[test]
    fn named_values_are_found() {
        let header =
            header(&[("EchoLinePosition", &["64"]), ("SliceNormalVector", &["0.0", "-0.5", "0.75"])]);
        assert_eq!(csa_numbers(&header, "SliceNormalVector"), Some([0.0, -0.5, 0.75]));
        assert_eq!(csa_numbers(&header, "EchoLinePosition"), Some([64.0]));
        assert_eq!(csa_numbers::<1>(&header, "Echo"), None);
        assert_eq!(csa_numbers::<4>(&header, "SliceNormalVector"), None, "it has but three");
        for length in 0..header.len() {
            assert_eq!(csa_numbers::<1>(&header[..length], "Nothing"), None);
        }
        for at in 0..header.len() {
            let mut broken = header.clone();
            broken[at] = 0xff;
            let _either = csa_numbers::<3>(&broken, "SliceNormalVector");
        }
    }
}
