//! Effects of single settings on a picture: combined lights, cuts, the floor, stretched kernels, shadow algorithms.

mod combine;
mod cuts;
mod floor;
mod near_field;
mod peaks;
mod phantom;
mod sides;
mod stretch;
mod variants;
