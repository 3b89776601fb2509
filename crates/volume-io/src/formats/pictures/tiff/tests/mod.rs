//! Tests that load TIFF files through the public interface: supported and refused ones.

mod broken;
mod numbers;
mod ome;
mod shaped;
mod stacks;
mod writer;

use crate::tests::helpers::{self, assert_refused, load_path as load_with};
use chiaroscuro_volume::{LoadError, Samples, Volume, VolumeChoice};

fn load_chosen(bytes: &[u8], choice: VolumeChoice) -> Result<Volume, LoadError> {
    // Without its extension, so that it is detected by its first bytes.
    helpers::load_bytes("stack.bin", bytes, choice)
}

fn load_bytes(bytes: &[u8]) -> Result<Volume, LoadError> {
    load_chosen(bytes, VolumeChoice::default())
}

#[track_caller]
fn samples_of(bytes: &[u8]) -> Samples {
    load_bytes(bytes).unwrap().samples().clone()
}
