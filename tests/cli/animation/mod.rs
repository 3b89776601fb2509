//! Tests of the commands that render animations: `turntable` and `time-series`.

mod time_series;
mod turntable;
