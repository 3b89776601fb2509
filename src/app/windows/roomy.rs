//! Dialog that asks how much of a large volume to load.

use std::path::PathBuf;

use eframe::egui::{self, DragValue, Key, Ui};

use crate::app::common::{frame, shortcuts};
use crate::app::text;
use crate::app::worker::loader::Reading;
use crate::app::worker::weighing::{Fit, Weighed};
use crate::data::load::{Portion, Region, Stretch, Thinning};
use crate::data::plain;

/// Longest path that is shown, in characters.
const LONGEST_PATH: usize = 200;

/// Width of the dialog's texts, in points.
const WIDTH: f32 = 440.0;

/// Way to load a volume: thinned, in part, or whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wish {
    Average,
    Every,
    Region,
    Whole,
}

/// Answer of the user to the dialog.
#[derive(Debug, Clone)]
pub(crate) enum Answer {
    /// Load the chosen portion of the volume.
    Read {
        /// Path of the volume's file.
        source: PathBuf,
        /// Options for reading, with the chosen portion.
        reading: Box<Reading>,
    },
    /// Load nothing and close the dialog.
    Cancel,
}

/// Volume that the dialog asks about.
#[derive(Debug)]
struct Asked {
    source: PathBuf,
    reading: Reading,
    weighed: Weighed,
    every: Option<Portion>,
    average: Option<Portion>,
    /// Region per axis: first voxel, and one past the last.
    region: [[usize; 2]; 3],
    wish: Wish,
}

/// State of the dialog; empty while it is closed.
#[derive(Debug, Default)]
pub(crate) struct Roomy {
    asked: Option<Asked>,
}

/// Remark on how well a portion fits into memory; `None` if it does.
fn but(fit: Fit) -> Option<&'static str> {
    match fit {
        Fit::Well => None,
        Fit::Tight => Some(text::roomy::TIGHT),
        Fit::Averaged => Some(text::roomy::AVERAGED),
        Fit::No => Some(text::roomy::TOO_MUCH),
    }
}

impl Asked {
    fn portion(&self, wish: Wish) -> Option<Portion> {
        match wish {
            Wish::Average => self.average,
            Wish::Every => self.every,
            Wish::Region => {
                let region = Region(self.region.map(|[first, end]| Stretch { first, end: Some(end) }));
                Some(Portion { region: Some(region), thinning: Thinning::None })
            }
            Wish::Whole => Some(Portion::default()),
        }
    }

    /// Chosen portion, if it fits into memory.
    fn chosen(&self) -> Option<Portion> {
        let portion = self.portion(self.wish)?;
        self.weighed.fit(&portion).filter(|fit| *fit != Fit::No).map(|_| portion)
    }

    /// Shows one way to load the volume, with the memory that it needs.
    fn way(&mut self, ui: &mut Ui, wish: Wish, name: &str, tip: &str) {
        let facts = self.portion(wish).and_then(|portion| {
            let [host, _] = self.weighed.needs(&portion)?;
            Some((self.weighed.size.dims_of(&portion)?, host, self.weighed.fit(&portion)?))
        });
        let can_be = wish == Wish::Region || facts.is_some_and(|(.., fit)| fit != Fit::No);
        ui.horizontal(|ui| {
            ui.add_enabled_ui(can_be, |ui| ui.radio_value(&mut self.wish, wish, name).on_hover_text(tip));
            ui.weak(match facts {
                Some((dims, host, fit)) => text::roomy::takes(dims, host, but(fit)),
                None => text::roomy::TOO_MUCH.to_owned(),
            });
        });
    }

    fn region(&mut self, ui: &mut Ui) {
        let before = self.region;
        egui::Grid::new("region").num_columns(3).show(ui, |ui| {
            for (axis, name) in text::raw::AXES.into_iter().enumerate() {
                let all = self.weighed.size.dims[axis];
                let [first, end] = &mut self.region[axis];
                ui.label(name);
                ui.name_inputs(text::roomy::first_along(name), |ui| {
                    ui.add(DragValue::new(first).range(0..=all - 1))
                });
                ui.name_inputs(text::roomy::end_along(name), |ui| ui.add(DragValue::new(end).range(1..=all)));
                ui.end_row();
                // At least one voxel along each axis.
                if *first >= *end {
                    if *first == before[axis][0] { *first = *end - 1 } else { *end = *first + 1 }
                }
            }
        });
        if self.region != before {
            self.wish = Wish::Region;
        }
    }

    fn answer(&self) -> Option<Answer> {
        let portion = self.chosen()?;
        let choice = self.reading.choice.clone().unwrap_or_default();
        let choice = Some(crate::data::load::Choice { portion: Some(portion), ..choice });
        let reading = Reading { choice, takes_all_memory: true, ..self.reading.clone() };
        Some(Answer::Read { source: self.source.clone(), reading: Box::new(reading) })
    }
}

impl Roomy {
    /// Opens the dialog, with the least thinning that fits into memory as default.
    pub(crate) fn ask(&mut self, source: PathBuf, reading: Reading, weighed: Weighed) {
        let (every, average) = (weighed.thinned(Thinning::Every), weighed.thinned(Thinning::Average));
        let region = weighed.middle().0.map(|Stretch { first, end }| [first, end.unwrap_or(first + 1)]);
        // Averages look better than single voxels; the method that keeps more voxels is preferred.
        let wish = match (every, average) {
            (Some(every), Some(average)) if every.thinning.step() < average.thinning.step() => Wish::Every,
            (_, Some(_)) => Wish::Average,
            (Some(_), None) => Wish::Every,
            (None, None) => Wish::Region,
        };
        self.asked = Some(Asked { source, reading, weighed, every, average, region, wish });
    }

    /// Closes the dialog without an answer.
    pub(crate) fn close(&mut self) {
        self.asked = None;
    }

    /// Shows the dialog, if it is open; closes it and returns the user's answer.
    pub(crate) fn ui(&mut self, ctx: &egui::Context) -> Option<Answer> {
        let asked = self.asked.as_mut()?;
        shortcuts::reserve_letters(ctx);
        let (mut open, mut answer) = (true, None);
        let window = egui::Window::new(text::roomy::TITLE).open(&mut open);
        window
            .collapsible(false)
            .resizable(false)
            .default_pos([120.0, 80.0])
            .constrain_to(frame::room(ctx))
            .show(ctx, |ui| {
                ui.set_max_width(WIDTH);
                let Weighed { size, room } = &asked.weighed;
                ui.label(text::roomy::holds(&plain(&asked.source.to_string_lossy(), LONGEST_PATH), size));
                if let Some([host, adapter]) = asked.weighed.needs(&Portion::default()) {
                    ui.label(text::roomy::memory(host, room.free_bytes()));
                    ui.label(text::roomy::adapter(adapter, (room.held != size.dims).then_some(room.held)));
                }
                ui.separator();
                let every = asked.every.map_or(2, |portion| portion.thinning.step());
                let average = asked.average.map_or(2, |portion| portion.thinning.step());
                asked.way(ui, Wish::Average, &text::roomy::average(average), text::roomy::AVERAGE_TIP);
                asked.way(ui, Wish::Every, &text::roomy::every(every), text::roomy::EVERY_TIP);
                asked.way(ui, Wish::Region, text::roomy::REGION, text::roomy::REGION_TIP);
                ui.indent("region", |ui| asked.region(ui));
                asked.way(ui, Wish::Whole, text::roomy::WHOLE, text::roomy::WHOLE_TIP);
                ui.separator();
                ui.horizontal(|ui| {
                    let chosen = asked.answer();
                    let is_open =
                        ui.add_enabled(chosen.is_some(), egui::Button::new(text::roomy::OPEN)).clicked();
                    if is_open || ui.input(|input| input.key_pressed(Key::Enter)) {
                        answer = chosen;
                    }
                    if ui.button(text::roomy::CANCEL).clicked() {
                        answer = Some(Answer::Cancel);
                    }
                });
            });
        if ctx.input(|input| input.key_pressed(Key::Escape)) || !open {
            answer = Some(Answer::Cancel);
        }
        if answer.is_some() {
            self.close();
        }
        answer
    }
}
