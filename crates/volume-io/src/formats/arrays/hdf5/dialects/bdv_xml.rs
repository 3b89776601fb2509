//! Descriptions of `BigDataViewer` in XML (`SpimData`): the HDF5 file, and names and voxel sizes of its setups.

use std::io::Read as _;
use std::path::PathBuf;

use roxmltree::Node;

use crate::length_unit::millimetres;
use crate::reading::companion_path;
use crate::reading::input::InputFile;
use crate::reading::placement::GridPlacement;
use chiaroscuro_files::{sanitised, xml};
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError, quoted};

const HELP: &str = "export it again with BigDataViewer, or open the HDF5 file";

/// Setup of a description: a channel, angle or tile.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BdvSetup {
    number: u32,
    pub(crate) name: String,
    /// Voxel size along x, y and z, and its unit in millimetres.
    voxel_size: Option<([f64; 3], Option<f64>)>,
}

impl BdvSetup {
    /// Placement of a level that is coarser by some factors.
    pub(crate) fn placement(&self, factors: [f64; 3]) -> GridPlacement {
        let Some((size, unit)) = self.voxel_size else { return GridPlacement::unknown() };
        let size: [f64; 3] = std::array::from_fn(|at| size[at] * factors[at] * unit.unwrap_or(1.0));
        match unit {
            Some(unit) => GridPlacement::from_spacing(size).with_length_unit(unit),
            None => GridPlacement::from_spacing(size).with_unknown_scale(),
        }
    }
}

/// Description of an HDF5 file.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct BdvDescription {
    /// Name of the HDF5 file.
    pub(crate) file: String,
    setups: Vec<BdvSetup>,
}

impl BdvDescription {
    /// Reads the description in a file.
    pub(crate) fn read(context: LoadContext<'_>, control: &LoadControl) -> Result<Self, LoadError> {
        let input = InputFile::open(context)?;
        control.record_read(context.path);
        let mut text = Vec::new();
        let most = xml::MAX_XML_BYTES as u64;
        input.reader.take(most).read_to_end(&mut text).map_err(|error| context.io_error(error))?;
        Self::parse(context, &String::from_utf8_lossy(&text))
    }

    fn parse(context: LoadContext<'_>, text: &str) -> Result<Self, LoadError> {
        let document =
            xml::parse(text).map_err(|error| context.bad_input_error("XML", error.to_string(), HELP))?;
        let root = document.root_element();
        let sequence = child(root, "SequenceDescription").unwrap_or(root);
        let loader = child(sequence, "ImageLoader");
        let format = loader.and_then(|loader| loader.attribute("format")).unwrap_or("");
        let Some(file) = loader.filter(|_| format == "bdv.hdf5").and_then(|loader| child(loader, "hdf5"))
        else {
            let why = format!("volumes in HDF5 (bdv.hdf5) were expected, {} was found", quoted(format));
            return Err(context.bad_input_error(
                "ImageLoader",
                why,
                "open the files of the volumes themselves",
            ));
        };
        let setups = child(sequence, "ViewSetups");
        let setups =
            setups.into_iter().flat_map(|setups| children(setups, "ViewSetup")).filter_map(parse_setup);
        Ok(Self { file: text_of(file).to_owned(), setups: setups.collect() })
    }

    /// Returns a setup by its number.
    pub(crate) fn setup(&self, number: u32) -> Option<&BdvSetup> {
        self.setups.iter().find(|setup| setup.number == number)
    }

    /// Path of the HDF5 file, which must lie beside the description.
    pub(crate) fn path(&self, context: LoadContext<'_>) -> Result<PathBuf, LoadError> {
        companion_path::resolve(context, "hdf5", &self.file)
    }
}

/// Reads the description beside an HDF5 file, if there is one of the same name that can be read.
pub(crate) fn read_beside(
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<Option<BdvDescription>, LoadError> {
    let path = context.path.with_extension("xml");
    if !path.is_file() {
        return Ok(None);
    }
    match BdvDescription::read(LoadContext { path: &path, ..context }, control) {
        Err(LoadError::Cancelled) => Err(LoadError::Cancelled),
        Err(error) => {
            context.warn(format!("the description beside it is not used: {error}"));
            Ok(None)
        }
        Ok(described) => Ok(Some(described)),
    }
}

fn children<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Option<Node<'a, 'i>> {
    children(node, name).next()
}

fn text_of<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or("").trim()
}

fn parse_setup(setup: Node<'_, '_>) -> Option<BdvSetup> {
    let number = text_of(child(setup, "id")?).parse().ok()?;
    let name = sanitised(child(setup, "name").map_or("", text_of), 80);
    let voxel_size = child(setup, "voxelSize").and_then(|size| {
        let mut numbers =
            text_of(child(size, "size")?).split_whitespace().map(|number| number.parse::<f64>().ok());
        let numbers = [numbers.next()??, numbers.next()??, numbers.next()??];
        Some((numbers, child(size, "unit").and_then(|unit| millimetres(text_of(unit)))))
    });
    Some(BdvSetup { number, name, voxel_size })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn parse(text: &str) -> Result<BdvDescription, LoadError> {
        BdvDescription::parse(LoadContext { operation: "test", path: Path::new("a/t.xml") }, text)
    }

    #[test]
    fn setups_are_read() {
        let text = "<SpimData version=\"0.2\"><BasePath type=\"relative\">.</BasePath><SequenceDescription>\
            <ImageLoader format=\"bdv.hdf5\"><hdf5 type=\"relative\"> t.h5 </hdf5></ImageLoader><ViewSetups><ViewSetup>\
            <id>3</id><name>GFP</name><size>4 5 6</size><voxelSize><unit>um</unit><size>0.5 0.5 2.0</size></voxelSize>\
            </ViewSetup><ViewSetup><id>x</id></ViewSetup></ViewSetups></SequenceDescription></SpimData>";
        let found = parse(text).unwrap();
        assert_eq!((found.file.as_str(), found.setups.len()), ("t.h5", 1));
        let setup = found.setup(3).unwrap();
        assert_eq!(setup.name, "GFP");
        let placed = setup.placement([2.0, 2.0, 1.0]);
        assert_eq!(
            placed.world_from_index.matrix3,
            glam::DMat3::from_diagonal(glam::DVec3::new(1e-3, 1e-3, 2e-3))
        );
        assert_eq!(found.setup(0), None);
    }

    #[test]
    fn other_descriptions_are_refused() {
        for (text, words) in [
            ("<SpimData>", "XML"),
            ("<SpimData/>", "bdv.hdf5"),
            (
                "<SpimData><SequenceDescription><ImageLoader format=\"bdv.n5\"/></SequenceDescription></SpimData>",
                "bdv.n5",
            ),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
