//! Window that shows a slice of a light volume in false colours, and exports it.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions, Vec2};

use super::file_dialogs::FileDialogPurpose;
use super::{SceneTool, ToolRequest, ToolScene};
use crate::app::common::dock::ToolWindow;
use crate::app::text;
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_files::write_atomically;
use chiaroscuro_media::ExportError;
use chiaroscuro_render::{
    AttenuationData, GpuError, RenderOptions, Renderer, WorkOptions, export_slice,
    plan::{LightKey, RenderRequest},
};
use chiaroscuro_scene::LightStorage;
use chiaroscuro_volume::{Volume, math::false_color};
use chiaroscuro_volume_io::write::nrrd_of_blocks;

/// Longest edge of the slice on screen, in points.
const SLICE_EDGE: f32 = 360.0;

/// Result of the worker: key of the light volume, and its attenuation.
type FilledLightVolume = (LightKey, AttenuationData);

/// Slice that the texture shows.
#[derive(Debug, Clone, PartialEq)]
struct LightSliceTexture {
    /// Key of the light volume.
    key: LightKey,
    /// Axis across which it is cut.
    axis: usize,
    /// Index of the slice along that axis, in voxels.
    index: usize,
}

/// State of the window, and the light volume that it shows.
#[derive(Default)]
pub(crate) struct LightSliceWindow {
    /// True while the window is open.
    pub open: bool,
    light: usize,
    axis: usize,
    /// Index of the slice along each axis; the middle until the user moves it.
    slice_indices: [Option<usize>; 3],
    work: JobSlot<Result<Option<FilledLightVolume>, GpuError>>,
    filled: Option<(LightKey, Arc<AttenuationData>)>,
    /// Key of the light volume under the current settings.
    wanted_key: Option<LightKey>,
    /// Key that could not be filled; it is not tried again.
    failed_key: Option<LightKey>,
    texture: Option<TextureHandle>,
    /// Slice that the texture shows.
    texture_slice: Option<LightSliceTexture>,
}

impl std::fmt::Debug for LightSliceWindow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LightSlice").field("open", &self.open).finish_non_exhaustive()
    }
}

impl SceneTool for LightSliceWindow {
    fn show(&mut self, ctx: &egui::Context, scene: &ToolScene<'_>) -> Option<ToolRequest> {
        match self.ui(ctx, scene) {
            Ok(false) => None,
            Ok(true) => Some(ToolRequest::AskFile(FileDialogPurpose::ExportLight)),
            Err(err) => Some(ToolRequest::Report(text::messages::LIGHT_VOLUME_NOT_SHOWN, err)),
        }
    }
}

impl LightSliceWindow {
    /// Shows the window if it is open; returns true if the user wants to export.
    fn ui(&mut self, ctx: &egui::Context, scene: &ToolScene<'_>) -> Result<bool, String> {
        if !self.open {
            return Ok(false);
        }
        let result = self.collect(ctx, scene);
        let (mut open, mut export) = (true, false);
        let tool = ToolWindow {
            title: text::light_volume::TITLE,
            default_pos: [24.0, 60.0],
            default_width: SLICE_EDGE,
        };
        tool.show(ctx, &mut open, |ui| {
            ui.horizontal(|ui| {
                let casting =
                    scene.settings.lights.iter().enumerate().filter(|(_, light)| light.needs_volume());
                for (index, light) in casting {
                    ui.selectable_value(&mut self.light, index, &light.name);
                }
                if self.work.is_running() {
                    ui.spinner();
                }
            });
            ui.horizontal(|ui| {
                for (axis, name) in text::light_volume::SLICE_ORIENTATIONS.into_iter().enumerate() {
                    ui.selectable_value(&mut self.axis, axis, name);
                }
            });
            let Some((key, attenuation)) = self.filled.clone() else {
                // While a volume is being filled, the window does not claim that there is none.
                let is_filling = self.work.is_running() || !scene.is_idle;
                ui.weak(if is_filling {
                    text::light_volume::FILLING
                } else {
                    text::light_volume::NO_LIGHT_VOLUME
                });
                return;
            };
            let is_outdated = self.wanted_key.as_ref() != Some(&key);
            let count = attenuation.dims[self.axis];
            let mut at = self.slice_indices[self.axis].unwrap_or(count / 2).min(count - 1);
            ui.spacing_mut().slider_width = SLICE_EDGE - 80.0;
            let slider = egui::Slider::new(&mut at, 0..=count - 1);
            if ui.name_inputs(text::light_volume::SLICE, |ui| ui.add(slider)).changed() {
                self.slice_indices[self.axis] = Some(at);
            }
            self.picture(
                ui,
                &attenuation,
                LightSliceTexture { key, axis: self.axis, index: at },
                is_outdated,
            );
            color_legend(ui);
            let button = text::light_volume::EXPORT;
            export = ui.button(button.name).on_hover_text(button.tooltip).clicked();
        });
        self.open = open;
        result.map(|()| export)
    }

    /// Writes the shown slice if the name ends in .png, else the whole light volume.
    pub(crate) fn export(&self, path: &Path, volume: &Volume) -> Result<(), String> {
        let Some((_, attenuation)) = &self.filled else {
            return Err(text::light_volume::NOTHING_TO_EXPORT.to_owned());
        };
        let is_slice = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        let written = if is_slice {
            let at = self.slice_indices[self.axis].unwrap_or(attenuation.dims[self.axis] / 2);
            let slice = attenuation.slice(self.axis, at).ok_or(text::light_volume::NO_SUCH_SLICE)?;
            export_slice(&slice, path)
        } else {
            let AttenuationData { dims, divisor, values, .. } = &**attenuation;
            let nrrd = nrrd_of_blocks(volume, AttenuationData::CONTENT, *dims, *divisor, values);
            write_atomically(path, &nrrd).map_err(ExportError::from)
        };
        written.map_err(|err| err.to_string())
    }

    /// Takes the result of the worker, and starts it again if another light volume is to be shown.
    fn collect(&mut self, ctx: &egui::Context, scene: &ToolScene<'_>) -> Result<(), String> {
        if let Some(result) = self.work.take_result() {
            self.filled = result?.map_err(|err| err.to_string())?.map(|(key, attenuation)| {
                self.failed_key = None;
                (key, Arc::new(attenuation))
            });
        }
        self.wanted_key = None;
        let Some(dataset) = &scene.dataset else { return Ok(()) };
        let is_there = |index: usize| {
            scene.settings.lights.get(index).is_some_and(chiaroscuro_scene::LightSettings::needs_volume)
        };
        if !is_there(self.light) {
            self.light = (0..scene.settings.lights.len()).find(|&index| is_there(index)).unwrap_or(0);
        }
        let mut request = RenderRequest {
            volume: dataset.id(),
            settings: scene.settings.clone(),
            size: [16, 16],
            preview_resolution: None,
        };
        self.wanted_key = LightKey::new(&request, self.light);
        let Some(key) = self.wanted_key.clone() else {
            self.filled = None;
            return Ok(());
        };
        let known = self.filled.as_ref().is_some_and(|(filled, _)| *filled == key);
        if known || self.work.is_running() || !scene.is_idle || self.failed_key.as_ref() == Some(&key) {
            return Ok(());
        }
        self.failed_key = Some(key.clone());
        let (context, dataset) = (scene.context.clone(), dataset.clone());
        let light = self.light;
        let task = move |_: &JobControl| {
            let mut renderer = Renderer::new(&context.second_device()?)?;
            // With combined storage there would be no volume for this light.
            request.settings.shadows.storage = LightStorage::PerLight;
            let options =
                RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() });
            renderer.draw(&dataset, &request.settings, request.size, &options)?;
            Ok(renderer.attenuation(&request, light)?.map(|attenuation| (key, attenuation)))
        };
        self.work.start(JobKind::LightSlice, ctx, (), task).map_err(|err| err.to_string())
    }

    fn picture(
        &mut self,
        ui: &mut egui::Ui,
        attenuation: &AttenuationData,
        what: LightSliceTexture,
        is_old: bool,
    ) {
        if self.texture_slice.as_ref() != Some(&what) {
            let Some(slice) = attenuation.slice(what.axis, what.index) else { return };
            let image = ColorImage::from_rgb(slice.size, &slice.colors());
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::NEAREST),
                empty => *empty = Some(ui.ctx().load_texture("light slice", image, TextureOptions::NEAREST)),
            }
            self.texture_slice = Some(what);
        }
        let Some(texture) = &self.texture else { return };
        let size = texture.size_vec2();
        let image = egui::Image::new((texture.id(), size * (SLICE_EDGE / size.max_elem())));
        // Dimmed while another slice is in progress.
        let tint = if is_old { egui::Color32::from_gray(0x70) } else { egui::Color32::WHITE };
        let shown = ui.add(image.tint(tint));
        if is_old {
            let (font, ink) = (egui::TextStyle::Body.resolve(ui.style()), egui::Color32::WHITE);
            let middle = shown.rect.center();
            ui.painter().text(middle, egui::Align2::CENTER_CENTER, text::light_volume::FILLING, font, ink);
        }
    }
}

/// Legend of the false colours, from dark to fully lit.
fn color_legend(ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        ui.weak(text::light_volume::DARK);
        let (rect, _) = ui.allocate_exact_size(Vec2::new(SLICE_EDGE - 110.0, 10.0), egui::Sense::hover());
        let mut mesh = egui::Mesh::default();
        const STEPS: u32 = 32;
        for step in 0..=STEPS {
            let share = step as f32 / STEPS as f32;
            let [r, g, b] = false_color(share);
            let x = egui::lerp(rect.x_range(), share);
            for y in [rect.top(), rect.bottom()] {
                mesh.colored_vertex(egui::pos2(x, y), egui::Color32::from_rgb(r, g, b));
            }
            if step > 0 {
                let end = 2 * step + 1;
                mesh.add_triangle(end - 3, end - 2, end - 1);
                mesh.add_triangle(end - 2, end - 1, end);
            }
        }
        ui.painter().add(mesh);
        ui.weak(text::light_volume::FULLY_LIT);
    });
}
