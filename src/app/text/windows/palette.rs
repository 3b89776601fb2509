//! Synonyms of the command palette, in lower case: search words that are not in the program's names, with notes.

/// Search words of the palette, with a note for a match or a missing feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sought {
    /// Search words, separated by spaces.
    pub words: &'static str,
    /// Note shown beside the match, or in its place.
    pub note: &'static str,
}

/// Makes an entry whose match needs no note.
const fn words(words: &'static str) -> Sought {
    noted(words, "")
}

/// Makes an entry with a note for its match.
const fn noted(words: &'static str, note: &'static str) -> Sought {
    Sought { words, note }
}

pub(crate) const TURN_OBJECT: Sought =
    words("stand up lay down flip tip over upside down rotate turn object orientation");
pub(crate) const TURN_ROUND: Sought = words("turn round quarter around spin object orientation");
pub(crate) const SCALE: Sought = words("zoom text font size dpi scale reset");
pub(crate) const GO_ON: Sought = words("go on where you left off continue resume restore");
pub(crate) const SAVE: Sought = words("save settings");
pub(crate) const TRANSFER: Sought = words("load colormap colour map lut tf");
pub(crate) const SOLO: Sought = words("only the selected light alone others off");
pub(crate) const MUTE: Sought = words("switch off on disable enable");
pub(crate) const COMPARE: Sought = words("before after split side by side difference");
pub(crate) const PICTURE_ONLY: Sought = words("hide panels distraction free presentation zen maximise");

pub(crate) const EXPORT: Sought = words("screenshot save picture image figure render poster");
pub(crate) const ANIMATION: Sought = noted(
    "animation animate turntable movie video film record rotate spin gif mp4",
    "once around the volume",
);
pub(crate) const MEASURE: Sought =
    noted("measure measurement measuring ruler distance length caliper", "two clicks: how far apart");
pub(crate) const MARKS: Sought = words("scale bar cube axes letters orientation marker");
pub(crate) const SKY: Sought = words("ambient occlusion ao skylight");
pub(crate) const WINDOW_LEVEL: Sought = words("window level width centre center contrast wl ww");
pub(crate) const FEWER_VOXELS: Sought = words("resample resampling downsample subsample reduce bin binning");
pub(crate) const LABELS: Sought = words("segmentation segments labels label classes regions");

pub(crate) const NO_PLAYING: Sought = noted(
    "play playing playback player time lapse timelapse slider",
    "Time steps are not played; these go through them",
);
pub(crate) const NO_COMPOSITE: Sought = noted(
    "composite compositing merge merged channels multichannel rgb",
    "Channels are shown one at a time: there is no composite of them",
);
pub(crate) const NO_PROJECTION: Sought = noted(
    "mip minip maximum minimum mean intensity projection",
    "There is no maximum intensity projection; its nearest is the look Translucent",
);
pub(crate) const NO_ANNOTATION: Sought = noted(
    "annotation annotate arrow caption callout",
    "There are no arrows or captions; exported pictures have a scale bar, letters and a legend",
);
pub(crate) const NO_FILTER: Sought = noted(
    "denoise denoising noise smooth smoothing filter blur median",
    "Values are not filtered; these make noise less visible",
);
pub(crate) const NO_STEREO: Sought =
    noted("stereo stereoscopic anaglyph 3d glasses vr headset", "There is no stereo picture");
pub(crate) const NO_FUSION: Sought = noted(
    "fusion fuse fused registration coregister second volume",
    "Volumes are not fused: one is shown at a time",
);
pub(crate) const NO_DEPTH_OF_FIELD: Sought =
    noted("depth of field dof bokeh lens focus", "There is no depth of field: all of the picture is sharp");
pub(crate) const NO_OBJECTS: Sought = noted(
    "remove table hide object holder bed couch island islands largest connected component",
    "Nothing is removed by object; a box or a plane leaves out what lies beyond it",
);
pub(crate) const NO_SEGMENTATION: Sought = noted(
    "segmentation segment segments labels label region growing",
    "Nothing is segmented here; label maps of other programs can be opened",
);
