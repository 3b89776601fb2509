//! Edits of the look by commands: colours, cuts, view and lights.

use super::Document;
use crate::app::common::light_keys;
use chiaroscuro_scene::{
    BoxCut, COLOR_MAPS, Camera, CutShape, CutShapeKind, HalfSpaceCut, LightSettings, LightingRig,
    MAX_SHAPE_CUTS, Settings, ShapeCut, StandardView, VolumeLayer,
};

impl Document {
    /// Gives layers from an index on the looks that they had before; their blend stays, and so do layers without one.
    pub(crate) fn apply_layer_looks(&mut self, from: usize, looks: &[Option<VolumeLayer>]) {
        for (layer, look) in self.settings.layers.iter_mut().skip(from).zip(looks) {
            if let Some(look) = look {
                *layer = VolumeLayer { blend: layer.blend, ..look.clone() };
            }
        }
    }

    /// Colours the visible values by a colour map, given by its index.
    pub(crate) fn use_colors(&mut self, at: usize, reversed: bool) {
        if let Some(map) = COLOR_MAPS.get(at) {
            self.selected_layer_mut().transfer.apply_color_map(map, reversed);
        }
    }

    /// Turns the clip plane across the line of sight, through the point about which the camera orbits.
    pub(crate) fn face_plane(&mut self) {
        let Camera { target, .. } = self.settings.camera;
        let normal = self.settings.camera.scene_from_view().z_axis;
        self.settings.cuts.plane.place_facing(normal, target.into());
    }

    /// Hides the eighth or the half of the volume that faces the camera, if there is room for another cut.
    pub(crate) fn cut_near_part(&mut self, kind: CutShapeKind) {
        let Some(volume) = &self.volume else { return };
        let camera = &self.settings.camera;
        let shape = if kind == CutShapeKind::HalfSpace {
            let normal = camera.scene_from_view().z_axis;
            CutShape::HalfSpace(HalfSpaceCut { normal: normal.into(), offset: 0.0 })
        } else {
            CutShape::Box(BoxCut::corner_towards(camera.position(), &volume.scene))
        };
        let shapes = &mut self.settings.cuts.shapes;
        if shapes.len() < MAX_SHAPE_CUTS {
            shapes.push(ShapeCut { shape, ..ShapeCut::default() });
        }
    }

    /// Resets the camera to that of the first look.
    pub(crate) fn reset_view(&mut self) {
        self.settings.camera = self.defaults.camera.clone();
    }

    /// Turns the camera to a standard view: of a body, where the volume has an anatomical orientation.
    pub(crate) fn set_standard_view(&mut self, view: StandardView) {
        if self.is_anatomical() {
            self.settings.camera.set_standard_view_of_body(view);
        } else {
            self.settings.camera.set_standard_view(view);
        }
    }

    /// Replaces the lights by a rig.
    pub(crate) fn use_rig(&mut self, rig: LightingRig) {
        self.settings.lights = rig.lights(&self.settings.camera);
        self.selected_light = 0;
    }

    /// Replaces the lights by others.
    pub(crate) fn use_lights(&mut self, lights: Vec<LightSettings>) {
        self.selected_light = self.selected_light.min(lights.len().saturating_sub(1));
        self.settings.lights = lights;
    }

    /// Replaces the look by a suggested one, which leaves saved views, render quality, cuts and corrections of the
    /// file as they are.
    pub(crate) fn use_look(&mut self, look: Settings) {
        let look = look.with_quality_of(&self.settings);
        let Settings { cuts, kept, volume, .. } = std::mem::take(&mut self.settings);
        self.settings = Settings { cuts, kept, volume, ..look };
        self.selected_light = 0;
    }

    /// Selects another light, `by` places further in the list.
    pub(crate) fn step_light(&mut self, by: isize) {
        self.selected_light = light_keys::cycle(self.settings.lights.len(), self.selected_light, by);
    }

    /// Switches off all lights but the selected one, or all on again.
    pub(crate) fn solo_light(&mut self) {
        light_keys::solo(&mut self.settings.lights, self.selected_light);
    }

    /// Changes the selected light, if there is one.
    pub(crate) fn change_light(&mut self, change: impl FnOnce(&mut LightSettings)) {
        if let Some(light) = self.settings.lights.get_mut(self.selected_light) {
            change(light);
        }
    }
}
