//! A contact sheet of lights: rigs, and places for the selected light, each tried on the open volume.

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions, vec2};
use glam::DVec3;

use super::commands::Command;
use super::export::{Subject, Worker};
use super::theme;
use super::work::Work;
use crate::model::{Camera, Kernel, Light, Resolution, Rig, Settings, Shot};

/// Pixels of a picture.
const SIZE: [u32; 2] = [176, 132];
/// Pictures side by side.
const COLUMNS: usize = 4;
/// Places for the selected light: hours of a clock face …
const HOURS: [u32; 6] = [10, 12, 2, 4, 6, 8];
/// … so far from the line of sight.
const ASIDE_DEG: f64 = 55.0;

/// Lights that were tried.
#[derive(Debug)]
struct Tried {
    name: String,
    lights: Vec<Light>,
    picture: ColorImage,
}

/// One of them, for the window.
struct Print {
    name: String,
    lights: Vec<Light>,
    texture: TextureHandle,
}

/// The window.
#[derive(Default)]
pub(super) struct ContactSheet {
    /// Whether it is shown.
    open: bool,
    /// Whether pictures are to be made as soon as that is possible.
    pub wanted: bool,
    work: Option<Work<Result<Vec<Tried>, String>>>,
    prints: Vec<Print>,
}

impl std::fmt::Debug for ContactSheet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ContactSheet").field("open", &self.open).finish_non_exhaustive()
    }
}

/// The lights that are tried, and what they are called.
fn candidates(settings: &Settings, selected: usize) -> Vec<(String, Vec<Light>)> {
    let mut all: Vec<_> =
        Rig::ALL.iter().map(|rig| (rig.name().to_owned(), rig.lights(&settings.camera))).collect();
    if let Some(light) = settings.lights.get(selected) {
        all.extend(HOURS.map(|hour| {
            let mut lights = settings.lights.clone();
            let world = at_hour(light, &settings.camera, hour);
            lights[selected].set_world_position(world, &settings.camera);
            (format!("{} at {hour} o'clock", light.name), lights)
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
fn quick(settings: &Settings, lights: Vec<Light>) -> Settings {
    let mut quick = Settings { lights, ..settings.clone() };
    quick.shadows.resolution = Resolution::Half;
    (quick.shadows.kernel, quick.sampling.kernel) = (Kernel::Prefiltered, Kernel::Prefiltered);
    quick.sampling.slab = quick.sampling.slab.max(1.0);
    quick
}

impl ContactSheet {
    /// Opens the window and asks for pictures.
    pub(super) fn open(&mut self) {
        (self.open, self.wanted) = (true, true);
    }

    /// Starts to make the pictures.
    pub(super) fn start(&mut self, subject: Subject, ctx: &egui::Context) -> Result<(), String> {
        self.wanted = false;
        let task = move || {
            let mut worker = Worker::new(&subject)?;
            let tried = candidates(&subject.settings, subject.selected_light).into_iter();
            tried
                .map(|(name, lights)| {
                    let settings = quick(&subject.settings, lights.clone());
                    let shown = worker.render(&subject, &settings, &Shot::new(SIZE))?;
                    let picture = ColorImage::from_rgba_unmultiplied(SIZE.map(|n| n as usize), &shown);
                    Ok(Tried { name, lights, picture })
                })
                .collect()
        };
        let work = Work::start("contact-sheet", ctx, task);
        self.work = Some(work.map_err(|err| format!("no thread for the pictures: {err}"))?);
        Ok(())
    }

    /// Shows the window, and adds what was chosen. An error says why there are no pictures.
    pub(super) fn ui(&mut self, ctx: &egui::Context, commands: &mut Vec<Command>) -> Result<(), String> {
        let finished = self.work.as_ref().and_then(Work::take);
        let mut outcome = Ok(());
        if let Some(result) = finished {
            self.work = None;
            match result.and_then(|result| result) {
                Ok(tried) => self.prints = tried.into_iter().map(|tried| print(ctx, tried)).collect(),
                Err(err) => outcome = Err(err),
            }
        }
        let mut open = self.open;
        let window = egui::Window::new("Try lights").open(&mut open).resizable(false).collapsible(false);
        window.default_pos([60.0, 60.0]).show(ctx, |ui| {
            egui::Grid::new("contact sheet").spacing([8.0, 8.0]).show(ui, |ui| {
                for (at, tried) in self.prints.iter().enumerate() {
                    if at > 0 && at % COLUMNS == 0 {
                        ui.end_row();
                    }
                    ui.vertical(|ui| {
                        let size = vec2(SIZE[0] as f32, SIZE[1] as f32);
                        let image = egui::Image::new((tried.texture.id(), size));
                        let button = ui.add(egui::Button::image(image).frame(false));
                        let name = format!("Use {}", tried.name);
                        button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                        if button.on_hover_text("Use these lights").clicked() {
                            commands.push(Command::UseLights(tried.lights.clone()));
                        }
                        ui.small(&tried.name);
                    });
                }
            });
            ui.horizontal(|ui| {
                if self.work.is_some() || self.wanted {
                    ui.spinner();
                    ui.label("trying lights on your volume");
                } else if ui.button("Again, as it looks now").clicked() {
                    self.wanted = true;
                }
                ui.add_space(theme::HANDLE_RADIUS);
                ui.weak("the picture's own size and quality come with a click");
            });
        });
        self.open = open;
        outcome
    }
}

fn print(ctx: &egui::Context, tried: Tried) -> Print {
    let Tried { name, lights, picture } = tried;
    let texture = ctx.load_texture(format!("contact sheet {name}"), picture, TextureOptions::LINEAR);
    Print { name, lights, texture }
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
            candidates(&Settings::default(), 0).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names.len(), Rig::ALL.len() + HOURS.len());
        names.sort();
        names.dedup();
        assert_eq!(names.len(), Rig::ALL.len() + HOURS.len());
        assert_eq!(candidates(&Settings::default(), 9).len(), Rig::ALL.len(), "no light is selected");
    }
}
