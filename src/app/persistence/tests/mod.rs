//! Tests of the state that outlives a run.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

mod kills;

use super::*;
use chiaroscuro_scene::LookRecord;
use chiaroscuro_volume::ValueRanges;

/// Volume of an autosaved look.
fn volume(source: impl Into<PathBuf>, opened_id: u64) -> Vec<FieldOrigin> {
    vec![FieldOrigin { source: source.into(), opened_id, choice: VolumeChoice::default() }]
}

pub(super) fn remember(folder: &Path) -> PersistentState {
    PersistentState::new(Some(folder), &egui::Context::default())
}

/// Look that is recognised by its gain.
pub(super) fn look(gain: f64) -> Settings {
    let mut settings = Settings::default();
    settings.shadows.gain = gain;
    settings
}

pub(super) fn gain_of(path: &Path) -> f64 {
    let record = LookRecord::parse(&fs::read_to_string(path).unwrap()).unwrap();
    record.apply(&Settings::default(), &ValueRanges::UNIT).unwrap().settings.shadows.gain
}

fn wait_until(what: &str, condition: impl Fn() -> bool) -> Duration {
    let begin = Instant::now();
    while !condition() {
        assert!(begin.elapsed() < Duration::from_secs(20), "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
    begin.elapsed()
}

/// Simulates a killed process: no clean-up is done, and the system releases the lock.
fn kill(memory: PersistentState) {
    let PersistentState { keeper, run, .. } = memory;
    drop(keeper);
    let look = run.as_ref().unwrap().look.clone();
    drop(run);
    fs::File::create(look.with_extension("lock")).unwrap();
}

/// Paths of the recent files.
fn paths(memory: &PersistentState) -> Vec<PathBuf> {
    memory.recent().iter().map(|file| file.path.clone()).collect()
}

#[test]
fn a_temporary_file_is_in_no_list() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = remember(folder.path());
    let [copy, other] = ["copy.nrrd", "other.nrrd"].map(|name| folder.path().join(name));
    memory.set_temporary_file(&copy);
    let by = Corrections { spacing: Some([2.0; 3]), ..Corrections::default() };
    for file in [&copy, &other] {
        memory.add_recent(file, &VolumeChoice::default());
        memory.remember_corrections(file, FileStamp::default(), 1, by);
    }
    assert_eq!(paths(&memory), std::slice::from_ref(&other));
    assert!(memory.corrections_of(&copy).is_none() && memory.corrections_of(&other).is_some());
    memory.remember_up(&copy, SceneAxis::PlusY);
    assert_eq!(memory.up_of(&copy), None);
    memory.remember_up(&other, SceneAxis::PlusY);
    assert_eq!(memory.up_of(&copy), Some(SceneAxis::PlusY), "the folder has one");
}

#[test]
fn files_are_remembered_by_all_windows() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = remember(folder.path());
    assert!(memory.recent().is_empty() && memory.previous_look().is_none() && memory.is_first_use());
    for file in ["/a.nrrd", "/b.nrrd", "builtin:chair", "/a.nrrd"] {
        memory.add_recent(Path::new(file), &VolumeChoice::default());
    }
    let second = VolumeChoice { frame: Some(1), ..VolumeChoice::default() };
    // Another window that began earlier does not know these files.
    let mut other = remember(folder.path());
    drop(memory);
    other.add_recent(Path::new("/c.nrrd"), &second);
    drop(other);
    let memory = remember(folder.path());
    assert!(!memory.is_first_use());
    assert_eq!(paths(&memory), ["/c.nrrd", "/a.nrrd", "/b.nrrd"].map(PathBuf::from));
    let choices = memory.recent().iter().map(|file| file.choice.clone()).collect::<Vec<_>>();
    assert_eq!(choices, [second, VolumeChoice::default(), VolumeChoice::default()]);
    drop(memory);
    for at in 0..2 * recent_files::MAX_RECENT_FILES {
        remember(folder.path()).add_recent(Path::new(&format!("/{at}.nrrd")), &VolumeChoice::default());
    }
    assert_eq!(remember(folder.path()).recent().len(), recent_files::MAX_RECENT_FILES);
}

/// Names on Unix are bytes: not all are valid text, and some look like the encoding of others.
#[cfg(unix)]
#[test]
fn files_whose_names_are_no_text_are_remembered() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = tempfile::tempdir().unwrap();
    let names: [&[u8]; 4] =
        [b"/data/t\xfcr.nrrd", b"/data/t%FCr \xff.nrrd", b"/file:/%FC", "/data/tür.nrrd".as_bytes()];
    let names = names.map(|name| PathBuf::from(std::ffi::OsStr::from_bytes(name)));
    let mut memory = remember(folder.path());
    for name in names.iter().rev() {
        memory.add_recent(name, &VolumeChoice::default());
    }
    assert_eq!(paths(&memory), names);
    drop(memory);
    assert_eq!(paths(&remember(folder.path())), names);
    // An earlier version reads the list as well.
    let text = fs::read(folder.path().join("recent.json")).unwrap();
    assert_eq!(serde_json::from_slice::<Vec<String>>(&text).unwrap().len(), names.len());
}

#[test]
fn files_stand_as_those_of_their_folder_did() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b, other) = (Path::new("/data/a.nrrd"), Path::new("/data/b.raw"), Path::new("/data/more/a.nrrd"));
    let mut memory = remember(folder.path());
    assert_eq!(memory.up_of(a), None);
    memory.remember_up(a, SceneAxis::PlusX);
    memory.remember_up(a, SceneAxis::MinusY);
    memory.remember_up(Path::new("builtin:chair"), SceneAxis::PlusX);
    assert_eq!(
        [a, b, other].map(|file| memory.up_of(file)),
        [Some(SceneAxis::MinusY), Some(SceneAxis::MinusY), None]
    );
    // Another window that began earlier does not know these folders.
    let mut second = remember(folder.path());
    drop(memory);
    second.remember_up(other, SceneAxis::PlusY);
    drop(second);
    let mut memory = remember(folder.path());
    assert_eq!((memory.up_of(b), memory.up_of(other)), (Some(SceneAxis::MinusY), Some(SceneAxis::PlusY)));
    assert_eq!(memory.up_of(Path::new("builtin:chair")), None);
    memory.remember_up(b, SceneAxis::PlusZ);
    drop(memory);
    let mut memory = remember(folder.path());
    assert_eq!(memory.up_of(a), Some(SceneAxis::PlusZ), "what was chosen last");
    // The number of folders is limited; the oldest one goes.
    for at in 0..2 * folder_orientation::MAX_FOLDERS {
        memory.remember_up(Path::new(&format!("/{at}/a.nrrd")), SceneAxis::PlusX);
    }
    assert_eq!(memory.standing.len(), folder_orientation::MAX_FOLDERS);
    drop(memory);
    let memory = remember(folder.path());
    assert_eq!(memory.standing.len(), folder_orientation::MAX_FOLDERS);
    assert_eq!((memory.up_of(other), memory.up_of(Path::new("/199/b.raw"))), (None, Some(SceneAxis::PlusX)));
    drop(memory);
    fs::write(folder.path().join("standing.json"), "[{}]").unwrap();
    let mut memory = remember(folder.path());
    assert!(memory.standing.is_empty() && memory.take_notices().len() == 1, "put aside, and said");
}

#[test]
fn files_are_corrected_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let data = tempfile::tempdir().unwrap();
    let [file, other] = ["a.nrrd", "b.nrrd"].map(|name| data.path().join(name));
    fs::write(&file, "voxels").unwrap();
    let (stamp, no_stamp) = (FileStamp::read(&file), FileStamp::read(&other));
    let wide = Corrections { spacing: Some([0.5, 0.5, 2.0]), ..Corrections::default() };
    let mut memory = remember(folder.path());
    assert!(memory.corrections_of(&file).is_none());
    memory.remember_corrections(&file, stamp, 7, wide);
    memory.remember_corrections(&other, no_stamp, 9, Corrections { unit: wide.unit, ..wide });
    memory.remember_corrections(Path::new("builtin:chair"), no_stamp, 3, wide);
    assert!(memory.corrections_of(Path::new("builtin:chair")).is_none());
    drop(memory);
    let mut memory = remember(folder.path());
    let known = memory.corrections_of(&file).unwrap();
    // For an unmodified file, or one that holds the same volume nevertheless; not for another file at its path.
    assert_eq!(
        (known.corrections_for(stamp, 8), known.corrections_for(no_stamp, 7)),
        (Some(wide), Some(wide))
    );
    fs::write(&file, "other voxels").unwrap();
    assert_eq!(known.corrections_for(FileStamp::read(&file), 8), None);
    assert_eq!(memory.corrections_of(&other).unwrap().corrections_for(no_stamp, 8), None);
    // The absence of corrections need not be remembered.
    memory.remember_corrections(&file, stamp, 7, Corrections::default());
    assert!(memory.corrections_of(&file).is_none());
    for at in 0..2 * corrected_files::MAX_CORRECTED_FILES {
        let file = PathBuf::from(format!("/{at}.nrrd"));
        memory.remember_corrections(&file, stamp, at as u64, wide);
    }
    drop(memory);
    let memory = remember(folder.path());
    assert_eq!(memory.corrected.len(), corrected_files::MAX_CORRECTED_FILES);
    assert!(memory.corrections_of(Path::new("/1.nrrd")).is_none());
    assert_eq!(
        memory.corrections_of(Path::new("/999.nrrd")).unwrap().corrections_for(no_stamp, 999),
        Some(wide)
    );
    drop(memory);
    fs::write(folder.path().join("corrected.json"), "[{}]").unwrap();
    let mut memory = remember(folder.path());
    assert!(memory.corrected.is_empty() && memory.take_notices().len() == 1, "put aside, and said");
}

/// Checks that a change is written soon, though no frame or further change follows.
#[test]
fn the_last_change_is_kept_within_two_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = remember(folder.path());
    let file = memory.run.as_ref().unwrap().look.clone();
    memory.autosave(&look(1.5), volume("builtin:chair", 7));
    wait_until("the first look is kept", || file.exists());
    for gain in [2.0, 2.5, 3.0] {
        memory.autosave(&look(gain), volume("builtin:chair", 7));
    }
    let took = wait_until("the last look is kept", || gain_of(&file) == 3.0);
    assert!(took < Duration::from_secs(2), "{took:?}");
}

#[test]
fn looks_of_runs_that_were_cut_off_are_offered_until_the_user_knows() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = remember(folder.path());
    memory.autosave(&look(2.0), volume("/data/tooth.nrrd", 7));
    memory.autosave_thumbnail(Arc::new(ColorImage::filled([40, 20], egui::Color32::RED)));
    kill(memory);
    // Starts and ends of other runs do not remove the look.
    for _ in 0..3 {
        let memory = remember(folder.path());
        let [run] = memory.earlier_runs() else { panic!("{:?}", memory.earlier_runs()) };
        assert!(run.crashed && run.source == "/data/tooth.nrrd" && gain_of(&run.look) == 2.0);
        assert_eq!(run.picture().unwrap().size, [40, 20]);
    }
    remember(folder.path()).acknowledge_crashes();
    let memory = remember(folder.path());
    assert!(!memory.earlier_runs()[0].crashed, "still there, but not offered");
    assert_eq!(memory.previous_look(), Some(memory.earlier_runs()[0].look.clone()));
}

#[test]
fn a_run_that_panics_is_one_that_was_cut_off() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_owned();
    let window = std::panic::catch_unwind(move || {
        let mut memory = remember(&path);
        memory.autosave(&look(2.0), volume("builtin:chair", 7));
        panic!("as a window might");
    });
    assert!(window.is_err());
    let memory = remember(folder.path());
    assert!(memory.earlier_runs()[0].crashed && gain_of(&memory.earlier_runs()[0].look) == 2.0);
}

#[test]
fn starts_that_fail_are_counted_until_one_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let fail = || kill(remember(folder.path()));
    drop(remember(folder.path()));
    for failed in 0..4 {
        assert_eq!(starts_have_failed(folder.path()), failed >= 3, "{failed}");
        assert_eq!(remember(folder.path()).needs_safe_start(), failed >= 3);
        fail();
    }
    let mut memory = remember(folder.path());
    memory.autosave(&look(2.0), volume("builtin:chair", 7));
    drop(memory);
    assert!(!starts_have_failed(folder.path()));
    drop(remember(folder.path()));
    assert_eq!(fs::read_dir(folder.path().join("runs")).unwrap().count(), 1, "the look alone");
}

#[test]
fn two_windows_take_nothing_from_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let mut first = remember(folder.path());
    first.autosave(&look(2.0), volume("builtin:chair", 7));
    let mut second = remember(folder.path());
    assert!(second.earlier_runs().is_empty(), "the first one goes on");
    second.autosave(&look(3.0), volume("builtin:fuel", 8));
    kill(first);
    drop(second);
    let third = remember(folder.path());
    let mut kept: Vec<_> = third.earlier_runs().iter().map(|run| (gain_of(&run.look), run.crashed)).collect();
    kept.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(kept, [(2.0, true), (3.0, false)]);
}

#[test]
fn ten_runs_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    for at in 0..13 {
        let mut memory = remember(folder.path());
        memory.autosave(&look(f64::from(at)), volume("builtin:chair", 7));
        drop(memory);
        // Names are in milliseconds.
        std::thread::sleep(Duration::from_millis(3));
    }
    let memory = remember(folder.path());
    let gains: Vec<_> = memory.earlier_runs().iter().map(|run| gain_of(&run.look)).collect();
    assert_eq!(gains, [12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0]);
    // Ten looks, and the lock of this run.
    assert_eq!(fs::read_dir(folder.path().join("runs")).unwrap().count(), 11);
}

#[test]
fn damaged_files_are_put_aside_and_said_once() {
    let folder = tempfile::tempdir().unwrap();
    let runs = folder.path().join("runs");
    fs::create_dir(&runs).unwrap();
    fs::write(folder.path().join("recent.json"), "{nonsense").unwrap();
    fs::write(runs.join("0000000000001-1.json"), "[]").unwrap();
    fs::create_dir(runs.join("0000000000002-1.json")).unwrap();
    let mut memory = remember(folder.path());
    assert!(memory.recent().is_empty() && memory.earlier_runs().is_empty());
    let notices = memory.take_notices();
    assert_eq!(notices.len(), 3, "{notices:?}");
    assert!(notices.iter().all(|notice| notice.contains("renamed")), "{notices:?}");
    assert!(memory.take_notices().is_empty());
    drop(memory);
    assert!(remember(folder.path()).take_notices().is_empty());
    let aside = |folder: &Path| {
        let names = fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name());
        names.filter(|name| name.to_string_lossy().contains(".damaged-")).count()
    };
    assert_eq!((aside(folder.path()), aside(&runs)), (1, 2), "nothing is thrown away");
}

#[test]
fn what_cannot_be_kept_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = remember(folder.path());
    // Nothing can be written without the folder.
    fs::remove_dir_all(folder.path().join("runs")).unwrap();
    memory.autosave(&look(2.0), volume("builtin:chair", 7));
    wait_until("the failure is known", || memory.keeper.as_ref().unwrap().failure().is_some());
    assert_eq!(memory.take_notices().len(), 1);
    assert!(memory.take_notices().is_empty(), "once");
    fs::create_dir(folder.path().join("runs")).unwrap();
    // Retried automatically: the look is still pending.
    let file = memory.run.as_ref().unwrap().look.clone();
    wait_until("the look is kept after all", || file.exists());
    let mut memory =
        PersistentState::new(Some(&folder.path().join("runs/no.txt/x")), &egui::Context::default());
    assert!(memory.take_notices().is_empty());
    fs::write(folder.path().join("file"), "").unwrap();
    let mut nowhere = remember(&folder.path().join("file"));
    assert_eq!(nowhere.take_notices().len(), 1);
    nowhere.autosave(&look(2.0), volume("builtin:chair", 7));
    assert!(PersistentState::new(None, &egui::Context::default()).emergency_save().is_none());
}

#[test]
fn last_words_are_written_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = remember(folder.path());
    memory.autosave(&look(2.0), volume("builtin:chair", 7));
    let begin = Instant::now();
    memory.emergency_save().unwrap().write();
    assert!(begin.elapsed() < Duration::from_millis(900), "before changes have been collected");
    assert_eq!(gain_of(&memory.run.as_ref().unwrap().look), 2.0);
}

#[test]
fn the_look_of_an_earlier_version_is_taken_over() {
    let folder = tempfile::tempdir().unwrap();
    let text = |gain| {
        let volume = chiaroscuro_scene::VolumeRecord::new(Path::new("builtin:chair"), 7, None);
        LookRecord::to_json(&look(gain), Some(&volume), None)
    };
    fs::write(folder.path().join("before.json"), text(2.0)).unwrap();
    std::thread::sleep(Duration::from_millis(5));
    fs::write(folder.path().join("now.json"), text(3.0)).unwrap();
    let memory = remember(folder.path());
    let gains: Vec<_> = memory.earlier_runs().iter().map(|run| gain_of(&run.look)).collect();
    assert_eq!(gains, [3.0, 2.0]);
    assert!(!memory.is_first_use());
}
