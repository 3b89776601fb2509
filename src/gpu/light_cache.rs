//! Which light volumes a picture needs, which of them are there, and which are forgotten.

use super::job::LightBuild;
use super::light_volume::{LightVolume, bricks_holding};
use super::{GpuError, Renderer};
use crate::plan::{BrickSet, LightKey, Request};

/// Light volumes that are kept beyond those of the current picture, if it does not have more itself:
/// undoing a drag finds them, and two looks that are compared do not push out each other's.
const SPARE_LIGHT_VOLUMES: usize = 2;

impl Renderer {
    /// Finds or makes the light volumes of a request and forgets the oldest of the others.
    pub(super) fn place_lights(
        &mut self,
        request: &Request,
    ) -> Result<(Vec<Option<LightKey>>, Vec<LightBuild>), GpuError> {
        let (Some(volume), Some(tables)) = (&self.volume, &self.tables) else {
            return Err(GpuError::Refused("no volume".to_owned()));
        };
        let count = request.settings.lights.len();
        self.rebuilds.resize(self.rebuilds.len().max(count), 0);
        let everything = self.options.fill_everything.then(|| BrickSet::full(volume.bricks.dims));
        let lit = everything.as_ref().unwrap_or(&tables.lit);
        let mut keys = vec![None; count];
        let mut builds: Vec<LightBuild> = Vec::new();
        for (light, slot) in keys.iter_mut().enumerate() {
            let Some(full) = LightKey::of(request, light) else { continue };
            let needed = |key: &LightKey| bricks_holding(volume, lit, key.resolution().divisor());
            let usable = |known: &LightVolume, key: &LightKey| {
                known.key == *key && needed(key).is_within(&known.filled)
            };
            let coarse = request.coarse.map(|resolution| full.at_resolution(resolution));
            let found = [Some(full.clone()), coarse.clone()]
                .into_iter()
                .flatten()
                .find(|key| self.lights.iter().any(|known| usable(known, key)));
            let key = found.clone().or(coarse).unwrap_or(full);
            if found.is_none() {
                self.lights.retain(|known| known.key != key);
                let fresh = LightVolume::new(&self.context, volume, key.clone(), needed(&key))?;
                let build = LightBuild::new(volume, request, light, &fresh, self.options.chunk);
                self.lights.push(fresh);
                builds.push(build);
            }
            for known in self.lights.iter_mut().filter(|known| known.key == key) {
                known.last_used = self.clock;
            }
            *slot = Some(key);
        }
        let clock = self.clock;
        self.lights.sort_by_key(|light| std::cmp::Reverse(light.last_used));
        let current = self.lights.iter().filter(|light| light.last_used == clock).count();
        self.lights.truncate(current + SPARE_LIGHT_VOLUMES.max(current));
        Ok((keys, builds))
    }
}
