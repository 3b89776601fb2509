//! Thumbnails of the presets, each rendered from a suitable volume by `script/preset-pictures`.

use std::collections::BTreeMap;

use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};

use chiaroscuro_scene::Preset;

macro_rules! pictures {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_bytes!(concat!("../../../assets/presets/", $name, ".png")))),+]
    };
}

/// PNG files of the thumbnails, by preset name.
const THUMBNAIL_FILES: &[(&str, &[u8])] = pictures![
    "ct/bone",
    "ct/muscle_and_skin",
    "ct/angiography",
    "ct/lung",
    "mr/head",
    "mr/angiography",
    "microscopy/fluorescence",
    "microscopy/stained_tissue",
    "simulation/fuel",
    "simulation/cloud",
    "simulation/signed",
    "light/studio",
    "light/overcast",
    "light/window",
    "light/hollows",
    "light/wax",
    "light/cloud",
    "light/ink_drawing",
    "paper/lobster",
    "paper/fuel",
    "paper/chair",
];

/// Decodes the thumbnail of a preset from its file.
fn decode_thumbnail(preset: &Preset) -> Option<ColorImage> {
    let (_, file) = THUMBNAIL_FILES.iter().find(|(name, _)| *name == preset.name)?;
    let picture = image::load_from_memory_with_format(file, image::ImageFormat::Png).ok()?.to_rgb8();
    let size = [picture.width() as usize, picture.height() as usize];
    Some(ColorImage::from_rgb(size, &picture))
}

/// Textures of the thumbnails that have been shown, by preset name.
#[derive(Default)]
pub(super) struct PresetThumbnails(BTreeMap<&'static str, Option<TextureHandle>>);

impl std::fmt::Debug for PresetThumbnails {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PresetPictures").field("made", &self.0.len()).finish()
    }
}

impl PresetThumbnails {
    /// Returns the thumbnail of a preset, decoded on first use; `None` if it has no file.
    pub(super) fn get(&mut self, ctx: &Context, preset: &Preset) -> Option<&TextureHandle> {
        let made = self.0.entry(preset.name).or_insert_with(|| {
            decode_thumbnail(preset)
                .map(|picture| ctx.load_texture("preset", picture, TextureOptions::LINEAR))
        });
        made.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::PRESETS;

    #[test]
    fn every_preset_of_the_menu_has_a_picture() {
        for preset in PRESETS.into_iter().filter(Preset::is_offered) {
            let picture =
                decode_thumbnail(&preset).unwrap_or_else(|| panic!("{} has no picture", preset.name));
            assert_eq!(picture.size, [176, 116], "{}", preset.name);
            let first = picture.pixels[0];
            assert!(picture.pixels.iter().any(|pixel| *pixel != first), "{} shows nothing", preset.name);
        }
        let offered = PRESETS.into_iter().filter(Preset::is_offered).count();
        assert_eq!(THUMBNAIL_FILES.len(), offered, "no picture without a preset");
    }
}
