//! Light search: finds a position for a light that makes shadows most effective. Tries candidates one after the
//! other, in small pictures of a downsampled volume.

use std::collections::VecDeque;

use glam::DVec3;

use super::balance::{MEASURED_SIZE, SmallPictures};
use super::measures::{exposure_for, seen_share};
use super::score::Score;
use super::small_volume::{quick, small_volume};
use crate::data::Dataset;
use crate::gpu::{GpuError, Renderer, ShaderLibrary};
use crate::model::{Light, LightPlace, Settings, auto, key_and_fill};

/// Minimum gain over the current position, in bits: smaller ones are invisible side by side, and opening similar
/// volumes should not make the light jump.
const CLEARLY_BETTER: f64 = 0.15;

/// Cost of a key light on the right, in bits: people assume that light comes from the left (Sun & Perona 1998).
const ON_THE_RIGHT: f64 = 0.15;

/// Minimum angle between suggestions; nearer ones look alike.
const APART_DEG: f64 = 30.0;

/// Minimum fraction of visible pixels for a picture to be scored: fewer than a hundred pixels are meaningless.
const LEAST_SEEN: f64 = 0.005;

/// Light whose position is searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sought {
    /// Key light of a first look; its fill light follows on the opposite side.
    KeyAndFill,
    /// Light of the settings with this index; the others are not moved.
    Light(usize),
}

/// Candidate lights with their score.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// Complete list of lights.
    pub lights: Vec<Light>,
    /// Score of the picture with these lights.
    pub score: Score,
    /// Balance measured with these lights.
    pub balance: f64,
    /// Exposure measured with these lights.
    pub exposure: f64,
    /// Penalty of the position, in bits.
    cost: f64,
}

impl Suggestion {
    /// Creates a suggestion with a given entropy of tones, balance and exposure.
    #[cfg(test)]
    pub(crate) fn of(lights: Vec<Light>, tones: f64, [balance, exposure]: [f64; 2]) -> Self {
        let score = Score { tones, shadowed: 0.0, dark: 0.0, edges: 0.0 };
        Self { lights, score, balance, exposure, cost: 0.0 }
    }

    fn worth(&self) -> f64 {
        self.score.total() - self.cost
    }
}

/// Result of a light search.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Score of the current lights.
    pub start: Suggestion,
    /// Best three suggestions, best first; fewer if nothing is visible.
    pub best: Vec<Suggestion>,
    /// `true` if the look gets a floor: the object shows few shadows itself, or stands on a broad base.
    wants_floor: bool,
}

impl Found {
    /// Creates a search result.
    #[cfg(test)]
    pub(crate) fn of(start: Suggestion, best: Vec<Suggestion>) -> Self {
        Self { start, best, wants_floor: false }
    }

    /// Returns the best suggestion, or the current lights unless it is clearly better.
    pub fn chosen(&self) -> &Suggestion {
        self.best
            .first()
            .filter(|best| best.worth() > self.start.worth() + CLEARLY_BETTER)
            .unwrap_or(&self.start)
    }

    /// Returns the settings with the chosen lights; balance and exposure change in proportion to those of the small
    /// pictures.
    #[must_use]
    pub fn apply(&self, first: &Settings) -> Settings {
        let (chosen, mut settings) = (self.chosen(), first.clone());
        settings.lights.clone_from(&chosen.lights);
        settings.shadows.balance *= chosen.balance / self.start.balance;
        settings.output.exposure *= chosen.exposure / self.start.exposure;
        if self.wants_floor && !settings.floor.on {
            settings.floor.on = true;
            settings.floor.color = auto::floor_color(settings.output.exposure);
        }
        settings.sanitise();
        settings
    }
}

/// Light search, executed step by step.
#[derive(Debug)]
pub struct LightSearch {
    renderer: Renderer,
    small: Dataset,
    settings: Settings,
    waiting: VecDeque<Candidate>,
    start: Option<Suggestion>,
    tried: Vec<(DVec3, Suggestion)>,
    /// Picture without lights, which all candidates share.
    unlit: Vec<[f32; 4]>,
}

/// Candidate lights to be scored.
#[derive(Debug)]
struct Candidate {
    /// Direction to the light in view space; `None` for the current lights.
    way: Option<DVec3>,
    lights: Vec<Light>,
    cost: f64,
}

impl LightSearch {
    /// Prepares a search for a volume and its settings, on the device of the shader library.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn new(
        shaders: ShaderLibrary,
        dataset: &Dataset,
        settings: &Settings,
        sought: Sought,
    ) -> Result<Self, GpuError> {
        let small = small_volume(dataset)?;
        let quick = quick(settings, dataset.volume(), small.volume());
        let as_they_are = Candidate { way: None, lights: settings.lights.clone(), cost: 0.0 };
        let others = LightPlace::to_try().into_iter().filter_map(|place| candidate(settings, place, sought));
        Ok(Self {
            renderer: Renderer::with_shaders(&shaders.context.clone(), shaders)?,
            waiting: std::iter::once(as_they_are).chain(others).collect(),
            small,
            settings: quick,
            start: None,
            tried: Vec::new(),
            unlit: Vec::new(),
        })
    }

    /// Scores the next candidate, which takes at most three small pictures. Returns true if there are more.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn step(&mut self) -> Result<bool, GpuError> {
        let Some(Candidate { way, lights, cost }) = self.waiting.pop_front() else { return Ok(false) };
        let quick = Settings { lights: lights.clone(), ..self.settings.clone() };
        let seen = if self.start.is_none() {
            SmallPictures::of(&mut self.renderer, &self.small, &quick)?
        } else {
            let unlit = std::mem::take(&mut self.unlit);
            SmallPictures::before(&mut self.renderer, &self.small, &quick, unlit)?
        };
        let balance = seen.balance();
        let with = seen.balanced(balance);
        let score = Score::of(&with, &seen.without, &seen.unlit, MEASURED_SIZE[0] as usize);
        let suggestion = Suggestion { lights, score, balance, exposure: exposure_for(&with), cost };
        log::debug!("light {way:?}: {score:?}, {:.3} in all", suggestion.worth());
        if let Some(way) = way {
            self.tried.push((way, suggestion));
        } else {
            self.start = Some(suggestion);
            if seen_share(&with) < LEAST_SEEN {
                self.waiting.clear();
            }
        }
        self.unlit = seen.unlit;
        Ok(!self.waiting.is_empty())
    }

    /// Returns the result of the search; `None` if nothing was scored.
    pub fn finish(self) -> Option<Found> {
        let Self { start, mut tried, small, settings, .. } = self;
        let start = start?;
        tried.sort_by(|(_, a), (_, b)| b.worth().total_cmp(&a.worth()));
        let mut best: Vec<(DVec3, Suggestion)> = Vec::new();
        for (way, suggestion) in tried {
            let is_apart =
                |(other, _): &(DVec3, Suggestion)| way.angle_between(*other) > APART_DEG.to_radians();
            if best.len() < 3 && best.iter().all(is_apart) {
                best.push((way, suggestion));
            }
        }
        let best = best.into_iter().map(|(_, suggestion)| suggestion).collect();
        let mut found = Found { start, best, wants_floor: false };
        let shadowed = found.chosen().score.shadowed;
        found.wants_floor = auto::wants_floor(&settings, small.volume(), shadowed);
        Some(found)
    }

    /// Scores all candidates.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn run(mut self) -> Result<Option<Found>, GpuError> {
        while self.step()? {}
        Ok(self.finish())
    }
}

/// Returns the lights with the selected one moved to a position; `None` if there is no such light.
fn candidate(settings: &Settings, place: LightPlace, sought: Sought) -> Option<Candidate> {
    let way = place.in_view();
    let cost = if place.is_right() { ON_THE_RIGHT } else { 0.0 };
    let lights = match sought {
        Sought::KeyAndFill => key_and_fill(&settings.camera, place).to_vec(),
        Sought::Light(index) => {
            let mut lights = settings.lights.clone();
            let light = lights.get_mut(index)?;
            let distance = DVec3::from(light.position).length().max(1.0);
            light.set_scene_position(settings.camera.scene_from_view() * way * distance, &settings.camera);
            light.on = true;
            lights
        }
    };
    Some(Candidate { way: Some(way), lights, cost })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn suggestion(tones: f64, at: [f64; 3]) -> Suggestion {
        Suggestion::of(vec![Light { position: at, ..Light::default() }], tones, [1.5, 1.2])
    }

    #[test]
    fn lights_stay_unless_others_are_clearly_better() {
        let start = suggestion(5.0, [0.0, 0.0, 3.0]);
        let found = |tones: f64| Found {
            start: start.clone(),
            best: vec![suggestion(tones, [3.0, 0.0, 0.0])],
            wants_floor: false,
        };
        assert_eq!(found(5.1).chosen(), &start);
        assert_eq!(found(5.1).apply(&Settings::default()).lights, start.lights);
        assert_eq!(found(5.2).apply(&Settings::default()).lights[0].position, [3.0, 0.0, 0.0]);
        assert_eq!(Found { best: Vec::new(), ..found(9.0) }.chosen(), &start);
    }

    #[test]
    fn brightness_follows_in_proportion() {
        let mut first = Settings::default();
        (first.shadows.balance, first.output.exposure) = (2.0, 1.5);
        let mut best = suggestion(9.0, [3.0, 0.0, 0.0]);
        (best.balance, best.exposure) = (1.8, 1.0);
        let found = Found { start: suggestion(5.0, [0.0, 0.0, 3.0]), best: vec![best], wants_floor: true };
        let look = found.apply(&first);
        assert!((look.shadows.balance - 2.0 * 1.8 / 1.5).abs() < 1e-12);
        assert!((look.output.exposure - 1.5 / 1.2).abs() < 1e-12);
        assert!(look.floor.on);
    }

    #[test]
    fn the_sought_light_moves_and_others_stay() {
        let lights = vec![Light { position: [0.0, 5.0, 0.0], ..Light::default() }; 2];
        let settings = Settings { lights, ..Settings::default() };
        for place in LightPlace::to_try() {
            let Candidate { lights, way, .. } =
                candidate(&settings, place, Sought::Light(1)).expect("a candidate");
            assert_eq!(lights[0], settings.lights[0]);
            let seen = settings.camera.scene_from_view().transpose() * DVec3::from(lights[1].position);
            assert!((seen / 5.0 - way.expect("a way")).length() < 1e-9, "as far away as before");
        }
        assert!(candidate(&settings, LightPlace::USUAL, Sought::Light(2)).is_none());
    }
}
