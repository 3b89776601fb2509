//! Texts of the chooser of series, channels, time steps and components, and of the rows that open it.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_volume::{ChoiceAspect, DefaultComponent, FileDimension, MAX_FIELDS, VoxelComponents};

/// Name and tooltip of the row of an aspect.
pub(crate) fn row(aspect: ChoiceAspect) -> ControlText {
    match aspect {
        ChoiceAspect::Dimension(FileDimension::Series) => {
            control_text("Series", "The scans in the folder or file: one is shown at a time")
        }
        ChoiceAspect::Dimension(FileDimension::Array) => {
            control_text("Array", "The arrays in the file: one is shown at a time")
        }
        ChoiceAspect::Dimension(FileDimension::Channel) => control_text(
            "Channel",
            "Simultaneous recordings of several dyes or detectors: one is shown at a time",
        ),
        ChoiceAspect::Dimension(FileDimension::Frame) => {
            control_text("Time step", "The time steps in the file: one is shown at a time")
        }
        ChoiceAspect::Dimension(FileDimension::Level) => control_text(
            "Resolution level",
            "Copies of the image in several sizes: the finest that fits into memory is opened first",
        ),
        ChoiceAspect::Component => control_text(
            "Component",
            "For voxels with several values: one of them, or one value computed from all",
        ),
    }
}

/// Title of the chooser window.
pub(crate) fn title(aspect: ChoiceAspect) -> &'static str {
    match aspect {
        ChoiceAspect::Dimension(FileDimension::Series) => "Choose a series",
        ChoiceAspect::Dimension(FileDimension::Array) => "Choose an array",
        ChoiceAspect::Dimension(FileDimension::Channel) => "Choose a channel",
        ChoiceAspect::Dimension(FileDimension::Frame) => "Choose a time step",
        ChoiceAspect::Dimension(FileDimension::Level) => "Choose a resolution level",
        ChoiceAspect::Component => "Choose a component",
    }
}

/// Command that opens the chooser.
pub(crate) fn command(aspect: ChoiceAspect) -> String {
    format!("{}…", title(aspect))
}

/// Command that goes to the next or the previous item.
pub(crate) fn step(aspect: ChoiceAspect, is_forward: bool) -> String {
    let what = row(aspect).name.to_lowercase();
    if is_forward { format!("Next {what}") } else { format!("Previous {what}") }
}

/// Switch for the levels that are finer than the one in memory.
pub(crate) const FINER_LEVELS: ControlText = control_text(
    "Finer levels",
    "Reads what the picture shows of finer levels from the file, part by part; off shows the level in memory alone",
);

/// Captions of the buttons that go one item back and forward.
pub(crate) const BACK: &str = "‹";
pub(crate) const FORWARD: &str = "›";

/// Message when the open file holds a single item of this aspect.
pub(crate) fn single_item(aspect: ChoiceAspect) -> String {
    let what = match aspect {
        ChoiceAspect::Dimension(dimension) => dimension.plural(),
        ChoiceAspect::Component => "components",
    };
    format!("The open file does not hold several {what}")
}

/// Default name of an unnamed item, numbered from 0.
pub(crate) fn default_name(dimension: FileDimension, at: usize) -> String {
    format!("{} {}", row(ChoiceAspect::Dimension(dimension)).name, at + 1)
}

/// Name of a scalar that is computed from all components.
pub(crate) fn scalar_name(whole: DefaultComponent) -> &'static str {
    match whole {
        DefaultComponent::Magnitude => "Magnitude",
        DefaultComponent::Luminance => "Luminance",
        DefaultComponent::First => "First",
    }
}

/// Name of a component, numbered from 0: a colour where they are colours.
pub(crate) fn component_name(at: usize, of: &VoxelComponents) -> String {
    const COLORS: [&str; 4] = ["Red", "Green", "Blue", "Opacity"];
    const GREYS: [&str; 2] = ["Grey", "Opacity"];
    let names: &[&str] = match (of.is_color, of.count) {
        (true, 3 | 4) => &COLORS,
        (true, 2) => &GREYS,
        _ => &[],
    };
    names.get(at).map_or_else(|| format!("Component {}", at + 1), |name| (*name).to_owned())
}

/// Position, count and name of the item shown.
pub(crate) fn current_item(at: usize, count: usize, name: &str) -> String {
    format!("{} of {count} · {name}", at + 1)
}

/// Maximum number of characters of an item's name beside the file name; dyes and arrays fit.
const MAX_TITLE_SUFFIX: usize = 20;

/// Item beside the file name in the title: a component by name, others by number, with a name where there is one.
pub(crate) fn title_suffix(aspect: ChoiceAspect, at: usize, count: usize, name: Option<&str>) -> String {
    let name = name.unwrap_or_default();
    if aspect == ChoiceAspect::Component {
        return name.to_owned();
    }
    let place = format!("{} {}", row(aspect).name, position(at, count));
    match name.char_indices().nth(MAX_TITLE_SUFFIX) {
        _ if name.is_empty() => place,
        Some((end, _)) => format!("{place} · {}…", name[..end].trim_end()),
        None => format!("{place} · {name}"),
    }
}

/// Position of the item, from 1, and the count.
pub(crate) fn position(at: usize, count: usize) -> String {
    format!("{} of {count}", at + 1)
}

/// Number of voxels along x, y and z.
pub(crate) fn size([x, y, z]: [u64; 3]) -> String {
    format!("{x} × {y} × {z} voxels")
}

/// Mark of the item that is shown already.
pub(crate) const SHOWN_MARK: &str = "shown";

/// Button of the command below.
pub(crate) const TOGETHER: &str = "Show all together";

/// Command that shows what a file has several of as layers.
pub(crate) fn show_together(aspect: ChoiceAspect) -> &'static str {
    match aspect {
        ChoiceAspect::Component => "Show colours, or all components together",
        ChoiceAspect::Dimension(FileDimension::Frame) => "Show a few time steps together",
        ChoiceAspect::Dimension(_) => "Show all channels together",
    }
}

/// Tooltip of that command for a file with too many.
pub(crate) fn together_tooltip(count: usize) -> String {
    if count > MAX_FIELDS {
        format!("Shows {MAX_FIELDS} of the {count} as layers, each in a colour of its own")
    } else {
        "Shows each as a layer in a colour of its own, with the shadows of all".to_owned()
    }
}

/// Note in the list for a file of colours, of which the luminance is shown.
pub(crate) const COLORS_NOTE: &str = "Show colours, in the section Data, shows the colours of the file";

/// Button that shows a volume in the colours of its file.
pub(crate) const COLORS: ControlText = control_text(
    "Show colours",
    "Colours the material by red, green and blue of the file; opacity is by luminance",
);

/// Keyboard hint below the list.
pub(crate) const KEYS: &str = "Arrow keys and Enter choose, Esc closes";
pub(crate) const KEEP_LOOK: ControlText = control_text(
    "Keep the look",
    "View, lights and transfer function stay as they are; otherwise a first look is made for what is chosen",
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_behind_numbers_as_far_as_there_is_room() {
        let channel = |name| title_suffix(ChoiceAspect::Dimension(FileDimension::Channel), 0, 3, name);
        assert_eq!(channel(None), "Channel 1 of 3");
        assert_eq!(channel(Some("DAPI")), "Channel 1 of 3 · DAPI");
        assert_eq!(channel(Some("Phalloidin, Alexa Fluor 568")), "Channel 1 of 3 · Phalloidin, Alexa Fl…");
        assert_eq!(title_suffix(ChoiceAspect::Component, 1, 3, Some("Green")), "Green");
    }
}
