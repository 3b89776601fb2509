//! Dialog that asks how much of a large volume to load.

use std::path::PathBuf;

use eframe::egui::{self, DragValue, Key, Ui};

use crate::app::common::{overlay_windows, shortcuts};
use crate::app::text;
use crate::app::worker::loader::ReadChoices;
use crate::app::worker::memory_estimate::{MemoryEstimate, MemoryFit};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{Downsampling, Portion, VoxelRegion, VoxelSpan};

/// Longest path that is shown, in characters.
const MAX_PATH_CHARS: usize = 200;

/// Width of the dialog's texts, in points.
const DIALOG_WIDTH: f32 = 440.0;

/// Way to load a volume: thinned, in part, or whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LoadMode {
    BlockAverage,
    Subsample,
    Region,
    Whole,
}

/// Answer of the user to the dialog.
#[derive(Debug, Clone)]
pub(crate) enum LargeVolumeAnswer {
    /// Load the chosen portion of the volume.
    Read {
        /// Path of the volume's file.
        source: PathBuf,
        /// Options for reading, with the chosen portion.
        reading: Box<ReadChoices>,
    },
    /// Load nothing and close the dialog.
    Cancel,
}

/// Volume that the dialog asks about.
#[derive(Debug)]
struct LargeVolume {
    source: PathBuf,
    reading: ReadChoices,
    memory_estimate: MemoryEstimate,
    subsampled: Option<Portion>,
    averaged: Option<Portion>,
    /// Region per axis: first voxel, and one past the last.
    region: [[usize; 2]; 3],
    mode: LoadMode,
}

/// State of the dialog; empty while it is closed.
#[derive(Debug, Default)]
pub(crate) struct LargeVolumeDialog {
    pending: Option<LargeVolume>,
}

/// Remark on how well a portion fits into memory; `None` if it does.
fn fit_remark(fit: MemoryFit) -> Option<&'static str> {
    match fit {
        MemoryFit::Comfortable => None,
        MemoryFit::Tight => Some(text::large_volume::MOST_OF_MEMORY),
        MemoryFit::Downsampled => Some(text::large_volume::DOWNSAMPLED_BY_ADAPTER),
        MemoryFit::TooLarge => Some(text::large_volume::TOO_MUCH),
    }
}

impl LargeVolume {
    fn portion(&self, wish: LoadMode) -> Option<Portion> {
        match wish {
            LoadMode::BlockAverage => self.averaged,
            LoadMode::Subsample => self.subsampled,
            LoadMode::Region => {
                let region = VoxelRegion(self.region.map(|[first, end]| VoxelSpan { first, end: Some(end) }));
                Some(Portion { region: Some(region), thinning: Downsampling::None })
            }
            LoadMode::Whole => Some(Portion::default()),
        }
    }

    /// Chosen portion, if it fits into memory.
    fn chosen_portion(&self) -> Option<Portion> {
        let portion = self.portion(self.mode)?;
        self.memory_estimate.fit(&portion).filter(|fit| *fit != MemoryFit::TooLarge).map(|_| portion)
    }

    /// Shows one way to load the volume, with the memory that it needs.
    fn mode_row(&mut self, ui: &mut Ui, wish: LoadMode, name: &str, tip: &str) {
        let facts = self.portion(wish).and_then(|portion| {
            let [host, _] = self.memory_estimate.required_bytes(&portion)?;
            Some((
                self.memory_estimate.size.portion_dims(&portion)?,
                host,
                self.memory_estimate.fit(&portion)?,
            ))
        });
        let is_possible =
            wish == LoadMode::Region || facts.is_some_and(|(.., fit)| fit != MemoryFit::TooLarge);
        ui.horizontal(|ui| {
            ui.add_enabled_ui(is_possible, |ui| {
                ui.radio_value(&mut self.mode, wish, name).on_hover_text(tip)
            });
            ui.weak(match facts {
                Some((dims, host, fit)) => text::large_volume::part_size(dims, host, fit_remark(fit)),
                None => text::large_volume::TOO_MUCH.to_owned(),
            });
        });
    }

    fn region_fields(&mut self, ui: &mut Ui) {
        let before = self.region;
        egui::Grid::new("region").num_columns(3).show(ui, |ui| {
            for (axis, name) in text::raw::AXES.into_iter().enumerate() {
                let all = self.memory_estimate.size.dims[axis];
                let [first, end] = &mut self.region[axis];
                ui.label(name);
                ui.name_inputs(text::large_volume::first_along(name), |ui| {
                    ui.add(DragValue::new(first).range(0..=all - 1))
                });
                ui.name_inputs(text::large_volume::end_along(name), |ui| {
                    ui.add(DragValue::new(end).range(1..=all))
                });
                ui.end_row();
                // At least one voxel along each axis.
                if *first >= *end {
                    if *first == before[axis][0] { *first = *end - 1 } else { *end = *first + 1 }
                }
            }
        });
        if self.region != before {
            self.mode = LoadMode::Region;
        }
    }

    fn answer(&self) -> Option<LargeVolumeAnswer> {
        let portion = self.chosen_portion()?;
        let choice = self.reading.choice.clone().unwrap_or_default();
        let choice = Some(chiaroscuro_volume::VolumeChoice { portion: Some(portion), ..choice });
        let reading = ReadChoices { choice, takes_all_memory: true, ..self.reading.clone() };
        Some(LargeVolumeAnswer::Read { source: self.source.clone(), reading: Box::new(reading) })
    }
}

impl LargeVolumeDialog {
    /// Opens the dialog, with the least thinning that fits into memory as default.
    pub(crate) fn open(&mut self, source: PathBuf, reading: ReadChoices, weighed: MemoryEstimate) {
        let (every, average) =
            (weighed.finest_thinning(Downsampling::Every), weighed.finest_thinning(Downsampling::Average));
        let region = weighed
            .largest_central_region()
            .0
            .map(|VoxelSpan { first, end }| [first, end.unwrap_or(first + 1)]);
        // Averages look better than single voxels; the method that keeps more voxels is preferred.
        let wish = match (every, average) {
            (Some(every), Some(average)) if every.thinning.stride() < average.thinning.stride() => {
                LoadMode::Subsample
            }
            (_, Some(_)) => LoadMode::BlockAverage,
            (Some(_), None) => LoadMode::Subsample,
            (None, None) => LoadMode::Region,
        };
        self.pending = Some(LargeVolume {
            source,
            reading,
            memory_estimate: weighed,
            subsampled: every,
            averaged: average,
            region,
            mode: wish,
        });
    }

    /// Closes the dialog without an answer.
    pub(crate) fn close(&mut self) {
        self.pending = None;
    }

    /// Shows the dialog, if it is open; closes it and returns the user's answer.
    pub(crate) fn ui(&mut self, ctx: &egui::Context) -> Option<LargeVolumeAnswer> {
        let asked = self.pending.as_mut()?;
        shortcuts::reserve_letters(ctx);
        let (mut open, mut answer) = (true, None);
        let window = egui::Window::new(text::large_volume::TITLE).open(&mut open);
        window
            .collapsible(false)
            .resizable(false)
            .default_pos([120.0, 80.0])
            .constrain_to(overlay_windows::window_area(ctx))
            .show(ctx, |ui| {
                ui.set_max_width(DIALOG_WIDTH);
                let MemoryEstimate { size, available: room } = &asked.memory_estimate;
                ui.label(text::large_volume::volume_size(
                    &sanitised(&asked.source.to_string_lossy(), MAX_PATH_CHARS),
                    size,
                ));
                if let Some([host, adapter]) = asked.memory_estimate.required_bytes(&Portion::default()) {
                    ui.label(text::large_volume::host_memory(host, room.free_bytes()));
                    ui.label(text::large_volume::gpu_memory(
                        adapter,
                        (room.adapter_dims != size.dims).then_some(room.adapter_dims),
                    ));
                }
                ui.separator();
                let every = asked.subsampled.map_or(2, |portion| portion.thinning.stride());
                let average = asked.averaged.map_or(2, |portion| portion.thinning.stride());
                asked.mode_row(
                    ui,
                    LoadMode::BlockAverage,
                    &text::large_volume::average(average),
                    text::large_volume::AVERAGE_TIP,
                );
                asked.mode_row(
                    ui,
                    LoadMode::Subsample,
                    &text::large_volume::subsample(every),
                    text::large_volume::EVERY_TIP,
                );
                asked.mode_row(
                    ui,
                    LoadMode::Region,
                    text::large_volume::REGION,
                    text::large_volume::REGION_TIP,
                );
                ui.indent("region", |ui| asked.region_fields(ui));
                asked.mode_row(ui, LoadMode::Whole, text::large_volume::WHOLE, text::large_volume::WHOLE_TIP);
                ui.separator();
                ui.horizontal(|ui| {
                    let chosen = asked.answer();
                    let is_open = ui
                        .add_enabled(chosen.is_some(), egui::Button::new(text::large_volume::OPEN))
                        .clicked();
                    if is_open || ui.input(|input| input.key_pressed(Key::Enter)) {
                        answer = chosen;
                    }
                    if ui.button(text::large_volume::CANCEL).clicked() {
                        answer = Some(LargeVolumeAnswer::Cancel);
                    }
                });
            });
        if ctx.input(|input| input.key_pressed(Key::Escape)) || !open {
            answer = Some(LargeVolumeAnswer::Cancel);
        }
        if answer.is_some() {
            self.close();
        }
        answer
    }
}
