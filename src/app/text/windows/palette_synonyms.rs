//! Synonyms of the command palette, in lower case: search words that are not in the program's names, with notes.

/// Search words of the palette, with a note for a match or a missing feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PaletteSynonyms {
    /// Search words, separated by spaces.
    pub words: &'static str,
    /// Note shown beside the match, or in its place.
    pub note: &'static str,
}

/// Makes an entry whose match needs no note.
const fn synonyms(words: &'static str) -> PaletteSynonyms {
    synonyms_with_note(words, "")
}

/// Makes an entry with a note for its match.
const fn synonyms_with_note(words: &'static str, note: &'static str) -> PaletteSynonyms {
    PaletteSynonyms { words, note }
}

pub(crate) const TILT: PaletteSynonyms =
    synonyms("stand up lay down flip tip over upside down rotate turn object orientation");
pub(crate) const ROTATE: PaletteSynonyms = synonyms("turn round quarter around spin object orientation");
pub(crate) const SCALE: PaletteSynonyms = synonyms("zoom text font size dpi scale reset");
pub(crate) const REOPEN_LAST: PaletteSynonyms = synonyms("go on where you left off continue resume restore");
pub(crate) const SAVE: PaletteSynonyms = synonyms("save settings");
pub(crate) const TRANSFER: PaletteSynonyms = synonyms("load colormap colour map lut tf");
pub(crate) const SOLO: PaletteSynonyms = synonyms("only the selected light alone others off");
pub(crate) const MUTE: PaletteSynonyms = synonyms("switch off on disable enable");
pub(crate) const COMPARE: PaletteSynonyms = synonyms("before after split side by side difference");
pub(crate) const PICTURE_ONLY: PaletteSynonyms =
    synonyms("hide panels distraction free presentation zen maximise");

pub(crate) const EXPORT: PaletteSynonyms = synonyms("screenshot save picture image figure render poster");
pub(crate) const ANIMATION: PaletteSynonyms = synonyms_with_note(
    "animation animate turntable movie video film record rotate spin gif mp4",
    "once around the volume",
);
pub(crate) const MEASURE: PaletteSynonyms = synonyms_with_note(
    "measure measurement measuring ruler distance length caliper",
    "two clicks measure a distance",
);
pub(crate) const ANNOTATIONS: PaletteSynonyms = synonyms("scale bar cube axes letters orientation marker");
pub(crate) const SKY: PaletteSynonyms = synonyms("ambient occlusion ao skylight");
pub(crate) const WINDOW_LEVEL: PaletteSynonyms = synonyms("window level width centre center contrast wl ww");
pub(crate) const FEWER_VOXELS: PaletteSynonyms =
    synonyms("resample resampling downsample subsample reduce bin binning");
pub(crate) const LABELS: PaletteSynonyms = synonyms("segmentation segments labels label classes regions");

pub(crate) const RAY_PROJECTIONS: PaletteSynonyms =
    synonyms("mip minip maximum minimum mean average intensity projection xray radiograph");
pub(crate) const TABLE: PaletteSynonyms = synonyms("remove hide table bed couch patient scanner board");
pub(crate) const ISOSURFACE: PaletteSynonyms = synonyms("isosurface iso surface isovalue threshold");

pub(crate) const PLAYING: PaletteSynonyms =
    synonyms("play playing playback player time lapse timelapse series slider");
pub(crate) const COMPOSITE: PaletteSynonyms =
    synonyms("composite compositing merge merged channels multichannel rgb");
pub(crate) const NO_ANNOTATION: PaletteSynonyms = synonyms_with_note(
    "annotation annotate arrow caption callout",
    "There are no arrows or captions; exported pictures have a scale bar, letters and a legend",
);
pub(crate) const NO_FILTER: PaletteSynonyms = synonyms_with_note(
    "denoise denoising noise smooth smoothing filter blur median",
    "Values are not filtered; these settings make noise less visible",
);
pub(crate) const NO_STEREO: PaletteSynonyms =
    synonyms_with_note("stereo stereoscopic anaglyph 3d glasses vr headset", "There is no stereo picture");
pub(crate) const FUSION: PaletteSynonyms = synonyms("fusion fuse fused overlay second volume layer");
pub(crate) const NO_DEPTH_OF_FIELD: PaletteSynonyms = synonyms_with_note(
    "depth of field dof bokeh lens focus",
    "There is no depth of field: the whole picture is sharp",
);
pub(crate) const OBJECTS: PaletteSynonyms =
    synonyms("remove object holder island islands largest connected component isolate part eraser");
pub(crate) const SCISSORS: PaletteSynonyms =
    synonyms("scissors lasso polygon outline freehand cut sculpt mask");
pub(crate) const NO_SEGMENTATION: PaletteSynonyms = synonyms_with_note(
    "segmentation segment segments labels label region growing",
    "There is no segmentation; label maps of other programs can be opened",
);
