//! Tests of the hints that NRRD headers give on values.

use super::{HEADER, VOXELS, load_attached};
use chiaroscuro_volume::{MAX_LABEL_NAME, MAX_LABELS, MissingVoxels, Modality, ValueMeaning, ValueMetadata};

/// Returns the hints of a header with these lines added.
fn hints_of(lines: &[&str]) -> ValueMetadata {
    let header = lines.iter().fold(HEADER.to_owned(), |header, line| header + line + "\n");
    load_attached(&header, &VOXELS).unwrap().metadata().clone()
}

#[test]
fn headers_that_say_nothing_give_no_hints() {
    assert!(hints_of(&[]).is_empty());
    assert!(hints_of(&["content: a tooth", "kinds: domain domain domain", "key:=value"]).is_empty());
}

#[test]
fn what_values_are_is_understood() {
    for line in ["modality:=CT", "Modality:= ct", "DICOM_0008_0060:=CT", "content: phantom, CT"] {
        assert_eq!(hints_of(&[line]).modality, Modality::Ct, "{line}");
    }
    for line in ["sample units: HU", "sample units: \"Hounsfield\"", "DICOM_0028_1054:=HU"] {
        assert_eq!(hints_of(&[line]).meaning, ValueMeaning::HounsfieldUnits, "{line}");
    }
    assert_eq!(hints_of(&["sample units: \"mg/ml\""]).unit(), Some("mg/ml"));
    assert!(hints_of(&["old min: -1000", "old max: 3000"]).is_rescaled);
    assert_eq!(hints_of(&["DICOM_0028_0120:=-2000"]).padding, Some(-2000.0));
    assert_eq!(hints_of(&["padding value:=0"]).padding, Some(0.0));
    // DICOM's padding value is a stored number, rescaled as the header says.
    let rescale = ["DICOM_0028_1053:=2", "DICOM_0028_1052:=-1024"];
    let with = |padding| hints_of(&[rescale[0], rescale[1], padding]).padding;
    assert_eq!(with("DICOM_0028_0120:=-500"), Some(-2024.0));
    assert_eq!(with("PixelPaddingValue:=-500"), Some(-2024.0));
    assert_eq!(with("PaddingValue:=-500"), Some(-500.0), "in the numbers of the file");
    assert_eq!(hints_of(&["RescaleIntercept:=-1000", "PixelPaddingValue:=0"]).padding, Some(-1000.0));
    assert_eq!(hints_of(&["RescaleSlope:=1e308", "PixelPaddingValue:=100"]).padding, None, "no number");
    let window = hints_of(&["DICOM_0028_1050:=40\\300", "DICOM_0028_1051:=400\\1500"]).window;
    assert_eq!(window, Some([-160.0, 240.0]), "the first of two");
    assert_eq!(hints_of(&["WindowCenter:=40", "WindowWidth:=0"]).window, None);
    assert_eq!(hints_of(&["SeriesDescription:=T1 \u{1b}axial"]).acquisition(), Some("T1 ·axial"));
}

#[test]
fn segments_of_slicer_are_labels() {
    let hints = hints_of(&[
        "Segment0_ID:=Segment_1",
        "Segment0_Name:=left lung",
        "Segment0_LabelValue:=3",
        "Segment0_Color:=0.5 0.25 1",
        "Segment0_Layer:=0",
        "Segment1_Name:=heart",
        "Segment1_Color:=0.5 0.25",
        "Segment2_Name:=of another layer",
        "Segment2_LabelValue:=1",
        "Segment2_Layer:=1",
        "Segment4_Name:=after a gap",
        "Segmentation_ContainedRepresentationNames:=Binary labelmap|",
    ]);
    assert_eq!(hints.meaning, ValueMeaning::Labels);
    let labels: Vec<_> = hints.labels.iter().map(|(number, label)| (number, label.name.as_str())).collect();
    assert_eq!(labels, [(2, "heart"), (3, "left lung")]);
    assert_eq!(hints.labels.get(3).and_then(|label| label.color), Some([0.5, 0.25, 1.0]));
    assert_eq!(hints.labels.get(2).and_then(|label| label.color), None, "two numbers are no colour");
    assert_eq!(hints_of(&["containedRepresentationNames:=Closed surface"]).meaning, ValueMeaning::Labels);
    assert_eq!(hints_of(&["modality:=SEG"]).meaning, ValueMeaning::Labels);
}

#[test]
fn hostile_keys_do_no_harm() {
    let many = (0..3 * MAX_LABELS).fold(String::new(), |lines, index| {
        lines + &format!("Segment{index}_Name:=n\nSegment{index}_LabelValue:={index}\n")
    });
    assert_eq!(hints_of(&[many.trim_end()]).labels.len(), MAX_LABELS);
    let long = format!("Segment0_Name:={}\u{202e}", "x".repeat(100_000));
    let hints =
        hints_of(&[&long, "Segment0_LabelValue:=99999999999999999999999", "Segment0_Color:=nan inf 1e99"]);
    assert!(hints.labels.is_empty(), "no such number");
    let hints = hints_of(&[&long, "Segment0_LabelValue:=-5", "Segment0_Color:=nan inf 1e99"]);
    let label = hints.labels.get(-5).unwrap();
    assert!(label.name.chars().count() <= MAX_LABEL_NAME + 1 && label.color.is_none());
    for line in [
        ":=",
        ":=value",
        "modality:=",
        "padding value:=",
        "padding value:=nan",
        "padding value:=1e999",
        "Segment0_:=",
        "Segment_Name:=x",
        "Segment0_Color:=",
        "sample units: \"",
        "old min: ",
        "modality:=\u{0}CT",
        "DICOM_0028_0120:=0x7fff",
    ] {
        let hints = hints_of(&[line]);
        assert_eq!(hints.padding, None, "{line}");
        assert_eq!(hints.meaning, ValueMeaning::Unknown, "{line}");
    }
    let twice = hints_of(&["modality:=CT", "modality:=MR"]);
    assert_eq!(twice.modality, Modality::Ct, "the first counts");
}

#[test]
fn padding_holds_nothing() {
    let load = |line: &str| load_attached(&format!("{HEADER}{line}\n"), &VOXELS).unwrap();
    let volume = load("PaddingValue:=1");
    assert_eq!((volume.padding_value(), volume.value_range().low), (Some(1.0), 2.0));
    assert_eq!(volume.missing().map(MissingVoxels::count), Some(1));
    let header = format!("{HEADER}PaddingValue:=5\n");
    let alone = load_attached(&header, &[5; 8]).unwrap();
    assert_eq!((alone.padding_value(), alone.metadata().padding), (None, Some(5.0)), "nothing else is there");
}

#[test]
fn hints_stay_when_voxels_are_averaged() {
    let volume = load_attached(&format!("{HEADER}modality:=MR\nsample units: ms\n"), &VOXELS).unwrap();
    let hints = volume.metadata().clone();
    let reduced = volume.block_averaged([2; 3]).unwrap();
    assert_eq!((reduced.dims(), reduced.metadata()), ([1; 3], &hints));
    assert_eq!(hints.unit(), Some("ms"));
}
