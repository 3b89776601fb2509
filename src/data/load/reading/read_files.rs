//! Which files are read, for who must not write over one of them: a header names others, and a slice brings its series.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};

type Paths = Mutex<BTreeSet<PathBuf>>;

/// Who wants to know.
static WATCHES: Mutex<Vec<Weak<Paths>>> = Mutex::new(Vec::new());

/// The files that any thread of this process has read voxels, or what is said of them, from since it was made.
#[derive(Debug)]
pub struct ReadFiles(Arc<Paths>);

impl ReadFiles {
    /// Begins to take notes.
    pub fn watch() -> Self {
        let paths = Arc::<Paths>::default();
        let mut watches = WATCHES.lock().unwrap_or_else(PoisonError::into_inner);
        watches.retain(|watch| watch.strong_count() > 0);
        watches.push(Arc::downgrade(&paths));
        Self(paths)
    }

    /// What was read until now, by the names that it was opened by.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }
}

/// Notes that a file is read.
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
