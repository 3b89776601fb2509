//! Pipeline variants of the pass that computes the emission of blocks (`scattered_light/source.wgsl`).

use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, flag};

/// Pipeline variant of the pass that computes the emission of blocks for the next bounce.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct SourceVariant {
    /// True if light of an earlier bounce is in the sums.
    pub(super) has_bounced: bool,
    /// True if the light of later bounces has diffused.
    pub(super) diffuses: bool,
    /// True if this step is mixed with the step before.
    pub(super) mixes: bool,
    /// True if one colour is followed in place of three.
    pub(super) one_color: bool,
}

impl PipelineVariant for SourceVariant {
    fn shader(&self) -> &'static str {
        "scattered_light/source.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![
            flag("HAS_BOUNCED", self.has_bounced),
            flag("DIFFUSES", self.diffuses),
            flag("MIXES", self.mixes),
            flag("ONE_COLOR", self.one_color),
        ]
    }
}
