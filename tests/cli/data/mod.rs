//! What is in a volume, and what the command line knows better than its file.

mod corrections;
mod info;
