//! Time steps of the open volume: the bar with slider and playback, and reading ahead of the steps that may be shown next.
//!
//! A step takes the place of the one that is shown without a first look: settings stay, and so do colours, since all steps
//! have the ranges of values of the one that was opened. The renderer uploads the next steps and fills their light volumes
//! while it has nothing to draw.

mod bar;
mod playback;
mod step_cache;

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;

use self::playback::Playback;
use self::step_cache::{StepBasis, StepCache, dataset_bytes};
use super::look_editor::LookEditor;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use crate::app::windows::export::ReadableSeries;
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use crate::app::worker::loader::ReadChoices;
use crate::app::worker::mailbox::UpcomingSteps;
use chiaroscuro_volume::{Dataset, memory_budget_bytes};
use chiaroscuro_volume_io::{LoadOptions, TimeSteps};

/// Largest number of steps that are read ahead, and kept in memory.
const MOST_KEPT: usize = 24;

/// Number of steps after the one that is shown that the renderer prepares.
const PREPARED: usize = 3;

/// Number of steps of which the range of the series is taken, at most: as the values of a series change slowly, more would
/// hardly widen it.
const RANGE_STEPS: usize = 32;

/// Time series of which the open volume is one step.
#[derive(Debug, Default)]
pub(crate) struct TimeSeries {
    /// Steps of the open volume with the options for reading them, if there are several.
    series: Option<ReadableSeries>,
    /// True if the steps are numbered files.
    is_of_files: bool,
    /// Choices by which the volume was read.
    reading: ReadChoices,
    /// Index of the step whose dataset the renderer has, and of the one that the user wants to see.
    shown: usize,
    wanted: usize,
    /// Index of the step whose picture is on screen.
    on_screen: usize,
    playback: Playback,
    cache: StepCache,
    /// Step that is being read, by its index and what it has in common with the others.
    loading: JobSlot<Result<Dataset, String>, (usize, StepBasis)>,
    /// Step that could not be read, which is not tried again before another one is wanted.
    failed: Option<usize>,
    /// Range of the series that is being read.
    measuring: JobSlot<Result<Dataset, String>>,
    /// True if the user asks for the range of the series.
    wants_range: bool,
    /// Steps that the renderer was told to prepare, and whether it was told so for playing.
    prepared: (Vec<usize>, bool),
    /// True if the renderer was told to prepare steps, which stays true after the series has ended until it was told so.
    has_prepared: bool,
}

impl TimeSeries {
    /// Takes over the time steps of a volume that was opened; those of the one before are forgotten.
    pub(crate) fn reset(&mut self, volume: Option<&VolumeFacts>, options: &LoadOptions) {
        self.close();
        let Some(volume) = volume else { return };
        let steps = TimeSteps::from_contents(&volume.source, &volume.held);
        self.use_steps(steps, volume, options);
    }

    /// Takes the files beside the open one whose names differ in a number as time steps; returns false if there are none.
    pub(crate) fn use_numbered_files(&mut self, volume: &VolumeFacts, options: &LoadOptions) -> bool {
        if self.series.is_none() {
            let steps = TimeSteps::from_numbered_files(&volume.source, volume.held.choice());
            self.is_of_files = steps.is_some();
            self.use_steps(steps, volume, options);
        }
        self.series.is_some()
    }

    fn use_steps(&mut self, steps: Option<TimeSteps>, volume: &VolumeFacts, options: &LoadOptions) {
        let Some(steps) = steps else { return };
        let Some(shown) = steps.index_of(&volume.source, &volume.held.choice()) else { return };
        (self.shown, self.wanted, self.on_screen) = (shown, shown, shown);
        self.reading = volume.reading.clone();
        // As the open volume was read, and limited to the memory that is free now.
        let options = LoadOptions {
            raw: self.reading.raw.unwrap_or(options.raw),
            only_files: self.reading.subset.clone(),
            memory_budget_bytes: options.memory_budget_bytes.min(memory_budget_bytes()),
            ..options.clone()
        };
        self.series = Some(ReadableSeries { steps: Arc::new(steps), options });
    }

    /// Forgets the steps, so that the open file is shown alone.
    fn close(&mut self) {
        *self =
            Self { playback: self.playback.at_rest(), has_prepared: self.has_prepared, ..Self::default() };
    }

    /// Returns the steps of the open volume, if there are several.
    pub(crate) fn steps(&self) -> Option<&Arc<TimeSteps>> {
        self.series.as_ref().map(|series| &series.steps)
    }

    /// Returns true while the series plays, or a step that is wanted is not shown yet.
    pub(crate) fn is_busy(&self) -> bool {
        self.playback.is_playing() || self.wanted != self.shown || self.measuring.is_running()
    }

    /// Returns the index of the step that is shown, and the number of steps.
    #[cfg(feature = "testing")]
    pub(crate) fn shown_of(&self) -> Option<(usize, usize)> {
        self.steps().map(|steps| (self.shown, steps.count()))
    }

    /// Returns true while the series plays.
    pub(crate) fn is_playing(&self) -> bool {
        self.playback.is_playing()
    }

    /// Starts or stops the playback.
    pub(crate) fn set_playing(&mut self, plays: bool, now_s: f64) {
        match (plays, self.steps().cloned()) {
            (true, Some(steps)) => {
                if self.playback.next(self.shown, steps.count()).is_none() {
                    // From the end, it begins again.
                    self.wanted = 0;
                }
                self.playback.start(now_s);
            }
            _ => self.playback.stop(),
        }
    }

    /// Asks for the range of values of all steps.
    pub(crate) fn ask_for_range(&mut self) {
        self.wants_range = self.series.is_some();
    }

    /// Goes to a step, and stops the playback.
    pub(crate) fn go_to(&mut self, index: usize) {
        self.playback.stop();
        (self.wanted, self.failed) = (index, None);
    }

    /// Goes to the next or the previous step; returns false if the open volume has no steps.
    pub(crate) fn step(&mut self, is_forward: bool) -> bool {
        let Some(steps) = self.steps() else { return false };
        let last = steps.count() - 1;
        self.go_to(if is_forward { (self.wanted + 1).min(last) } else { self.wanted.saturating_sub(1) });
        true
    }

    /// Reads steps, and shows the one that is wanted, or the nearest that is there. Returns true if another one is shown
    /// than before.
    pub(crate) fn update(&mut self, editor: &mut LookEditor, ctx: &egui::Context) -> bool {
        if editor.series != self.series {
            editor.series.clone_from(&self.series);
        }
        let Some(series) = self.series.clone() else {
            (editor.plays_steps, editor.viewport.step_ms) = (false, None);
            self.end_preparation(editor);
            return false;
        };
        let Some(shown) = editor.viewport.dataset().filter(|_| !editor.is_correcting()) else { return false };
        let steps = &series.steps;
        self.update_range(&shown, &series, editor, ctx);
        if editor.viewport.displays(&editor.shown_looks()) {
            self.on_screen = self.shown;
        }
        self.cache.use_basis(StepBasis::new(&shown));
        self.cache.insert(self.shown, shown.clone());
        self.take_step(editor, steps);
        self.play(editor, steps, ctx);
        let most = most_kept(&shown, series.options.memory_budget_bytes);
        let order = self.playback.reading_order(self.wanted, steps.count(), most);
        self.read_next(&shown, &series, editor, &order, ctx);
        let has_changed = self.show_nearest(editor, steps, ctx);
        self.cache.keep_only(&[order.as_slice(), &[self.shown]].concat());
        self.prepare_next(editor, &order);
        has_changed
    }

    /// Takes a step that has been read.
    fn take_step(&mut self, editor: &mut LookEditor, steps: &TimeSteps) {
        let Some(((index, basis), read)) = self.loading.take_ended() else { return };
        match read.and_then(|read| read) {
            Ok(dataset) if self.cache.basis() == Some(&basis) => self.cache.insert(index, dataset),
            Ok(_) => {}
            Err(why) => {
                self.failed = Some(index);
                if index == self.wanted {
                    self.playback.stop();
                    editor.messages.error(text::time_series::not_read(index, &steps.name(index)), why);
                    self.wanted = self.shown;
                } else {
                    log::warn!("time step {} of {}: {why}", index + 1, steps.count());
                }
            }
        }
    }

    /// Wants the next step when it is due and the picture of the present one is on screen.
    fn play(&mut self, editor: &mut LookEditor, steps: &TimeSteps, ctx: &egui::Context) {
        let now_s = ctx.input(|input| input.time);
        let is_playing = self.playback.is_playing();
        editor.plays_steps = is_playing;
        editor.viewport.step_ms = is_playing.then(|| 1000.0 * self.playback.drawing_s());
        let Some(wait_s) = self.playback.wait_s(now_s) else { return };
        if wait_s > 0.0 {
            return ctx.request_repaint_after(Duration::from_secs_f64(wait_s));
        }
        // The window draws a frame when the picture is complete, and when the next step has been read.
        if self.wanted != self.shown || self.on_screen != self.shown {
            return;
        }
        match self.playback.next(self.shown, steps.count()) {
            Some(next) if self.failed != Some(next) => {
                self.wanted = next;
                self.playback.advance(now_s);
                ctx.request_repaint();
            }
            _ => self.playback.stop(),
        }
    }

    /// Starts to read the first step of an order that is not there.
    fn read_next(
        &mut self,
        shown: &Dataset,
        series: &ReadableSeries,
        editor: &mut LookEditor,
        order: &[usize],
        ctx: &egui::Context,
    ) {
        let is_missing = |index: &usize| self.cache.get(*index).is_none() && self.failed != Some(*index);
        let next = order.iter().copied().find(is_missing);
        let basis = StepBasis::new(shown);
        if let Some((index, known)) = self.loading.inputs() {
            let is_useful = *known == basis && order.contains(index);
            // A step that is wanted now does not wait for others.
            let is_first = Some(*index) == next || next != Some(self.wanted);
            if is_useful && is_first {
                return;
            }
            self.loading.discard();
        }
        let Some(index) = next else { return };
        let series = series.clone();
        let (shown, context) = (shown.clone(), editor.viewport.context().clone());
        let task = move |job: &JobControl| series.read(index, &shown, (&context, job.token()));
        if let Err(err) = self.loading.start(JobKind::TimeStep, ctx, (index, basis), task) {
            self.failed = Some(index);
            let short = text::time_series::not_read(index, "");
            editor.messages.error(short, text::opening::no_thread(err));
        }
    }

    /// Shows the step that is wanted, or of those that are there the nearest to it. Returns true if another one is shown
    /// than before.
    fn show_nearest(&mut self, editor: &mut LookEditor, steps: &TimeSteps, ctx: &egui::Context) -> bool {
        let Some(index) = self.cache.nearest_to(self.wanted).filter(|&index| index != self.shown) else {
            return false;
        };
        // While the series plays, no step is left out.
        if self.playback.is_playing() && index != self.wanted {
            return false;
        }
        let Some(dataset) = self.cache.get(index).cloned() else { return false };
        self.shown = index;
        let document = &mut editor.document;
        let reading = ReadChoices { choice: Some(steps.choice(index)), ..self.reading.clone() };
        document.volume = Some(VolumeFacts::new(steps.path(index).to_owned(), reading, &dataset));
        // Going to another step is no step of the history: all steps of it show the layers of this one.
        document.list_recorded_volumes(&dataset, ctx.input(|input| input.time));
        editor.viewport.set_dataset(dataset);
        true
    }

    /// Tells the renderer which steps may be shown next.
    fn prepare_next(&mut self, editor: &LookEditor, order: &[usize]) {
        let others = order.iter().filter(|&&index| index != self.shown);
        let there = others.filter_map(|&index| Some((index, self.cache.get(index)?.clone()))).take(PREPARED);
        let (indices, datasets): (Vec<usize>, Vec<Dataset>) = there.unzip();
        let is_playing = self.playback.is_playing();
        if self.prepared != (indices.clone(), is_playing) {
            (self.prepared, self.has_prepared) = ((indices, is_playing), true);
            editor.viewport.prepare_steps(UpcomingSteps { datasets, is_series: true, is_playing });
        }
    }

    /// Frees the memory of the steps that were prepared, after the series has ended.
    fn end_preparation(&mut self, editor: &LookEditor) {
        if std::mem::take(&mut self.has_prepared) {
            editor.viewport.prepare_steps(UpcomingSteps::default());
        }
    }

    /// Reads the range of the series if the user asks for it, and uses it when it is known.
    fn update_range(
        &mut self,
        shown: &Dataset,
        series: &ReadableSeries,
        editor: &mut LookEditor,
        ctx: &egui::Context,
    ) {
        if std::mem::take(&mut self.wants_range) && !self.measuring.is_running() {
            let (series, of, index) = (series.clone(), shown.clone(), self.shown);
            let context = editor.viewport.context().clone();
            let task = move |job: &JobControl| {
                let progress = |done: usize, total: usize| job.set_progress(done as u32, total as u32);
                series.read_by(&of, (&context, job.token()), |by| {
                    let read = series.steps.with_series_ranges((&of, index), RANGE_STEPS, by, progress);
                    read.map_err(|err| err.to_string())
                })
            };
            if let Err(err) = self.measuring.start(JobKind::SeriesRange, ctx, (), task) {
                let why = text::opening::no_thread(err);
                editor.messages.error(text::time_series::RANGE_NOT_READ, why);
            }
        }
        if self.measuring.is_running() {
            ctx.request_repaint_after(Duration::from_millis(100));
        }
        match self.measuring.take_result().map(|read| read.and_then(|read| read)) {
            None => {}
            Some(Err(why)) => editor.messages.error(text::time_series::RANGE_NOT_READ, why),
            Some(Ok(measured)) => {
                // The step may be another by now, with the layers that it had.
                let mut dataset = shown.clone();
                for (index, (field, own)) in
                    std::iter::zip(measured.fields().iter(), shown.fields().iter()).enumerate()
                {
                    let (from, to) = (own.volume().ranges(), field.volume().ranges());
                    dataset = dataset.with_ranges_of(index, to);
                    let layers = editor.document.settings.layers.count();
                    if index < layers {
                        editor.document.settings.layer_at_mut(index).map_range(from.robust, to.robust);
                    }
                }
                let range = dataset.volume().ranges().all;
                editor.messages.note(text::time_series::range_used(series.steps.count(), range));
                if let Some(facts) = &mut editor.document.volume {
                    facts.update(&dataset);
                }
                editor.viewport.set_dataset(dataset);
            }
        }
    }
}

/// Returns how many steps are kept in memory: all that fit into a quarter of what is free, and two at least.
fn most_kept(shown: &Dataset, budget_bytes: u64) -> usize {
    let fitting = budget_bytes / 4 / dataset_bytes(shown).max(1);
    usize::try_from(fitting).unwrap_or(MOST_KEPT).clamp(2, MOST_KEPT)
}
