//! Recordings: stacks of slices of one object at several times or in several channels, by the numbers in their names.
//! Each time and channel is chosen by its index, as in files that hold several.

use std::collections::{BTreeSet, HashMap, HashSet};

use rayon::prelude::*;

use super::super::channels_and_times::{ChannelsAndTimes, ChosenChannelAndTime};
use super::super::gaps::{GapWords, SliceRun};
use super::groups::{CounterValue, RecordedStack, SliceGroup, gap_remark, group_by_key};
use chiaroscuro_files::natural_sort_key;
use chiaroscuro_volume::{LoadContext, LoadError, VolumeChoice};

/// Wording of the remark on slices that one time and channel lacks.
const OTHER_STACKS: GapWords = GapWords { pictures: "files", claim: "are in the whole recording" };

/// Series of slices to choose from: one stack, or a recording of several.
#[derive(Debug)]
pub(super) struct SliceSeries {
    /// Common name of all files, and all of them.
    pub(super) group: SliceGroup,
    /// Times and channels, where there are several.
    pub(super) recording: Option<SliceRecording>,
}

/// Stacks of slices of equal size that were recorded at several times or in several channels.
#[derive(Debug)]
pub(super) struct SliceRecording {
    /// Width and height of a slice, in pixels.
    size: [u64; 2],
    /// Number of slices of a complete stack.
    pub(super) slice_count: usize,
    times: Vec<CounterValue>,
    channels: Vec<CounterValue>,
    /// Stacks that exist, of one slice at least.
    stacks: HashMap<ChannelAndTime, NumberedStack>,
}

/// Slices of one time and channel, and a remark about gaps in their numbers.
#[derive(Debug)]
struct NumberedStack {
    slices: Vec<NumberedSlice>,
    gap: Option<String>,
}

/// Index of a channel and of a time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct ChannelAndTime {
    channel: usize,
    time: usize,
}

/// File of a slice, and the index of the slice in its stack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct NumberedSlice {
    slice: usize,
    file: usize,
}

/// Files of the chosen time and channel.
#[derive(Debug)]
pub(super) struct ChosenStack {
    /// Files by slice; `None` for a slice without a file, at least one is there.
    pub(super) files: Vec<Option<usize>>,
    pub(super) choice: ChosenChannelAndTime,
    pub(super) remarks: Vec<String>,
}

/// Joins the stacks of each recording into one series, where their slices have equal sizes and fit each other; all
/// other groups are series of their own. `size_of` reads the size of a file's picture, if it can be read.
pub(super) fn join_recordings(
    groups: Vec<SliceGroup>,
    size_of: impl Fn(usize) -> Option<[u64; 2]> + Sync,
) -> Vec<SliceSeries> {
    let keys: Vec<_> = groups
        .iter()
        .enumerate()
        .map(|(at, group)| {
            // A group that belongs to no recording has a key of its own.
            let recording = group.recorded.as_ref().map(|stack| stack.recording.clone());
            let own = recording.is_none().then_some(at);
            ((group.kind, recording, own), at)
        })
        .collect();
    let mut groups: Vec<Option<SliceGroup>> = groups.into_iter().map(Some).collect();
    let mut series = Vec::new();
    for (_, members) in group_by_key(keys) {
        let parts: Vec<SliceGroup> = members.into_iter().filter_map(|at| groups[at].take()).collect();
        match SliceRecording::new(&parts, &size_of) {
            Some(recording) => {
                let (kind, name) = (parts[0].kind, recording_name(&parts));
                let files = parts.into_iter().flat_map(|part| part.files).collect();
                let group = SliceGroup { name, kind, files, gap: None, recorded: None };
                series.push(SliceSeries { group, recording: Some(recording) });
            }
            None => series.extend(parts.into_iter().map(|group| SliceSeries { group, recording: None })),
        }
    }
    series
}

/// Name that the stacks of a recording have in common.
fn recording_name(parts: &[SliceGroup]) -> String {
    let recorded = parts.first().and_then(|part| part.recorded.as_ref());
    recorded.map_or_else(String::new, |stack| stack.recording.clone())
}

/// Distinct values of a counter in natural order.
fn distinct_values<'a>(values: impl Iterator<Item = &'a CounterValue>) -> Vec<CounterValue> {
    let mut seen = HashSet::new();
    let mut distinct: Vec<CounterValue> =
        values.filter(|value| seen.insert(value.digits.as_str())).cloned().collect();
    distinct.sort_by_cached_key(|value| natural_sort_key(&value.digits));
    distinct
}

/// Order of slice numbers, which are digits without leading zeros.
fn number_order(digits: &str) -> (usize, &str) {
    (digits.len(), digits)
}

impl SliceRecording {
    /// Puts stacks together; `None` where they are no recording: a single one, most pairs of time and channel are
    /// missing, sizes differ, or slices cannot be assigned to each other.
    fn new(parts: &[SliceGroup], size_of: &(impl Fn(usize) -> Option<[u64; 2]> + Sync)) -> Option<Self> {
        if parts.len() < 2 {
            return None;
        }
        let stacks: Vec<&RecordedStack> =
            parts.iter().map(|part| part.recorded.as_ref()).collect::<Option<_>>()?;
        let times = distinct_values(stacks.iter().map(|stack| &stack.time));
        let channels = distinct_values(stacks.iter().map(|stack| &stack.channel));
        // Numbers that change together are no axes.
        if times.len().saturating_mul(channels.len()) > parts.len().saturating_mul(2) {
            return None;
        }
        let SliceNumbering { indices, slice_count, is_by_number, gap } = SliceNumbering::new(&stacks)?;
        let sizes: Vec<[u64; 2]> =
            parts.par_iter().filter_map(|part| size_of(*part.files.first()?)).collect();
        let &size = sizes.first()?;
        if sizes.iter().any(|&other| other != size) {
            return None;
        }
        let index_of = |values: &[CounterValue]| -> HashMap<String, usize> {
            values.iter().enumerate().map(|(at, value)| (value.digits.clone(), at)).collect()
        };
        let (time_index, channel_index) = (index_of(&times), index_of(&channels));
        let mut filed = HashMap::new();
        for ((part, stack), indices) in parts.iter().zip(&stacks).zip(indices) {
            let key = ChannelAndTime {
                channel: *channel_index.get(&stack.channel.digits)?,
                time: *time_index.get(&stack.time.digits)?,
            };
            let slices = part.files.iter().zip(indices);
            let slices = slices.map(|(&file, slice)| NumberedSlice { slice, file }).collect();
            let gap = if is_by_number { gap.clone() } else { part.gap.clone() };
            filed.insert(key, NumberedStack { slices, gap });
        }
        Some(Self { size, slice_count, times, channels, stacks: filed })
    }

    /// Dimensions of a complete stack, in voxels along x, y, z.
    pub(super) fn dims(&self) -> [u64; 3] {
        [self.size[0], self.size[1], self.slice_count as u64]
    }

    /// Selects the stack of a time and a channel by the user's choice, where there are several.
    ///
    /// # Errors
    /// [`LoadError::Several`] where nothing is selected, `BadInput` where the selected stack has no files.
    pub(super) fn choose(
        &self,
        context: LoadContext<'_>,
        choice: &VolumeChoice,
    ) -> Result<ChosenStack, LoadError> {
        let labels = |values: &[CounterValue]| values.iter().map(|value| value.label.clone()).collect();
        let steps = ChannelsAndTimes {
            dims: self.dims(),
            channels: self.channels.len(),
            channel_names: labels(&self.channels),
            channel_colors: Vec::new(),
            frames: self.times.len(),
            frame_names: labels(&self.times),
        };
        let choice = steps.choose(context, choice)?;
        let mut slots = HashMap::new();
        let times = if choice.time_is_depth { 0..self.times.len() } else { choice.frame..choice.frame + 1 };
        let mut remarks = BTreeSet::new();
        for time in times {
            let Some(stack) = self.stacks.get(&ChannelAndTime { channel: choice.channel, time }) else {
                continue;
            };
            slots.extend(stack.slices.iter().map(|&NumberedSlice { slice, file }| ([time, slice], file)));
            remarks.extend(stack.gap.clone());
        }
        let wanted = choice.slices(self.slice_count, self.times.len());
        let files: Vec<Option<usize>> = wanted.iter().map(|place| slots.get(place).copied()).collect();
        let Some(SliceRun { slices, remark }) = SliceRun::new(&files, OTHER_STACKS) else {
            let [channel, time] = [&self.channels[choice.channel], &self.times[choice.frame]];
            let names = [time, channel].map(|value| value.label.as_str());
            let names: Vec<&str> = names.into_iter().filter(|name| !name.is_empty()).collect();
            return Err(context.bad_input_error(
                "files",
                format!("there are no files for {}", names.join(" and ")),
                "choose another time step or channel with --frame or --channel",
            ));
        };
        Ok(ChosenStack { files: slices, choice, remarks: remarks.into_iter().chain(remark).collect() })
    }
}

/// Assignment of the slices of several stacks to each other.
struct SliceNumbering {
    /// Index of each slice in a complete stack, for each stack.
    indices: Vec<Vec<usize>>,
    /// Number of slices of a complete stack.
    slice_count: usize,
    /// True if slices are assigned by their numbers, otherwise by their order.
    is_by_number: bool,
    /// Remark about numbers that no stack has.
    gap: Option<String>,
}

impl SliceNumbering {
    /// Assigns slices by their numbers where stacks share these, so that a stack may lack some, or by their order
    /// where each stack goes on counting; `None` where they do not belong together.
    fn new(stacks: &[&RecordedStack]) -> Option<Self> {
        let mut all: Vec<&str> = stacks.iter().flat_map(|stack| &stack.numbers).map(String::as_str).collect();
        all.sort_unstable_by_key(|digits| number_order(digits));
        all.dedup();
        let largest = stacks.iter().max_by_key(|stack| stack.numbers.len())?;
        let most = largest.numbers.len();
        let of_largest: HashSet<&str> = largest.numbers.iter().map(String::as_str).collect();
        let is_shared = |stack: &&RecordedStack| {
            let distinct: HashSet<&String> = stack.numbers.iter().collect();
            distinct.len() == stack.numbers.len()
                && stack.numbers.iter().any(|digits| of_largest.contains(digits.as_str()))
        };
        // Most slices are in one stack at least: others that count differently would make it full of holes.
        if all.len() <= most.saturating_mul(2) && stacks.iter().all(is_shared) {
            let index_of: HashMap<&str, usize> =
                all.iter().enumerate().map(|(at, &digits)| (digits, at)).collect();
            let of_stack = |stack: &&RecordedStack| -> Option<Vec<usize>> {
                stack.numbers.iter().map(|digits| index_of.get(digits.as_str()).copied()).collect()
            };
            let indices = stacks.iter().map(of_stack).collect::<Option<_>>()?;
            let (slice_count, gap) = (all.len(), gap_remark(&all));
            return Some(Self { indices, slice_count, is_by_number: true, gap });
        }
        let is_equal = stacks.iter().all(|stack| stack.numbers.len() == most);
        let by_order = || vec![(0..most).collect(); stacks.len()];
        is_equal.then(|| Self { indices: by_order(), slice_count: most, is_by_number: false, gap: None })
    }
}
