//! Volumes of other time steps that stay on the GPU with their light, so that a step that was prepared, or shown a moment
//! ago, is drawn at once.

use crate::frame::loaded_volume::LoadedVolume;
use crate::plan::VolumeKey;
use crate::resources::cache_entry::CacheEntry;
use chiaroscuro_volume::Dataset;

/// Cache of volumes beside the one that is shown, most recently used last. It holds none without a budget.
#[derive(Debug, Default)]
pub(crate) struct SpareVolumes {
    budget_bytes: u64,
    volumes: Vec<CacheEntry<VolumeKey, LoadedVolume>>,
    /// True if volumes were dropped whose textures bind groups may keep alive.
    has_dropped: bool,
}

impl SpareVolumes {
    /// Sets the memory that the volumes may take, and drops those beyond it.
    pub(crate) fn set_budget(&mut self, bytes: u64) {
        self.budget_bytes = bytes;
        self.evict();
    }

    /// Finds the volume with a key, if it has the voxel type of a dataset.
    pub(crate) fn find(&self, key: &VolumeKey, dataset: &Dataset) -> Option<&LoadedVolume> {
        self.position(key, dataset).map(|at| &self.volumes[at].product)
    }

    /// Exchanges the volume that is shown for the one with a key: returns that one, if it is here, or else the one that
    /// was shown where it is of no use as a spare volume.
    pub(crate) fn exchange(
        &mut self,
        shown: Option<CacheEntry<VolumeKey, LoadedVolume>>,
        key: &VolumeKey,
        dataset: &Dataset,
    ) -> Option<CacheEntry<VolumeKey, LoadedVolume>> {
        // Volumes that are shown in another way have to be uploaded again.
        let count = self.volumes.len();
        self.volumes.retain(|spare| is_shown_like(spare.key(), key));
        self.has_dropped |= self.volumes.len() < count;
        let found = self.position(key, dataset).map(|at| self.volumes.remove(at));
        let is_spare = |shown: &CacheEntry<VolumeKey, LoadedVolume>| {
            shown.is_complete()
                && shown.key().content_id != key.content_id
                && is_shown_like(shown.key(), key)
                && self.budget_bytes > 0
        };
        match shown {
            Some(shown) if is_spare(&shown) => {
                self.volumes.push(shown);
                self.evict();
                found
            }
            other => found.or(other),
        }
    }

    /// Returns true, once, if volumes were dropped whose textures bind groups may keep alive.
    pub(crate) fn take_dropped(&mut self) -> bool {
        std::mem::take(&mut self.has_dropped)
    }

    /// Drops all volumes.
    pub(crate) fn clear(&mut self) {
        self.volumes.clear();
    }

    /// Returns the size of all volumes, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.volumes.iter().map(|spare| spare.product.bytes()).sum()
    }

    fn position(&self, key: &VolumeKey, dataset: &Dataset) -> Option<usize> {
        let is_it = |spare: &CacheEntry<VolumeKey, LoadedVolume>| {
            spare.is_valid_for(key) && spare.product.has_voxel_type_of(dataset)
        };
        self.volumes.iter().position(is_it)
    }

    /// Drops the least recently used volumes until the others fit into the budget.
    fn evict(&mut self) {
        while !self.volumes.is_empty() && self.bytes() > self.budget_bytes {
            self.volumes.remove(0);
            self.has_dropped = true;
        }
    }
}

/// Returns true if two keys differ in nothing but the voxels.
fn is_shown_like(known: &VolumeKey, wanted: &VolumeKey) -> bool {
    VolumeKey { content_id: wanted.content_id, ..*known } == *wanted
}
