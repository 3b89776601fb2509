//! Texts of the shadows section.

use crate::app::text::{ControlText, control_text};

pub(crate) const ALGORITHM: ControlText = control_text("Method", "How light is attenuated on its way");
pub(crate) const OFF: ControlText = control_text("Off", "Light reaches everything: only the shading is left");
pub(crate) const SPLAT: ControlText =
    control_text("Splat", "A light volume filled by sheet-buffer splatting: the quick way");
pub(crate) const RAYCAST: ControlText = control_text(
    "Voxel",
    "A light volume filled by a ray from every voxel: a little sharper, many times slower when a light moves",
);
pub(crate) const DIRECT: ControlText = control_text(
    "Sample",
    "A ray to the light from every sample: the sharpest shadows; every picture takes as long as a light volume",
);

/// Warning on software rasterisers, which end shadow rays to area lights early.
pub(crate) const SOFTWARE_RAYS_WARNING: &str = "This software graphics driver ends rays to area lights too early, \
     so that such lights are too dark. The quality Fine shows them correctly";

pub(crate) const STRENGTH: ControlText =
    control_text("Strength", "0 shows no shadows, 1 shows them fully; between, they are mixed");
pub(crate) const AMBIENT_OFFSET: ControlText = control_text(
    "Ambient offset",
    "Light that reaches everything: lifts black interiors without touching bright parts",
);
pub(crate) const GAIN: ControlText =
    control_text("Gain", "Multiplies the transmittance, up to full light: brightens half-shadows");
pub(crate) const LIGHT_BIAS: ControlText = control_text(
    "Shadow bias",
    "Looks up the light a little nearer to its source: removes self-shadowing of surfaces",
);

pub(crate) const BALANCE: ControlText = control_text(
    "Balance",
    "Multiplies the lights while shadows are on, so that the picture is as bright as without them",
);
/// Button that measures the balance once.
pub(crate) const MEASURE_BALANCE: ControlText =
    control_text("Balance brightness", "Measures the picture with and without shadows and sets the balance");
/// Checkbox that keeps the balance up to date automatically.
pub(crate) const KEEP_BALANCED: ControlText = control_text(
    "Keep balanced",
    "Balances the brightness again after each change of lights, opacities or shadows; a balance set by \
     hand switches it off",
);

pub(crate) const NEARLY_BLACK: ControlText = control_text(
    "Nearly black",
    "Share of the visible pixels that are nearly black. Light opacity below 1 lets light pass thin parts, \
     a narrow Gaussian or a shadow bias removes self-shadowing, an ambient offset brightens everything",
);
/// Text in place of a share that is not measured yet.
pub(crate) const UNKNOWN: &str = "–";

pub(crate) const LIGHT_OPACITY: ControlText = control_text(
    "Light opacity",
    "Multiplies how strongly material attenuates light, not the eye: below 1 lets light pass thin \
     structures; refills the light volumes",
);
pub(crate) const LINKED: ControlText = control_text(
    "Same opacity for light and eye",
    "Light uses the eye's opacity curve. Unlinked, it has a separate one in the transfer function editor",
);

pub(crate) const TRANSMISSION: ControlText = control_text(
    "Shadow colour",
    "Coloured shadows: share of the light of its own hue that a material lets through, as coloured glass \
     does; 0 leaves shadows grey. Colours are those of the eye's curve, or of a separate curve for light. \
     Light volumes take four times the memory",
);

pub(crate) const RESOLUTION: ControlText =
    control_text("Resolution", "Resolution of the light volumes; they are refilled when it changes");
pub(crate) const FULL: ControlText = control_text("Full", "One light voxel per voxel");
pub(crate) const HALF: ControlText =
    control_text("Half", "An eighth of the memory and time; shadow edges get softer");
pub(crate) const QUARTER: ControlText = control_text("Quarter", "Soft shadows; for very large volumes");

pub(crate) const FIRST_TOUCH: ControlText = control_text(
    "First touch",
    "Each voxel takes only the light of the first sheet that touches it: crisper and brighter, \
     with faint steps",
);

pub(crate) const PRECISION: ControlText = control_text("Precision", "Bits per value in light volumes");
pub(crate) const SIXTEEN_BITS: ControlText =
    control_text("16 bits", "Smooth in dark parts, too, and with gain");
pub(crate) const EIGHT_BITS: ControlText =
    control_text("8 bits", "Half the memory; shows steps where gain lifts dark parts");

pub(crate) const STORAGE: ControlText =
    control_text("Light volumes", "A light volume for each light, or one for all");
pub(crate) const AUTO: ControlText = control_text(
    "Auto",
    "One for all with five or more lights (two with shadow colour), if there are no highlights or \
     contact shadows",
);
pub(crate) const PER_LIGHT: ControlText =
    control_text("Each", "A volume for each light: highlights, and colours that change at once");
pub(crate) const COMBINED: ControlText = control_text(
    "One",
    "The diffuse light of all lights in one volume: fast pictures with many lights, without highlights",
);

pub(crate) const QUALITY: ControlText = control_text(
    "Quality",
    "Accuracy of the light; sets the method, contact shadows, slabs, kernels and normals",
);
pub(crate) const FAST: ControlText = control_text("Fast", "Light volumes alone: soft shadows, quickest");
pub(crate) const STANDARD: ControlText =
    control_text("Standard", "Light volumes, and short rays near visible material");
pub(crate) const FINE: ControlText = control_text("Fine", "Light volumes, and longer rays: for figures");
pub(crate) const EXACT: ControlText =
    control_text("Exact", "Rays all the way and the thinnest slabs: accurate, and slow");

pub(crate) const NEAR_FIELD: ControlText = control_text(
    "Contact shadows",
    "Shadows of nearby material, found by a short ray: relief, contacts and thin structures are sharp",
);
pub(crate) const CONTACT_OFF: ControlText =
    control_text("Off", "The light volume alone, as in the paper: soft, and quickest");
pub(crate) const CONTACT_SHORT: ControlText =
    control_text("3 voxels", "Sharp where it matters most, at little cost");
pub(crate) const CONTACT_LONG: ControlText =
    control_text("6 voxels", "More accurate, and slower: for figures");

pub(crate) const REVERSE_KERNEL: ControlText =
    control_text("Reverse kernel", "Kernel that carries light from the sheets into the light volume");
pub(crate) const TENT: ControlText = control_text("Tent", "Narrow: sharper shadows, filled in less time");
pub(crate) const FORWARD_KERNEL: ControlText =
    control_text("Kernel", "The kernel of the light pass, as in the paper: softer shadows");

pub(crate) const DEPOSIT: ControlText =
    control_text("Deposit", "The light that a sheet stores in its voxels");
pub(crate) const SLAB_MEAN: ControlText =
    control_text("Mean", "The mean over the slab: hardly depends on its thickness");
pub(crate) const SLAB_FRONT: ControlText =
    control_text("Front", "The light in front of the slab: a little brighter; the paper's equation");

pub(crate) const AREA_SAMPLES: ControlText = control_text(
    "Light samples",
    "Number of points that sample an area light: too few show as several edges of a shadow",
);
pub(crate) const AREA_RESOLUTION: ControlText = control_text(
    "Soft resolution",
    "Resolution of the light volumes of area lights, whose shadows have less detail",
);

pub(crate) const MIN_BLOCKS: ControlText = control_text(
    "Minimum blocks",
    "Least number of blocks along the longest edge in which light of wide lights, of the sky and of \
     bounces is computed: small volumes are lit as finely as large ones",
);

/// Percentage of the visible pixels that are nearly black.
pub(crate) fn dark_share(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}

/// Memory of the light volumes, and the way they are shared.
pub(crate) fn light_volumes(mebibytes: f64, shared: bool) -> String {
    let kind = if shared { "one for all lights" } else { "one for each light" };
    format!("Light volumes: {mebibytes:.1} MiB, {kind}")
}

/// Estimated cost of each light volume.
pub(crate) fn volume_cost(cost: &str) -> String {
    format!("Each light volume takes about {cost}")
}

/// Estimated cost of each area light.
pub(crate) fn area_cost(cost: &str) -> String {
    format!("Each area light takes about {cost}")
}

/// Estimated cost of an effect that exists once, as the sky.
pub(crate) fn soft_cost(cost: &str) -> String {
    format!("Takes about {cost}")
}

/// Cost in milliseconds, where measured, and in MiB.
pub(crate) fn cost(ms: Option<f64>, mebibytes: f64) -> String {
    let memory = if mebibytes < 10.0 { format!("{mebibytes:.1} MiB") } else { format!("{mebibytes:.0} MiB") };
    match ms {
        Some(ms) if ms < 1.0 => format!("<1 ms, {memory}"),
        Some(ms) => format!("{ms:.0} ms, {memory}"),
        None => memory,
    }
}
