//! Tests of the command `convert`: the written volume is the one that was read, in another format, cropped,
//! reoriented or in another voxel type.

use serde_json::Value;

use crate::program::ProgramFolder;
use crate::volumes::{attached, gzipped, header};

/// File extensions of all output formats.
const EXTENSIONS: [&str; 11] =
    ["nrrd", "mha", "nii", "nii.gz", "tif", "tiff", "npy", "vti", "ome.zarr", "ozx", "zarr.zip"];

fn info_json(folder: &ProgramFolder, file: &str) -> Value {
    serde_json::from_str(&folder.run_successfully(&format!("info {file} --json"))).expect("valid JSON")
}

/// NRRD file of 4 × 3 × 2 voxels of a body, with much metadata.
fn ct_nrrd() -> Vec<u8> {
    let header = header(
        "sizes: 4 3 2\nspace: left-posterior-superior\nspace directions: (0,0.5,0) (-0.75,0,0) (0,0,2)\n\
         space origin: (10,-20,30)\nsample units: \"HU\"\ncontent: a chest\nmodality:=CT\npadding value:=5\n\
         acquisition:=thin slices",
    );
    let mut bytes = header.replace("uint8", "int16\nendian: little").into_bytes();
    bytes.extend((0..24i16).flat_map(|at| (100 * at - 995).to_le_bytes()));
    bytes
}

#[test]
fn info_agrees_before_and_after_conversion() {
    let folder = ProgramFolder::new();
    folder.write("ct.nrrd", ct_nrrd());
    let wanted = info_json(&folder, "ct.nrrd");
    assert_eq!((&wanted["hints"]["modality"], &wanted["is_anatomical"]), (&"ct".into(), &true.into()));
    for ending in EXTENSIONS {
        folder.run_successfully(&format!("convert ct.nrrd out.{ending}"));
        let found = info_json(&folder, &format!("out.{ending}"));
        for same in ["dims", "type", "range", "non_finite_voxels"] {
            assert_eq!(found[same], wanted[same], "{ending}: {same}");
        }
        let has_place = ["nrrd", "mha", "nii", "nii.gz", "vti"].contains(&ending);
        for place in ["spacing_mm", "world_from_index"] {
            assert_eq!(
                found[place] == wanted[place],
                has_place || (ending != "npy" && place == "spacing_mm"),
                "{ending}"
            );
        }
        assert_eq!(found["is_anatomical"], has_place && ending != "vti", "{ending}");
    }
    for file in ["nrrd.nrrd", "nrrd.nrrd --compress", "mha.mha", "mha.mha --compress"] {
        folder.run_successfully(&format!("convert ct.nrrd {file}"));
        let found = info_json(&folder, file.split(' ').next().unwrap_or_default());
        for (key, value) in wanted.as_object().expect("an object") {
            if key != "format" {
                assert_eq!(&found[key], value, "{file}: {key}");
            }
        }
        assert_eq!(found["format"], if file.starts_with("mha") { "MetaImage" } else { "NRRD" }, "{file}");
    }
}

#[test]
fn dropped_metadata_is_reported() {
    let folder = ProgramFolder::new();
    folder.write("ct.nrrd", ct_nrrd());
    let outcome = folder.run("convert ct.nrrd out.npy");
    let said = &outcome.stderr;
    assert!(outcome.code == Some(0) && said.starts_with("warning: .npy does not store"), "{outcome:?}");
    for lost in ["the voxel size", "axis directions", "padding", "unit"] {
        assert!(said.contains(lost), "{lost}: {said}");
    }
    assert_eq!(folder.run("convert ct.nrrd out.mha").stderr, "");
}

#[test]
fn parts_turns_and_numbers() {
    let folder = ProgramFolder::new();
    folder.write("ct.nrrd", ct_nrrd());
    folder.run_successfully("convert ct.nrrd part.nrrd --region 1:3,:,1:");
    let (part, whole) = (info_json(&folder, "part.nrrd"), info_json(&folder, "ct.nrrd"));
    assert_eq!(part["dims"], serde_json::json!([2, 3, 1]));
    assert_eq!(part["range"], serde_json::json!([305.0, 1205.0]));
    let number = |facts: &Value, at: usize| facts["world_from_index"][at].as_f64().expect("a number");
    // The first voxel is one further along x and z.
    for axis in 9..12 {
        let wanted = number(&whole, axis) + number(&whole, axis - 9) + number(&whole, axis - 3);
        assert!((number(&part, axis) - wanted).abs() < 1e-12, "{axis}");
    }
    folder.run_successfully("convert ct.nrrd ras.nrrd --orient RAS");
    let ras = info_json(&folder, "ras.nrrd");
    assert_eq!(ras["dims"], serde_json::json!([3, 4, 2]));
    assert_eq!(ras["spacing_mm"], serde_json::json!([0.75, 0.5, 2.0]));
    assert!([0, 4, 8].iter().all(|&at| number(&ras, at) > 0.0), "{ras}");
    // Reoriented back, and nothing is lost.
    folder.run_successfully("convert ras.nrrd back.nrrd --orient PRS");
    folder.run_successfully("convert ct.nrrd once.nrrd --orient PRS");
    assert_eq!(folder.read("back.nrrd"), folder.read("once.nrrd"));
    // A region counts voxels of the file, and blocks are averaged in it.
    folder.run_successfully("convert builtin:sphere:16 half.nrrd --region 0:8,0:6,0:4 --reduce 2");
    assert_eq!(info_json(&folder, "half.nrrd")["dims"], serde_json::json!([4, 3, 2]));
    folder.run_successfully("convert ct.nrrd thin.nrrd --every 2");
    assert_eq!(info_json(&folder, "thin.nrrd")["dims"], serde_json::json!([2, 2, 1]));
    folder.run_successfully("convert ct.nrrd float.mha --type float32");
    assert_eq!(info_json(&folder, "float.mha")["type"], "float32");
    folder.run_successfully("convert ct.nrrd small.tif --type uint8 --rescale -1000:1000");
    let small = info_json(&folder, "small.tif");
    assert_eq!((&small["type"], &small["hints"]["padding"]), (&"uint8".into(), &0.0.into()));
    // RAW input, whose own voxel type has an option of another name here.
    folder.write("x.bin", [1u8, 0, 2, 0, 3, 0, 4, 1]);
    folder.run_successfully(
        "convert x.bin x.npy --dims 2x2x1 --input-type uint16 --endian little --type float64",
    );
    assert_eq!(info_json(&folder, "x.npy")["range"], serde_json::json!([1.0, 260.0]));
}

#[test]
fn unwritable_outputs_are_refused() {
    let folder = ProgramFolder::new();
    folder.write("ct.nrrd", ct_nrrd());
    folder.write("plain.nrrd", attached("sizes: 8 8 8", 512));
    folder.write("theirs.mha", "ObjectType = Image\nComment = somebody's\n");
    folder.write("theirs.nii.gz", gzipped(b"somebody's"));
    for (args, words) in [
        ("ct.nrrd out.mhd", &[".nrrd", ".mha", ".nii.gz", ".vti"][..]),
        ("ct.nrrd out", &[".nrrd"]),
        ("ct.nrrd ct.nrrd", &["would replace"]),
        ("ct.nrrd ./ct.nrrd --force", &["would replace"]),
        ("ct.nrrd theirs.mha", &["--force"]),
        ("ct.nrrd theirs.nii.gz", &["--force"]),
        ("ct.nrrd out.npy --compress", &["--compress", ".nrrd"]),
        ("ct.nrrd out.npy --format nrrd", &["--format"]),
        ("ct.nrrd out.nrrd --region 0:5,:,:", &["--region", "4 x 3 x 2"]),
        ("ct.nrrd out.nrrd --region 1:1,:,:", &["--region"]),
        ("ct.nrrd out.nrrd --region 1:2", &["0:64,0:64,10:20"]),
        ("ct.nrrd out.nrrd --orient RAX", &["LPS"]),
        ("plain.nrrd out.nrrd --orient RAS", &["plain.nrrd", "does not state the orientation of a body"]),
        ("ct.nrrd out.nrrd --type uint8", &["ct.nrrd", "-995", "1305", "--rescale"]),
        ("ct.nrrd out.nrrd --type complex", &["float32"]),
        ("ct.nrrd out.nrrd --rescale 3:1 --type uint8", &["-1000:3000"]),
    ] {
        let said = folder.run_failing(&format!("convert {args}"), 2);
        assert!(words.iter().all(|word| said.contains(word)), "{args}: {said}");
    }
    folder.run_failing("convert nothing.nrrd out.nrrd", 6);
    folder.run_failing("convert theirs.mha out.nrrd", 3);
    folder.run_failing("convert ct.nrrd no/such/folder/out.nrrd", 6);
    folder.run_successfully("convert ct.nrrd theirs.mha --force");
    // Files made by the program may be replaced by it.
    for ending in EXTENSIONS {
        folder.run_successfully(&format!("convert ct.nrrd o.{ending}"));
        if ending == "npy" {
            // NumPy arrays cannot state which program wrote them.
            folder.run_failing("convert ct.nrrd o.npy", 2);
        } else {
            folder.run_successfully(&format!("convert ct.nrrd o.{ending}"));
        }
    }
}

#[test]
fn folders_are_replaced_with_care() {
    let folder = ProgramFolder::new();
    folder.run_successfully("convert builtin:sphere:16 a.ome.zarr");
    folder.run_successfully("convert a.ome.zarr b.nrrd");
    for (args, words) in [
        ("a.ome.zarr a.ome.zarr --force", "would replace"),
        ("a.ome.zarr/zarr.json a.ome.zarr --force", "would replace"),
        ("a.ome.zarr/0 a.ome.zarr --force", "would replace"),
        ("b.nrrd - --format ome.zarr", "is a folder"),
    ] {
        let said = folder.run_failing(&format!("convert {args}"), 2);
        assert!(said.contains(words), "{args}: {said}");
    }
    folder.write("a.ome.zarr/zarr.json", "{}");
    let said = folder.run_failing("convert b.nrrd a.ome.zarr", 2);
    assert!(said.contains("--force"), "{said}");
    folder.run_successfully("convert b.nrrd a.ome.zarr --force");
    folder.write("a.ome.zarr/notes.txt", "mine");
    folder.run_failing("convert b.nrrd a.ome.zarr", 2);
    let said = folder.run_failing("convert b.nrrd a.ome.zarr --force", 6);
    assert!(said.contains("other files"), "{said}");
    assert_eq!(folder.read("a.ome.zarr/notes.txt"), b"mine");
}

/// Inputs are never replaced: besides the input file itself, data files that a header names, and the other files of a
/// folder or a slice.
#[test]
fn inputs_are_never_replaced() {
    let folder = ProgramFolder::new();
    let header = header("sizes: 4 4 2\ndata file: voxels.nii");
    folder.write("volume.nhdr", header);
    folder.write("voxels.nii", [7; 32]);
    folder.write("beside.nii", [7; 32]);
    std::fs::create_dir(folder.path("slices")).expect("room");
    for at in 0..2 {
        folder.run_successfully(&format!(
            "convert builtin:sphere:8 slices/{at}.tif --region :,:,{at}:{}",
            at + 1
        ));
    }
    for args in
        ["volume.nhdr voxels.nii", "slices slices/1.tif", "slices slices/../slices/0.tif --type float32"]
    {
        let said = folder.run_failing(&format!("convert {args} --force"), 2);
        assert!(said.contains("would replace") && said.contains("which is read"), "{args}: {said}");
    }
    assert_eq!(folder.read("voxels.nii"), [7; 32]);
    // Files beside them that are not read may be replaced.
    folder.run_successfully("convert volume.nhdr beside.nii --force");
    folder.run_successfully("convert slices slices/all.npy");
    folder.run_successfully("convert slices slices/all.npy --force");
}

#[test]
fn options_are_called_as_this_command_calls_them() {
    let folder = ProgramFolder::new();
    folder.write("a--type.bin", [0; 30]);
    for (command, own, other) in [
        ("info a--type.bin", " --type", "--input-type"),
        ("convert a--type.bin o.npy", "--input-type", " --type"),
    ] {
        for dims in ["", " --dims 2x3x4"] {
            let said = folder.run_failing(&format!("{command}{dims}"), 3);
            assert!(said.contains(own) && !said.contains(other) && said.contains("a--type.bin"), "{said}");
        }
    }
    folder.write("b.bin", [0; 48]);
    let said = folder.run_failing("convert b.bin o.npy --dims 2x3x4 --input-type uint8", 3);
    assert!(said.contains("try --input-type uint16"), "{said}");
}

#[cfg(unix)]
#[test]
fn devices_are_no_targets() {
    let folder = ProgramFolder::new();
    folder.write("ct.nrrd", ct_nrrd());
    std::os::unix::fs::symlink("/dev/null", folder.path("null.nrrd")).expect("a link");
    let said = folder.run_failing("convert ct.nrrd null.nrrd --force", 6);
    assert!(said.contains("device"), "{said}");
}

#[test]
fn standard_output_is_a_file_alone() {
    let folder = ProgramFolder::new();
    folder.write("ct.nrrd", ct_nrrd());
    let output = |args: &str| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_chiaroscuro"))
            .args(args.split_whitespace())
            .current_dir(folder.path(""))
            .output()
            .expect("the program can be started");
        assert!(output.status.success(), "{args}: {output:?}");
        output.stdout
    };
    folder.run_successfully("convert ct.nrrd file.nrrd");
    folder.run_successfully("convert ct.nrrd file.vti");
    assert_eq!(output("convert ct.nrrd -"), folder.read("file.nrrd"));
    assert_eq!(output("convert ct.nrrd - --format vti"), folder.read("file.vti"));
}
