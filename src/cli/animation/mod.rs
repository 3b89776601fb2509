//! Commands that render an animation: `chiaroscuro turntable` and `chiaroscuro time-series`.

mod frame_selection;
mod frame_writer;
mod step_reader;
mod time_series;
mod turntable;

pub(super) use self::time_series::{TimeSeriesArgs, run as run_time_series};
pub(super) use self::turntable::{TurntableArgs, run as run_turntable};
