//! Effect of a cut on the part that it cuts away: for the eye, for light or for both.

use serde::{Deserialize, Serialize};

/// Effect of clipping on the part that is cut away.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClipEffect {
    /// Invisible, and casts no shadow.
    #[default]
    Removed,
    /// Invisible, but still casts its shadow.
    Hidden,
    /// Visible, but casts no shadow.
    Shadowless,
}

impl ClipEffect {
    /// All effects, in the order of menus.
    pub const ALL: [Self; 3] = [Self::Removed, Self::Hidden, Self::Shadowless];

    /// Returns true if the part cannot be seen.
    pub fn is_invisible(self) -> bool {
        self != Self::Shadowless
    }

    /// Returns true if the part does not attenuate light.
    pub fn is_shadowless(self) -> bool {
        self != Self::Hidden
    }
}
