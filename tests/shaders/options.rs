//! Check that options of shaders are declared once, where they are used, and that the host sets no others.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use chiaroscuro_render::{SHADERS, ShaderLibrary, shader_conditions};
use wgpu::TextureFormat;

/// Options that a source declares by `#option NAME: meaning`.
fn options_of(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("#option ")?.split(':').next())
}

/// Override constants that a source declares.
fn overrides_of(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("override ")?.split(':').next())
}

/// Names that a source of the host sets: capitals that open a pair, or the arguments of `flag`.
fn names_set_by(code: &str) -> Vec<&str> {
    let opened = code.split("(\"").skip(1).filter_map(|rest| rest.split_once("\","));
    let is_capital = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
    // Formats of textures are replaced in the text.
    let is_option =
        |name: &&str| !name.is_empty() && name.chars().all(is_capital) && !name.ends_with("_FORMAT");
    opened.map(|(name, _)| name).filter(is_option).collect()
}

/// Names that a source of the host sets and no shader declares.
fn undeclared_names(code: &str) -> Vec<&str> {
    let declared: BTreeSet<_> =
        SHADERS.iter().flat_map(|(_, text)| options_of(text).chain(overrides_of(text))).collect();
    names_set_by(code).into_iter().filter(|name| !declared.contains(name)).collect()
}

/// Contents of the Rust files below a folder, without tests in files of their own.
fn rust_sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("it can be listed").path();
        if path.is_dir() {
            if path.file_name().is_some_and(|name| name != "tests") {
                rust_sources(&path, found);
            }
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).expect("it can be read");
            let code = text.split("#[cfg(test)]").next().expect("text before tests").to_owned();
            found.push((path.display().to_string(), code));
        }
    }
}

#[test]
fn every_file_declares_or_imports_the_options_that_it_uses() {
    for (name, _) in SHADERS {
        let source = ShaderLibrary::source(name, TextureFormat::R16Float, TextureFormat::R16Float);
        assert!(source.is_ok(), "{name}: {:?}", source.err());
    }
}

#[test]
fn options_are_declared_once_and_used() {
    let mut declared = BTreeMap::new();
    for (file, text) in SHADERS {
        for option in options_of(text) {
            assert_eq!(
                declared.insert(option, file),
                None,
                "{option} is declared in {file} and another file"
            );
        }
    }
    assert!(declared.len() >= 12, "the check must see the options: {declared:?}");
    let is_used = |name: &str| {
        let conditions = SHADERS.iter().flat_map(|(_, text)| text.lines());
        conditions
            .filter_map(|line| line.strip_prefix("#if "))
            .any(|rest| rest.split(' ').next() == Some(name))
    };
    for (option, file) in &declared {
        assert!(is_used(option), "{option} of {file} decides nothing");
        assert!(shader_conditions().any(|known| known == *option), "{option} is in no variant");
    }
}

#[test]
fn the_host_sets_declared_options_only() {
    let mut sources = Vec::new();
    rust_sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/render/src"), &mut sources);
    let set: BTreeSet<_> = sources.iter().flat_map(|(_, code)| names_set_by(code)).collect();
    for name in ["FACES", "KERNEL", "DIRECT", "SHADOWED", "ONE_COLOR", "LINEAR_TARGET"] {
        assert!(set.contains(name), "the check must see {name}: {set:?}");
    }
    for (path, code) in &sources {
        assert_eq!(undeclared_names(code), [""; 0], "{path}");
    }
    // Guards the check itself: other names are noticed.
    let wrong = "constants.extend([flag(\"CORNERS\", true), (\"KERNEL\", 2.0), (\"EDGES\", 1.0)]);";
    assert_eq!(undeclared_names(wrong), ["CORNERS", "EDGES"]);
}
