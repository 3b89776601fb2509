//! Pictures of the built-in scenes, rendered from them by `script/start-pictures`.

use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};

macro_rules! pictures {
    ($($name:literal),+ $(,)?) => {
        [$(($name, include_bytes!(concat!("../../../../assets/start/", $name, ".jpg")))),+]
    };
}

/// JPEG files of the pictures, by the name of the scene's volume.
const PICTURE_FILES: [(&str, &[u8]); 5] = pictures!["bone", "cloud", "wax", "stained_glass", "cells"];

/// Decodes the picture of a scene from its file.
fn decode_picture(file: &[u8]) -> Option<ColorImage> {
    let picture = image::load_from_memory_with_format(file, image::ImageFormat::Jpeg).ok()?.to_rgb8();
    let size = [picture.width() as usize, picture.height() as usize];
    Some(ColorImage::from_rgb(size, &picture))
}

/// Textures of the pictures, as far as they are decoded.
#[derive(Default)]
pub(super) struct ScenePictures {
    decoded: Vec<(&'static str, Option<TextureHandle>)>,
}

impl ScenePictures {
    /// Decodes the next picture: one per frame, after the first, so that the window is not kept from opening.
    pub(super) fn decode_next(&mut self, ctx: &Context) {
        if ctx.cumulative_frame_nr() == 0 {
            return ctx.request_repaint();
        }
        if let Some((name, file)) = PICTURE_FILES.get(self.decoded.len()) {
            let picture = decode_picture(file);
            let options = TextureOptions::LINEAR.with_mipmap_mode(Some(eframe::egui::TextureFilter::Linear));
            self.decoded.push((name, picture.map(|picture| ctx.load_texture(*name, picture, options))));
            ctx.request_repaint();
        }
    }

    /// Returns the picture of a scene, if it is decoded.
    pub(super) fn get(&self, volume: &str) -> Option<&TextureHandle> {
        let (_, picture) = self.decoded.iter().find(|(name, _)| *name == volume)?;
        picture.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shell::start_screen::scenes;

    #[test]
    fn every_scene_has_a_picture_that_shows_something() {
        let scenes: Vec<_> = scenes().map(|(_, volume)| volume).collect();
        assert_eq!(scenes, PICTURE_FILES.map(|(name, _)| name));
        for (name, file) in PICTURE_FILES {
            let picture = decode_picture(file).unwrap_or_else(|| panic!("{name} has no picture"));
            assert_eq!(picture.size, [640, 480], "{name}");
            let first = picture.pixels[0];
            assert!(picture.pixels.iter().any(|pixel| *pixel != first), "{name} shows nothing");
        }
        let bytes: usize = PICTURE_FILES.iter().map(|(_, file)| file.len()).sum();
        // A hundredth of the program's size.
        assert!(bytes < 400_000, "{bytes}");
    }
}
