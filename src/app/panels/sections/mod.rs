//! State of the side panel's sections: which are active, and how their reset buttons restore the first look.

mod icons;
pub(super) mod tabs;

use crate::app::text::sections::{CAMERA, COMPARE, CUTS, DATA, FLOOR, LIGHTS, SHADING, SHADOWS, SOFT_LIGHT};
use chiaroscuro_scene::{Settings, ShadowSettings, VolumeLayer};

/// Returns true if something is on in a section that is off by default, so that its header shows a dot.
pub(super) fn is_section_active(title: &str, settings: &Settings, compares: bool) -> bool {
    match title {
        SOFT_LIGHT => settings.sky.is_on() || settings.has_bounces(),
        CUTS => settings.cuts.crop.on || settings.cuts.plane.on,
        FLOOR => settings.floor.on,
        COMPARE => compares,
        DATA => !settings.volume.is_none(),
        _ => false,
    }
}

/// Resets a section to the first look; sections that belong to the file, or that compare two looks, are not reset.
pub(super) fn reset_section(title: &str, settings: &mut Settings, first: &Settings) {
    match title {
        // The first lights are placed around the object as it stood then.
        LIGHTS if settings.camera.up == first.camera.up => settings.lights.clone_from(&first.lights),
        SHADOWS => {
            // The balance is measured rather than set.
            let ShadowSettings { balance, keep_balanced, .. } = settings.shadows;
            settings.shadows = ShadowSettings { balance, keep_balanced, ..first.shadows.clone() };
            for (index, layer) in settings.layers.iter_mut().enumerate() {
                let VolumeLayer { lighting, opacity_unit, .. } = first.layer_at(index).clone();
                (layer.lighting, layer.opacity_unit) = (lighting, opacity_unit);
            }
        }
        SOFT_LIGHT => (settings.sky, settings.scattering) = (first.sky.clone(), first.scattering.clone()),
        SHADING => {
            (settings.shading, settings.output) = (first.shading.clone(), first.output.clone());
            settings.mode = first.mode.clone();
        }
        CUTS => settings.cuts = first.cuts.clone(),
        FLOOR => {
            let height = settings.floor.height;
            settings.floor = first.floor.clone();
            if settings.camera.up != first.camera.up {
                settings.floor.height = height;
            }
        }
        CAMERA => {
            settings.sampling = first.sampling.clone();
            settings.camera.projection = first.camera.projection;
            settings.camera.fov_y_deg = first.camera.fov_y_deg;
            settings.camera.roll_deg = first.camera.roll_deg;
            // Only if the object still stands the same way up.
            if first.camera.up == settings.camera.up {
                settings.camera.clone_from(&first.camera);
            }
        }
        _ => {}
    }
}

/// Returns true if resetting a section would change a setting.
pub(super) fn can_reset(title: &str, settings: &Settings, first: &Settings) -> bool {
    match title {
        DATA | COMPARE => false,
        _ => {
            let mut back = settings.clone();
            reset_section(title, &mut back, first);
            back != *settings
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::text;
    use chiaroscuro_scene::{LightSettings, RenderMode};

    #[test]
    fn resetting_a_section_changes_no_other() {
        let first = Settings::default();
        let mut settings = first.clone();
        settings.lights.push(LightSettings::default());
        settings.floor.on = true;
        settings.shadows.gain = 2.0;
        settings.shadows.balance = 1.5;
        settings.cuts.plane.on = true;
        settings.camera.azimuth_deg = 12.0;
        settings.shading.diffuse = 0.1;
        settings.mode.kind = RenderMode::Maximum;
        settings.sky.mode = chiaroscuro_scene::SkyMode::White;
        let changed = [LIGHTS, SHADOWS, SOFT_LIGHT, SHADING, CUTS, FLOOR, CAMERA];
        for title in text::sections::ALL {
            assert_eq!(can_reset(title, &settings, &first), changed.contains(&title), "{title}");
        }
        for (at, title) in changed.into_iter().enumerate() {
            reset_section(title, &mut settings, &first);
            for later in &changed[at + 1..] {
                assert!(can_reset(later, &settings, &first), "{title} puts {later} back");
            }
        }
        assert_eq!(settings.shadows.balance, 1.5, "what is measured stays");
        assert_eq!(Settings { shadows: first.shadows.clone(), ..settings }, first);
    }

    #[test]
    fn headers_show_what_is_on() {
        let mut settings = Settings::default();
        assert!(text::sections::ALL.iter().all(|title| !is_section_active(title, &settings, false)));
        settings.floor.on = true;
        settings.cuts.crop.on = true;
        let on: Vec<_> = text::sections::ALL
            .into_iter()
            .filter(|title| is_section_active(title, &settings, true))
            .collect();
        assert_eq!(on, [CUTS, FLOOR, COMPARE]);
    }
}
