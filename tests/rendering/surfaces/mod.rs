//! Pictures of surfaces against oracles that share nothing with the program: level, grain and thin shells.

mod peaks;
mod plate_oracle;
mod plates;
