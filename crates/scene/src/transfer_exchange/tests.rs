//! Tests of the exchange formats: reading, rejecting, and round trips.

use std::path::Path;

use super::*;
use crate::{OpacityInterpolation, Preset, Settings};
use chiaroscuro_files::xml::slow_texts::slow_texts;
use chiaroscuro_volume::ValueRanges;

const RANGE: ValueRange = ValueRange::new(-1000.0, 1000.0);

fn read(name: &str, bytes: &[u8]) -> Result<TransferFunction, String> {
    import_transfer(Path::new(name), bytes, RANGE).map_err(|err| err.to_string())
}

/// Returns a function with every feature: jumps, smooth segments, colours mixed in Oklab.
fn rich() -> TransferFunction {
    let point =
        |value, color, opacity, easing| ControlPoint { easing, ..ControlPoint::new(value, color, opacity) };
    TransferFunction {
        points: vec![
            point(-800.0, [0.1, 0.2, 0.9], 0.0, Easing::Smooth),
            point(-200.0, [0.9, 0.8, 0.1], 0.4, Easing::Step),
            point(100.0, [0.2, 0.9, 0.3], 0.1, Easing::Linear),
            point(700.0, [1.0, 1.0, 1.0], 0.9, Easing::Linear),
        ],
        interpolation: OpacityInterpolation::Opacity,
        mixing: ColorMixing::Seen,
    }
}

#[test]
fn what_is_written_is_read_back() {
    for (name, opacity_apart, color_apart) in [
        // A smooth segment in eight linear pieces is off by less than 1/64 of its height; colours mixed in Oklab, by
        // a little more.
        ("a.json", 0.012, 0.03),
        ("a.vp", 0.012, 0.03),
        ("a.vp.json", 0.012, 0.03),
        ("a.itf", 0.012, 0.03),
        ("a.preset.json", 1e-9, 1e-6),
        // Positions are bytes, too.
        ("a.clut", 0.03, 0.06),
    ] {
        let before = rich();
        let after = read(name, &export_transfer(Path::new(name), &before, RANGE).unwrap()).unwrap();
        for step in 0..=100 {
            // Values away from the jumps.
            let value = -995.0 + f64::from(step) * 19.9;
            if [-200.0, 100.0].iter().any(|jump: &f64| (value - jump).abs() < 12.0) {
                continue;
            }
            let apart = (before.opacity_at(value) - after.opacity_at(value)).abs();
            assert!(apart < opacity_apart, "{name} at {value}: {apart}");
            for (a, b) in before.sample(value).color.iter().zip(after.sample(value).color) {
                assert!((a - b).abs() < color_apart, "{name} at {value}: {a} and {b}");
            }
        }
    }
}

#[test]
fn imagej_gets_the_colors() {
    let before = rich();
    let table = export_transfer(Path::new("a.lut"), &before, RANGE).unwrap();
    assert_eq!(table.len(), 768);
    let after = read("a.lut", &table).unwrap();
    for point in &after.points {
        let wanted = before.sample(point.value).color;
        assert!(
            after.sample(point.value).color.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 0.01),
            "{point:?}"
        );
    }
    let err = export_transfer(Path::new("a.txt"), &before, RANGE).unwrap_err().to_string();
    assert!(err.contains(".txt is not an extension"), "{err}");
}

#[test]
fn inviwos_points_of_either_kind() {
    let old = r#"<?xml version="1.0" ?><InviwoTreeData version="1.0"><maskMin content="0" /><dataPoints>
        <point><pos x="0.25" y="0.5" /><rgba x="1" y="0.5" z="0" w="0.5" /></point>
        <point><pos x="1" y="1" /><rgba x="0" y="0" z="1" w="1" /></point>
        </dataPoints></InviwoTreeData>"#;
    let new = r#"<?xml version="1.0" ?><InviwoWorkspace version="3"><Points>
        <Point><pos content="0.25" /><rgba x="1" y="0.5" z="0" w="0.5" /></Point>
        <Point><pos content="1" /><rgba x="0" y="0" z="1" w="1" /></Point></Points></InviwoWorkspace>"#;
    let function = read("a.itf", old.as_bytes()).unwrap();
    assert_eq!(function, read("a.itf", new.as_bytes()).unwrap());
    let first = function.points[0];
    assert_eq!((first.value, first.color, first.opacity), (-500.0, [1.0, 0.5, 0.0], 0.5));
}

#[test]
fn voreens_keys_with_splits_and_thresholds() {
    let file = |domain: &str, threshold: &str| {
        format!(
            r#"<?xml version="1.0" ?><VoreenData version="1"><TransFuncIntensity type="TransFuncIntensity">
            {domain}{threshold}<Keys>
            <key type="TransFuncMappingKey"><intensity value="0.5" /><split value="true" />
                <colorL r="0" g="0" b="0" a="0" /><colorR r="255" g="0" b="51" a="102" /></key>
            <key type="TransFuncMappingKey"><intensity value="0" /><split value="false" />
                <colorL r="0" g="0" b="0" a="51" /></key>
            </Keys></TransFuncIntensity></VoreenData>"#
        )
    };
    let function = read("a.tfi", file("", "").as_bytes()).unwrap();
    let places: Vec<_> = function.points.iter().map(|point| (point.value, point.opacity)).collect();
    assert_eq!(places, [(-1000.0, 0.2), (0.0, 0.0), (0.0, 0.4)]);
    assert_eq!(function.points[2].color, [1.0, 0.0, 0.2]);
    let own = file(r#"<domain x="0" y="4000" />"#, r#"<threshold x="0.1" y="1" />"#);
    let function = read("a.tfi", own.as_bytes()).unwrap();
    // Opacity is 0 below the threshold, and unchanged above it.
    assert_eq!((function.opacity_at(399.0), function.points.last().unwrap().value), (0.0, 2000.0));
    assert!((function.opacity_at(401.0) - 0.2 * (1.0 - 401.0 / 2000.0)).abs() < 1e-9);
    let band = r#"<TransFuncIntensity><threshold x="0.3" y="0.7" /><Keys>
        <key><intensity value="0" /><split value="false" /><colorL r="0" g="0" b="0" a="255" /></key>
        <key><intensity value="1" /><split value="false" /><colorL r="0" g="0" b="0" a="255" /></key>
        </Keys></TransFuncIntensity>"#;
    let function = read("a.tfi", band.as_bytes()).unwrap();
    let found = [-500.0, -399.0, 399.0, 500.0].map(|value| function.opacity_at(value));
    assert!(found[0] == 0.0 && found[1] > 0.99 && found[2] > 0.99 && found[3] == 0.0, "{found:?}");
}

#[test]
fn agaves_channels() {
    let file = |curve: &str| {
        format!(
            r#"{{"channels": [{{"enabled": false, "lutParams": {{}}}},
            {{"enabled": true, "opacity": 0.5, "diffuseColor": [1, 0.5, 0], "lutParams": {{{curve}}}}}]}}"#
        )
    };
    let read = |curve: &str| read("a.json", file(curve).as_bytes());
    let window = read(r#""mode": 0, "level": 0.5, "window": 0.25"#).unwrap();
    let ends: Vec<_> = window.points.iter().map(|point| (point.value, point.opacity)).collect();
    assert_eq!(ends, [(-250.0, 0.0), (250.0, 0.5)]);
    assert_eq!(window.points[0].color, [1.0, 0.5, 0.0]);
    let iso = read(r#""mode": 1, "isovalue": 0.5, "isorange": 0.1"#).unwrap();
    assert_eq!((iso.opacity_at(-101.0), iso.opacity_at(101.0)), (0.0, 0.0));
    assert!((iso.opacity_at(0.0) - 0.5).abs() < 1e-12);
    let points =
        r#""mode": 3, "controlPoints": [{"x": 0, "value": [0,0,0,0]}, {"x": 1, "value": [1,1,1,1]}]"#;
    assert_eq!(read(points).unwrap().points[1].opacity, 0.5);
    for (curve, what) in [
        (r#""mode": 0, "level": 0.5"#, "window"),
        (r#""mode": 3"#, "controlPoints"),
        (r#""mode": 3, "controlPoints": [{"x": 0, "value": [1]}]"#, "four numbers"),
    ] {
        let err = read(curve).unwrap_err();
        assert!(err.contains(what), "{err}");
    }
}

#[test]
fn what_is_not_straight_elsewhere_gets_more_points() {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let before = TransferFunction {
        points: vec![point(0.0, 0.0), point(100.0, 0.8)],
        interpolation: OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    };
    let after = read("a.vp", &export_transfer(Path::new("a.vp"), &before, RANGE).unwrap()).unwrap();
    for value in [10.0, 50.0, 90.0] {
        let apart = (after.opacity_at(value) - before.opacity_at(value)).abs();
        assert!(apart < 0.01, "{value}: {apart}");
    }
    // A jump at the end remains one in byte positions.
    let mut plateau = TransferFunction { interpolation: OpacityInterpolation::Opacity, ..before };
    plateau.points.insert(1, ControlPoint { easing: Easing::Step, ..point(50.0, 0.8) });
    plateau.points[2].opacity = 0.0;
    let after = read("a.clut", &export_transfer(Path::new("a.clut"), &plateau, RANGE).unwrap()).unwrap();
    assert!(after.opacity_at(95.0) > 0.78 && after.opacity_at(100.0) < 0.01);
    plateau.points.truncate(1);
    assert!(read("a.clut", &export_transfer(Path::new("a.clut"), &plateau, RANGE).unwrap()).is_ok());
}

#[test]
fn numbers_without_end_are_refused() {
    let far = r#"<a><point><pos x="1e308"/><rgba x="1" y="1" z="1" w="1"/></point></a>"#;
    assert!(read("a.itf", far.as_bytes()).unwrap_err().contains("beyond"));
    let many: String = (0..5000).map(|_| "0 0.5 ").collect();
    let text = format!("10000 {many}\n2 0 1\n4 0 1 1 1\n");
    assert!(read("a.vp", text.as_bytes()).unwrap_err().contains("5000 points"));
    assert!(read("a.clut", "x".repeat(MAX_CLUT_BYTES + 1).as_bytes()).unwrap_err().contains("longer"));
}

#[test]
fn a_comma_too_many_is_forgiven() {
    let text = b"[{\"RGBPoints\": [2, 0, 0, 0, 4, 1, 1, 1]},\n]\n";
    assert_eq!(read("a.json", text).unwrap().points.len(), 2);
}

#[test]
fn xml_that_would_take_long_is_refused() {
    for (words, text) in slow_texts("InviwoTransferFunction") {
        for name in ["a.itf", "a.tfi"] {
            let error = read(name, text.as_bytes()).unwrap_err();
            assert!(error.contains(words) && error.lines().count() == 1, "{name}: {error}");
        }
    }
}

#[test]
fn other_xml_and_json_are_refused_in_words() {
    for (name, text, what) in [
        ("a.itf", "no XML", "XML"),
        ("a.itf", "<a/>", "no points"),
        ("a.itf", "<a><point/></a>", "no pos"),
        ("a.itf", r#"<a><point><pos x="q"/><rgba/></point></a>"#, "not a number"),
        ("a.tfi", "<a/>", "TransFuncIntensity"),
        ("a.tfi", "<TransFuncIntensity/>", "no keys"),
        ("a.tfi", "<TransFuncIntensity><key/></TransFuncIntensity>", "no intensity"),
        ("a.vp.json", r#"{"volumeProperties": []}"#, "no component"),
        ("a.vp.json", r#"{"volumeProperties": [{"components": [{}]}]}"#, "scalarOpacity"),
        ("a.json", r#"{"channels": []}"#, "no channels"),
        ("a.json", r#"{"transfer": {"points": 3}}"#, "wrong type or value"),
    ] {
        let err = read(name, text.as_bytes()).unwrap_err();
        assert!(err.contains(what), "{name} {text}: {err}");
    }
}

#[test]
fn curves_are_read_from_presets_and_from_sessions_of_every_schema() {
    let settings = Preset::find("mr/head").unwrap().apply(&Settings::default(), &ValueRanges::UNIT).unwrap();
    let function = serde_json::to_value(&settings.layer().transfer).unwrap();
    let before = serde_json::json!({"schema": 2, "transfer": function});
    for text in [before.to_string(), crate::settings_to_json(&settings)] {
        assert_eq!(read("a.json", text.as_bytes()).unwrap(), settings.layer().transfer);
    }
}

#[test]
fn maps_of_paraview_are_read_back() {
    for name in ["ct/bone", "mr/head", "simulation/signed"] {
        let preset = Preset::find(name).unwrap();
        let before = preset.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().layer().transfer.clone();
        let after = read("a.json", &export_transfer(Path::new("a.json"), &before, RANGE).unwrap()).unwrap();
        assert_eq!(after.points.len(), before.points.len());
        for (a, b) in after.points.iter().zip(&before.points) {
            assert!((a.value - b.value).abs() < 1e-12 && (a.opacity - b.opacity).abs() < 1e-12);
            assert!(a.color.iter().zip(&b.color).all(|(a, b)| (a - b).abs() < 1e-6), "{name}");
        }
    }
}

#[test]
fn colors_and_opacities_may_stand_at_different_values() {
    let text = r#"[{"Name": "x", "ColorSpace": "Diverging",
        "RGBPoints": [0, 0.0, 0.0, 1.0, 10, 1.0, 0.0, 0.0],
        "Points": [0, 0.0, 0.5, 0.0, 5, 0.8, 0.5, 0.0, 10, 0.2, 0.5, 0.0]}]"#;
    let function = read("a.json", text.as_bytes()).unwrap();
    let middle = function.points[1];
    assert_eq!((middle.value, middle.opacity, middle.color), (5.0, 0.8, [0.5, 0.0, 0.5]));
    let colors = read("a.json", br#"{"RGBPoints": [2, 0, 0, 0, 4, 1, 1, 1]}"#).unwrap();
    assert_eq!((colors.points[0].opacity, colors.points[1].opacity), (0.0, 1.0));
}

#[test]
fn other_maps_of_paraview_are_refused_in_words() {
    for (text, what) in [
        ("{", "JSON"),
        ("[]", "no colour map"),
        (r#"{"points": 3}"#, "RGBPoints"),
        (r#"{"RGBPoints": [1, 2, 3]}"#, "red, green and blue"),
        (r#"{"RGBPoints": [1, "a", 3, 4]}"#, "other than numbers"),
        (r#"{"RGBPoints": [1, 0, 0, 0], "Points": [1]}"#, "four numbers"),
    ] {
        let err = read("a.json", text.as_bytes()).unwrap_err();
        assert!(err.contains(what), "{text}: {err}");
    }
}

#[test]
fn slicers_volume_properties() {
    let text = "1\n1\n0.9\n0.1\n0.2\n10\n6 -100 0 50 0.5 300 2\n4 0 1 255 1\n8 -100 0 0 0 300 1 0.5 0\n";
    let function = read("bone.VP", text.as_bytes()).unwrap();
    let [low, middle, high] = function.points[..] else { panic!("{function:?}") };
    assert_eq!((low.value, low.opacity, high.value, high.opacity), (-100.0, 0.0, 300.0, 1.0));
    assert_eq!((middle.value, middle.opacity), (50.0, 0.5));
    assert!((middle.color[0] - 0.375).abs() < 1e-6, "between the colours: {middle:?}");
}

#[test]
fn mricrogls_tables() {
    let text = "[FLT]\nmin=0\nmax=0\n[INT]\nnumnodes=2\n[BYT]\nnodeintensity0=0\nnodeintensity1=255\n\
                [RGBA255]\nnodergba0=0|0|0|0\nnodergba1=255|51|0|102\n";
    let function = read("hot.clut", text.as_bytes()).unwrap();
    let [low, high] = function.points[..] else { panic!("{function:?}") };
    assert_eq!((low.value, low.opacity), (-1000.0, 0.0), "over the volume's range");
    assert_eq!((high.value, high.opacity, high.color), (1000.0, 0.4, [1.0, 0.2, 0.0]));
    let own = text.replace("min=0", "min=20").replace("max=0", "max=70");
    assert_eq!(read("hot.clut", own.as_bytes()).unwrap().points[1].value, 70.0);
}

#[test]
fn imagejs_tables() {
    let table: Vec<u8> = (0..768).map(|at| if at < 256 { at as u8 } else { 0 }).collect();
    let header = [b"ICOL".as_slice(), &[0; 28]].concat();
    let rows: Vec<String> = (0..256).map(|at| format!("{at}\t{at}\t0\t0")).collect();
    let plain = read("red.lut", &table).unwrap();
    assert_eq!(plain, read("red.lut", &[header.as_slice(), &table].concat()).unwrap());
    assert_eq!(
        plain,
        read("red.lut", format!("Index\tRed\tGreen\tBlue\n{}", rows.join("\n")).as_bytes()).unwrap()
    );
    assert_eq!(plain.points.len(), 17);
    assert_eq!((plain.points[16].value, plain.points[16].color), (1000.0, [1.0, 0.0, 0.0]));
    assert_eq!((plain.points[0].value, plain.points[0].opacity), (-1000.0, 0.0));
}

#[test]
fn other_files_are_refused_in_words() {
    for (name, bytes, what) in [
        ("a.vp", b"1\n1\n".as_slice(), "three lists"),
        ("a.vp", b"3 1 2\n", "its first number states"),
        ("a.vp", b"3 0 1 2\n2 0 1\n4 0 0 0 0\n", "cut off"),
        ("a.vp", b"hello", "other than numbers"),
        ("a.clut", b"numnodes=1", "2 to 256"),
        ("a.clut", b"numnodes=2", "nodeintensity0"),
        ("a.clut", b"numnodes=2\nnodeintensity0=1\nnodergba0=1|2|3", "four numbers"),
        ("a.lut", &[200; 700], "768 bytes"),
        ("a.lut", b"1 2 3\n", "256"),
        ("a.json", b"{", "JSON"),
        ("a.json", &[0xff, 0xfe], "not UTF-8 text"),
    ] {
        let err = read(name, bytes).unwrap_err();
        assert!(err.contains(what), "{name}: {err}");
    }
}

#[test]
fn files_that_are_longer_than_functions_are_not_made_into_trees() {
    let long = format!("{{\"transfer\": {{\"points\": [{}{{}}]}}}}", "0,".repeat(MAX_JSON_BYTES / 2));
    let refused =
        import_transfer(Path::new("a.json"), long.as_bytes(), ValueRange::UNIT).unwrap_err().to_string();
    assert!(refused.contains("longer than a transfer function can be"), "{refused}");
    // So is a function with more points than are allowed.
    let point = "{\"value\":0,\"opacity\":0.5}";
    let many =
        format!("{{\"transfer\": {{\"points\": [{}{point}]}}}}", format!("{point},").repeat(MAX_POINTS));
    let function = import_transfer(Path::new("a.json"), many.as_bytes(), ValueRange::UNIT).unwrap();
    assert_eq!(function.points.len(), MAX_POINTS);
}
