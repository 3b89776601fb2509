//! Record of the files that are read, so that no output overwrites one of them: a header names others, and a slice
//! brings its series.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};

type Paths = Mutex<BTreeSet<PathBuf>>;

/// Recorders that are still alive.
static WATCHES: Mutex<Vec<Weak<Paths>>> = Mutex::new(Vec::new());

/// Files that any thread of this process has read voxels or metadata from since this recorder was made.
#[derive(Debug)]
pub struct ReadFiles(Arc<Paths>);

impl ReadFiles {
    /// Starts recording the files that are read.
    pub fn watch() -> Self {
        let paths = Arc::<Paths>::default();
        let mut watches = WATCHES.lock().unwrap_or_else(PoisonError::into_inner);
        watches.retain(|watch| watch.strong_count() > 0);
        watches.push(Arc::downgrade(&paths));
        Self(paths)
    }

    /// Paths that were read so far, as they were opened.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }
}

/// Adds a path to all active recorders.
pub(in crate::data::load) fn note(path: &Path) {
    for watch in WATCHES.lock().unwrap_or_else(PoisonError::into_inner).iter().filter_map(Weak::upgrade) {
        watch.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_noted_while_somebody_wants_to_know() {
        let name = Path::new("files_are_noted_while_somebody_wants_to_know");
        note(name);
        let [first, second] = [ReadFiles::watch(), ReadFiles::watch()];
        let has = |watch: &ReadFiles| watch.paths().iter().any(|path| path == name);
        assert!(!has(&first));
        note(name);
        assert!(has(&first) && has(&second) && !has(&ReadFiles::watch()));
    }
}
