//! Looks as Python objects: the settings of a picture, read and changed by the names of the command line.

use std::path::{Path, PathBuf};

use chiaroscuro_files::{read_small_file, write_atomically};
use chiaroscuro_media::{may_carry_record, read_record};
use chiaroscuro_render::UndecidedPart;
use chiaroscuro_scene::{
    AppliedSettings, COLOR_MAPS, ControlPoint, DensityRange, LookRecord, PRESETS, Preset, QualityPreset,
    Settings, VolumeLayer, apply_json, first_look, set_value, setting_value,
};
use chiaroscuro_volume::{KindName, ValueRange, ValueRanges, Volume};
use glam::{DVec2, DVec3};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;

use crate::errors::{self, ExceptionClass};
use crate::volume::NativeVolume;

/// Names of the colour maps.
#[pyfunction]
pub(crate) fn color_map_names() -> Vec<&'static str> {
    COLOR_MAPS.iter().map(|map| map.name).collect()
}

/// Names of the built-in presets.
#[pyfunction]
pub(crate) fn preset_names() -> Vec<&'static str> {
    PRESETS.iter().map(|preset| preset.name).collect()
}

/// Settings of a picture, and the parts of them that are still to be found.
#[pyclass(frozen, module = "chiaroscuro._native")]
#[derive(Debug, Clone)]
pub(crate) struct NativeLook {
    pub(crate) settings: Settings,
    /// Parts that are chosen by drawing, once the look is finished; settings that are set are no longer among them.
    pub(crate) undecided: Vec<UndecidedPart>,
}

/// Issues the warnings of the settings' readers as Python warnings.
fn warn(py: Python<'_>, warnings: &[String]) -> PyResult<()> {
    for text in warnings {
        let text = std::ffi::CString::new(text.replace('\0', "")).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 2)?;
    }
    Ok(())
}

/// Returns true if one of two paths of settings contains the other.
fn overlaps(one: &str, other: &str) -> bool {
    let is_within = |inner: &str, outer: &str| {
        inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    is_within(one, other) || is_within(other, one)
}

/// Reads a record from a built-in preset, a JSON file or an exported picture.
fn read_look(name: &Path) -> PyResult<LookRecord> {
    let shown = name.display();
    let unreadable = |why: String| ExceptionClass::UnreadableFile.error(format!("{why} ({shown})"));
    let text = if let Some(preset) = name.to_str().and_then(Preset::find) {
        preset.json().as_bytes().to_vec()
    } else if may_carry_record(name) {
        let record = read_record(name).map_err(|err| unreadable(err.to_string()))?;
        record.ok_or_else(|| unreadable("the picture carries no settings".to_owned()))?.into_bytes()
    } else {
        let help = "check that the file exists and can be read";
        read_small_file(name).map_err(|err| unreadable(format!("could not read the look: {err}; {help}")))?
    };
    LookRecord::from_bytes(&text).map_err(|err| unreadable(err.to_string()))
}

impl NativeLook {
    /// Returns the look with other settings, in which a part by the name of a setting is decided.
    fn with_settings(&self, settings: Settings, is_decided: impl Fn(&str) -> bool) -> Self {
        let undecided = self.undecided.iter().copied().filter(|part| !is_decided(part.path())).collect();
        Self { settings, undecided }
    }

    /// Lays the floor under what is visible with other opacities or another range.
    fn with_floor_under(mut self, before: &Self, volume: &Volume) -> Self {
        let visible = |look: &Self| {
            let layer = look.settings.layer();
            (layer.transfer.clone(), layer.range, look.settings.camera.up)
        };
        if visible(&self) != visible(before) && self.settings.floor.height == before.settings.floor.height {
            first_look::lay_floor(&mut self.settings, volume);
        }
        self
    }
}

#[pymethods]
impl NativeLook {
    /// Returns the first look of a volume before its lights are found; `kind` treats it as another kind of data than
    /// the one that was detected.
    #[staticmethod]
    fn automatic(py: Python<'_>, volume: &NativeVolume, kind: Option<&str>) -> PyResult<Self> {
        let kinds = KindName::ALL;
        let data_kind = kind
            .map(|name| {
                kinds.into_iter().find(|kind| kind.key() == name).ok_or_else(|| {
                    let known = kinds.map(KindName::key).join(", ");
                    ExceptionClass::InvalidArgument
                        .error(format!("kind: expected one of {known}, found {name:?}"))
                })
            })
            .transpose()?;
        let options = first_look::FirstLookOptions { data_kind, ..Default::default() };
        let dataset = &volume.dataset;
        let settings = crate::interruptible::interruptible(py, || {
            let mut settings =
                first_look::first_settings_with(dataset.volume(), dataset.histogram(), options);
            first_look::add_layers(&mut settings, dataset);
            settings.volume = *dataset.volume().corrections();
            settings
        })?;
        Ok(Self { settings, undecided: UndecidedPart::ALL.to_vec() })
    }

    /// Returns the look of no volume, over which others are read.
    #[staticmethod]
    fn default() -> Self {
        Self { settings: Settings::default(), undecided: Vec::new() }
    }

    /// Reads all settings from JSON.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let tree = serde_json::from_str(text)
            .map_err(|err| ExceptionClass::InvalidArgument.error(err.to_string()))?;
        let settings =
            apply_json(&Settings::default(), &tree).map_err(|err| errors::from_preset(&err))?.settings;
        Ok(Self { settings, undecided: Vec::new() })
    }

    /// Returns the look with another accuracy of lighting: `fast`, `standard` or `fine`.
    fn with_quality(&self, name: &str) -> PyResult<Self> {
        let levels = QualityPreset::ALL;
        let level = levels.into_iter().find(|level| level.key() == name).ok_or_else(|| {
            let known = levels.map(QualityPreset::key).join(", ");
            ExceptionClass::InvalidArgument.error(format!("quality: expected one of {known}, found {name:?}"))
        })?;
        let mut settings = self.settings.clone();
        level.apply(&mut settings);
        Ok(self.with_settings(settings, |_| false))
    }

    /// Returns the look with another range of values shown, over which the transfer function is stretched.
    fn with_range(&self, volume: &NativeVolume, low: f64, high: f64) -> Self {
        let mut settings = self.settings.clone();
        let ranges = volume.dataset.volume().ranges();
        let layer = settings.layer_mut();
        let before = layer.range.resolve(&ranges);
        let scale = (high - low) / (before.high - before.low);
        for point in &mut layer.transfer.points {
            point.value = low + (point.value - before.low) * scale;
        }
        layer.range = DensityRange::Typed(ValueRange::new(low, high));
        settings.sanitise();
        self.with_settings(settings, |_| false)
    }

    /// Returns the look with one setting changed, given as JSON.
    fn with_value(&self, py: Python<'_>, path: &str, json: &str) -> PyResult<Self> {
        let AppliedSettings { settings, warnings } =
            set_value(&self.settings, path, json).map_err(|err| errors::from_preset(&err))?;
        warn(py, &warnings)?;
        Ok(self.with_settings(settings, |part| overlaps(part, path)))
    }

    /// Returns the value of one setting as JSON; `None` if there is no such setting.
    fn value(&self, path: &str) -> Option<String> {
        setting_value(&self.settings, path).map(|value| value.to_string())
    }

    /// Returns the look with the settings of a preset, a JSON file or an exported picture, for values of a volume.
    fn with_look_of(&self, py: Python<'_>, name: PathBuf, volume: Option<&NativeVolume>) -> PyResult<Self> {
        let record = read_look(&name)?;
        let ranges = volume.map_or(ValueRanges::UNIT, |volume| volume.dataset.volume().ranges());
        let AppliedSettings { mut settings, warnings } =
            record.apply(&self.settings, &ranges).map_err(|err| errors::from_preset(&err))?;
        warn(py, &warnings)?;
        settings.volume = self.settings.volume;
        Ok(self.with_settings(settings, |part| record.has_setting(part)))
    }

    /// Returns the look with a colour map, in which opacities are as before.
    fn with_color_map(&self, layer: usize, name: &str, is_reversed: bool) -> PyResult<Self> {
        let map = COLOR_MAPS.iter().find(|map| map.name.eq_ignore_ascii_case(name)).ok_or_else(|| {
            let known = color_map_names().join(", ");
            ExceptionClass::InvalidArgument
                .error(format!("colormap: expected one of {known}, found {name:?}"))
        })?;
        let mut settings = self.settings.clone();
        layer_of(&mut settings, layer)?.transfer.apply_color_map(map, is_reversed);
        Ok(self.with_settings(settings, |_| false))
    }

    /// Returns the look with other opacities, given as values and opacities of 0 … 1 at them; colours stay where they
    /// are.
    fn with_opacities(&self, layer: usize, points: Vec<(f64, f64)>) -> PyResult<Self> {
        let mut settings = self.settings.clone();
        let transfer = &mut layer_of(&mut settings, layer)?.transfer;
        transfer.points = points
            .iter()
            .map(|&(value, opacity)| ControlPoint::new(value, transfer.point_at(value).color, opacity))
            .collect();
        transfer.sort();
        settings.sanitise();
        Ok(self.with_settings(settings, |_| false))
    }

    /// Returns the look with the floor laid under what a volume shows, if another look had been before it.
    fn with_floor_laid(&self, py: Python<'_>, before: &Self, volume: &NativeVolume) -> PyResult<Self> {
        crate::interruptible::interruptible(py, || {
            self.clone().with_floor_under(before, volume.dataset.volume())
        })
    }

    /// Returns the range of values that the look shows of a volume.
    fn shown_range(&self, volume: &NativeVolume) -> (f64, f64) {
        let ValueRange { low, high } = self.settings.layer().range.resolve(&volume.dataset.volume().ranges());
        (low, high)
    }

    /// Returns the direction of a light as seen by the viewer: degrees to the right of the line of sight, and above it.
    fn light_direction(&self, light: usize) -> PyResult<(f64, f64)> {
        let found = self.settings.lights.get(light).ok_or_else(|| no_light(&self.settings, light))?;
        let camera = &self.settings.camera;
        let position = DVec3::from(found.resolve(camera).position);
        let view = camera.scene_from_view().transpose() * position;
        let level = DVec2::new(view.x, view.z).length();
        Ok((view.x.atan2(view.z).to_degrees(), view.y.atan2(level).to_degrees()))
    }

    /// Returns the look with a light in another direction as seen by the viewer, at the distance that it has.
    fn with_light_direction(&self, light: usize, azimuth_deg: f64, elevation_deg: f64) -> PyResult<Self> {
        let mut settings = self.settings.clone();
        let camera = settings.camera.clone();
        let none = no_light(&settings, light);
        let found = settings.lights.get_mut(light).ok_or(none)?;
        let distance = DVec3::from(found.resolve(&camera).position).length();
        let ((right, toward), (up, level)) =
            (azimuth_deg.to_radians().sin_cos(), elevation_deg.to_radians().sin_cos());
        let view = DVec3::new(level * right, up, level * toward);
        found.set_scene_position(camera.scene_from_view() * view * distance, &camera);
        settings.sanitise();
        Ok(self.with_settings(settings, |part| part == UndecidedPart::Lights.path()))
    }

    /// Returns the look after a share of a full turn, 0 … 1, of the camera, or of a light.
    fn turned(&self, share: f64, light: Option<usize>) -> PyResult<Self> {
        if let Some(light) = light.filter(|&light| light >= self.settings.lights.len()) {
            return Err(no_light(&self.settings, light));
        }
        Ok(self.with_settings(self.settings.at_turntable_angle(light, share), |_| false))
    }

    /// Number of lights.
    #[getter]
    fn light_count(&self) -> usize {
        self.settings.lights.len()
    }

    /// Returns all settings as JSON.
    fn to_json(&self) -> String {
        LookRecord::to_json(&self.settings, None, None)
    }

    /// Writes all settings to a JSON file, which program and window read as a session.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        let text = format!("{}\n", self.to_json());
        write_atomically(&path, text.as_bytes())
            .map_err(|err| ExceptionClass::Error.error(format!("the look was not saved: {err}")))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.settings == other.settings
    }
}

/// Returns the layer with an index.
fn layer_of(settings: &mut Settings, index: usize) -> PyResult<&mut VolumeLayer> {
    let count = settings.layers.count();
    if index >= count {
        let why = format!("layer: there are {count} layers, counted from 0, and no layer {index}");
        return Err(ExceptionClass::InvalidArgument.error(why));
    }
    Ok(settings.layer_at_mut(index))
}

/// Error for a light that there is not.
fn no_light(settings: &Settings, light: usize) -> PyErr {
    let count = settings.lights.len();
    ExceptionClass::InvalidArgument
        .error(format!("light: there are {count} lights, counted from 0, and no light {light}"))
}
