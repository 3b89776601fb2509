//! Choice of a channel and a time step among those of a file, or of a folder of slices.

use crate::reading::placement::GridPlacement;
use chiaroscuro_volume::{FileDimension, LoadContext, LoadError, VolumeChoice, VolumeOffer};

/// Numbers of channels and time steps in a file.
pub(crate) struct ChannelsAndTimes {
    pub(crate) dims: [u64; 3],
    pub(crate) channels: usize,
    pub(crate) channel_names: Vec<String>,
    /// Colours of the channels in sRGB, as far as the file has them.
    pub(crate) channel_colors: Vec<Option<[u8; 3]>>,
    pub(crate) frames: usize,
    /// Names of the time steps; empty where the file has none.
    pub(crate) frame_names: Vec<String>,
}

/// Chosen channel and time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ChosenChannelAndTime {
    pub(crate) channel: usize,
    pub(crate) frame: usize,
    /// True if each time step is one slice, and all together are shown as a volume.
    pub(crate) time_is_depth: bool,
}

impl ChannelsAndTimes {
    /// Selects the channel and the time step by the user's choice, where there are several.
    pub(crate) fn choose(
        &self,
        context: LoadContext<'_>,
        choice: &VolumeChoice,
    ) -> Result<ChosenChannelAndTime, LoadError> {
        let [width, height, slices] = self.dims;
        // A time series of one slice is a volume only with time as its depth.
        let is_time_depth = slices == 1 && self.frames > 1 && choice.frame.is_none();
        let dims = [width, height, if is_time_depth { self.frames as u64 } else { slices }];
        let offers = |count: usize, names: &[String]| -> Vec<VolumeOffer> {
            let name = |at: usize| names.get(at).map_or("", String::as_str);
            (0..count).map(|at| VolumeOffer::with_number(at, name(at), dims)).collect()
        };
        let mut channels = offers(self.channels, &self.channel_names);
        for (channel, color) in channels.iter_mut().zip(&self.channel_colors) {
            channel.color = *color;
        }
        let channel = context.resolve_choice(choice, FileDimension::Channel, channels)?;
        let frame = if is_time_depth {
            0
        } else {
            let frames = offers(self.frames, &self.frame_names);
            context.resolve_choice(choice, FileDimension::Frame, frames)?
        };
        Ok(ChosenChannelAndTime { channel, frame, time_is_depth: is_time_depth })
    }
}

impl ChosenChannelAndTime {
    /// Time step and slice index of each slice of the volume.
    pub(crate) fn slices(&self, slices: usize, frames: usize) -> Vec<[usize; 2]> {
        if self.time_is_depth {
            (0..frames).map(|frame| [frame, 0]).collect()
        } else {
            (0..slices).map(|slice| [self.frame, slice]).collect()
        }
    }

    /// Adds the remark on time as depth to a placement; the scale along it is unknown.
    pub(crate) fn add_time_remark(&self, placement: &mut GridPlacement) {
        if self.time_is_depth {
            let remark = "each time step is one slice: they are stacked in the order of time";
            placement.remarks.push(remark.to_owned());
            let axes = placement.world_from_index.matrix3;
            let flat = GridPlacement::from_spacing([1.0, axes.y_axis.length() / axes.x_axis.length(), 1.0]);
            placement.world_from_index = flat.world_from_index;
            placement.is_scale_known = false;
        }
    }
}
