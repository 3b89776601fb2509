//! Automatic first look at a volume: transfer function, camera, floor and lights, from its values and its file.
//!
//! The kind of data decides what is shown: every label, both sides of zero, bone. For other data the background is
//! recognised by the volume's border, because most scans have a margin, and opacity begins between its level and
//! Otsu's split of the histogram (Otsu 1979).

mod data_kind_override;
mod domain;
mod empty_look_fallback;
mod floor;
mod frame;
mod lighting;
mod look_proposals;
mod object;
mod palette;
mod reveal;
#[cfg(test)]
mod robustness_tests;
mod surface;
mod transfer;
mod view_selection;

pub use self::data_kind_override::{first_look_as_kind, labels_for_kind, replace_look, transfer_for_kind};
pub use self::empty_look_fallback::{densest_transfer, with_visible_transfer};
pub use self::floor::{floor_color, needs_floor};
pub use self::frame::ObjectOutline;
pub use self::look_proposals::{LookProposal, propose_looks};
pub use self::palette::further_layers::{add_layers, layer_of_field};

use self::data_kind_override::{data_kind, find_transfer_as_kind};
use self::domain::DataDomain;
use self::lighting::{evenly_lit, shading, soft_shadows, weak_sky, wide_floor};
use self::object::VisibleObject;
use self::surface::{isosurfaces, threshold};
use self::transfer::{FirstTransfer, TransferStyle};
use super::{
    Camera, ClassificationOrder, LightingRig, ObjectRotation, OpacityLength, QualityPreset,
    ReconstructionKernel, SceneAxis, Settings, ShadowSettings, SkySettings,
};
use chiaroscuro_volume::{DataKind, DensityMapping, Histogram, KindName, Volume};

/// Smallest visible opacity per opacity unit: for white in full light, 63 of 255 before black.
const MIN_VISIBLE_OPACITY: f64 = 0.05;

/// User preferences for a first look that do not follow from the volume.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FirstLookOptions {
    /// Kind of data to treat the volume as; `None` for the detected kind.
    pub data_kind: Option<KindName>,
    /// Scene axis that points up, unless the file says where the head is; `None` for the one that the object suggests.
    pub up: Option<SceneAxis>,
}

/// Returns the settings of a volume's first look.
pub fn first_settings(volume: &Volume, histogram: &Histogram) -> Settings {
    first_settings_with(volume, histogram, FirstLookOptions::default())
}

/// Returns the settings of a volume's first look, with user preferences.
pub fn first_settings_with(volume: &Volume, histogram: &Histogram, wishes: FirstLookOptions) -> Settings {
    with_robust_range(volume, histogram, |volume, histogram| {
        look_over_robust_range(volume, histogram, wishes)
    })
}

/// Calls a function with the volume showing its robust range, and the histogram over that range.
fn with_robust_range<T>(
    volume: &Volume,
    histogram: &Histogram,
    ask: impl FnOnce(&Volume, &Histogram) -> T,
) -> T {
    let robust = volume.ranges().robust;
    if volume.density_mapping() == DensityMapping::Range(robust) {
        return ask(volume, histogram);
    }
    let volume = volume.with_density_mapping(robust);
    ask(&volume, &Histogram::from_volume(&volume))
}

/// Returns the first look at a volume that shows its robust range.
fn look_over_robust_range(volume: &Volume, histogram: &Histogram, wishes: FirstLookOptions) -> Settings {
    let found = find_transfer_as_kind(volume, histogram, wishes.data_kind);
    let (domain, style) = (found.domain, found.style);
    let settings = framed_look(volume, histogram, wishes, found);
    if matches!(style, TransferStyle::Picture | TransferStyle::KnownObject) {
        return settings;
    }
    let mut settings = with_hidden_material(settings, volume, histogram, wishes, domain);
    // Label maps, masks and small objects have the edges of voxels, and densities of molecules a conventional contour.
    if settings.sampling.classification == ClassificationOrder::Post
        && !(data_kind(volume, wishes.data_kind) == DataKind::Mask || domain == DataDomain::Molecule)
        && surface::sharpen_edges(&mut settings.layer_mut().transfer, volume)
    {
        frame_object(&mut settings, volume);
    }
    settings
}

/// Returns a look with a transfer function, framed.
fn framed_look(
    volume: &Volume,
    histogram: &Histogram,
    wishes: FirstLookOptions,
    found: FirstTransfer,
) -> Settings {
    let kind = data_kind(volume, wishes.data_kind);
    let (domain, style) = (found.domain, found.style);
    let wished_up = if volume.is_anatomical() { Some(SceneAxis::PlusZ) } else { wishes.up };
    let mut settings = Settings {
        camera: Camera { up: wished_up.unwrap_or_default(), ..Camera::default() },
        lights: Vec::new(),
        shading: if style == TransferStyle::Picture { evenly_lit() } else { shading(found.domain) },
        sky: if style == TransferStyle::Picture { SkySettings::default() } else { weak_sky() },
        // An automatic look stays as bright as without shadows.
        shadows: ShadowSettings { keep_balanced: true, ..soft_shadows() },
        floor: wide_floor(),
        volume: *volume.corrections(),
        ..Settings::default()
    }
    .with_transfer(found.transfer)
    .with_labels(found.labels)
    .with_opacity_unit(opacity_unit(volume));
    QualityPreset::Standard.apply(&mut settings);
    if let DataKind::LabelMap { .. } = kind {
        // Numbers between two labels mean nothing, and no label is an outlier.
        settings.layer_mut().range = transfer::range_of_labels(volume);
        settings.sampling.classification = ClassificationOrder::PreCrisp;
        // Sharper than the B-spline, which would round off the shapes of voxels.
        (settings.sampling.kernel, settings.shadows.kernel) =
            (ReconstructionKernel::Prefiltered, ReconstructionKernel::Prefiltered);
    }
    if wished_up.is_none() {
        settings.camera.up =
            view_selection::find_up_axis(&settings, volume, histogram, kind, (domain, style));
    }
    choose_view_and_lights(&mut settings, volume);
    if style == TransferStyle::Veiled {
        settings = frame_veil(settings, volume);
    }
    settings
}

/// Returns the look with small objects, material inside and skin shown, and other material if it shows nothing.
fn with_hidden_material(
    mut settings: Settings,
    volume: &Volume,
    histogram: &Histogram,
    wishes: FirstLookOptions,
    domain: DataDomain,
) -> Settings {
    let kind = data_kind(volume, wishes.data_kind);
    if let Some(small) = reveal::show_small_objects(&settings, volume, histogram, kind) {
        settings = small.settings;
        if small.are_alone {
            choose_view_and_lights(&mut settings, volume);
        }
        return settings;
    }
    match kind {
        // All labels are shown already; a label that hides the others is framed, too.
        DataKind::LabelMap { .. } => {
            let unit = settings.layer().opacity_unit;
            transfer::make_cover_translucent(&mut settings.layer_mut().labels, volume, unit);
            settings
        }
        DataKind::Mask => settings,
        DataKind::Scalar => {
            let settings = empty_look_fallback::with_fallback(settings, volume, histogram, wishes.data_kind);
            reveal::reveal_inner_material(settings, volume, histogram)
        }
        DataKind::HounsfieldCt { water } => {
            let bones = (domain == DataDomain::Bone).then(|| settings.layer().transfer.clone());
            let settings = empty_look_fallback::with_fallback(settings, volume, histogram, wishes.data_kind);
            if bones.is_some_and(|bones| bones == settings.layer().transfer) {
                reveal::with_skin(settings, volume, water)
            } else {
                settings
            }
        }
        _ => empty_look_fallback::with_fallback(settings, volume, histogram, wishes.data_kind),
    }
}

/// Points camera and lights at the visible object, from the default view or a better one, regardless of the previous
/// camera.
fn choose_view_and_lights(settings: &mut Settings, volume: &Volume) {
    settings.camera = Camera { up: settings.camera.up, ..Camera::default() };
    let object = VisibleObject::from_settings(settings, volume);
    view_selection::choose_view(&mut settings.camera, volume, &object);
    frame::frame_object(settings, volume, &object);
    settings.lights = LightingRig::KeyAndRim.lights(&settings.camera);
}

/// Frames a veil as if it were opaque; otherwise it is too transparent to count as visible.
fn frame_veil(settings: Settings, volume: &Volume) -> Settings {
    let veil = settings.layer().transfer.clone();
    let mut opaque = settings.with_transfer(transfer::opaque_transfer(&veil));
    choose_view_and_lights(&mut opaque, volume);
    opaque.with_transfer(veil)
}

/// Returns the opacity unit of a first look.
fn opacity_unit(volume: &Volume) -> OpacityLength {
    volume.opacity_unit_mm().map_or_else(|| OpacityLength::Voxels(file_voxel_edge(volume)), OpacityLength::Mm)
}

/// Reorients the object so that a scene axis points up, and frames it again; floor and lights keep their relation to
/// it.
pub fn set_up_axis(settings: &mut Settings, volume: &Volume, up: SceneAxis) {
    if settings.camera.up != up {
        settings.rotate_object(ObjectRotation::MakeUpright(up));
        frame_object(settings, volume);
    }
}

/// Frames the visible object from the camera's current direction, and puts the floor under it.
pub fn frame_object(settings: &mut Settings, volume: &Volume) {
    let object = VisibleObject::from_settings(settings, volume);
    frame::frame_object(settings, volume, &object);
}

/// Frames the largest part of the visible object as [`frame_object`] does the whole of it.
fn frame_largest_part(settings: &mut Settings, volume: &Volume) {
    let object = VisibleObject::from_settings(settings, volume).largest_part();
    frame::frame_object(settings, volume, &object);
}

/// Puts the floor under the visible object; it is not moved if nothing is visible.
pub fn lay_floor(settings: &mut Settings, volume: &Volume) {
    let object = VisibleObject::from_settings(settings, volume);
    frame::place_floor(settings, volume, &object);
}

/// Returns the share of the visible object's surface that lies on the volume's box, where the data end.
pub fn box_share(settings: &Settings, volume: &Volume) -> f64 {
    VisibleObject::from_visible(settings, volume).box_share()
}

/// Returns the edge of the file's voxels in voxels of the volume: averaged voxels look like the original ones.
fn file_voxel_edge(volume: &Volume) -> f64 {
    let count = |dims: [usize; 3]| dims.iter().map(|&n| n as f64).product::<f64>();
    (count(volume.dims()) / count(volume.finest_dims())).cbrt()
}

/// Returns the number of labels that are invisible with the settings, or not in their own colour.
pub fn count_lost_labels(settings: &Settings, volume: &Volume) -> usize {
    transfer::count_lost_labels(settings, volume)
}

/// Returns the part of a histogram above a density.
fn histogram_above(histogram: &Histogram, start: f64) -> Histogram {
    let first = ((start * histogram.counts.len() as f64) as usize).min(histogram.counts.len() - 1);
    let counts: Vec<u64> = histogram
        .counts
        .iter()
        .enumerate()
        .map(|(bin, &count)| if bin < first { 0 } else { count })
        .collect();
    let total = counts.iter().sum();
    Histogram { counts, total }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{ControlPoint, TransferFunction};
    use chiaroscuro_volume::Samples;

    /// Returns settings that show values above 100 of 255.
    pub(super) fn threshold_settings() -> Settings {
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        let points = vec![point(100.0, 0.0), point(101.0, 1.0), point(255.0, 1.0)];
        Settings::default().with_transfer(TransferFunction { points, ..TransferFunction::default() })
    }

    /// Returns a ball of one value in a margin of another, with a ripple on both.
    pub(super) fn ball(inside: f32, outside: f32) -> Volume {
        let n = 32usize;
        let values = (0..n * n * n)
            .map(|at| {
                let p = [at % n, at / n % n, at / n / n].map(|c| c as f32 - 15.5);
                let base = if p.iter().map(|c| c * c).sum::<f32>() < 100.0 { inside } else { outside };
                base + (at % 7) as f32
            })
            .collect();
        Volume::with_spacing("ball", [n; 3], DVec3::ONE, Samples::F32(values)).unwrap()
    }

    #[test]
    fn the_floor_lies_under_the_object() {
        let volume = ball(200.0, 0.0);
        let settings = first_settings(&volume, &Histogram::from_volume(&volume));
        // The ball's radius is ten of 32 voxels, and a scene unit 16.
        assert!((settings.floor.height + 10.0 / 16.0).abs() < 0.07, "{}", settings.floor.height);
        assert!(!settings.floor.on);
    }

    /// Returns a rod along x that lies low in y and high in z.
    fn rod() -> Volume {
        let n = 32usize;
        let value = |at: usize| {
            let [x, y, z] = [at % n, at / n % n, at / n / n];
            let is_rod = (2..30).contains(&x) && (4..10).contains(&y) && (20..28).contains(&z);
            if is_rod { 200 } else { 0 }
        };
        Volume::with_spacing("rod", [n; 3], DVec3::ONE, Samples::U8((0..n * n * n).map(value).collect()))
            .unwrap()
    }

    #[test]
    fn whatever_is_up_the_object_stands_on_the_floor_and_fills_the_picture() {
        let volume = rod();
        let histogram = Histogram::from_volume(&volume);
        // Scene units are 16 voxels, from the centre.
        for (up, floor) in [
            (SceneAxis::PlusX, -14.0 / 16.0),
            (SceneAxis::MinusX, -14.0 / 16.0),
            (SceneAxis::PlusY, -12.0 / 16.0),
            (SceneAxis::MinusY, 6.0 / 16.0),
            (SceneAxis::PlusZ, 4.0 / 16.0),
            (SceneAxis::MinusZ, -12.0 / 16.0),
        ] {
            let first = first_settings_with(
                &volume,
                &histogram,
                FirstLookOptions { up: Some(up), ..FirstLookOptions::default() },
            );
            assert_eq!(first.camera.up, up);
            assert!((first.floor.height - floor).abs() < 0.07, "{up:?}: {}", first.floor.height);
            let mut turned = first_settings(&volume, &histogram);
            turned.rotate_object(crate::ObjectRotation::MakeUpright(up));
            frame_object(&mut turned, &volume);
            assert_eq!(turned.floor.height, first.floor.height);
            for look in [first, turned] {
                let middle = DVec3::new(0.0, -9.0 / 16.0, 8.0 / 16.0);
                let (x, y, _) = look.camera.pixel_from_scene(middle, 400.0, 300.0).unwrap();
                assert!((x - 200.0).abs() < 40.0 && (y - 150.0).abs() < 40.0, "{up:?}: {x} {y}");
                assert!(
                    look.lights.iter().all(|light| DVec3::from(light.position).dot(up.direction()) > 0.0)
                );
            }
        }
        let patient = volume.with_anatomical_axes(true);
        let first = first_settings_with(
            &patient,
            &histogram,
            FirstLookOptions { up: Some(SceneAxis::MinusX), ..FirstLookOptions::default() },
        );
        assert_eq!(first.camera.up, SceneAxis::PlusZ);
    }

    #[test]
    fn the_object_is_shown_and_its_surroundings_are_not() {
        for (inside, outside) in [(200.0, 0.0), (1200.0, -1000.0), (60.0, 40.0)] {
            let volume = ball(inside, outside);
            let function = transfer_for_kind(&volume, &Histogram::from_volume(&volume), None);
            assert_eq!(function.opacity_at(f64::from(outside) + 6.0), 0.0, "{inside} {outside}");
            assert!(function.opacity_at(f64::from(inside) + 6.0) > 0.1, "{inside} {outside}");
        }
    }

    #[test]
    fn functions_are_made_from_the_values_that_matter_whatever_is_shown() {
        let mut values: Vec<f32> = (0..32 * 32 * 32).map(|at| (at % 97) as f32).collect();
        values[5] = 1e6;
        let volume = Volume::with_spacing("t", [32; 3], DVec3::ONE, Samples::F32(values)).unwrap();
        let all = volume.with_density_mapping(volume.value_range());
        assert_ne!(all.shown_range(), volume.shown_range());
        for kind in KindName::choices() {
            let made = |volume: &Volume| transfer_for_kind(volume, &Histogram::from_volume(volume), kind);
            assert_eq!(made(&all), made(&volume), "{kind:?}");
        }
    }

    #[test]
    fn a_look_that_is_tried_next_is_seen_from_where_first_looks_begin() {
        let volume = rod();
        let mut settings = first_settings(&volume, &Histogram::from_volume(&volume));
        let wanted = settings.camera.clone();
        settings.camera = Camera { azimuth_deg: 7.0, elevation_deg: -80.0, distance: 0.4, ..wanted.clone() };
        choose_view_and_lights(&mut settings, &volume);
        assert_eq!(settings.camera, wanted);
    }

    #[test]
    fn points_ascend_even_for_odd_histograms() {
        let constant = Volume::with_spacing("c", [8; 3], DVec3::ONE, Samples::U8(vec![7; 512])).unwrap();
        let one = {
            let mut values = vec![0u8; 512];
            values[100] = 255;
            Volume::with_spacing("one", [8; 3], DVec3::ONE, Samples::U8(values)).unwrap()
        };
        for volume in [constant, one] {
            let function = transfer_for_kind(&volume, &Histogram::from_volume(&volume), None);
            assert!(function.points.windows(2).all(|pair| pair[0].value <= pair[1].value), "{function:?}");
        }
    }
}
