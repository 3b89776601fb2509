//! First look: measurements when a volume is opened, in addition to the automatic settings, that choose brightness,
//! lights and the floor.

mod balance;
mod finish;
mod image_statistics;
mod light_search;
mod measured_settings;
mod score;
mod small_volume;

pub use self::balance::{first_look, first_look_upright, measure_balance, measure_balance_fast};
pub use self::finish::{UndecidedPart, complete_first_look};
pub use self::image_statistics::{
    automatic_exposure, dark_fraction, mean_luminance, shadowed_fraction, visible_fraction,
};
pub use self::light_search::{LightSearch, LightSearchResult, LightSuggestion, SearchedLight};
pub use self::measured_settings::MeasuredSettings;
pub use self::score::LightingScore;
pub use self::small_volume::downsampled_volume;
