//! Volumes as Python objects: from files, built-in ones, and from the voxels of arrays.

use std::path::PathBuf;

use chiaroscuro_scene::first_look;
use chiaroscuro_volume::{
    Corrections, Dataset, Downsampling, LevelRule, LoadControl, Portion, Samples, ValueMeaning,
    ValueMetadata, Volume, VolumeChoice, with_samples,
};
use chiaroscuro_volume_io::write::{ExportVolume, VolumeFormat, write_volume};
use chiaroscuro_volume_io::{FilePages, LoadOptions, open};
use glam::{DAffine3, DMat3, DVec3};
use numpy::{IntoPyArray as _, PyArray1};
use pyo3::prelude::*;

use crate::errors::{self, ExceptionClass};
use crate::interruptible::interruptible;
use crate::voxel_buffer::VoxelBuffer;

/// Volume, or several that are shown together, with data derived from the voxels.
#[pyclass(frozen, module = "chiaroscuro._native")]
#[derive(Debug)]
pub(crate) struct NativeVolume {
    pub(crate) dataset: Dataset,
    /// File that the volume was read from; `None` for arrays, layers and corrected volumes.
    pub(crate) file: Option<LevelFile>,
}

/// File of a volume, of which resolution levels are read that are finer than the one in memory.
#[derive(Debug)]
pub(crate) struct LevelFile {
    path: PathBuf,
    options: LoadOptions,
    /// True if the level in memory was named, and is shown alone unless memory for finer ones was asked for.
    pub(crate) is_named: bool,
}

impl LevelFile {
    /// Returns a reader of the levels that are finer than a dataset, whose blocks take at most `cache_bytes`; `None` if there
    /// are none, or they cannot be shown.
    pub(crate) fn pages(&self, dataset: &Dataset, cache_bytes: u64) -> Option<FilePages> {
        FilePages::new(&self.path, &self.options, dataset, cache_bytes).ok()
    }
}

/// Facts about an array that its voxels do not say.
#[derive(Debug, FromPyObject)]
pub(crate) struct ArrayFacts {
    /// Name of the volume.
    #[pyo3(item)]
    name: String,
    /// Number of voxels along z, y, x.
    #[pyo3(item)]
    shape: [usize; 3],
    /// Affine map from voxel indices x, y, z to millimetres: three rows of four numbers.
    #[pyo3(item)]
    world_from_index: [[f64; 4]; 3],
    /// Length of the unit that lengths are shown in, in mm; `None` if the size of voxels is unknown.
    #[pyo3(item)]
    unit_mm: Option<f64>,
    /// True if world space is right-anterior-superior.
    #[pyo3(item)]
    is_anatomical: bool,
    /// True if values are numbers of objects.
    #[pyo3(item)]
    are_labels: bool,
    /// Unit of the values, such as `HU`.
    #[pyo3(item)]
    value_unit: Option<String>,
}

impl ArrayFacts {
    /// Creates a volume of the voxels.
    fn volume(self, samples: Samples) -> PyResult<Volume> {
        let rows = self.world_from_index;
        let column = |c: usize| DVec3::new(rows[0][c], rows[1][c], rows[2][c]);
        let world_from_index =
            DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) };
        let [z, y, x] = self.shape;
        let volume = Volume::new(self.name, [x, y, z], world_from_index, samples)
            .map_err(|err| errors::from_volume(&err))?;
        let mut metadata = ValueMetadata::default();
        if let Some(unit) = &self.value_unit {
            metadata.set_unit(unit);
        }
        if self.are_labels {
            metadata.meaning = ValueMeaning::Labels;
        }
        let volume = volume.with_metadata(metadata).with_anatomical_axes(self.is_anatomical);
        Ok(match self.unit_mm {
            Some(mm) => volume.with_length_unit(mm),
            None => volume.with_unknown_scale(),
        })
    }
}

/// Part of a file that is read.
#[derive(Debug, FromPyObject)]
pub(crate) struct FileSelection {
    /// Edge of blocks that are averaged, in voxels.
    #[pyo3(item)]
    reduce: Option<usize>,
    /// Channel, counted from 0.
    #[pyo3(item)]
    channel: Option<usize>,
    /// Time step, counted from 0.
    #[pyo3(item)]
    frame: Option<usize>,
    /// Component of vectors or colours, counted from 0.
    #[pyo3(item)]
    component: Option<usize>,
    /// Series of a folder, by number or name.
    #[pyo3(item)]
    series: Option<String>,
    /// Array of a file with several.
    #[pyo3(item)]
    array: Option<String>,
    /// Resolution level, by number from 0, the finest, or by name.
    #[pyo3(item)]
    level: Option<String>,
}

impl FileSelection {
    /// Converts the selection to the readers' options.
    fn load_options(self) -> LoadOptions {
        let Self { reduce, channel, frame, component, series, array, level } = self;
        let rule = match level {
            Some(_) => LevelRule::Finest,
            None => LevelRule::BesidePages(LevelRule::CARD_VOXELS),
        };
        let portion = reduce.map(|block| Portion { region: None, thinning: Downsampling::Average(block) });
        let choice = VolumeChoice {
            channel,
            frame,
            component,
            series,
            array,
            level,
            portion,
            ..VolumeChoice::default()
        };
        LoadOptions { choice, level: rule, ..LoadOptions::default() }
    }
}

impl NativeVolume {
    /// Creates a volume without finer levels.
    fn from_dataset(dataset: Dataset) -> Self {
        Self { dataset, file: None }
    }
}

#[pymethods]
impl NativeVolume {
    /// Reads a file or a folder, or makes a built-in volume.
    #[staticmethod]
    fn open(py: Python<'_>, source: PathBuf, selection: FileSelection) -> PyResult<Self> {
        let options = selection.load_options();
        let dataset = interruptible(py, || open(&source, &options, &LoadControl::new()).map(Dataset::new))?
            .map_err(|err| errors::from_load(&err))?;
        let is_named = options.choice.level.is_some();
        Ok(Self { dataset, file: Some(LevelFile { path: source, options, is_named }) })
    }

    /// Creates a volume of the voxels in a buffer.
    #[staticmethod]
    fn from_voxels(py: Python<'_>, voxels: &VoxelBuffer, facts: ArrayFacts) -> PyResult<Self> {
        let samples = voxels.take()?;
        interruptible(py, || facts.volume(samples).map(Dataset::new))?.map(Self::from_dataset)
    }

    /// Returns this volume with the first field of another shown over it.
    fn with_field(&self, py: Python<'_>, other: &Self) -> PyResult<Self> {
        let source = other.dataset.volume().name().to_owned();
        interruptible(py, || self.dataset.with_field(other.dataset.volume(), source))?
            .map(Self::from_dataset)
            .map_err(errors::from_field)
    }

    /// Returns this volume without the table under a body, and true if there was one. Material is what the first look
    /// shows.
    fn without_table(&self, py: Python<'_>) -> PyResult<(Self, bool)> {
        let dataset = interruptible(py, || {
            let volume = self.dataset.volume();
            let threshold =
                first_look::first_settings(volume, self.dataset.histogram()).material_threshold(volume);
            self.dataset.corrected(&Corrections { hidden_table: Some(threshold), ..*volume.corrections() })
        })?
        .map_err(|err| errors::from_volume(&err))?;
        let is_found = !dataset.volume().lacks_table();
        Ok((Self::from_dataset(dataset), is_found))
    }

    /// Name of the volume: that of its file or of the built-in volume.
    #[getter]
    fn name(&self) -> &str {
        self.dataset.volume().name()
    }

    /// Number of voxels along z, y, x.
    #[getter]
    fn shape(&self) -> (usize, usize, usize) {
        let [x, y, z] = self.dataset.volume().dims();
        (z, y, x)
    }

    /// Number type of the voxels: `uint8`, … `float64`.
    #[getter]
    fn dtype(&self) -> &'static str {
        self.dataset.volume().samples().voxel_type().name()
    }

    /// Distance between voxels along z, y, x in millimetres; in voxels if it is unknown.
    #[getter]
    fn spacing_mm(&self) -> (f64, f64, f64) {
        let spacing = self.dataset.volume().spacing_mm();
        (spacing.z, spacing.y, spacing.x)
    }

    /// True if the size of voxels is unknown.
    #[getter]
    fn has_unknown_scale(&self) -> bool {
        self.dataset.volume().has_unknown_scale()
    }

    /// Affine map from voxel indices x, y, z to millimetres: three rows of four numbers.
    #[getter]
    fn world_from_index(&self) -> [[f64; 4]; 3] {
        let affine = self.dataset.volume().world_from_index();
        let columns = [affine.x_axis, affine.y_axis, affine.z_axis, affine.translation];
        std::array::from_fn(|row| columns.map(|column| column[row]))
    }

    /// Smallest and largest finite value.
    #[getter]
    fn value_range(&self) -> (f64, f64) {
        let range = self.dataset.volume().value_range();
        (range.low, range.high)
    }

    /// Kind of data that was detected: `ct`, `scalar`, `labels`, ….
    #[getter]
    fn kind(&self) -> &'static str {
        self.dataset.volume().kind().kind.name().key()
    }

    /// Number of fields that are shown together.
    #[getter]
    fn field_count(&self) -> usize {
        self.dataset.fields().len()
    }

    /// Remarks about how the file was read.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.dataset.volume().remarks().to_vec()
    }

    /// Writes the voxels of the first field to a file, whose format is that of the name's ending.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let format = VolumeFormat::from_path(&path).ok_or_else(|| {
            let found = path.display();
            ExceptionClass::InvalidArgument
                .error(format!("path: expected a name such as volume.nrrd, .nii.gz or .tif, found {found}"))
        })?;
        let volume = ExportVolume::new(self.dataset.volume());
        interruptible(py, || write_volume(&path, format, &volume, false))?
            .map_err(|err| ExceptionClass::Error.error(err.to_string()))
    }

    /// Copies the voxels, as one row in C order.
    fn voxels<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        fn row<'py, T: numpy::Element + Copy>(py: Python<'py>, values: &[T]) -> Bound<'py, PyAny> {
            let array: Bound<'py, PyArray1<T>> = values.to_vec().into_pyarray(py);
            array.into_any()
        }
        with_samples!(self.dataset.volume().samples(), values => row(py, values))
    }
}
