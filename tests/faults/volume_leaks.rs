//! Leak tests of volumes that are opened and closed again, or cancelled while loading.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use chiaroscuro_render::{GpuContext, RenderOptions, Renderer};
use chiaroscuro_scene::first_look;
use chiaroscuro_volume::{Dataset, LoadControl, LoadErrorKind};
use chiaroscuro_volume_io::{LoadOptions, open};

use crate::random::Random;
use crate::samples::samples;

/// Number of opens after which caches and pools are full.
const WARM_UP: usize = 50;

/// Largest relative growth of memory from then on, as demanded of programs for data of this size.
const MAX_GROWTH: f64 = 0.02;

/// Memory in bytes that an allocator may or may not keep, regardless of leaks.
const ALLOCATOR_SLACK: u64 = 2 << 20;

/// Longest time from a cancellation to the end of the load, on a busy machine; the figure is printed.
const CANCEL_TIMEOUT: Duration = Duration::from_secs(2);

/// Resident memory in bytes, where the system reports it.
fn resident_bytes() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}

/// Number of open files, where the system reports it.
fn open_files() -> Option<usize> {
    Some(std::fs::read_dir("/proc/self/fd").ok()?.count())
}

/// Writes volumes of several sizes and kinds, one of them invalid.
fn files(folder: &Path) -> Vec<PathBuf> {
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("room");
        path
    };
    let is_volume = |name: &str| name.contains("nrrd") || name.contains(".raw");
    let mut found: Vec<_> = samples(folder)
        .into_iter()
        .filter(|sample| is_volume(&sample.name))
        .map(|sample| write(&sample.name, &sample.bytes))
        .collect();
    for edge in [8, 24, 48] {
        let voxels: Vec<u8> = (0..edge * edge * edge).map(|at| (at * 7 % 251) as u8).collect();
        found.push(write(&format!("cube_{edge}x{edge}x{edge}_uint8.raw"), &voxels));
        let words: Vec<u8> = voxels.iter().flat_map(|&voxel| [voxel, voxel / 64]).collect();
        found.push(write(&format!("cube_{edge}x{edge}x{edge}_uint16.raw"), &words));
    }
    found.push(write("short_9x9x9_uint8.raw", &[0; 100]));
    found
}

/// Opens and renders a number of volumes, one after another.
fn open_and_close(count: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let files = files(folder.path());
    let mut renderer = Renderer::new(&GpuContext::headless().expect("an adapter")).expect("a renderer");
    let mut baseline = None;
    let mut refused = 0;
    for at in 0..count {
        let file = &files[at % files.len()];
        let Ok(volume) = open(file, &LoadOptions::default(), &LoadControl::new()) else {
            refused += 1;
            continue;
        };
        let dataset = Dataset::new(volume);
        let mut settings = first_look::first_settings(dataset.volume(), dataset.histogram());
        // Everything that is computed for a picture, with the sky of the first look.
        settings.scattering.bounces = 1;
        renderer.render(&dataset, &settings, [16, 12], &RenderOptions::default()).expect("a picture");
        // Measured each time after the same volume.
        if at % files.len() == 0 {
            let now = (resident_bytes(), open_files(), renderer.gpu_bytes());
            if at >= WARM_UP && baseline.is_none() {
                baseline = Some(now);
            }
            let Some(before) = baseline else { continue };
            assert_eq!((now.1, now.2), (before.1, before.2), "files or graphics memory after {at}");
            if let (Some(now), Some(before)) = (now.0, before.0) {
                let most = before + ((before as f64 * MAX_GROWTH) as u64).max(ALLOCATOR_SLACK);
                assert!(now <= most, "{now} bytes after {at} volumes, {before} after {WARM_UP}");
            }
        }
    }
    let (before, after) = (baseline.expect("more than the first").0, resident_bytes());
    println!("{count} volumes opened and closed, {refused} refused; bytes in memory {before:?} … {after:?}");
    assert!(refused * files.len() >= count / 2, "one of each round is not valid");
}

/// Cancels a number of loads at random points: every second one after a number of bytes, the others after a share of
/// the usual duration.
fn cancel_loads(count: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let edge = 256;
    let path = folder.path().join(format!("large_{edge}x{edge}x{edge}_uint16.raw"));
    let voxels: Vec<u8> = (0..edge * edge * edge * 2).map(|at: usize| (at * 31 % 253) as u8).collect();
    std::fs::write(&path, voxels).expect("room");
    let load = |control: &LoadControl| open(&path, &LoadOptions::default(), control);
    let begin = Instant::now();
    let whole = load(&LoadControl::new()).expect("it is valid").content_id();
    let usual = begin.elapsed();
    let mut random = Random::new(count as u64);
    let (mut given_up, mut slowest) = (0, Duration::ZERO);
    for at in 0..count {
        let control = LoadControl::new();
        let share = random.below(1000) as f64 / 1000.0;
        let (result, took) = std::thread::scope(|threads| {
            let loader = threads.spawn(|| load(&control));
            if at % 2 == 0 {
                let is_read = || control.fraction().is_some_and(|read| read >= share);
                while !is_read() && !loader.is_finished() {
                    std::thread::sleep(Duration::from_micros(50));
                }
            } else {
                std::thread::sleep(usual.mul_f64(share));
            }
            let begin = Instant::now();
            control.cancel();
            (loader.join().expect("no panic"), begin.elapsed())
        });
        slowest = slowest.max(took);
        match result {
            Ok(volume) => assert_eq!(volume.content_id(), whole),
            Err(err) => {
                assert_eq!(err.kind(), LoadErrorKind::Cancelled, "{err}");
                given_up += 1;
            }
        }
    }
    println!("{count} opens given up, {given_up} in the middle; the slowest went on for {slowest:?}");
    assert!(given_up > count / 3 && slowest < CANCEL_TIMEOUT);
    assert_eq!(load(&LoadControl::new()).expect("it is valid").content_id(), whole);
}

#[test]
fn closed_volumes_leave_nothing_behind() {
    open_and_close(150);
}

#[test]
#[ignore = "a thousand volumes: minutes"]
fn a_thousand_closed_volumes_leave_nothing_behind() {
    open_and_close(1000);
}

#[test]
fn loading_ends_soon_when_it_is_given_up() {
    cancel_loads(20);
}

#[test]
#[ignore = "minutes"]
fn loading_ends_soon_whenever_it_is_given_up() {
    cancel_loads(300);
}
