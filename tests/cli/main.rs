//! Tests of the command line as scripts see it: exit codes, messages, and the files that are written or not.
//!
//! Exit codes: 0 ok, 1 a check that does not hold, 2 usage, 3 bad input, 4 no usable graphics adapter, 5 out of
//! memory or over a limit, 6 input or output.

mod animation;
mod bench;
mod checks;
mod convert;
mod data;
mod inputs;
mod light;
mod memory_limits;
mod outputs;
mod render;
mod replay;
mod results;
mod support;
mod usage;

use support::{program, volumes};
