//! Source files of the project, its crates, and the modules that they define.

use std::fs;
use std::path::Path;

/// Source file with its path and text.
pub(crate) struct SourceFile {
    /// Path below the folder that was searched, with `/` between folders.
    pub(crate) path: String,
    pub(crate) text: String,
}

impl SourceFile {
    /// Module path below the root of its crate, for a path below the crate's sources: folders and stem, without `mod`;
    /// empty for the root itself.
    pub(crate) fn module_path(&self) -> Vec<&str> {
        let stem = self.path.strip_suffix(".rs").unwrap_or(&self.path);
        stem.split('/').filter(|part| !["mod", "lib"].contains(part)).collect()
    }
}

/// Crates of the project from the lowest layer up, each with the folder of its sources and the crates that it may
/// depend on.
pub(crate) const LAYERS: [(&str, &str, &[&str]); 10] = [
    ("chiaroscuro-files", "crates/files/src", &[]),
    ("chiaroscuro-codecs", "crates/codecs/src", &[]),
    ("chiaroscuro-volume", "crates/volume/src", &["files"]),
    ("chiaroscuro-volume-io", "crates/volume-io/src", &["codecs", "files", "volume"]),
    ("chiaroscuro-scene", "crates/scene/src", &["files", "volume"]),
    ("chiaroscuro-media", "crates/media/src", &["files", "scene", "volume"]),
    ("chiaroscuro-render", "crates/render/src", &["files", "media", "scene", "volume"]),
    ("chiaroscuro-reference", "crates/reference/src", &["render", "scene", "volume"]),
    ("chiaroscuro-python", "python/src", &["files", "media", "render", "scene", "volume", "volume-io"]),
    ("chiaroscuro", "src", &["files", "media", "render", "scene", "volume", "volume-io"]),
];

/// Sources of all crates, with paths below the top folder of the project.
pub(crate) fn all_sources() -> Vec<SourceFile> {
    let below = |(_, folder, _): (&str, &str, &[&str])| {
        source_files(folder, "rs")
            .into_iter()
            .map(|file| SourceFile { path: format!("{folder}/{}", file.path), ..file })
            .collect::<Vec<_>>()
    };
    LAYERS.into_iter().flat_map(below).collect()
}

/// Paths of all files below a folder of the project, sorted.
pub(crate) fn file_paths(folder: &str) -> Vec<String> {
    fn walk(folder: &Path, root: &Path, found: &mut Vec<String>) {
        for entry in fs::read_dir(folder).expect("the folder can be listed") {
            let path = entry.expect("the folder can be listed").path();
            if path.is_dir() {
                walk(&path, root, found);
            } else {
                let below = path.strip_prefix(root).expect("it is below");
                found.push(below.to_string_lossy().replace('\\', "/"));
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut found = Vec::new();
    walk(&root, &root, &mut found);
    found.sort();
    found
}

/// All files below a folder of the project with this extension.
pub(crate) fn source_files(folder: &str, ending: &str) -> Vec<SourceFile> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let text = |path: &str| fs::read_to_string(root.join(path)).expect("sources are text");
    file_paths(folder)
        .into_iter()
        .filter(|path| Path::new(path).extension().is_some_and(|found| found == ending))
        .map(|path| SourceFile { text: text(&path), path })
        .collect()
}
