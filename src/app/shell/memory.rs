//! What is remembered from one run to the next: files that were opened, and the look as it was at last.

use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::data::read_small;

/// Files that the menu offers.
const MOST_RECENT: usize = 12;
/// The look is kept at most so often.
const KEEP_EVERY: Duration = Duration::from_secs(5);

/// Writes files on a thread of its own, one after the other, since a disk may take its time. Dropping this waits
/// until all is written.
#[derive(Debug)]
struct Writer {
    /// Name and text; none when there is nothing more to come.
    queue: Option<mpsc::Sender<(&'static str, String)>>,
    thread: Option<JoinHandle<()>>,
}

impl Writer {
    fn new(folder: &Path) -> std::io::Result<Self> {
        let folder = folder.to_owned();
        let (queue, due) = mpsc::channel::<(&str, String)>();
        let thread = std::thread::Builder::new().name("memory".to_owned()).spawn(move || {
            for (name, text) in due {
                if let Err(err) = crate::export::write_atomically(&folder.join(name), text.as_bytes()) {
                    log::warn!("{name} was not kept: {err}");
                }
            }
        })?;
        Ok(Self { queue: Some(queue), thread: Some(thread) })
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.queue = None;
        // That it panicked is logged where it did.
        self.thread.take().map(JoinHandle::join);
    }
}

/// Files in the folder that the system gives us; without one, nothing is remembered.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    folder: Option<PathBuf>,
    writer: Option<Writer>,
    recent: Vec<String>,
    /// The look of the run before.
    before: Option<PathBuf>,
    /// There was no run before.
    is_first: bool,
    /// The look that was written last, and when.
    kept: Option<(String, Instant)>,
}

impl Memory {
    /// Remembers what was written to a folder. The look of the run before is put aside.
    pub(crate) fn new(folder: Option<PathBuf>) -> Self {
        let mut memory = Self { folder, ..Self::default() };
        if let Some(folder) = &memory.folder {
            memory.is_first = !["now.json", "before.json"].iter().any(|name| folder.join(name).exists());
            std::fs::create_dir_all(folder).ok();
            std::fs::rename(folder.join("now.json"), folder.join("before.json")).ok();
            memory.before = Some(folder.join("before.json")).filter(|path| path.exists());
            let list = read_small(&folder.join("recent.json")).unwrap_or_default();
            memory.recent = serde_json::from_slice(&list).unwrap_or_default();
            memory.recent.truncate(MOST_RECENT);
            match Writer::new(folder) {
                Ok(writer) => memory.writer = Some(writer),
                Err(err) => log::warn!("nothing will be remembered: {err}"),
            }
        }
        memory
    }

    /// Whether nobody has used the program here before.
    pub(crate) fn is_first(&self) -> bool {
        self.is_first
    }

    /// What was opened, the latest first.
    pub(crate) fn recent(&self) -> &[String] {
        &self.recent
    }

    /// Takes note of a file that was opened. Built-in volumes have a menu of their own.
    pub(crate) fn opened(&mut self, source: &str) {
        if source.starts_with("builtin:") {
            return;
        }
        let whole =
            std::path::absolute(source).map_or_else(|_| source.to_owned(), |path| path.display().to_string());
        self.recent.retain(|known| *known != whole);
        self.recent.insert(0, whole);
        self.recent.truncate(MOST_RECENT);
        self.write("recent.json", serde_json::to_string_pretty(&self.recent).unwrap_or_default());
    }

    /// The look of the run before, if there is one.
    pub(crate) fn before(&self) -> Option<&Path> {
        self.before.as_deref()
    }

    /// Whether it is time to keep the look.
    pub(crate) fn is_due(&self) -> bool {
        self.folder.is_some() && self.kept.as_ref().is_none_or(|(_, when)| when.elapsed() > KEEP_EVERY)
    }

    /// Keeps the look, unless it is as it was.
    pub(crate) fn keep(&mut self, text: String) {
        if self.kept.as_ref().is_none_or(|(known, _)| *known != text) {
            self.write("now.json", text.clone());
        }
        self.kept = Some((text, Instant::now()));
    }

    fn write(&self, name: &'static str, text: String) {
        if let Some(queue) = self.writer.as_ref().and_then(|writer| writer.queue.as_ref())
            && queue.send((name, text)).is_err()
        {
            log::warn!("{name} was not kept: its thread has ended");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_the_last_look_are_remembered() {
        let folder = tempfile::tempdir().unwrap();
        let remember = || Memory::new(Some(folder.path().to_owned()));
        let mut memory = remember();
        assert!(memory.recent().is_empty() && memory.before().is_none() && memory.is_due());
        assert!(memory.is_first());
        for file in ["/a.nrrd", "/b.nrrd", "builtin:chair", "/a.nrrd"] {
            memory.opened(file);
        }
        memory.keep("{\"look\": 1}".to_owned());
        assert!(!memory.is_due());
        drop(memory);
        let memory = remember();
        assert!(!memory.is_first());
        assert_eq!(memory.recent(), ["/a.nrrd", "/b.nrrd"]);
        assert_eq!(std::fs::read_to_string(memory.before().unwrap()).unwrap(), "{\"look\": 1}");
        for at in 0..2 * MOST_RECENT {
            remember().opened(&format!("/{at}.nrrd"));
        }
        assert_eq!(remember().recent().len(), MOST_RECENT);
    }

    #[test]
    fn damaged_files_are_nothing_and_no_folder_remembers_nothing() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("recent.json"), "{nonsense").unwrap();
        assert!(Memory::new(Some(folder.path().to_owned())).recent().is_empty());
        let mut memory = Memory::new(None);
        memory.opened("/a.nrrd");
        memory.keep("x".to_owned());
        assert!(!memory.is_due() && memory.before().is_none());
    }
}
