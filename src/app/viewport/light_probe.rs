//! "Why is this dark?": what is under the pointer, and what of every light gets there.

use eframe::egui::{self, Pos2, Rect, Shape, Stroke, Ui, vec2};
use glam::DVec3;

use crate::app::common::theme;
use crate::app::common::volume_facts::decimals;
use crate::app::text::{self, common::LengthUnit};
use crate::data::Volume;
use crate::model::{Camera, Light, LightKind, Settings};
use crate::plan::{Arrival, Probe, probe};

/// State of the probe between frames.
#[derive(Debug, Default)]
pub(crate) struct LightProbe {
    /// Whether it is shown.
    pub on: bool,
    /// The last answer, and the question.
    last: Option<(Pos2, Settings, Option<Probe>)>,
}

impl LightProbe {
    /// Asks what is under the pointer and paints the answer.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        picture: Rect,
        settings: &Settings,
        volume: &Volume,
        pointer: Option<Pos2>,
    ) {
        let Some(pointer) = pointer.filter(|_| self.on) else {
            self.last = None;
            return;
        };
        if self.last.as_ref().is_none_or(|(at, of, _)| *at != pointer || of != settings) {
            let found = seen_at(volume, settings, picture, pointer);
            self.last = Some((pointer, settings.clone(), found));
        }
        let found = self.last.as_ref().and_then(|(_, _, found)| found.as_ref());
        let painter = ui.painter_at(picture);
        if let Some(found) = found {
            rays(&painter, picture, settings, found);
        }
        let words =
            found.map_or_else(|| text::probe::NOTHING.to_owned(), |found| answer(settings, volume, found));
        // In a corner of its own, so that it does not hide what it speaks of.
        let galley = painter.layout(
            words,
            egui::TextStyle::Small.resolve(ui.style()),
            theme::EYE_CURVE,
            (picture.width() - 40.0).max(60.0),
        );
        let size = galley.size() + vec2(16.0, 12.0);
        let corner = Rect::from_min_size(picture.right_bottom() - size - vec2(10.0, 10.0), size);
        painter.rect_filled(corner, 4.0, theme::OUTLINE.gamma_multiply(0.85));
        painter.galley(corner.min + vec2(8.0, 6.0), galley, theme::EYE_CURVE);
    }

    /// The value under the pointer, for other views to mark.
    pub(crate) fn value(&self) -> Option<f64> {
        let (_, _, found) = self.last.as_ref().filter(|_| self.on)?;
        Some(found.as_ref()?.value)
    }
}

/// What is seen at a point of the window.
pub(crate) fn seen_at(volume: &Volume, settings: &Settings, picture: Rect, at: Pos2) -> Option<Probe> {
    let offset = at - picture.min;
    let (origin, direction) = settings.camera.ray_through(
        f64::from(offset.x),
        f64::from(offset.y),
        f64::from(picture.width()),
        f64::from(picture.height()),
    );
    probe(volume, settings, origin, direction)
}

/// The answer in words and numbers.
fn answer(settings: &Settings, volume: &Volume, found: &Probe) -> String {
    let unit = LengthUnit::showing(volume.scene().mm_per_unit, volume.has_unknown_scale());
    let place = text::probe::place(found.index.to_array(), found.world_mm.to_array(), unit);
    let mut words = if settings.labels.is_empty() || volume.labels().is_none() {
        text::probe::found(found.value, decimals(volume.table_range()), found.opacity, &place)
    } else {
        let number = found.value as i64;
        let named =
            settings.labels.get(number).map(|look| look.name.as_str()).filter(|name| !name.is_empty());
        let in_file = volume.hints().labels.get(number).map(|label| label.name.as_str());
        text::probe::found_label(number, named.or(in_file).unwrap_or_default(), found.opacity, &place)
    };
    for (light, arrival) in settings.lights.iter().zip(&found.lights) {
        words.push('\n');
        words.push_str(&text::probe::of_light(&light.name, &reason(light, arrival)));
    }
    if let Some(open) = found.sky {
        words.push('\n');
        words.push_str(&text::probe::of_light(text::probe::SKY, &text::probe::open(open)));
    }
    words
}

/// Why a light lights a point, or does not.
fn reason(light: &Light, arrival: &Arrival) -> String {
    let Arrival { transmittance, hood, facing } = *arrival;
    if !light.on {
        return text::probe::OFF.to_owned();
    }
    if hood <= 0.0 {
        return text::probe::OUTSIDE_HOOD.to_owned();
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
        share => text::probe::arrives(share),
    };
    text::probe::arrival(&through, angle_deg)
}

/// Lines from the point to the lights: as strong as what arrives.
fn rays(painter: &egui::Painter, picture: Rect, settings: &Settings, found: &Probe) {
    let camera = &settings.camera;
    let Some(from) = place(camera, picture, found.point) else { return };
    for (light, arrival) in settings.lights.iter().zip(&found.lights).filter(|(light, _)| light.on) {
        let world = light.in_scene(camera);
        let to = match light.kind {
            LightKind::Parallel => found.point + world.direction() * 2.0,
            LightKind::Perspective => DVec3::from(world.position),
        };
        let Some(to) = place(camera, picture, to) else { continue };
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

fn place(camera: &Camera, picture: Rect, point: DVec3) -> Option<Pos2> {
    let (width, height) = (f64::from(picture.width()), f64::from(picture.height()));
    let (x, y, _) = camera.pixel_from_scene(point, width, height)?;
    Some(picture.min + vec2(x as f32, y as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_darkness_has_its_reason() {
        let lit = Arrival { transmittance: 0.37, hood: 1.0, facing: Some(0.5) };
        let key = Light::default();
        assert_eq!(reason(&key, &lit), "37 % arrives, at 30° to the surface");
        assert_eq!(reason(&Light { on: false, ..key.clone() }, &lit), "off");
        assert_eq!(reason(&key, &Arrival { hood: 0.0, ..lit }), "outside its hood");
        assert!(reason(&key, &Arrival { facing: Some(-0.2), ..lit }).contains("faces away"));
        assert!(reason(&key, &Arrival { transmittance: 1e-4, ..lit }).contains("in its way"));
        let fill = Light { casts_shadows: false, ..key };
        assert!(reason(&fill, &Arrival { facing: None, ..lit }).contains("no shadows"));
    }
}
