//! Natural sort order of names: `slice 9` before `slice 10`.

/// Piece of a name, ordered so that numbers sort by value.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub enum NameSegment {
    /// Digits without leading zeros, preceded by their count, so that shorter numbers sort first; then the count with
    /// zeros.
    Number(usize, String, usize),
    Text(String),
}

/// Returns the key that sorts names in natural order, ignoring case.
pub fn natural_sort_key(name: &str) -> Vec<NameSegment> {
    let mut pieces = Vec::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let is_number = first.is_ascii_digit();
        let end = rest.find(|c: char| c.is_ascii_digit() != is_number).unwrap_or(rest.len());
        let (piece, after) = rest.split_at(end);
        pieces.push(if is_number {
            let digits = piece.trim_start_matches('0');
            NameSegment::Number(digits.len(), digits.to_owned(), piece.len())
        } else {
            NameSegment::Text(piece.to_lowercase())
        });
        rest = after;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_the_order_of_their_values() {
        let mut names = [
            "b1",
            "a10",
            "a9",
            "A2.tif",
            "a010",
            "a",
            "2",
            "10",
            "x99999999999999999999",
            "x100000000000000000000",
        ];
        names.sort_by_cached_key(|name| natural_sort_key(name));
        let expected = [
            "2",
            "10",
            "a",
            "A2.tif",
            "a9",
            "a10",
            "a010",
            "b1",
            "x99999999999999999999",
            "x100000000000000000000",
        ];
        assert_eq!(names, expected);
    }
}
