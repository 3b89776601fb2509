//! What the numbers of a label map stand for.

use std::collections::BTreeMap;

use super::plain;

/// Most labels that are kept: the finest atlases of brains have two thousand.
pub const MAX_LABELS: usize = 4096;

/// Characters of a label's name that are kept.
pub const MAX_LABEL_NAME: usize = 200;

/// A label.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// What it is called, as one line without control characters; may be empty.
    pub name: String,
    /// sRGB, 0 … 1, where the file gives one.
    pub color: Option<[f32; 3]>,
}

/// Names and colours by the number that voxels have.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Labels(BTreeMap<i64, Label>);

impl Labels {
    /// States what a number stands for, in the file's words. Of colours only those within 0 … 1 are kept; labels beyond
    /// [`MAX_LABELS`] are not.
    pub fn insert(&mut self, number: i64, name: &str, color: Option<[f32; 3]>) {
        if self.0.len() >= MAX_LABELS && !self.0.contains_key(&number) {
            return;
        }
        let is_color = |color: &[f32; 3]| color.iter().all(|c| (0.0..=1.0).contains(c));
        let label = Label { name: plain(name.trim(), MAX_LABEL_NAME), color: color.filter(is_color) };
        self.0.insert(number, label);
    }

    /// What a number stands for.
    pub fn get(&self, number: i64) -> Option<&Label> {
        self.0.get(&number)
    }

    /// All of them, by number.
    pub fn iter(&self) -> impl Iterator<Item = (i64, &Label)> {
        self.0.iter().map(|(&number, label)| (number, label))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_bounded_and_clean() {
        let mut labels = Labels::default();
        for number in 0..2 * MAX_LABELS as i64 {
            labels.insert(number, &"n".repeat(1000), None);
        }
        labels.insert(7, " a\u{202e}b ", Some([0.5, 2.0, 0.0]));
        labels.insert(8, "c", Some([0.5, 1.0, 0.0]));
        assert_eq!(labels.len(), MAX_LABELS);
        assert_eq!(labels.get(7), Some(&Label { name: "a·b".to_owned(), color: None }));
        assert_eq!(labels.get(8).and_then(|label| label.color), Some([0.5, 1.0, 0.0]));
        assert!(labels.get(3).is_some_and(|label| label.name.chars().count() == MAX_LABEL_NAME + 1));
        assert!(labels.get(MAX_LABELS as i64).is_none());
    }
}
