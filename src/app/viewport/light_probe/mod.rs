//! Light probe ("Why is this dark?"): the material under the pointer, the share of every light that arrives there,
//! and the distance between two points.

mod diagnosis;
mod layer_values;
pub(crate) mod material_picker;
mod tag;

use eframe::egui::{self, Pos2, Rect, Shape, Stroke, Ui, vec2};
use glam::DVec3;

use self::diagnosis::BrightnessCause;
use self::layer_values::{LayerValue, values_of_other_layers};
use self::tag::ProbeTag;
use crate::app::common::overlay_windows;
use crate::app::common::theme;
use crate::app::common::volume_facts::{VolumeFacts, range_decimals};
use crate::app::text::{self, common::LengthUnit};
use chiaroscuro_render::plan::{LightArrival, Probe, probe, probe_layers};
use chiaroscuro_scene::{Camera, LightGeometry, LightSettings, RenderMode, Settings, VolumeLayer};
use chiaroscuro_volume::{DataKind, Dataset, Volume};

/// Point of the volume that was clicked.
#[derive(Debug, Clone, Copy)]
struct ProbePin {
    /// Position in scene space.
    point: DVec3,
}

/// State of the light probe between frames.
#[derive(Debug, Default)]
pub(crate) struct LightProbe {
    /// True if the probe is active.
    pub is_active: bool,
    /// Last result, with the window position and the settings that it belongs to.
    last_result: Option<(Pos2, Settings, Option<Probe>)>,
    /// Content id of the volume that the state belongs to.
    volume_id: Option<u64>,
    /// Clicked points, the latest last: at most two.
    pins: Vec<ProbePin>,
}

/// Volumes that are probed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProbedVolumes<'a> {
    /// Fields of the picture.
    pub dataset: &'a Dataset,
    /// Facts about them.
    pub facts: &'a VolumeFacts,
}

/// Pointer input of the probe in this frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProbePointer {
    /// Position of the pointer in points, if nothing is being dragged.
    pub pointer: Option<Pos2>,
    /// True if the picture was clicked.
    pub clicked: bool,
}

impl LightProbe {
    /// Probes the point under the pointer, or the clicked one, and shows the result; applies a remedy if the user
    /// clicks it.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        picture: Rect,
        settings: &mut Settings,
        volumes: ProbedVolumes<'_>,
        ProbePointer { pointer, clicked }: ProbePointer,
    ) {
        let dataset = volumes.dataset;
        let volume = dataset.volume();
        let of = Some(dataset.id().content_id);
        if !self.is_active || self.volume_id != of {
            (self.last_result, self.pins, self.volume_id) = (None, Vec::new(), of);
        }
        if !self.is_active {
            return;
        }
        if !self.pins.is_empty() && overlay_windows::escape_for_picture(ui.ctx()) {
            self.pins.clear();
        }
        if let Some(at) = pointer.filter(|_| clicked) {
            match probe_layers_at(dataset, settings, picture, at) {
                Some(found) => {
                    if self.pins.len() == 2 {
                        self.pins.remove(0);
                    }
                    self.pins.push(ProbePin { point: found.point });
                }
                // A click beside the object removes the pins.
                None => self.pins.clear(),
            }
        }
        let pinned = self.pins.last().and_then(|pin| project(&settings.camera, picture, pin.point));
        let Some(at) = pinned.or(pointer) else {
            self.last_result = None;
            return;
        };
        if self.last_result.as_ref().is_none_or(|(of, look, _)| *of != at || look != settings) {
            let found = probe_layers_at(dataset, settings, picture, at);
            self.last_result = Some((at, settings.clone(), found));
        }
        let found = self.last_result.as_ref().and_then(|(_, _, found)| found.as_ref());
        let painter = ui.painter_at(picture);
        if let Some(found) = found {
            paint_light_rays(&painter, picture, settings, found);
        }
        let others =
            found.map_or_else(Vec::new, |found| values_of_other_layers(settings, volumes.facts, found));
        let (mm_per_unit, unit) = (volume.scene().mm_per_unit, length_unit(volume));
        let distance = match &self.pins[..] {
            [from, to] => {
                let length = text::probe::length(from.point.distance(to.point) * mm_per_unit, unit);
                paint_distance(&painter, picture, &settings.camera, [from.point, to.point], &length);
                Some(text::probe::distance_to_previous(&length))
            }
            _ => None,
        };
        let cause =
            found.filter(|_| !settings.is_unlit()).map(|found| BrightnessCause::diagnose(settings, found));
        let lost = found.and_then(|found| {
            let blocked = settings.lights.iter().zip(&found.lights).find_map(|(light, arrival)| {
                let [near, _] = arrival.blocked.filter(|_| light.on)?;
                Some(found.point + direction_to_light(light, &settings.camera, found.point) * near)
            })?;
            Some(project(&settings.camera, picture, blocked)? - at)
        });
        let shown = ProbeTag {
            subject: found.and_then(|found| {
                let own = label_text(
                    settings.layer_at(found.layer),
                    dataset.fields().get(found.layer)?.volume(),
                    found,
                );
                own.or_else(|| others.iter().find(|other| other.is_label).map(|label| label.text.clone()))
            }),
            cause,
            remedies: cause
                .filter(|_| pinned.is_some())
                .map(|cause| cause.remedies(settings))
                .unwrap_or_default(),
            sentence: cause.map_or_else(
                || if found.is_some() { text::shading::UNLIT } else { text::probe::NOTHING }.to_owned(),
                |cause| cause.description(settings, mm_per_unit, unit),
            ),
            facts: found.map_or_else(String::new, |found| result_text(settings, dataset, found, &others)),
            distance,
            occluder_offset: lost,
            is_pinned: pinned.is_some(),
        };
        if let Some(cure) = tag::show_probe_tag(ui, picture, at, &shown) {
            cure.apply(settings);
        }
    }

    /// Returns the value of a layer's material under the pointer, for other views to mark.
    pub(crate) fn value_in(&self, layer: usize) -> Option<f64> {
        let (_, _, found) = self.last_result.as_ref().filter(|_| self.is_active)?;
        found.as_ref().filter(|found| found.layer == layer).map(|found| found.value)
    }
}

/// Returns the unit of lengths in a volume.
fn length_unit(volume: &Volume) -> LengthUnit {
    LengthUnit::from_spacing_unit(volume.length_unit())
}

/// Paints a line between two points, with its length.
fn paint_distance(painter: &egui::Painter, picture: Rect, camera: &Camera, ends: [DVec3; 2], length: &str) {
    let [Some(from), Some(to)] = ends.map(|end| project(camera, picture, end)) else { return };
    for (width, ink) in [(4.0, theme::OUTLINE), (1.5, theme::PICTURE_TEXT)] {
        painter.line_segment([from, to], Stroke::new(width, ink));
        painter.circle(from, 3.0, ink, Stroke::NONE);
    }
    let middle = from + (to - from) / 2.0;
    let font = egui::FontId::proportional(13.0);
    let galley = painter.layout_no_wrap(length.to_owned(), font, theme::PICTURE_TEXT);
    let ground = Rect::from_center_size(middle, galley.size() + vec2(10.0, 4.0));
    painter.rect_filled(ground, 4.0, theme::OUTLINE.gamma_multiply(0.85));
    painter.galley(ground.min + vec2(5.0, 2.0), galley, theme::PICTURE_TEXT);
}

/// Probes the first volume along the viewing ray through a point of the window.
pub(crate) fn probe_at(volume: &Volume, settings: &Settings, picture: Rect, at: Pos2) -> Option<Probe> {
    let (origin, direction) = viewing_ray(&settings.camera, picture, at);
    probe(volume, settings, origin, direction)
}

/// Probes all layers along the viewing ray through a point of the window.
fn probe_layers_at(dataset: &Dataset, settings: &Settings, picture: Rect, at: Pos2) -> Option<Probe> {
    let (origin, direction) = viewing_ray(&settings.camera, picture, at);
    probe_layers(dataset, settings, origin, direction)
}

/// Returns origin and direction of the viewing ray through a point of the window, in scene space.
fn viewing_ray(camera: &Camera, picture: Rect, at: Pos2) -> (DVec3, DVec3) {
    let (offset, size) = (at - picture.min, picture.size());
    camera.ray_through(f64::from(offset.x), f64::from(offset.y), f64::from(size.x), f64::from(size.y))
}

/// Returns the value of the first visible material under a point of the window, whatever the render mode.
pub(crate) fn material_value(volume: &Volume, settings: &Settings, picture: Rect, at: Pos2) -> Option<f64> {
    let mut material = settings.clone();
    material.mode.kind = RenderMode::Matter;
    Some(probe_at(volume, &material, picture, at)?.value)
}

/// Returns the visible label as number and name; `None` if the values are not labels.
fn label_text(layer: &VolumeLayer, volume: &Volume, found: &Probe) -> Option<String> {
    let is_by_curve = layer.labels.is_empty();
    // Other data would be counted first, which takes seconds.
    if is_by_curve && !matches!(volume.kind().kind, DataKind::LabelMap { .. }) {
        return None;
    }
    volume.labels()?;
    let number = if is_by_curve {
        // A transfer function interpolates label numbers, so the nearest voxel decides.
        let last = volume.dims().map(|n| n - 1);
        let [x, y, z] = [0, 1, 2].map(|axis| (found.index[axis].round().max(0.0) as usize).min(last[axis]));
        volume.value(x, y, z)
    } else {
        found.value
    } as i64;
    let named = layer.labels.get(number).map(|look| look.name.as_str()).filter(|name| !name.is_empty());
    let in_file = volume.metadata().labels.get(number).map(|label| label.name.as_str());
    Some(text::probe::label(number, named.or(in_file).unwrap_or_default()))
}

/// Formats the probe's result: the value, its position, a line per light, and one for each other layer.
fn result_text(settings: &Settings, dataset: &Dataset, found: &Probe, others: &[LayerValue]) -> String {
    let fields = dataset.fields();
    let volume = fields.get(found.layer).map_or(dataset.volume(), |field| field.volume());
    let unit = length_unit(dataset.volume());
    let place = text::probe::place(
        found.index.to_array(),
        found.world_mm.to_array(),
        unit,
        dataset.volume().is_anatomical(),
    );
    let mut words = if settings.layer_at(found.layer).labels.is_empty() || volume.labels().is_none() {
        text::probe::sample(found.value, range_decimals(volume.table_range()), found.opacity, &place)
    } else {
        text::probe::label_sample(found.opacity, &place)
    };
    for (light, arrival) in settings.lights.iter().zip(&found.lights) {
        words.push('\n');
        words.push_str(&text::probe::light_row(&light.name, &light_explanation(light, arrival)));
    }
    if let Some(open) = found.sky {
        words.push('\n');
        words.push_str(&text::probe::light_row(text::probe::SKY, &text::probe::sky_visibility(open)));
    }
    for other in others {
        words.push('\n');
        words.push_str(&other.text);
    }
    words
}

/// Explains the contribution of one light at the probed point.
fn light_explanation(light: &LightSettings, arrival: &LightArrival) -> String {
    let LightArrival { transmittance, hood, facing, blocked: _ } = *arrival;
    if !light.on {
        return text::probe::OFF.to_owned();
    }
    if hood <= 0.0 {
        return text::probe::OUTSIDE_CONE.to_owned();
    }
    if let Some(facing) = facing
        && facing <= 0.0
    {
        return text::probe::FACES_AWAY.to_owned();
    }
    let angle_deg = facing.map(|facing| 90.0 - facing.clamp(-1.0, 1.0).acos().to_degrees());
    let arrives = transmittance * hood;
    let through = match arrives {
        _ if !light.casts_shadows => text::probe::CASTS_NO_SHADOWS.to_owned(),
        share if share < 0.005 => text::probe::IN_ITS_WAY.to_owned(),
        share => text::probe::transmittance(share),
    };
    text::probe::arrival(&through, angle_deg)
}

/// Unit vector from a point towards a light, in scene space.
fn direction_to_light(light: &LightSettings, camera: &Camera, point: DVec3) -> DVec3 {
    let world = light.resolve(camera);
    match light.kind {
        LightGeometry::Parallel => world.direction(),
        LightGeometry::Perspective => (DVec3::from(world.position) - point).normalize_or(DVec3::Z),
    }
}

/// Paints lines from the probed point to the lights, with an opacity that follows the share that arrives.
fn paint_light_rays(painter: &egui::Painter, picture: Rect, settings: &Settings, found: &Probe) {
    let camera = &settings.camera;
    let Some(from) = project(camera, picture, found.point) else { return };
    for (light, arrival) in settings.lights.iter().zip(&found.lights).filter(|(light, _)| light.on) {
        let world = light.resolve(camera);
        let to = match light.kind {
            LightGeometry::Parallel => found.point + world.direction() * 2.0,
            LightGeometry::Perspective => DVec3::from(world.position),
        };
        let Some(to) = project(camera, picture, to) else { continue };
        // Section of the ray in which the light is absorbed.
        if let Some([near, far]) = arrival.blocked {
            let towards = direction_to_light(light, camera, found.point);
            let [Some(near), Some(far)] =
                [near, far].map(|distance| project(camera, picture, found.point + towards * distance))
            else {
                continue;
            };
            painter.line_segment([near, far], Stroke::new(7.0, theme::OUTLINE.gamma_multiply(0.8)));
            painter.line_segment([near, far], Stroke::new(4.0, theme::BLOCKED));
        }
        let share = (arrival.transmittance * arrival.hood) as f32;
        let ink = theme::color(light.color);
        if share > 0.02 {
            painter.line_segment([from, to], Stroke::new(1.5, ink.gamma_multiply(0.25 + 0.75 * share)));
        } else {
            painter.extend(Shape::dashed_line(
                &[from, to],
                Stroke::new(1.0, ink.gamma_multiply(0.5)),
                3.0,
                5.0,
            ));
        }
    }
    painter.circle(from, 3.5, theme::ACCENT, Stroke::new(1.5, theme::OUTLINE));
}

fn project(camera: &Camera, picture: Rect, point: DVec3) -> Option<Pos2> {
    let (width, height) = (f64::from(picture.width()), f64::from(picture.height()));
    let (x, y, _) = camera.pixel_from_scene(point, width, height)?;
    Some(picture.min + vec2(x as f32, y as f32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::LabelLook;
    use chiaroscuro_volume::Samples;

    #[test]
    fn labels_are_named_where_they_are_seen() {
        const N: usize = 16;
        let value = |at: usize| {
            let place = [at % N, at / N % N, at / N / N];
            if place.iter().all(|c| (3..13).contains(c)) { if place[0] < 8 { 3 } else { 9 } } else { 0 }
        };
        let samples = Samples::U8((0..N.pow(3)).map(value).collect());
        let volume = Volume::with_spacing("t", [N; 3], DVec3::ONE, samples).unwrap();
        let mut settings = Settings::default();
        let named = |number, name: &str| {
            (number, LabelLook { name: name.to_owned(), ..LabelLook::default_for(number) })
        };
        settings.layer_mut().labels = [named(3, "Liver"), named(9, "")].into_iter().collect();
        // Probed from the side of the low numbers, and from the opposite one.
        let said = |settings: &Settings, from: f64| {
            let found =
                probe(&volume, settings, DVec3::X * from, DVec3::X * -from.signum()).expect("a label");
            label_text(settings.layer(), &volume, &found)
        };
        assert_eq!(said(&settings, -3.0).as_deref(), Some("Label 3: Liver"));
        assert_eq!(said(&settings, 3.0).as_deref(), Some("Label 9"));
        let grey = Volume::with_spacing("t", [N; 3], DVec3::ONE, Samples::F32(vec![0.5; N.pow(3)])).unwrap();
        let found = Probe {
            layer: 0,
            point: DVec3::ZERO,
            normal: DVec3::ZERO,
            index: DVec3::ONE,
            world_mm: DVec3::ONE,
            value: 0.5,
            opacity: 1.0,
            lights: Vec::new(),
            sky: None,
        };
        assert_eq!(label_text(&VolumeLayer::default(), &grey, &found), None);
    }

    #[test]
    fn every_darkness_has_its_reason() {
        let lit = LightArrival { transmittance: 0.37, hood: 1.0, facing: Some(0.5), blocked: None };
        let key = LightSettings::default();
        assert_eq!(light_explanation(&key, &lit), "37 % arrives, at 30° to the surface");
        assert_eq!(light_explanation(&LightSettings { on: false, ..key.clone() }, &lit), "off");
        assert_eq!(light_explanation(&key, &LightArrival { hood: 0.0, ..lit }), "outside its spotlight cone");
        assert!(light_explanation(&key, &LightArrival { facing: Some(-0.2), ..lit }).contains("faces away"));
        assert!(
            light_explanation(&key, &LightArrival { transmittance: 1e-4, ..lit })
                .contains("material blocks it")
        );
        let fill = LightSettings { casts_shadows: false, ..key };
        assert!(light_explanation(&fill, &LightArrival { facing: None, ..lit }).contains("no shadows"));
    }
}
