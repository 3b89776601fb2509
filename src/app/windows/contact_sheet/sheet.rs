//! Candidates of contact sheets, and their rendering as small pictures.

use std::sync::atomic::{AtomicBool, Ordering};

use eframe::egui::ColorImage;
use glam::DVec3;

use crate::app::common::commands::Command;
use crate::app::text;
use crate::app::windows::export::{Subject, Worker};
use crate::data::Volume;
use crate::gpu::{LightSearch, SmallLook, Sought, small_volume};
use crate::model::{
    Camera, ImageSpec, Kernel, Light, PRESETS, Preset, Resolution, Rig, Settings, Slabs, auto,
};

/// Size of a picture in pixels: 4:3, as first looks are framed, and four of them with their gaps are no wider than
/// the space that a window of 1280 points has beside its panel.
pub(in crate::app) const SIZE: [u32; 2] = [176, 132];
/// Positions for the selected light, as hours of a clock face around the line of sight.
const HOURS: [u32; 6] = [10, 12, 2, 4, 6, 8];
/// Angle from the line of sight to those positions, in degrees: closer to it few shadows are visible, and at 90° half
/// of the visible surface is unlit.
const ASIDE_DEG: f64 = 55.0;

/// Kind of contact sheet, by what its candidates vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Sheet {
    /// Lighting rigs, and positions for the selected light.
    #[default]
    Lights,
    /// Transfer function presets of the library.
    Presets,
    /// Whole looks that are proposed for the volume.
    Looks,
    /// Best positions for the selected light, found by search.
    Suggestions,
}

/// Candidate look of a contact sheet.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub name: String,
    pub tip: String,
    pub settings: Settings,
    /// Command that applies the candidate.
    pub command: Command,
    /// True if the candidate suits the kind of data.
    pub fits: bool,
}

/// Candidate look and its small picture.
pub(super) type Tried = (Candidate, ColorImage);

impl Sheet {
    /// Title of the contact sheet window.
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Lights => text::contact_sheet::LIGHTS,
            Self::Presets => text::contact_sheet::PRESETS,
            Self::Looks => text::contact_sheet::LOOKS,
            Self::Suggestions => text::contact_sheet::SUGGESTIONS,
        }
    }

    /// Renders all candidates until cancelled; each picture is passed to `hand_on` when it is finished, with the
    /// total number of candidates. An error says why there are no more.
    pub(super) fn try_all(
        self,
        subject: &Subject,
        is_unwanted: &AtomicBool,
        hand_on: &dyn Fn(usize, Tried),
    ) -> Result<(), String> {
        let is_wanted = || !is_unwanted.load(Ordering::Relaxed);
        let mut worker = Worker::new(subject)?;
        let mut shown = 0;
        if self == Self::Suggestions && subject.settings.lights.get(subject.selected_light).is_some() {
            // Shown first, because the search takes long, and as the reference for the suggestions.
            let Settings { lights, .. } = subject.settings.clone();
            let now = with(text::contact_sheet::AS_IT_IS.to_owned(), lights, &subject.settings);
            let picture = small_picture(&mut worker, subject, &closer(&now.settings, subject))?;
            hand_on(0, (now, picture));
            shown = 1;
        }
        let candidates = match self {
            Self::Lights => with_lights(&subject.settings, subject.selected_light),
            Self::Presets => with_presets(&subject.settings, subject.dataset.volume()),
            Self::Suggestions => suggested(subject, &worker, &is_wanted)?,
            Self::Looks => return looks(subject, &mut worker, &is_wanted, hand_on),
        };
        let count = shown + candidates.len();
        for candidate in candidates.into_iter().take_while(|_| is_wanted()) {
            let picture = small_picture(&mut worker, subject, &closer(&candidate.settings, subject))?;
            hand_on(count, (candidate, picture));
        }
        Ok(())
    }
}

/// Moves the camera as close as the outline of the object allows, if all of it is visible: small pictures have no
/// space for surroundings.
fn closer(settings: &Settings, subject: &Subject) -> Settings {
    let mut closer = settings.clone();
    if let Some(outline) = subject.outline.as_ref().filter(|outline| !outline.is_empty()) {
        let least = outline.least_distance(&closer.camera);
        if closer.camera.distance > least && least > 0.0 {
            closer.camera.distance = least;
        }
    }
    closer
}

/// Renders a small picture of a look with quick settings.
pub(in crate::app) fn small_picture(
    worker: &mut Worker,
    subject: &Subject,
    settings: &Settings,
) -> Result<ColorImage, String> {
    picture(worker, subject, &quick(settings))
}

/// Renders a small picture of a look with its own settings.
fn picture(worker: &mut Worker, subject: &Subject, settings: &Settings) -> Result<ColorImage, String> {
    let shown = worker.render(subject, settings, &ImageSpec::new(SIZE))?;
    Ok(ColorImage::from_rgba_unmultiplied(SIZE.map(|n| n as usize), &shown))
}

/// Candidates with each preset applied, except that of the benchmarks; presets for other kinds of data come last.
fn with_presets(settings: &Settings, volume: &Volume) -> Vec<Candidate> {
    let ranges = volume.ranges();
    let kind = volume.kind().kind;
    let mut presets: Vec<_> = PRESETS.into_iter().filter(|preset| preset.domain() != "bench").collect();
    let fits = |preset: &Preset| preset.suits(&kind);
    presets.sort_by_key(|preset| !fits(preset));
    presets
        .into_iter()
        .filter_map(|preset| {
            let settings = preset.apply(settings, &ranges).ok()?;
            let name = preset.title.to_owned();
            let fits = fits(&preset);
            let tip = if fits { text::contact_sheet::USE_TIP } else { text::transfer::FOR_CT };
            let command = Command::UsePreset(preset);
            Some(Candidate { name, tip: tip.to_owned(), settings, command, fits })
        })
        .collect()
}

/// Candidate with other lights than the current look.
fn with(name: String, lights: Vec<Light>, settings: &Settings) -> Candidate {
    let settings = Settings { lights: lights.clone(), ..settings.clone() };
    let tip = text::contact_sheet::USE_TIP.to_owned();
    Candidate { name, tip, settings, command: Command::UseLights(lights), fits: true }
}

/// Candidates with each choice of lights.
fn with_lights(settings: &Settings, selected: usize) -> Vec<Candidate> {
    let choices = lights_to_try(settings, selected).into_iter();
    choices.map(|(name, lights)| with(name, lights, settings)).collect()
}

/// Candidates with the selected light at the positions of the light search, best first.
fn suggested(
    subject: &Subject,
    worker: &Worker,
    is_wanted: &dyn Fn() -> bool,
) -> Result<Vec<Candidate>, String> {
    let Subject { dataset, settings, selected_light, .. } = subject;
    let Some(light) = settings.lights.get(*selected_light) else {
        return Err(text::contact_sheet::NO_LIGHT.to_owned());
    };
    let search = LightSearch::new(worker.shaders(), dataset, settings, Sought::Light(*selected_light));
    let mut search = search.map_err(|err| err.to_string())?;
    while is_wanted() && search.step().map_err(|err| err.to_string())? {}
    let found = search.finish();
    let best = found.map(|found| found.best).unwrap_or_default().into_iter().enumerate();
    Ok(best
        .map(|(at, suggestion)| {
            // Exposed as the picture will be when its balance is kept.
            let mut shown = settings.clone();
            shown.shadows.balance = suggestion.balance;
            with(text::contact_sheet::suggestion(&light.name, at + 1), suggestion.lights, &shown)
        })
        .collect())
}

/// Renders the proposed whole looks of the volume, on a small copy of it.
fn looks(
    subject: &Subject,
    worker: &mut Worker,
    is_wanted: &dyn Fn() -> bool,
    hand_on: &dyn Fn(usize, Tried),
) -> Result<(), String> {
    let whole = subject.dataset.volume();
    let small = small_volume(&subject.dataset).map_err(|err| err.to_string())?;
    let proposals = auto::looks(&subject.first, small.volume(), small.histogram());
    let on_small = Subject { dataset: small, ..subject.clone() };
    let count = proposals.len();
    for (at, proposal) in proposals.into_iter().enumerate().take_while(|_| is_wanted()) {
        // The brightness of the first look has been measured already.
        let look = if at == 0 {
            SmallLook::known(whole, &on_small.dataset, proposal.settings)
        } else {
            worker.measure(whole, &on_small.dataset, &proposal.settings)?
        };
        let mut shown = closer(&look.quick, subject);
        even_faces(&mut shown);
        let picture = picture(worker, &on_small, &shown)?;
        let candidate = Candidate {
            name: text::contact_sheet::look(at + 1, proposal.name),
            tip: proposal.differs.to_owned(),
            command: Command::UseLook(Box::new(look.settings.clone())),
            settings: look.settings,
            fits: true,
        };
        hand_on(count, (candidate, picture));
    }
    Ok(())
}

/// Choices of lights to try, with their names.
fn lights_to_try(settings: &Settings, selected: usize) -> Vec<(String, Vec<Light>)> {
    let mut all: Vec<_> =
        Rig::ALL.iter().map(|rig| (rig.name().to_owned(), rig.lights(&settings.camera))).collect();
    if let Some(light) = settings.lights.get(selected) {
        all.extend(HOURS.map(|hour| {
            let mut lights = settings.lights.clone();
            let world = at_hour(light, &settings.camera, hour);
            lights[selected].set_scene_position(world, &settings.camera);
            (text::contact_sheet::at_hour(&light.name, hour), lights)
        }));
    }
    all
}

/// Position on a clock face around the line of sight, at the light's distance from the centre, in scene space.
fn at_hour(light: &Light, camera: &Camera, hour: u32) -> DVec3 {
    let view = camera.scene_from_view();
    let (sin, cos) = (f64::from(hour) / 12.0 * std::f64::consts::TAU).sin_cos();
    let (aside, along) = ASIDE_DEG.to_radians().sin_cos();
    let distance = DVec3::from(light.position).length().max(1.0);
    (view.x_axis * (sin * aside) + view.y_axis * (cos * aside) + view.z_axis * along) * distance
}

/// Number of sky directions, and of points of an area light, that suffice for a small picture.
const FEW_DIRECTIONS: u32 = 16;

/// Chooses slabs that leave no grain: small pictures have few pixels, and small volumes large voxels.
fn even_faces(settings: &mut Settings) {
    (settings.sampling.slabs, settings.sampling.slab) = (Slabs::ByNeed, 1.0);
}

/// Returns quick settings for a small picture.
fn quick(settings: &Settings) -> Settings {
    let mut quick = settings.clone();
    quick.shadows.resolution = Resolution::Half;
    (quick.shadows.kernel, quick.sampling.kernel) = (Kernel::Prefiltered, Kernel::Prefiltered);
    even_faces(&mut quick);
    quick.sky.directions = quick.sky.directions.min(FEW_DIRECTIONS);
    quick.shadows.area.samples = quick.shadows.area.samples.min(FEW_DIRECTIONS);
    quick
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::synthetic::builtin;

    #[test]
    fn hours_are_where_a_clock_has_them() {
        let settings = Settings::default();
        let view = settings.camera.scene_from_view().transpose();
        let seen = |hour| view * at_hour(&settings.lights[0], &settings.camera, hour);
        assert!(seen(12).y > 0.0 && seen(12).x.abs() < 1e-9, "above");
        assert!(seen(2).x > 0.0 && seen(2).y > 0.0 && seen(8).x < 0.0 && seen(8).y < 0.0);
        let distance = DVec3::from(settings.lights[0].position).length();
        assert!((seen(4).length() - distance).abs() < 1e-9 && seen(4).z > 0.0, "on the viewer's side");
    }

    #[test]
    fn all_candidates_have_names_of_their_own() {
        let mut names: Vec<_> =
            lights_to_try(&Settings::default(), 0).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names.len(), Rig::ALL.len() + HOURS.len());
        names.sort();
        names.dedup();
        assert_eq!(names.len(), Rig::ALL.len() + HOURS.len());
        assert_eq!(lights_to_try(&Settings::default(), 9).len(), Rig::ALL.len(), "no light is selected");
        let volume = builtin("sphere", Some(8)).unwrap();
        let presets = with_presets(&Settings::default(), &volume);
        let last_that_fits = presets.iter().rposition(|look| look.fits);
        assert_eq!(last_that_fits, presets.iter().position(|look| !look.fits).map(|first| first - 1));
        assert_eq!(presets.len(), PRESETS.len() - 1);
        let usual = Settings::default();
        // Presets of light leave the curve as it is.
        let differs = |look: &Settings| {
            look.transfer != usual.transfer || look.sky != usual.sky || look.scattering != usual.scattering
        };
        assert!(presets.iter().all(|look| differs(&look.settings)));
    }
}
