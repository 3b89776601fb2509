//! Check that every shader file is embedded, imported where needed, and included once.

use std::collections::BTreeSet;

use chiaroscuro_render::{SHADERS, ShaderLibrary};
use wgpu::TextureFormat;

use crate::sources::{entry_shaders, imports_of, shader_source};

#[test]
fn every_shader_file_is_embedded_and_used() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut on_disk = BTreeSet::new();
    let mut open = vec![root.clone()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).expect("the folder of shaders is there") {
            let path = entry.expect("it can be listed").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|ending| ending == "wgsl") {
                let below = path.strip_prefix(&root).expect("it is below");
                on_disk.insert(below.to_string_lossy().replace('\\', "/"));
            }
        }
    }
    let embedded: BTreeSet<_> = SHADERS.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(on_disk, embedded);

    let imported: BTreeSet<_> = SHADERS.iter().flat_map(|(_, text)| imports_of(text)).collect();
    let entries = entry_shaders();
    for &(name, _) in SHADERS {
        assert!(entries.contains(&name) || imported.contains(name), "{name} is in no shader");
    }
}

#[test]
fn imports_of_missing_files_are_errors() {
    let err = ShaderLibrary::source("common/missing.wgsl", TextureFormat::R16Float, TextureFormat::R16Float)
        .expect_err("there is no such file");
    assert!(err.to_string().contains("common/missing.wgsl"), "{err}");
    for (name, text) in SHADERS {
        for import in imports_of(text) {
            assert!(SHADERS.iter().any(|(known, _)| *known == import), "{name} imports {import}");
        }
    }
}

#[test]
fn every_imported_file_appears_exactly_once() {
    for name in entry_shaders() {
        let source = shader_source(name);
        assert!(!source.contains("#import"), "{name}: an import was not resolved");
        // Expected files: the shader and its direct and indirect imports.
        let mut wanted = BTreeSet::from([name]);
        let mut open = vec![name];
        while let Some(next) = open.pop() {
            let (_, text) = SHADERS.iter().find(|(known, _)| *known == next).expect("imports exist");
            open.extend(imports_of(text).into_iter().filter(|import| wanted.insert(import)));
        }
        for (file, text) in SHADERS {
            let first_line = text.lines().next().expect("no shader is empty");
            let expected = usize::from(wanted.contains(file));
            assert_eq!(source.matches(first_line).count(), expected, "{file} in {name}");
        }
    }
}
