//! Mask over the voxels of a grid: the part of each that is hidden from the eye, and from light.

use std::ops::Range;

/// Number of steps from a visible voxel to a hidden one.
const SHARE_STEPS: f32 = 255.0;

/// Side from which a voxel may be hidden: the eye, or light on its way through the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Observer {
    /// Eye, which does not see hidden voxels.
    Eye,
    /// Light, which hidden voxels do not attenuate.
    Light,
}

impl Observer {
    /// Eye and light, in this order.
    pub const ALL: [Self; 2] = [Self::Eye, Self::Light];
}

/// Mask over the voxels of a grid. A voxel that is hidden in part is one at the edge of a cut.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VoxelMask {
    /// Number of voxels along x, y, z.
    dims: [usize; 3],
    /// Share of each voxel that is hidden from eye and light, x fastest, from 0 to 255.
    hidden: Vec<u8>,
    /// Shares that are hidden from the eye, and from light, if these differ.
    by_observer: Option<[Vec<u8>; 2]>,
}

impl VoxelMask {
    /// Creates a mask from the hidden share of each voxel, x fastest, from 0 for visible to 255 for hidden; `None` if
    /// no voxel is hidden, or there is not one share for each voxel.
    pub fn from_hidden_shares(dims: [usize; 3], hidden: Vec<u8>) -> Option<Self> {
        let is_whole = hidden.len() == dims.iter().product::<usize>();
        (is_whole && hidden.iter().any(|&share| share > 0)).then_some(Self {
            dims,
            hidden,
            by_observer: None,
        })
    }

    /// Creates a mask from the shares of each voxel that are hidden from the eye, and from light; `None` in the cases
    /// of [`Self::from_hidden_shares`].
    pub fn from_shares_by_observer(dims: [usize; 3], eye: Vec<u8>, light: Vec<u8>) -> Option<Self> {
        if eye == light {
            return Self::from_hidden_shares(dims, eye);
        }
        let count = dims.iter().product::<usize>();
        let hidden = eye.iter().zip(&light).map(|(&eye, &light)| eye.min(light)).collect();
        (eye.len() == count && light.len() == count).then_some(Self {
            dims,
            hidden,
            by_observer: Some([eye, light]),
        })
    }

    /// Returns the number of voxels along x, y, z.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Returns true if some voxels are hidden from the eye alone, or from light alone.
    pub fn differs_by_observer(&self) -> bool {
        self.by_observer.is_some()
    }

    /// Returns the shares of all voxels that are hidden from an observer, x fastest, from 0 to 255.
    pub fn hidden_from(&self, observer: Observer) -> &[u8] {
        match (&self.by_observer, observer) {
            (None, _) => &self.hidden,
            (Some([eye, _]), Observer::Eye) => eye,
            (Some([_, light]), Observer::Light) => light,
        }
    }

    /// Returns the share of the voxel at an index, x fastest, that is visible to some observer, from 0 to 1.
    pub(crate) fn visible_to_any(&self, voxel: usize) -> f32 {
        1.0 - f32::from(self.hidden[voxel]) / SHARE_STEPS
    }

    /// Returns the share of the voxel at an index, x fastest, that is visible to an observer, from 0 to 1.
    pub(crate) fn visible_to(&self, voxel: usize, observer: Observer) -> f32 {
        1.0 - f32::from(self.hidden_from(observer)[voxel]) / SHARE_STEPS
    }

    /// Returns true if no voxel in a range of indices is hidden from any observer, even in part.
    pub(crate) fn hides_none_of(&self, voxels: Range<usize>) -> bool {
        let is_clear = |shares: &[u8]| shares[voxels.clone()].iter().all(|&share| share == 0);
        match &self.by_observer {
            None => is_clear(&self.hidden),
            Some(shares) => shares.iter().all(|shares| is_clear(shares)),
        }
    }
}
