//! First look: measurements when a volume is opened, in addition to the automatic settings, that choose brightness,
//! lights and the floor.

mod balance;
mod finish;
mod light_search;
mod measures;
mod score;
mod small_look;
mod small_volume;

pub use self::balance::{balance, balance_quickly, first_look, first_look_upright};
pub use self::finish::{Open, finish_look};
pub use self::light_search::{Found, LightSearch, Sought, Suggestion};
pub use self::measures::{dark_share, exposure_for, mean_luminance, seen_share, shadowed_share};
pub use self::score::Score;
pub use self::small_look::SmallLook;
pub use self::small_volume::small_volume;
