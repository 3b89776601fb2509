//! Which files of a folder are the slices of one volume, by their names.

use std::collections::HashMap;
use std::path::Path;

use super::picture::Kind;

/// Files that are slices of one volume, by their numbers in the list of all.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Group {
    /// What their names have in common, with `#` where they count.
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) files: Vec<usize>,
    /// What is missing in their numbers.
    pub(super) gap: Option<String>,
}

/// A name in pieces: text, and digits between.
struct Pieces {
    texts: Vec<String>,
    digits: Vec<String>,
}

impl Pieces {
    fn of(path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let (mut texts, mut digits) = (vec![String::new()], Vec::new());
        let mut was_digit = false;
        for c in name.chars() {
            let is_digit = c.is_ascii_digit();
            if is_digit && !was_digit {
                digits.push(String::new());
                texts.push(String::new());
            }
            let piece = if is_digit { digits.last_mut() } else { texts.last_mut() };
            if let Some(piece) = piece {
                piece.push(c);
            }
            was_digit = is_digit;
        }
        Self { texts, digits }
    }

    /// The name with `#` in place of some of its digits.
    fn name(&self, is_counted: impl Fn(usize) -> bool) -> String {
        let mut name = self.texts.first().cloned().unwrap_or_default();
        for (at, (digits, text)) in self.digits.iter().zip(self.texts.iter().skip(1)).enumerate() {
            name.push_str(if is_counted(at) { "#" } else { digits });
            name.push_str(text);
        }
        name
    }
}

/// Sorts pictures, in natural order, into groups: those whose names differ in the last number that counts.
pub(super) fn groups<'a>(files: impl IntoIterator<Item = (&'a Path, Kind)>) -> Vec<Group> {
    let files: Vec<(Pieces, Kind)> = files.into_iter().map(|(path, kind)| (Pieces::of(path), kind)).collect();
    let alike = gathered((0..files.len()).map(|at| {
        let (pieces, kind) = &files[at];
        ((*kind, pieces.name(|_| true)), at)
    }));
    let mut groups = Vec::new();
    for ((kind, _), members) in alike {
        let digits = |member: usize| &files[member].0.digits;
        let columns = members.first().map_or(0, |&member| digits(member).len());
        let varies =
            |column: usize| members.windows(2).any(|pair| digits(pair[0])[column] != digits(pair[1])[column]);
        let varying: Vec<usize> = (0..columns).filter(|&column| varies(column)).collect();
        let Some((&counted, others)) = varying.split_last() else {
            let name = members.first().map_or(String::new(), |&member| files[member].0.name(|_| false));
            groups.push(Group { name, kind, files: members, gap: None });
            continue;
        };
        let parts = gathered(members.iter().map(|&member| {
            let key: Vec<&str> = others.iter().map(|&column| digits(member)[column].as_str()).collect();
            (key, member)
        }));
        // Numbers that go on together, as a count and the time of day, count together.
        let parts = if parts.iter().all(|(_, part)| part.len() > 1) {
            parts.into_iter().map(|(_, part)| (vec![counted], part)).collect()
        } else {
            vec![(varying.clone(), members)]
        };
        for (counts, part) in parts {
            let name = files[part[0]].0.name(|column| counts.contains(&column));
            let numbers = part.iter().map(|&member| digits(member)[counted].parse().ok());
            let gap = if counts.len() == 1 { gap(&numbers.collect::<Vec<_>>()) } else { None };
            groups.push(Group { name, kind, files: part, gap });
        }
    }
    groups
}

/// Things with the same key together, in the order in which keys come first.
fn gathered<K: Clone + Eq + std::hash::Hash>(
    things: impl IntoIterator<Item = (K, usize)>,
) -> Vec<(K, Vec<usize>)> {
    let mut places: HashMap<K, usize> = HashMap::new();
    let mut groups: Vec<(K, Vec<usize>)> = Vec::new();
    for (key, thing) in things {
        let place = *places.entry(key.clone()).or_insert(groups.len());
        if place == groups.len() {
            groups.push((key, Vec::new()));
        }
        groups[place].1.push(thing);
    }
    groups
}

/// What is missing in numbers that go on by equal steps.
fn gap(numbers: &[Option<u64>]) -> Option<String> {
    let steps = numbers.windows(2).filter_map(|pair| {
        let (before, after) = (pair[0]?, pair[1]?);
        Some((before, after, after.checked_sub(before)?))
    });
    let usual = steps.clone().map(|(_, _, step)| step).filter(|&step| step > 0).min()?;
    let mut wide = steps.filter(|&(_, _, step)| step > usual);
    let (before, after, _) = wide.next()?;
    let more = match wide.count() {
        0 => String::new(),
        more => format!(", and at {more} more places"),
    };
    Some(format!(
        "slices are missing between numbers {before} and {after}{more}: the others are stacked as if they were not"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grouped(names: &[&str]) -> Vec<(String, Vec<usize>, bool)> {
        let kind = |name: &str| if name.ends_with("jpg") { Kind::Jpeg } else { Kind::Png };
        let groups = groups(names.iter().map(|name| (Path::new(*name), kind(name))));
        groups.into_iter().map(|group| (group.name, group.files, group.gap.is_some())).collect()
    }

    #[test]
    fn names_say_what_belongs_together() {
        let group = |name: &str, files: &[usize]| (name.to_owned(), files.to_vec(), false);
        for (names, expected) in [
            (vec!["s1.png", "s2.png", "S3.PNG"], vec![group("s#.png", &[0, 1, 2])]),
            (vec!["a1.png", "a2.png", "b1.png"], vec![group("a#.png", &[0, 1]), group("b1.png", &[2])]),
            (vec!["a1.jpg", "a1.png", "a2.jpg"], vec![group("a#.jpg", &[0, 2]), group("a1.png", &[1])]),
            (
                vec!["t1_z1.png", "t1_z2.png", "t2_z1.png", "t2_z2.png"],
                vec![group("t1_z#.png", &[0, 1]), group("t2_z#.png", &[2, 3])],
            ),
            (vec!["3d_1_v2.png", "3d_2_v2.png"], vec![group("3d_#_v2.png", &[0, 1])]),
            (vec!["1_120001.png", "2_120004.png"], vec![group("#_#.png", &[0, 1])]),
            (vec!["one.png"], vec![group("one.png", &[0])]),
        ] {
            assert_eq!(grouped(&names), expected, "{names:?}");
        }
    }

    #[test]
    fn gaps_are_found_and_equal_steps_are_none() {
        let numbers = |numbers: &[u64]| gap(&numbers.iter().map(|&number| Some(number)).collect::<Vec<_>>());
        assert_eq!(numbers(&[1, 2, 3]), None);
        assert_eq!(numbers(&[10, 20, 30]), None);
        assert_eq!(numbers(&[7]), None);
        assert!(numbers(&[1, 2, 5, 6, 9]).unwrap().contains("2 and 5, and at 1 more places"));
        assert_eq!(gap(&[Some(1), None, Some(9)]), None, "a number that is too long for a count");
    }
}
