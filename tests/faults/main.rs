//! Fault tests: every reader on damaged and hostile files, writers that are killed, disks that refuse, and random
//! scenes. The ordinary run has a sample; `script/test --all` has the long versions.

#![expect(clippy::print_stdout, reason = "what was tried, and with which seeds, for whoever reads the log")]

mod changing_files;
mod hostile;
mod killed_writers;
mod mutations;
mod pictures;
mod random;
mod refusing_disks;
mod samples;
mod volume_leaks;
