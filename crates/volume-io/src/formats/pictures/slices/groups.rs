//! Grouping of a folder's files into volumes, by the numbers in their names.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::counters::{NameCounter, counter_label, name_counters, slice_column};
use super::picture::SliceFormat;

/// Files that are slices of one volume, as indices into the list of all.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct SliceGroup {
    /// Common part of their names, with `#` in place of the slice number.
    pub(super) name: String,
    pub(super) kind: SliceFormat,
    pub(super) files: Vec<usize>,
    /// Remark about gaps in the numbering.
    pub(super) gap: Option<String>,
    /// Time and channel; `None` where the names count neither.
    pub(super) recorded: Option<RecordedStack>,
}

/// Stack of slices that were recorded at one time and in one channel, as the names of its files tell.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct RecordedStack {
    /// Name with `#` for slice, time and channel, which all stacks of a recording have in common.
    pub(super) recording: String,
    pub(super) time: CounterValue,
    pub(super) channel: CounterValue,
    /// Number of each slice, in digits without leading zeros.
    pub(super) numbers: Vec<String>,
}

/// Value of a counter in a name; empty where the name has no such counter.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct CounterValue {
    pub(super) digits: String,
    /// Text for the user: the digits with the word before them.
    pub(super) label: String,
}

/// File name split into texts and the digits between them.
struct NamePieces {
    texts: Vec<String>,
    digits: Vec<String>,
    /// Meaning of each of the numbers.
    counters: Vec<NameCounter>,
    /// Each number with the word before it.
    labels: Vec<String>,
}

impl NamePieces {
    fn parse(path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = strip_uuid(&name);
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
        let counters = name_counters(texts.iter().take(digits.len()).map(String::as_str));
        let labels = texts.iter().zip(&digits).map(|(text, digits)| counter_label(text, digits)).collect();
        let texts = texts.iter().map(|text| text.to_lowercase()).collect();
        Self { texts, digits, counters, labels }
    }

    /// Value of those columns that count the same, together.
    fn value(&self, columns: &[usize]) -> CounterValue {
        let join = |pieces: &[String]| {
            let pieces: Vec<&str> = columns.iter().map(|&column| pieces[column].as_str()).collect();
            pieces.join("_")
        };
        CounterValue { digits: join(&self.digits), label: join(&self.labels) }
    }

    /// Returns the name with `#` in place of those digits that count.
    fn name(&self, is_counted: impl Fn(usize) -> bool) -> String {
        let mut name = self.texts.first().cloned().unwrap_or_default();
        for (at, (digits, text)) in self.digits.iter().zip(self.texts.iter().skip(1)).enumerate() {
            name.push_str(if is_counted(at) { "#" } else { digits });
            name.push_str(text);
        }
        name
    }
}

/// Removes a UUID from a name (32 hexadecimal digits, RFC 9562, 4), by which some databases keep files apart: it
/// carries no order.
fn strip_uuid(name: &str) -> String {
    const GROUPS: [usize; 5] = [8, 4, 4, 4, 12];
    const MARK_BYTES: usize = 36;
    let is_mark = |mark: &str| {
        let groups: Vec<&str> = mark.split('-').collect();
        let is_hex = |group: &&str| group.bytes().all(|byte| byte.is_ascii_hexdigit());
        groups.len() == GROUPS.len()
            && groups.iter().zip(GROUPS).all(|(group, length)| group.len() == length)
            && groups.iter().all(is_hex)
    };
    let at = (0..name.len().saturating_sub(MARK_BYTES - 1))
        .find(|&at| name.get(at..at + MARK_BYTES).is_some_and(is_mark));
    at.map_or_else(|| name.to_owned(), |at| [&name[..at], &name[at + MARK_BYTES..]].concat())
}

/// Name with `#` in place of all numbers, which the slices of a volume have in common.
pub(super) fn name_pattern(path: &Path) -> String {
    NamePieces::parse(path).name(|_| true)
}

/// Groups pictures, in natural order: members of a group differ in the number that counts slices.
pub(super) fn group_slices<'a>(files: impl IntoIterator<Item = (&'a Path, SliceFormat)>) -> Vec<SliceGroup> {
    let files: Vec<(NamePieces, SliceFormat)> =
        files.into_iter().map(|(path, kind)| (NamePieces::parse(path), kind)).collect();
    let alike = group_by_key((0..files.len()).map(|at| {
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
        let counters = members.first().map_or(&[][..], |&member| &files[member].0.counters);
        let Some(counted) = slice_column(&varying, counters) else {
            let name = members.first().map_or(String::new(), |&member| files[member].0.name(|_| false));
            groups.push(SliceGroup { name, kind, files: members, gap: None, recorded: None });
            continue;
        };
        let parts = group_by_key(members.iter().map(|&member| {
            let others = varying.iter().filter(|&&column| column != counted);
            let key: Vec<&str> = others.map(|&column| digits(member)[column].as_str()).collect();
            (key, member)
        }));
        // Numbers that change together, such as a counter and the time of day, count together: one of them alone
        // distinguishes all members.
        let tells_all = |&column: &usize| {
            let numbers: HashSet<&str> =
                members.iter().map(|&member| digits(member)[column].as_str()).collect();
            numbers.len() == members.len()
        };
        let is_split = parts.iter().all(|(_, part)| part.len() > 1)
            || !(parts.iter().all(|(_, part)| part.len() == 1) || varying.iter().any(tells_all));
        let parts = if is_split {
            parts.into_iter().map(|(_, part)| (vec![counted], part)).collect()
        } else {
            vec![(varying.clone(), members)]
        };
        // Times and channels beside the slices; what counts the slices is neither.
        let columns_of = |kind: NameCounter| -> Vec<usize> {
            let is_of_kind = |column: &usize| is_split && counters[*column] == kind;
            let other = varying.iter().copied().filter(is_of_kind);
            if counters[counted] == kind { Vec::new() } else { other.collect() }
        };
        let [times, channels] = [NameCounter::Time, NameCounter::Channel].map(columns_of);
        for (counts, part) in parts {
            let pieces = &files[part[0]].0;
            let name = pieces.name(|column| counts.contains(&column));
            let of_part = |member: &usize| digits(*member)[counted].as_str();
            let numbers: Vec<&str> = part.iter().map(of_part).collect();
            let gap = if counts.len() == 1 { gap_remark(&numbers) } else { None };
            let recorded = (!times.is_empty() || !channels.is_empty()).then(|| RecordedStack {
                recording: pieces.name(|column| {
                    column == counted || times.contains(&column) || channels.contains(&column)
                }),
                time: pieces.value(&times),
                channel: pieces.value(&channels),
                numbers: numbers.iter().map(|digits| digits.trim_start_matches('0').to_owned()).collect(),
            });
            groups.push(SliceGroup { name, kind, files: part, gap, recorded });
        }
    }
    groups
}

/// Groups items by key, in the order in which the keys first occur.
pub(super) fn group_by_key<K: Clone + Eq + std::hash::Hash>(
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

/// Remark about missing numbers in a sequence of equal steps.
pub(super) fn gap_remark(numbers: &[&str]) -> Option<String> {
    // Without digits it is 0, whose zeros were taken off; some numbers are too long for a count.
    let number = |digits: &str| if digits.is_empty() { Some(0) } else { digits.parse::<u64>().ok() };
    let steps = numbers.windows(2).filter_map(|pair| {
        let (before, after) = (number(pair[0])?, number(pair[1])?);
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
        "slices are missing between numbers {before} and {after}{more}: the others are stacked without gaps"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grouped(names: &[&str]) -> Vec<(String, Vec<usize>, bool)> {
        let kind = |name: &str| if name.ends_with("jpg") { SliceFormat::Jpeg } else { SliceFormat::Png };
        let groups = group_slices(names.iter().map(|name| (Path::new(*name), kind(name))));
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
            (
                vec!["S1_z00_ch00.png", "S1_z00_ch01.png", "S1_z01_ch00.png", "S1_z01_ch01.png"],
                vec![group("s1_z#_ch00.png", &[0, 2]), group("s1_z#_ch01.png", &[1, 3])],
            ),
            (
                vec!["S1_z0_ch0.png", "S1_z0_ch1.png", "S1_z1_ch0.png"],
                vec![group("s1_z#_ch0.png", &[0, 2]), group("s1_z#_ch1.png", &[1])],
            ),
            (
                vec!["001_c1.png", "001_c2.png", "002_c1.png", "002_c2.png"],
                vec![group("#_c1.png", &[0, 2]), group("#_c2.png", &[1, 3])],
            ),
            (
                vec!["m1_s1.png", "m1_s2.png", "m2_s1.png", "m2_s2.png"],
                vec![group("m1_s#.png", &[0, 1]), group("m2_s#.png", &[2, 3])],
            ),
            (
                vec!["ch0_01.png", "ch0_02.png", "ch1_03.png", "ch1_04.png"],
                vec![group("ch0_#.png", &[0, 1]), group("ch1_#.png", &[2, 3])],
            ),
            (vec!["1_120001.png", "2_120004.png"], vec![group("#_#.png", &[0, 1])]),
            (vec!["one.png"], vec![group("one.png", &[0])]),
        ] {
            assert_eq!(grouped(&names), expected, "{names:?}");
        }
    }

    #[test]
    fn marks_of_databases_say_nothing() {
        let names: Vec<String> = [("z1", "0A"), ("z2", "9F"), ("z3", "B7")]
            .map(|(slice, mark)| format!("p_{slice}_w1{}-1111-2222-3333-444455556666.tif", mark.repeat(4)))
            .to_vec();
        let found = group_slices(names.iter().map(|name| (Path::new(name.as_str()), SliceFormat::Tiff)));
        assert_eq!((found.len(), found[0].name.as_str()), (1, "p_z#_w1.tif"));
        for name in ["slice-1111-2222-3333-1.png", "é-1.png", "x"] {
            assert_eq!(strip_uuid(name), name);
        }
    }

    /// All permutations of some items.
    fn orders<T: Clone>(things: &[T]) -> Vec<Vec<T>> {
        if things.is_empty() {
            return vec![Vec::new()];
        }
        let with = |at: usize| {
            let mut rest = things.to_vec();
            let first = rest.remove(at);
            orders(&rest).into_iter().map(move |rest| [vec![first.clone()], rest].concat())
        };
        (0..things.len()).flat_map(with).collect()
    }

    #[test]
    fn slices_are_told_in_any_order_of_letters() {
        // Word before a counter, and how many values it has; the first counts the slices.
        let sets: [&[(&str, usize)]; 8] = [
            &[("z", 8), ("ch", 2)],
            &[("Z", 3), ("C", 2), ("T", 4)],
            &[("z", 2), ("w", 3), ("s", 2), ("t", 2)],
            &[("slice", 5), ("channel", 2), ("time", 2)],
            &[("", 6), ("ch", 3)],
            &[("", 6), ("t", 3), ("c", 2)],
            &[("p", 4), ("f", 2), ("ch", 2), ("sk", 2)],
            &[("z", 3), ("Series", 2), ("xy", 2)],
        ];
        for set in sets {
            for order in orders(&(0..set.len()).collect::<Vec<_>>()) {
                for (separator, width) in [("_", 1), ("-", 3), (" ", 2)] {
                    let mut names = vec!["exp".to_owned()];
                    for &counter in &order {
                        let (word, count) = set[counter];
                        let numbered = |name: &String| {
                            let name = name.clone();
                            (0..count).map(move |at| format!("{name}{separator}{word}{at:0width$}"))
                        };
                        names = names.iter().flat_map(numbered).collect();
                    }
                    let names: Vec<String> = names.into_iter().map(|name| name + ".tif").collect();
                    let groups =
                        group_slices(names.iter().map(|name| (Path::new(name.as_str()), SliceFormat::Tiff)));
                    let (_, slices) = set[0];
                    let others: usize = set[1..].iter().map(|&(_, count)| count).product();
                    assert_eq!(groups.len(), others, "{names:?}");
                    for group in &groups {
                        assert_eq!((group.files.len(), &group.gap), (slices, &None), "{}", group.name);
                        assert_eq!(group.name.matches('#').count(), 1, "{}", group.name);
                        let ordered = group.files.is_sorted();
                        assert!(ordered && group.name.contains(&format!("{}#", set[0].0.to_lowercase())));
                    }
                }
            }
        }
    }

    #[test]
    fn gaps_are_found_and_equal_steps_are_none() {
        assert_eq!(gap_remark(&["1", "2", "3"]), None);
        assert_eq!(gap_remark(&["010", "020", "030"]), None);
        assert_eq!(gap_remark(&["", "1"]), None);
        assert_eq!(gap_remark(&["7"]), None);
        assert!(gap_remark(&["1", "2", "5", "6", "9"]).unwrap().contains("2 and 5, and at 1 more places"));
        assert_eq!(gap_remark(&["1", &"9".repeat(40), "9"]), None, "a number that is too long for a count");
    }
}
