//! Names and colours of the labels of a label map.

use std::collections::BTreeMap;

use super::sanitised;

/// Maximum number of labels that are stored: the finest atlases of brains have two thousand.
pub const MAX_LABELS: usize = 4096;

/// Maximum length of a label's name, in characters.
pub const MAX_LABEL_NAME: usize = 200;

/// Name and colour of a label.
#[derive(Debug, Clone, PartialEq)]
pub struct FileLabel {
    /// Name, as one line without control characters; may be empty.
    pub name: String,
    /// Colour in sRGB, 0 … 1, if the file gives one.
    pub color: Option<[f32; 3]>,
}

/// Table of labels by the number that voxels hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileLabelTable(BTreeMap<i64, FileLabel>);

impl FileLabelTable {
    /// Adds a label as the file names it. Colours outside 0 … 1 and labels beyond [`MAX_LABELS`] are dropped.
    pub fn insert(&mut self, number: i64, name: &str, color: Option<[f32; 3]>) {
        if self.0.len() >= MAX_LABELS && !self.0.contains_key(&number) {
            return;
        }
        let is_color = |color: &[f32; 3]| color.iter().all(|c| (0.0..=1.0).contains(c));
        let label = FileLabel { name: sanitised(name.trim(), MAX_LABEL_NAME), color: color.filter(is_color) };
        self.0.insert(number, label);
    }

    /// Returns the label of a number, if the table has it.
    pub fn get(&self, number: i64) -> Option<&FileLabel> {
        self.0.get(&number)
    }

    /// Iterates over all labels in the order of their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (i64, &FileLabel)> {
        self.0.iter().map(|(&number, label)| (number, label))
    }

    /// Returns the number of labels.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns true if the table has no label.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_bounded_and_clean() {
        let mut labels = FileLabelTable::default();
        for number in 0..2 * MAX_LABELS as i64 {
            labels.insert(number, &"n".repeat(1000), None);
        }
        labels.insert(7, " a\u{202e}b ", Some([0.5, 2.0, 0.0]));
        labels.insert(8, "c", Some([0.5, 1.0, 0.0]));
        assert_eq!(labels.len(), MAX_LABELS);
        assert_eq!(labels.get(7), Some(&FileLabel { name: "a·b".to_owned(), color: None }));
        assert_eq!(labels.get(8).and_then(|label| label.color), Some([0.5, 1.0, 0.0]));
        assert!(labels.get(3).is_some_and(|label| label.name.chars().count() == MAX_LABEL_NAME + 1));
        assert!(labels.get(MAX_LABELS as i64).is_none());
    }
}
