//! What happens when files are damaged and processes are killed: every reader on mutations of what it reads, writers
//! killed in the middle. The ordinary run has a sample; `script/test --all` has the long versions.

#![expect(clippy::print_stdout, reason = "what was tried, and with which seeds, for whoever reads the log")]

mod changing_files;
mod hostile;
mod kills;
mod many_volumes;
mod mutations;
mod pictures;
mod random;
mod refusing_disks;
mod samples;
