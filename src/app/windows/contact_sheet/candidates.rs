//! Candidates of contact sheets, and their rendering as small pictures.

use eframe::egui::ColorImage;
use glam::DVec3;

use crate::app::common::commands::AppCommand;
use crate::app::text;
use crate::app::windows::export::{ExportScene, ExportWorker};
use chiaroscuro_render::{LightSearch, MeasuredSettings, SearchedLight, downsampled_volume};
use chiaroscuro_scene::{
    Camera, ImageSpec, LightSettings, LightVolumeResolution, LightingRig, PRESETS, Preset,
    ReconstructionKernel, Settings, SlabMode, first_look,
};
use chiaroscuro_volume::{CancelToken, Volume};

/// Size of a picture in pixels: 4:3, as first looks are framed, and four of them with their gaps are no wider than
/// the space that a window of 1280 points has beside its panel.
pub(crate) const PICTURE_SIZE: [u32; 2] = [176, 132];
/// Positions for the selected light, as hours of a clock face around the line of sight.
const CLOCK_HOURS: [u32; 6] = [10, 12, 2, 4, 6, 8];
/// Angle from the line of sight to those positions, in degrees: closer to it few shadows are visible, and at 90° half
/// of the visible surface is unlit.
const CLOCK_ANGLE_DEG: f64 = 55.0;

/// Kind of contact sheet, by what its candidates vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum ContactSheetKind {
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
pub(super) struct LookCandidate {
    pub name: String,
    pub tip: String,
    pub settings: Settings,
    /// Command that applies the candidate.
    pub command: AppCommand,
    /// True if the candidate suits the kind of data.
    pub suits_data: bool,
}

/// Candidate look and its small picture.
pub(super) type RenderedCandidate = (LookCandidate, ColorImage);

impl ContactSheetKind {
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
    pub(super) fn render_candidates(
        self,
        subject: &ExportScene,
        cancel: &CancelToken,
        send: &dyn Fn(usize, RenderedCandidate),
    ) -> Result<(), String> {
        let mut worker = ExportWorker::new(subject)?;
        let mut shown = 0;
        if self == Self::Suggestions && subject.settings.lights.get(subject.selected_light).is_some() {
            // Shown first, because the search takes long, and as the reference for the suggestions.
            let Settings { lights, .. } = subject.settings.clone();
            let now = with_other_lights(text::contact_sheet::UNCHANGED.to_owned(), lights, &subject.settings);
            let picture = render_small(&mut worker, subject, &move_closer(&now.settings, subject))?;
            send(0, (now, picture));
            shown = 1;
        }
        let candidates = match self {
            Self::Lights => light_candidates(&subject.settings, subject.selected_light),
            Self::Presets => preset_candidates(&subject.settings, subject.dataset.volume()),
            Self::Suggestions => suggested_lights(subject, &worker, cancel)?,
            Self::Looks => return render_whole_looks(subject, &mut worker, cancel, send),
        };
        let count = shown + candidates.len();
        for candidate in candidates.into_iter().take_while(|_| !cancel.is_cancelled()) {
            let picture = render_small(&mut worker, subject, &move_closer(&candidate.settings, subject))?;
            send(count, (candidate, picture));
        }
        Ok(())
    }
}

/// Moves the camera as close as the outline of the object allows, if all of it is visible: small pictures have no
/// space for surroundings.
fn move_closer(settings: &Settings, subject: &ExportScene) -> Settings {
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
pub(crate) fn render_small(
    worker: &mut ExportWorker,
    subject: &ExportScene,
    settings: &Settings,
) -> Result<ColorImage, String> {
    render_candidate(worker, subject, &quick_settings(settings))
}

/// Renders a small picture of a look with its own settings.
fn render_candidate(
    worker: &mut ExportWorker,
    subject: &ExportScene,
    settings: &Settings,
) -> Result<ColorImage, String> {
    let shown = worker.render(subject, settings, &ImageSpec::new(PICTURE_SIZE))?;
    Ok(ColorImage::from_rgba_unmultiplied(PICTURE_SIZE.map(|n| n as usize), &shown))
}

/// Candidates with each preset that fits other volumes applied; presets for other kinds of data come last.
fn preset_candidates(settings: &Settings, volume: &Volume) -> Vec<LookCandidate> {
    let ranges = volume.ranges();
    let kind = volume.kind().kind;
    let mut presets: Vec<_> = PRESETS.into_iter().filter(Preset::is_offered).collect();
    let fits = |preset: &Preset| preset.suits_data(&kind);
    presets.sort_by_key(|preset| !fits(preset));
    presets
        .into_iter()
        .filter_map(|preset| {
            let settings = preset.apply(settings, &ranges).ok()?;
            let name = preset.title.to_owned();
            let fits = fits(&preset);
            let tip = if fits { text::contact_sheet::USE_TIP } else { text::transfer::FOR_CT };
            let command = AppCommand::UsePreset(preset);
            Some(LookCandidate { name, tip: tip.to_owned(), settings, command, suits_data: fits })
        })
        .collect()
}

/// Candidate with other lights than the current look.
fn with_other_lights(name: String, lights: Vec<LightSettings>, settings: &Settings) -> LookCandidate {
    let settings = Settings { lights: lights.clone(), ..settings.clone() };
    let tip = text::contact_sheet::USE_TIP.to_owned();
    LookCandidate { name, tip, settings, command: AppCommand::UseLights(lights), suits_data: true }
}

/// Candidates with each choice of lights.
fn light_candidates(settings: &Settings, selected: usize) -> Vec<LookCandidate> {
    let choices = light_choices(settings, selected).into_iter();
    choices.map(|(name, lights)| with_other_lights(name, lights, settings)).collect()
}

/// Candidates with the selected light at the positions of the light search, best first.
fn suggested_lights(
    subject: &ExportScene,
    worker: &ExportWorker,
    cancel: &CancelToken,
) -> Result<Vec<LookCandidate>, String> {
    let ExportScene { dataset, settings, selected_light, .. } = subject;
    let Some(light) = settings.lights.get(*selected_light) else {
        return Err(text::contact_sheet::NO_LIGHT.to_owned());
    };
    let search = LightSearch::new(worker.shaders(), dataset, settings, SearchedLight::Light(*selected_light));
    let mut search = search.map_err(|err| err.to_string())?;
    while !cancel.is_cancelled() && search.step().map_err(|err| err.to_string())? {}
    let found = search.finish();
    let best = found.map(|found| found.best).unwrap_or_default().into_iter().enumerate();
    Ok(best
        .map(|(at, suggestion)| {
            // Exposed as the picture will be when its balance is kept.
            let mut shown = settings.clone();
            shown.shadows.balance = suggestion.balance;
            with_other_lights(
                text::contact_sheet::suggestion_name(&light.name, at + 1),
                suggestion.lights,
                &shown,
            )
        })
        .collect())
}

/// Renders the proposed whole looks of the volume, on a small copy of it.
fn render_whole_looks(
    subject: &ExportScene,
    worker: &mut ExportWorker,
    cancel: &CancelToken,
    hand_on: &dyn Fn(usize, RenderedCandidate),
) -> Result<(), String> {
    let whole = subject.dataset.volume();
    let small = downsampled_volume(&subject.dataset).map_err(|err| err.to_string())?;
    let proposals = first_look::propose_looks(&subject.first_look, small.volume(), small.histogram());
    let on_small = ExportScene { dataset: small, ..subject.clone() };
    let count = proposals.len();
    for (at, proposal) in proposals.into_iter().enumerate().take_while(|_| !cancel.is_cancelled()) {
        // The brightness of the first look has been measured already.
        let look = if at == 0 {
            MeasuredSettings::new(whole, &on_small.dataset, proposal.settings)
        } else {
            worker.measure_brightness(whole, &on_small.dataset, &proposal.settings)?
        };
        let mut shown = move_closer(&look.fast, subject);
        use_even_slabs(&mut shown);
        let picture = render_candidate(worker, &on_small, &shown)?;
        let candidate = LookCandidate {
            name: text::contact_sheet::look_name(at + 1, proposal.name),
            tip: proposal.description.to_owned(),
            command: AppCommand::UseLook(Box::new(look.settings.clone())),
            settings: look.settings,
            suits_data: true,
        };
        hand_on(count, (candidate, picture));
    }
    Ok(())
}

/// Choices of lights to try, with their names.
fn light_choices(settings: &Settings, selected: usize) -> Vec<(String, Vec<LightSettings>)> {
    let mut all: Vec<_> =
        LightingRig::ALL.iter().map(|rig| (rig.name().to_owned(), rig.lights(&settings.camera))).collect();
    if let Some(light) = settings.lights.get(selected) {
        all.extend(CLOCK_HOURS.map(|hour| {
            let mut lights = settings.lights.clone();
            let world = clock_position(light, &settings.camera, hour);
            lights[selected].set_scene_position(world, &settings.camera);
            (text::contact_sheet::clock_position(&light.name, hour), lights)
        }));
    }
    all
}

/// Position on a clock face around the line of sight, at the light's distance from the centre, in scene space.
fn clock_position(light: &LightSettings, camera: &Camera, hour: u32) -> DVec3 {
    let view = camera.scene_from_view();
    let (sin, cos) = (f64::from(hour) / 12.0 * std::f64::consts::TAU).sin_cos();
    let (aside, along) = CLOCK_ANGLE_DEG.to_radians().sin_cos();
    let distance = DVec3::from(light.position).length().max(1.0);
    (view.x_axis * (sin * aside) + view.y_axis * (cos * aside) + view.z_axis * along) * distance
}

/// Number of sky directions, and of points of an area light, that suffice for a small picture.
const QUICK_DIRECTIONS: u32 = 16;

/// Chooses slabs that leave no grain: small pictures have few pixels, and small volumes large voxels.
fn use_even_slabs(settings: &mut Settings) {
    (settings.sampling.slabs, settings.sampling.slab) = (SlabMode::ByNeed, 1.0);
}

/// Returns quick settings for a small picture.
pub(crate) fn quick_settings(settings: &Settings) -> Settings {
    let mut quick = settings.clone();
    quick.shadows.resolution = LightVolumeResolution::Half;
    (quick.shadows.kernel, quick.sampling.kernel) =
        (ReconstructionKernel::Prefiltered, ReconstructionKernel::Prefiltered);
    use_even_slabs(&mut quick);
    quick.sky.directions = quick.sky.directions.min(QUICK_DIRECTIONS);
    quick.shadows.area.samples = quick.shadows.area.samples.min(QUICK_DIRECTIONS);
    quick
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::synthetic::builtin;

    #[test]
    fn hours_are_where_a_clock_has_them() {
        let settings = Settings::default();
        let view = settings.camera.scene_from_view().transpose();
        let seen = |hour| view * clock_position(&settings.lights[0], &settings.camera, hour);
        assert!(seen(12).y > 0.0 && seen(12).x.abs() < 1e-9, "above");
        assert!(seen(2).x > 0.0 && seen(2).y > 0.0 && seen(8).x < 0.0 && seen(8).y < 0.0);
        let distance = DVec3::from(settings.lights[0].position).length();
        assert!((seen(4).length() - distance).abs() < 1e-9 && seen(4).z > 0.0, "on the viewer's side");
    }

    #[test]
    fn all_candidates_have_names_of_their_own() {
        let mut names: Vec<_> =
            light_choices(&Settings::default(), 0).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names.len(), LightingRig::ALL.len() + CLOCK_HOURS.len());
        names.sort();
        names.dedup();
        assert_eq!(names.len(), LightingRig::ALL.len() + CLOCK_HOURS.len());
        assert_eq!(
            light_choices(&Settings::default(), 9).len(),
            LightingRig::ALL.len(),
            "no light is selected"
        );
        let volume = builtin("sphere", Some(8)).unwrap();
        let presets = preset_candidates(&Settings::default(), &volume);
        let last_that_fits = presets.iter().rposition(|look| look.suits_data);
        assert_eq!(last_that_fits, presets.iter().position(|look| !look.suits_data).map(|first| first - 1));
        assert_eq!(presets.len(), PRESETS.into_iter().filter(Preset::is_offered).count());
        let usual = Settings::default();
        // Presets of light leave the curve as it is.
        let differs = |look: &Settings| {
            look.layer().transfer != usual.layer().transfer
                || look.sky != usual.sky
                || look.scattering != usual.scattering
        };
        assert!(presets.iter().all(|look| differs(&look.settings)));
    }
}
