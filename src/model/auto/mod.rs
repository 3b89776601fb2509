//! A first look at a volume that needs no touch: transfer function, camera and lights from the
//! values alone.
//!
//! What is around the object is recognised by the volume's own border: most scans have a margin.
//! The opacity ramp starts above it, at the value that best splits the volume in two (Otsu 1979).

mod domain;
mod floor;
mod frame;
mod isosurfaces;
mod looks;
mod object;
mod palette;
#[cfg(test)]
mod robustness;
mod threshold;
mod transfer;
mod view;
mod visible;

pub use self::floor::wants_floor;
pub use self::looks::{Proposal, looks};

use self::domain::Domain;
use self::object::Object;
pub use self::visible::{densest, show_something};
use super::{
    Camera, Classification, DensityRange, Kernel, LabelTable, Length, ObjectTurn, Quality, Rig, SceneAxis,
    Settings, Shading, Shadows, TransferFunction,
};
use crate::data::{DataKind, Histogram, KindName, Shown, Volume};

/// What a first look is to respect that the volume itself does not say.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Wishes {
    /// The kind of data that it is shown as; its own where none is named.
    pub treated_as: Option<KindName>,
    /// The axis of the scene that points up, unless the file says where the head is.
    pub up: SceneAxis,
}

/// Settings for a volume that nobody has touched yet.
pub fn first_settings(volume: &Volume, histogram: &Histogram) -> Settings {
    first_settings_with(volume, histogram, Wishes::default())
}

/// Settings for a volume that nobody has touched yet, as somebody wishes them to be.
pub fn first_settings_with(volume: &Volume, histogram: &Histogram, wishes: Wishes) -> Settings {
    // Whatever was shown before.
    let robust = volume.ranges().robust;
    if volume.shown() != Shown::Range(robust) {
        let volume = volume.showing(robust);
        return first_settings_with(&volume, &Histogram::of(&volume), wishes);
    }
    let kind = kind_of(volume, wishes.treated_as);
    let found = transfer::find(volume, histogram, kind);
    let up = if volume.is_anatomical() { SceneAxis::PlusZ } else { wishes.up };
    let mut settings = Settings {
        camera: Camera { up, ..Camera::default() },
        transfer: found.transfer,
        labels: found.labels,
        opacity_unit: volume.unit_mm().map_or_else(|| Length::Voxels(voxels_of_file(volume)), Length::Mm),
        lights: Vec::new(),
        shading: shading(found.domain),
        // A look that nobody has made by hand stays as bright as without shadows.
        shadows: Shadows { keep_balanced: true, ..Shadows::default() },
        ..Settings::default()
    };
    Quality::Standard.apply(&mut settings);
    if let DataKind::LabelMap { .. } = kind {
        // Between two labels there is none of the numbers between them, and none of them is an outlier.
        settings.range = DensityRange::Full;
        settings.sampling.classification = Classification::Pre;
        // Sharper than the B-spline, which would round off what voxels are.
        (settings.sampling.kernel, settings.shadows.kernel) = (Kernel::Prefiltered, Kernel::Prefiltered);
    }
    aim(&mut settings, volume);
    match kind {
        // Every number is shown already.
        DataKind::LabelMap { .. } | DataKind::Mask => settings,
        _ => visible::or_another(settings, volume, histogram),
    }
}

/// Points camera and lights at what settings show.
fn aim(settings: &mut Settings, volume: &Volume) {
    let object = Object::shown_by(settings, volume);
    view::choose(&mut settings.camera, volume, &object);
    frame::frame(settings, volume, &object);
    settings.lights = Rig::KeyAndFill.lights(&settings.camera);
}

/// Stands what settings show of a volume up so that an axis of the scene points up, on the floor and in the light as
/// they were.
pub fn stand(settings: &mut Settings, volume: &Volume, up: SceneAxis) {
    if settings.camera.up != up {
        settings.turn_object(ObjectTurn::Upright(up));
        frame(settings, volume);
    }
}

/// The kind of that name, or what the volume's own is.
fn kind_of(volume: &Volume, treated_as: Option<KindName>) -> DataKind {
    let own = volume.kind().kind;
    match treated_as {
        Some(name) if name != own.name() => DataKind::of_name(name, volume),
        _ => own,
    }
}

/// What surfaces are like: metal shines.
fn shading(domain: Domain) -> Shading {
    match domain {
        Domain::Metal => Shading { specular: 0.5, shininess: 48.0, ..Shading::default() },
        _ => Shading::default(),
    }
}

/// Frames what settings show of a volume from where their camera looks, and puts the floor under it.
pub fn frame(settings: &mut Settings, volume: &Volume) {
    let object = Object::shown_by(settings, volume);
    // From where first looks begin: the same view is framed in the same way, whatever it was framed as before.
    settings.camera.distance = Camera::default().distance;
    frame::frame(settings, volume, &object);
}

/// The share of what settings show of a volume's surface that is not where material ends, but where the data do.
pub fn blockness(settings: &Settings, volume: &Volume) -> f64 {
    Object::of_shown(settings, volume).blockness()
}

/// The edge of a voxel of the file, in voxels: averaged voxels look like those that they stand for.
fn voxels_of_file(volume: &Volume) -> f64 {
    let count = |dims: [usize; 3]| dims.iter().map(|&n| n as f64).product::<f64>();
    (count(volume.dims()) / count(volume.file_dims())).cbrt()
}

/// A transfer function that shows the object and hides what is around it.
pub fn transfer(volume: &Volume, histogram: &Histogram) -> TransferFunction {
    transfer_as(volume, histogram, None)
}

/// A transfer function that shows what begins at the density `start`.
fn ramp(volume: &Volume, histogram: &Histogram, start: f64) -> TransferFunction {
    transfer::beginning_at(volume, histogram, start)
}

/// A transfer function as if the volume held data of that kind; of its own where none is named.
pub fn transfer_as(volume: &Volume, histogram: &Histogram, treated_as: Option<KindName>) -> TransferFunction {
    transfer::find(volume, histogram, kind_of(volume, treated_as)).transfer
}

/// A table of labels as if the volume held data of that kind; of its own where none is named. Empty of all but label
/// maps.
pub fn labels_as(volume: &Volume, treated_as: Option<KindName>) -> LabelTable {
    match kind_of(volume, treated_as) {
        DataKind::LabelMap { .. } => transfer::label_table(volume),
        _ => LabelTable::default(),
    }
}

/// The labels of a label map that settings do not show.
pub fn labels_lost(settings: &Settings, volume: &Volume) -> usize {
    transfer::lost_labels(settings, volume)
}

/// What of a histogram lies above a density.
fn above(histogram: &Histogram, start: f64) -> Histogram {
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
    use super::*;
    use crate::data::Samples;
    use glam::DVec3;

    /// A ball of the given value in a margin of another, with a ripple on both.
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
        let settings = first_settings(&volume, &Histogram::of(&volume));
        // The ball's radius is ten of 32 voxels, and a scene unit 16.
        assert!((settings.floor.height + 10.0 / 16.0).abs() < 0.07, "{}", settings.floor.height);
        assert!(!settings.floor.on);
    }

    /// A rod along x that lies low in y and high in z.
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
        let histogram = Histogram::of(&volume);
        // Scene units are 16 voxels, from the middle.
        for (up, floor) in [
            (SceneAxis::PlusX, -14.0 / 16.0),
            (SceneAxis::MinusX, -14.0 / 16.0),
            (SceneAxis::PlusY, -12.0 / 16.0),
            (SceneAxis::MinusY, 6.0 / 16.0),
            (SceneAxis::PlusZ, 4.0 / 16.0),
            (SceneAxis::MinusZ, -12.0 / 16.0),
        ] {
            let first = first_settings_with(&volume, &histogram, Wishes { up, ..Wishes::default() });
            assert_eq!(first.camera.up, up);
            assert!((first.floor.height - floor).abs() < 0.07, "{up:?}: {}", first.floor.height);
            let mut turned = first_settings(&volume, &histogram);
            turned.turn_object(crate::model::ObjectTurn::Upright(up));
            frame(&mut turned, &volume);
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
        let patient = volume.with_anatomy(true);
        let first =
            first_settings_with(&patient, &histogram, Wishes { up: SceneAxis::MinusX, ..Wishes::default() });
        assert_eq!(first.camera.up, SceneAxis::PlusZ);
    }

    #[test]
    fn the_object_is_shown_and_its_surroundings_are_not() {
        for (inside, outside) in [(200.0, 0.0), (1200.0, -1000.0), (60.0, 40.0)] {
            let volume = ball(inside, outside);
            let function = transfer(&volume, &Histogram::of(&volume));
            assert_eq!(function.opacity_at(f64::from(outside) + 6.0), 0.0, "{inside} {outside}");
            assert!(function.opacity_at(f64::from(inside) + 6.0) > 0.1, "{inside} {outside}");
        }
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
            let function = transfer(&volume, &Histogram::of(&volume));
            assert!(function.points.windows(2).all(|pair| pair[0].value <= pair[1].value), "{function:?}");
        }
    }
}
