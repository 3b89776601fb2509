//! Tests of cancellation: whatever is being done to a volume stops almost immediately.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use tempfile::TempDir;

use super::helpers::gzip;
use crate::{LoadOptions, load};
use chiaroscuro_volume::{Dataset, LoadControl, LoadError, Portion, Volume, VolumeChoice};

/// Voxels along an edge of the test volume, 2 MiB in all.
const EDGE: usize = 128;

/// Number of values between two checks for cancellation.
const PIECE: usize = 1 << 16;

fn write(folder: &TempDir, edge: usize, is_packed: bool) -> PathBuf {
    let bytes: Vec<u8> = (0..edge.pow(3)).map(|at| (at * 31 / 7) as u8).collect();
    let ending = if is_packed { ".gz" } else { "" };
    let path = folder.path().join(format!("large_{edge}x{edge}x{edge}_uint8.raw{ending}"));
    fs::write(&path, if is_packed { gzip(&bytes) } else { bytes }).unwrap();
    path
}

fn read(path: &Path, portion: Portion, control: &LoadControl) -> Result<Volume, LoadError> {
    let choice = VolumeChoice { portion: Some(portion), ..VolumeChoice::default() };
    load(path, &LoadOptions { choice, ..LoadOptions::default() }, control)
}

/// Runs all processing of a volume before its first image.
fn open(path: &Path, portion: Portion, control: &LoadControl) -> Result<Dataset, LoadError> {
    let volume = read(path, portion, control)?;
    let dataset = control.run(|| Dataset::new(volume));
    if control.is_cancelled() { Err(LoadError::Cancelled) } else { Ok(dataset) }
}

#[test]
fn every_stage_is_cut_into_small_pieces() {
    let folder = TempDir::new().unwrap();
    let path = write(&folder, EDGE, false);
    let control = LoadControl::new();
    let volume = read(&path, Portion::default(), &control).unwrap();
    let pieces = EDGE.pow(3) / PIECE;
    // Value range, statistics and fingerprint, and blocks of at most 1 MiB for reading.
    let of_reading = control.pieces_begun();
    assert!(of_reading >= 3 * pieces as u64 + 2, "{of_reading}");
    control.run(|| volume.to_block_averaged([2; 3])).unwrap();
    let of_means = control.pieces_begun() - of_reading;
    assert!(of_means >= EDGE as u64, "{of_means}: a slice at a time");
    control.run(|| Dataset::new(volume));
    let of_bounds = control.pieces_begun() - of_means - of_reading;
    // Bricks, cells and histogram.
    assert!(of_bounds >= 4 * EDGE as u64, "{of_bounds}");
}

#[test]
fn cancelling_waits_for_pieces_in_progress_only() {
    let folder = TempDir::new().unwrap();
    for (is_packed, portion) in [
        (false, Portion::default()),
        (true, Portion::default()),
        (false, Portion::with_stride(2)),
        (true, Portion::with_block_average(2)),
    ] {
        let path = write(&folder, EDGE, is_packed);
        let control = LoadControl::new();
        open(&path, portion, &control).unwrap();
        let all = control.pieces_begun();
        // The first moments, the last one, and nineteen in between.
        let moments =
            [1, 2, 3, all - 1].into_iter().chain((1..20).map(|at| at * all / 20).filter(|&at| at > 0));
        for moment in moments {
            let control = LoadControl::new();
            control.cancel_after(moment);
            let given_up = open(&path, portion, &control);
            assert!(matches!(given_up, Err(LoadError::Cancelled)), "{moment} of {all}");
            // Each core may have begun one piece at the same moment.
            let late = control.pieces_begun() - moment;
            assert!(late <= rayon::current_num_threads() as u64 + 1, "{late} pieces after {moment} of {all}");
        }
    }
}

/// Measures the longest delay of cancellation:
/// `cargo nextest run --lib --run-ignored only -E 'test(how_long)' --no-capture`
#[test]
#[ignore = "it measures, and checks nothing"]
fn measure_cancellation_delay() {
    let folder = TempDir::new().unwrap();
    for is_packed in [false, true] {
        let path = write(&folder, 512, is_packed);
        let start = Instant::now();
        open(&path, Portion::default(), &LoadControl::new()).unwrap();
        let whole = start.elapsed();
        let longest = (1..40u32).map(|at| {
            let control = LoadControl::new();
            std::thread::scope(|scope| {
                let opened = scope.spawn(|| drop(open(&path, Portion::default(), &control)));
                std::thread::sleep(whole * at / 40);
                control.cancel();
                let start = Instant::now();
                opened.join().unwrap();
                (start.elapsed(), at)
            })
        });
        let (longest, at) = longest.max().unwrap();
        println!(
            "512³, packed: {is_packed}, in all {whole:?}; longest wait {longest:?}, after {at} of 40 parts"
        );
    }
}
