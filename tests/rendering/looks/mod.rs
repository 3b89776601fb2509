//! What single settings do to a picture: combined lights, cuts, the floor, far away, other algorithms.

mod combine;
mod cuts;
mod floor;
mod near_field;
mod peaks;
mod phantom;
mod sides;
mod stretch;
mod variants;
