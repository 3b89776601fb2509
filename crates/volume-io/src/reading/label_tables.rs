//! Label names and colours from a text file beside a label map: ITK-SNAP label descriptions, or `FreeSurfer` colour
//! tables (<https://surfer.nmr.mgh.harvard.edu/fswiki/LabelsClutsAnnotationFiles>).
//!
//! No header names such a file: it is found by the volume's file name.

use std::path::Path;

use super::companion_path;
use super::input::name_without_extension;
use chiaroscuro_files::read_small_file;
use chiaroscuro_volume::{FileLabelTable, LoadContext, Samples, ValueMeaning, ValueMetadata};

/// Extensions of label tables, the most specific first.
const ENDINGS: [&str; 4] = [".ctab", ".label", ".lut", ".txt"];

/// Reads the label table beside a volume, if there is one, and marks the volume as a label map; only where all values
/// are integers.
pub(crate) fn add_label_table(
    context: LoadContext<'_>,
    endings: &[&str],
    samples: &Samples,
    hints: &mut ValueMetadata,
) {
    add_labels(read_label_table(context, endings), samples, hints);
}

/// Adds the labels that a file states, and marks the volume as a label map; only where there are labels, and all
/// values are integers.
pub(crate) fn add_labels(labels: FileLabelTable, samples: &Samples, hints: &mut ValueMetadata) {
    if !labels.is_empty() && all_integers(samples) {
        hints.labels = labels;
        hints.meaning = ValueMeaning::Labels;
    }
}

/// Labels of the table beside the volume that has the volume's file name without its extension (one of `endings`);
/// empty where there is no such file, or where it is not a label table.
fn read_label_table(context: LoadContext<'_>, endings: &[&str]) -> FileLabelTable {
    let stem = name_without_extension(context.path, endings);
    let folder = context.path.parent().unwrap_or(Path::new(""));
    let found = ENDINGS.iter().find_map(|ending| {
        let name = format!("{stem}{ending}");
        // Checked before opening: usually there is no such file.
        if !folder.join(&name).is_file() {
            return None;
        }
        let path = companion_path::resolve(context, "labels", &name).ok()?;
        parse_label_table(&String::from_utf8_lossy(&read_small_file(&path).ok()?))
    });
    found.unwrap_or_default()
}

/// Returns true if no value has a fractional part.
pub(crate) fn all_integers(samples: &Samples) -> bool {
    match samples {
        Samples::F32(values) => values.iter().all(|value| value.fract() == 0.0),
        Samples::F64(values) => values.iter().all(|value| value.fract() == 0.0),
        _ => true,
    }
}

/// Parses a label table; `None` for any other text: one line that is not an entry is enough.
fn parse_label_table(text: &str) -> Option<FileLabelTable> {
    let mut labels = FileLabelTable::default();
    for line in text.trim_start_matches('\u{feff}').lines() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (number, name, color) = parse_itk_snap_entry(line).or_else(|| parse_freesurfer_entry(line))?;
        labels.insert(number, name, Some(color));
    }
    (!labels.is_empty()).then_some(labels)
}

/// Parses an ITK-SNAP entry: `IDX R G B A VIS MSH "LABEL"`.
fn parse_itk_snap_entry(line: &str) -> Option<(i64, &str, [f32; 3])> {
    let (numbers, rest) = line.split_once('"')?;
    let (name, after) = rest.rsplit_once('"')?;
    let words: Vec<&str> = numbers.split_whitespace().take(8).collect();
    let [index, red, green, blue, opacity, visible, mesh] = words[..] else { return None };
    let are_numbers = [opacity, visible, mesh].iter().all(|word| word.parse::<f64>().is_ok());
    let entry = (index.parse().ok()?, name, color([red, green, blue])?);
    (are_numbers && after.trim().is_empty()).then_some(entry)
}

/// Parses a `FreeSurfer` entry: `No. Name R G B A`; the name may contain spaces, and A may be missing.
fn parse_freesurfer_entry(line: &str) -> Option<(i64, &str, [f32; 3])> {
    let (number, rest) = line.split_once(char::is_whitespace)?;
    let number = number.parse().ok()?;
    let (mut name, mut numbers) = (rest.trim_start(), Vec::new());
    while let Some((before, word)) = name.rsplit_once(char::is_whitespace) {
        if numbers.len() == 4 || word.parse::<u8>().is_err() {
            break;
        }
        numbers.insert(0, word);
        name = before.trim_end();
    }
    let &[red, green, blue, ..] = &numbers[..] else { return None };
    // A row of numbers without a name is not a label.
    name.contains(char::is_alphabetic).then_some(())?;
    Some((number, name, color([red, green, blue])?))
}

/// Converts sRGB bytes written as text to components from 0 to 1.
fn color(words: [&str; 3]) -> Option<[f32; 3]> {
    let mut color = [0.0; 3];
    for (part, word) in color.iter_mut().zip(words) {
        *part = f32::from(word.parse::<u8>().ok()?) / 255.0;
    }
    Some(color)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::FileLabel;

    fn label(name: &str, color: [u8; 3]) -> FileLabel {
        FileLabel { name: name.to_owned(), color: Some(color.map(|part| f32::from(part) / 255.0)) }
    }

    #[test]
    fn both_layouts_are_read() {
        let snap = "################\n# ITK-SnAP Label Description File\n\
                    \x20   0     0    0    0        0  0  0    \"Clear Label\"\r\n\
                    \x20  12   255    0   10        0.5  1  1    \"Left \"big\" one\"\n";
        let labels = parse_label_table(snap).unwrap();
        assert_eq!(labels.get(0), Some(&label("Clear Label", [0; 3])));
        assert_eq!(labels.get(12), Some(&label("Left \"big\" one", [255, 0, 10])));
        let freesurfer = "\u{feff}#No. Label Name:  R   G   B   A\n\n0   Unknown   0   0   0   0\n\
                          2   Left-Cerebral-White-Matter   245 245 245 0\n\
                          7   of two words   1 2 3\n 8 area 4 5 6 7 0\n";
        let labels = parse_label_table(freesurfer).unwrap();
        assert_eq!(labels.len(), 4);
        assert_eq!(labels.get(2), Some(&label("Left-Cerebral-White-Matter", [245; 3])));
        assert_eq!(labels.get(7), Some(&label("of two words", [1, 2, 3])));
        assert_eq!(labels.get(8), Some(&label("area 4", [5, 6, 7])));
    }

    #[test]
    fn other_text_is_no_table() {
        for text in [
            "",
            "# nothing but words about it",
            "1 2 3",
            "1 2 3 4",
            "a scan of 12 May, 3 4 5 6",
            "1 2 3 4 5 6",
            "1 Bone 256 0 0",
            "1 Bone 255 0 0 0\nand more",
            "1 255 0 0 1 1 \"too few\"",
            "1 255 0 0 1 1 1 \"open",
            "x Bone 255 0 0 0",
            "1 Bone 0 -1 0",
        ] {
            assert_eq!(parse_label_table(text), None, "{text:?}");
        }
    }

    #[test]
    fn a_file_that_is_called_like_the_volume_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("seg.nii.gz");
        let context = LoadContext { operation: "test", path: &path };
        let endings = [".nii.gz", ".nii"];
        let mut hints = ValueMetadata::default();
        add_label_table(context, &endings, &Samples::U8(vec![1]), &mut hints);
        assert!(hints.is_empty());
        std::fs::write(folder.path().join("seg.label"), "no table").unwrap();
        std::fs::write(folder.path().join("seg.txt"), "1 Bone 255 0 0 0").unwrap();
        add_label_table(context, &endings, &Samples::F32(vec![1.5]), &mut hints);
        assert!(hints.is_empty(), "values with fractions are no labels");
        add_label_table(context, &endings, &Samples::F32(vec![1.0]), &mut hints);
        assert_eq!(hints.meaning, ValueMeaning::Labels);
        assert_eq!(hints.labels.get(1), Some(&label("Bone", [255, 0, 0])));
    }
}
