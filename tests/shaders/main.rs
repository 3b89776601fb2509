//! Every shader is valid, and agrees with the Rust code about structs, constants and sizes. Needs no
//! GPU: shaders are parsed and looked into.

mod bindings;
mod constants;
mod driver_rules;
mod imports;
mod layouts;
mod sources;
mod structs;
mod validity;
