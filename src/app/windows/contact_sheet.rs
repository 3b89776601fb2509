//! A contact sheet: looks that are tried on the open volume. Lights (rigs, and places for the selected light),
//! or the library's presets.

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions, vec2};
use glam::DVec3;

use super::export::{Subject, Worker};
use crate::app::common::commands::Command;
use crate::app::common::theme;
use crate::app::text;
use crate::app::worker::task::Work;
use crate::data::ValueRanges;
use crate::model::{Camera, ImageSpec, Kernel, Light, PRESETS, Resolution, Rig, Settings, Slabs};

/// Pixels of a picture.
const SIZE: [u32; 2] = [176, 132];
/// Pictures side by side.
const COLUMNS: usize = 4;
/// Places for the selected light, as hours of a clock face around the line of sight.
const HOURS: [u32; 6] = [10, 12, 2, 4, 6, 8];
/// Degrees from the line of sight to those places.
const ASIDE_DEG: f64 = 55.0;

/// What is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Sheet {
    /// Rigs, and places for the selected light.
    #[default]
    Lights,
    /// Presets of the library.
    Presets,
}

/// A look to try.
#[derive(Debug, Clone)]
struct Candidate {
    name: String,
    settings: Settings,
    /// What takes it over.
    command: Command,
}

/// A look, and what it looks like.
type Tried = (Candidate, ColorImage);

/// A candidate and its small picture, on the GPU of the window.
struct Print {
    name: String,
    command: Command,
    texture: TextureHandle,
}

impl Sheet {
    fn title(self) -> &'static str {
        match self {
            Self::Lights => text::contact_sheet::LIGHTS,
            Self::Presets => text::contact_sheet::PRESETS,
        }
    }

    fn candidates(self, subject: &Subject) -> Vec<Candidate> {
        match self {
            Self::Lights => with_lights(&subject.settings, subject.selected_light),
            Self::Presets => with_presets(&subject.settings, &subject.dataset.volume().ranges()),
        }
    }
}

/// The look with each preset laid over it, but for that of the benchmarks.
fn with_presets(settings: &Settings, ranges: &ValueRanges) -> Vec<Candidate> {
    let presets = PRESETS.into_iter().filter(|preset| preset.domain() != "bench");
    presets
        .filter_map(|preset| {
            let settings = preset.apply(settings, ranges).ok()?;
            let [domain, _] = preset.domain_titles();
            let name = text::contact_sheet::preset(domain, &preset.title());
            Some(Candidate { name, settings, command: Command::UsePreset(preset) })
        })
        .collect()
}

/// The look with each choice of lights.
fn with_lights(settings: &Settings, selected: usize) -> Vec<Candidate> {
    lights_to_try(settings, selected)
        .into_iter()
        .map(|(name, lights)| {
            let settings = Settings { lights: lights.clone(), ..settings.clone() };
            Candidate { name, settings, command: Command::UseLights(lights) }
        })
        .collect()
}

/// The window.
#[derive(Default)]
pub(crate) struct ContactSheet {
    /// Whether it is shown.
    open: bool,
    /// What it shows.
    sheet: Sheet,
    /// Whether pictures are to be made as soon as that is possible.
    pub is_due: bool,
    work: Option<Work<Result<Vec<Tried>, String>>>,
    prints: Vec<Print>,
}

impl std::fmt::Debug for ContactSheet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ContactSheet").field("open", &self.open).finish_non_exhaustive()
    }
}

/// The lights that are tried, and what they are called.
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

/// A place on a clock face around the line of sight, as far from the middle as the light is.
fn at_hour(light: &Light, camera: &Camera, hour: u32) -> DVec3 {
    let view = camera.scene_from_view();
    let (sin, cos) = (f64::from(hour) / 12.0 * std::f64::consts::TAU).sin_cos();
    let (aside, along) = ASIDE_DEG.to_radians().sin_cos();
    let distance = DVec3::from(light.position).length().max(1.0);
    (view.x_axis * (sin * aside) + view.y_axis * (cos * aside) + view.z_axis * along) * distance
}

/// Quick settings for a small picture.
fn quick(settings: &Settings) -> Settings {
    let mut quick = settings.clone();
    quick.shadows.resolution = Resolution::Half;
    (quick.shadows.kernel, quick.sampling.kernel) = (Kernel::Prefiltered, Kernel::Prefiltered);
    quick.sampling.slab = quick.sampling.slab.max(1.0);
    quick.sampling.slabs = Slabs::Even;
    quick
}

impl ContactSheet {
    /// Opens the window and asks for pictures.
    pub(crate) fn open(&mut self, sheet: Sheet) {
        if self.sheet != sheet {
            self.prints.clear();
        }
        (self.open, self.is_due, self.sheet) = (true, true, sheet);
    }

    /// Starts to make the pictures.
    pub(crate) fn start(&mut self, subject: Subject, ctx: &egui::Context) -> Result<(), String> {
        self.is_due = false;
        let sheet = self.sheet;
        let task = move || {
            let mut worker = Worker::new(&subject)?;
            let tried = sheet.candidates(&subject).into_iter();
            tried
                .map(|candidate| {
                    let shown =
                        worker.render(&subject, &quick(&candidate.settings), &ImageSpec::new(SIZE))?;
                    let picture = ColorImage::from_rgba_unmultiplied(SIZE.map(|n| n as usize), &shown);
                    Ok((candidate, picture))
                })
                .collect()
        };
        let work = Work::start("contact-sheet", ctx, task);
        self.work = Some(work.map_err(text::contact_sheet::no_thread)?);
        Ok(())
    }

    /// Shows the window, and adds what was chosen. An error says why there are no pictures.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, commands: &mut Vec<Command>) -> Result<(), String> {
        let finished = self.work.as_ref().and_then(Work::take);
        let mut outcome = Ok(());
        if let Some(result) = finished {
            self.work = None;
            match result.and_then(|result| result) {
                Ok(tried) => {
                    self.prints =
                        tried.into_iter().map(|(look, picture)| print(ctx, look, picture)).collect();
                }
                Err(err) => outcome = Err(err),
            }
        }
        let mut open = self.open;
        let window =
            egui::Window::new(self.sheet.title()).open(&mut open).resizable(false).collapsible(false);
        window.default_pos([60.0, 60.0]).show(ctx, |ui| {
            ui.horizontal(|ui| {
                if self.work.is_some() || self.is_due {
                    ui.spinner();
                    ui.label(text::contact_sheet::TRYING);
                } else if ui.button(text::contact_sheet::AGAIN).clicked() {
                    self.is_due = true;
                }
                ui.add_space(theme::HANDLE_RADIUS);
                ui.weak(text::contact_sheet::QUALITY);
            });
            // Low windows have bars instead of a sheet that hangs over.
            let most = ctx.content_rect().height() - 170.0;
            let most = most.max(150.0);
            let area = egui::ScrollArea::vertical().max_height(most).min_scrolled_height(most);
            area.show(ui, |ui| {
                egui::Grid::new("contact sheet").spacing([8.0, 8.0]).show(ui, |ui| {
                    for (at, tried) in self.prints.iter().enumerate() {
                        if at > 0 && at % COLUMNS == 0 {
                            ui.end_row();
                        }
                        ui.vertical(|ui| {
                            let size = vec2(SIZE[0] as f32, SIZE[1] as f32);
                            let image = egui::Image::new((tried.texture.id(), size));
                            let button = ui.add(egui::Button::image(image).frame(false));
                            let name = text::contact_sheet::use_look(&tried.name);
                            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                            if button.on_hover_text(text::contact_sheet::USE_TIP).clicked() {
                                commands.push(tried.command.clone());
                            }
                            ui.small(&tried.name);
                        });
                    }
                })
            });
        });
        self.open = open;
        outcome
    }
}

fn print(ctx: &egui::Context, look: Candidate, picture: ColorImage) -> Print {
    let Candidate { name, command, settings: _ } = look;
    let texture = ctx.load_texture(format!("contact sheet {name}"), picture, TextureOptions::LINEAR);
    Print { name, command, texture }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let presets = with_presets(&Settings::default(), &ValueRanges::UNIT);
        assert_eq!(presets.len(), PRESETS.len() - 1);
        assert!(presets.iter().all(|look| look.settings.transfer != Settings::default().transfer));
    }
}
