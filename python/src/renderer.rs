//! Renderer as a Python object: one graphics device, and what it keeps between pictures.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use chiaroscuro_media::PixelRows;
use chiaroscuro_render::plan::{PagedView, RenderRequest, probe_layers};
use chiaroscuro_render::{
    BandError, GpuContext, GpuError, PartPages, RenderOptions, Renderer, WorkOptions, complete_first_look,
    downsample_to_fit,
};
use chiaroscuro_scene::{
    ImageSpec, LightStorage, MAX_IMAGE_EDGE, MAX_SAMPLES_PER_EDGE, PixelFormat, Settings,
};
use chiaroscuro_volume::{CancelToken, Dataset, PageCache, VolumeId};
use numpy::{IntoPyArray as _, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{self, ExceptionClass};
use crate::interruptible::interruptible;
use crate::look::NativeLook;
use crate::volume::{LevelFile, NativeVolume};

/// Size of the picture with which a light volume is filled, in pixels; the light volume does not depend on it.
const LIGHT_VOLUME_PICTURE: [u32; 2] = [16, 16];

/// Renderer with the volume that the device can hold.
#[derive(Debug)]
struct OpenRenderer {
    renderer: Renderer,
    /// Last volume, with what is drawn of it: itself, or a smaller one if the device cannot hold it.
    fitted: Option<(VolumeId, Dataset)>,
    /// Memory for pages of finer levels, in bytes; `None` for the default, which does not show those of a named level.
    page_bytes: Option<u64>,
    /// Pages that pictures of the last volume have read.
    pages: Option<(VolumeId, PageCache)>,
}

/// Renderer on a graphics device. Calls from several threads wait for each other.
#[pyclass(frozen, module = "chiaroscuro._native")]
#[derive(Debug)]
pub(crate) struct NativeRenderer {
    /// Open renderer; `None` after it was closed.
    open: Mutex<Option<Box<OpenRenderer>>>,
    adapter: String,
}

impl OpenRenderer {
    /// Returns the volume, or a smaller one if the device cannot hold it.
    fn fitting(&mut self, dataset: &Dataset) -> Result<Dataset, GpuError> {
        let id = dataset.id();
        if let Some((known, fitted)) = &self.fitted
            && *known == id
        {
            return Ok(fitted.clone());
        }
        let whole = dataset.volume();
        let volume = downsample_to_fit(self.renderer.context(), Clone::clone(&**whole))?;
        let mut fitted = dataset.clone();
        if volume.dims() != whole.dims() {
            fitted = Dataset::new(volume);
            for field in &dataset.fields()[1..] {
                let source = field.origin().map(|origin| origin.source.clone()).unwrap_or_default();
                // Fields that meet on the whole grid meet on a coarser one, too.
                if let Ok(more) = fitted.with_field(field.volume(), source) {
                    fitted = more;
                }
            }
        }
        self.fitted = Some((id, fitted.clone()));
        Ok(fitted)
    }

    /// Draws a picture in bands; what it shows of finer levels is read for one part after another.
    fn draw(
        &mut self,
        volume: &NativeVolume,
        settings: &Settings,
        spec: &ImageSpec,
    ) -> Result<PixelRows, BandError> {
        let fitted = self.fitting(&volume.dataset)?;
        let mapping = settings.shown_content(&fitted.volume().ranges());
        let dataset = fitted.with_density_mapping(mapping);
        let is_whole = fitted.id() == volume.dataset.id();
        let file = volume.file.as_ref().filter(|_| is_whole && settings.sampling.finer_levels);
        let mut cache = file.and_then(|file| self.take_pages(file, &dataset));
        let shows_finer = cache.as_ref().is_some_and(|cache| {
            let size = spec.size.map(|n| n * spec.samples);
            PagedView::new(cache.resident().levels(), settings, &dataset.volume().scene(), size).is_some()
        });
        let token = CancelToken::current();
        let parts = cache.as_mut().filter(|_| shows_finer);
        let parts = parts.map(|cache| PartPages::new(cache, |_| !token.is_cancelled()));
        let rows = self.renderer.bands(&dataset, settings, spec).with_pages(parts).all();
        if let Some(cache) = cache {
            self.pages = Some((dataset.id(), cache));
        }
        rows
    }

    /// Returns the pages of a volume that earlier pictures have read, or an empty cache; `None` if its finer levels are not
    /// shown.
    fn take_pages(&mut self, file: &LevelFile, dataset: &Dataset) -> Option<PageCache> {
        if file.is_named && self.page_bytes.is_none() {
            return None;
        }
        let id = dataset.id();
        let known = self.pages.take().filter(|(known, _)| *known == id);
        known.map(|(_, cache)| cache).or_else(|| {
            let bytes = self.page_bytes.unwrap_or_else(PageCache::default_bytes);
            Some(dataset.page_cache(Arc::new(file.pages(dataset, bytes)?), bytes))
        })
    }
}

/// Picture that Python asks for.
#[derive(Debug, FromPyObject)]
pub(crate) struct PictureRequest {
    /// Width and height in pixels.
    #[pyo3(item)]
    size: (u32, u32),
    /// Samples along the edge of a pixel.
    #[pyo3(item)]
    samples: u32,
    /// True if the background is left out.
    #[pyo3(item)]
    is_transparent: bool,
    /// True for linear light, false for bytes in sRGB.
    #[pyo3(item)]
    is_linear: bool,
}

impl PictureRequest {
    /// Returns the specification of the picture.
    fn image_spec(&self) -> PyResult<ImageSpec> {
        let (size, samples) = (check_size(self.size)?, self.samples);
        if !(1..=MAX_SAMPLES_PER_EDGE).contains(&samples) {
            return Err(ExceptionClass::InvalidArgument.error(format!(
                "samples: expected 1 to {MAX_SAMPLES_PER_EDGE} samples along the edge of a pixel, found {samples}"
            )));
        }
        let depth = if self.is_linear { PixelFormat::Linear } else { PixelFormat::Eight };
        Ok(ImageSpec { samples, transparent: self.is_transparent, depth, ..ImageSpec::new(size) })
    }
}

/// Checks width and height of a picture.
fn check_size((width, height): (u32, u32)) -> PyResult<[u32; 2]> {
    let edges = 1..=MAX_IMAGE_EDGE;
    if !edges.contains(&width) || !edges.contains(&height) {
        return Err(ExceptionClass::InvalidArgument.error(format!(
            "size: expected (width, height) of 1 to {MAX_IMAGE_EDGE} pixels, found ({width}, {height})"
        )));
    }
    Ok([width, height])
}

impl NativeRenderer {
    /// Runs work with the renderer, without the interpreter's lock.
    fn with_renderer<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut OpenRenderer) -> Result<T, GpuError> + Send,
    ) -> PyResult<T> {
        let done = interruptible(py, || self.lock().as_mut().map(|open| work(open)))?;
        let done =
            done.ok_or_else(|| ExceptionClass::Error.error("the renderer is closed; make a new one"))?;
        done.map_err(|err| errors::from_gpu(&err))
    }

    fn lock(&self) -> MutexGuard<'_, Option<Box<OpenRenderer>>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl NativeRenderer {
    /// Opens an adapter, counted from the fastest, which is 0. Pages of finer levels take at most `page_bytes` of memory.
    #[new]
    fn new(py: Python<'_>, adapter: usize, page_bytes: Option<u64>) -> PyResult<Self> {
        let opened = interruptible(py, || {
            let context = GpuContext::headless_on(adapter)?;
            let renderer = Renderer::new(&context)?;
            let open = OpenRenderer { renderer, fitted: None, page_bytes, pages: None };
            Ok((Box::new(open), context.description()))
        })?;
        let (open, adapter) = opened.map_err(|err| errors::from_gpu(&err))?;
        Ok(Self { open: Mutex::new(Some(open)), adapter })
    }

    /// Name and driver of the adapter.
    #[getter]
    fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Frees the device and everything on it.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        interruptible(py, || drop(self.lock().take()))
    }

    /// Returns the look with its lights, floor and brightness found, as far as they are undecided.
    fn finish_look(&self, py: Python<'_>, volume: &NativeVolume, look: &NativeLook) -> PyResult<NativeLook> {
        let settings = self.with_renderer(py, |open| {
            let dataset = open.fitting(&volume.dataset)?;
            complete_first_look(&mut open.renderer, &dataset, &look.settings, &look.undecided)
        })?;
        Ok(NativeLook { settings, undecided: Vec::new() })
    }

    /// Draws a picture and returns it row by row from the top left, as an array of (height, width, 4) `uint8` in sRGB,
    /// or `float32` of linear light.
    fn render<'py>(
        &self,
        py: Python<'py>,
        volume: &NativeVolume,
        look: &NativeLook,
        request: PictureRequest,
    ) -> PyResult<Bound<'py, PyAny>> {
        let spec = request.image_spec()?;
        let rows = self.with_renderer(py, |open| Ok(open.draw(volume, &look.settings, &spec)))?;
        let rows = rows.map_err(|err| errors::from_band(&err))?;
        let [width, height] = spec.size.map(|edge| edge as usize);
        let shape = [height, width, 4];
        Ok(match rows {
            PixelRows::Bytes(bytes) => bytes.into_pyarray(py).reshape(shape)?.into_any(),
            PixelRows::Floats(floats) => floats.into_pyarray(py).reshape(shape)?.into_any(),
        })
    }

    /// Returns the share of a light that reaches each voxel of its light volume, as an array of (z, y, x) `float32`.
    fn light_volume<'py>(
        &self,
        py: Python<'py>,
        volume: &NativeVolume,
        look: &NativeLook,
        light: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut settings = look.settings.clone();
        let lights = settings.lights.len();
        // In a combined volume, this light could not be separated.
        settings.shadows.storage = LightStorage::PerLight;
        let options =
            RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() });
        let found = self.with_renderer(py, |open| {
            let dataset = open.fitting(&volume.dataset)?;
            open.renderer.draw(&dataset, &settings, LIGHT_VOLUME_PICTURE, &options)?;
            let request = RenderRequest {
                volume: dataset.id(),
                settings,
                size: LIGHT_VOLUME_PICTURE,
                preview_resolution: None,
            };
            open.renderer.attenuation(&request, light)
        })?;
        let found = found.ok_or_else(|| {
            ExceptionClass::InvalidArgument.error(format!(
                "light: light {light} has no light volume; expected one of the {lights} lights, counted from 0, that \
                 is on and casts shadows, with shadows on"
            ))
        })?;
        let [x, y, z] = found.dims;
        Ok(found.values.into_pyarray(py).reshape([z, y, x])?.into_any())
    }

    /// Returns facts about the material that is first seen at a pixel, or `None` if there is none.
    #[staticmethod]
    fn pick<'py>(
        py: Python<'py>,
        volume: &NativeVolume,
        look: &NativeLook,
        pixel: (f64, f64),
        size: (u32, u32),
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let settings: &Settings = &look.settings;
        let [width, height] = check_size(size)?.map(f64::from);
        // Pixels are numbered; the ray goes through the middle of one.
        let (origin, direction) = settings.camera.ray_through(pixel.0 + 0.5, pixel.1 + 0.5, width, height);
        let found = interruptible(py, || probe_layers(&volume.dataset, settings, origin, direction))?;
        let Some(found) = found else { return Ok(None) };
        let facts = PyDict::new(py);
        facts.set_item("value", found.value)?;
        facts.set_item("opacity", found.opacity)?;
        facts.set_item("layer", found.layer)?;
        facts.set_item("index", (found.index.z, found.index.y, found.index.x))?;
        facts.set_item("position_mm", (found.world_mm.z, found.world_mm.y, found.world_mm.x))?;
        let lights = found.lights.iter().map(|light| light.transmittance * light.hood).collect::<Vec<_>>();
        facts.set_item("lights", lights)?;
        facts.set_item("sky", found.sky)?;
        Ok(Some(facts))
    }

    /// Returns times, counts and memory of the pictures so far.
    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (report, light_rebuilds) = self.with_renderer(py, |open| {
            Ok((open.renderer.report().clone(), open.renderer.light_rebuilds().to_vec()))
        })?;
        let facts = PyDict::new(py);
        facts.set_item("light_volumes_filled", light_rebuilds)?;
        facts.set_item("peak_gpu_bytes", report.peak_gpu_bytes)?;
        facts.set_item(
            "light_ms",
            report.light_march_ms + report.light_backproject_ms + report.light_raycast_ms,
        )?;
        facts.set_item("sky_ms", report.sky_ms)?;
        facts.set_item("eye_ms", report.eye_ms)?;
        facts.set_item("readback_ms", report.readback_ms)?;
        Ok(facts)
    }
}
