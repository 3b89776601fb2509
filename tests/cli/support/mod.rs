//! Shared helpers of the command-line tests: running the program in a folder, and small volumes.

pub(crate) mod program;
pub(crate) mod volumes;
