//! Record of the files that are read, so that no output overwrites one of them: a header names others, and a slice
//! brings its series.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};

type Paths = Mutex<BTreeSet<PathBuf>>;

/// Recorders that are still alive.
static RECORDERS: Mutex<Vec<Weak<Paths>>> = Mutex::new(Vec::new());

/// Files that any thread of this process has read voxels or metadata from since this recorder was made.
#[derive(Debug)]
pub struct ReadFiles(Arc<Paths>);

impl ReadFiles {
    /// Starts recording the files that are read.
    pub fn record() -> Self {
        let paths = Arc::<Paths>::default();
        let mut watches = RECORDERS.lock().unwrap_or_else(PoisonError::into_inner);
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
pub(crate) fn record_read(path: &Path) {
    for watch in RECORDERS.lock().unwrap_or_else(PoisonError::into_inner).iter().filter_map(Weak::upgrade) {
        watch.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_are_recorded_while_a_recorder_exists() {
        let name = Path::new("files_are_noted_while_somebody_wants_to_know");
        record_read(name);
        let [first, second] = [ReadFiles::record(), ReadFiles::record()];
        let has = |watch: &ReadFiles| watch.paths().iter().any(|path| path == name);
        assert!(!has(&first));
        record_read(name);
        assert!(has(&first) && has(&second) && !has(&ReadFiles::record()));
    }
}
