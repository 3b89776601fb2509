//! Shader library: joins embedded sources by `#import "path"` (each file once) and makes pipelines of them.

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use super::binding::{BindingGroup, BindingSlot, ShaderPipeline, ring_format};
use super::layouts::layouts;
use super::pipeline_cache::PipelineCache;
use super::pipeline_variant::PipelineVariant;
use super::preprocessor::{override_constants, preprocess, value_in_shader};
use super::shader_files::SHADERS;
use crate::context::{COMPILER_ADDRESS_BYTES, check_address_space};
use crate::{GpuContext, GpuError};
use chiaroscuro_files::{
    WriteError,
    fault::{self, InjectedFault},
};

/// Cache of compute pipelines; joins the sources and compiles each variant once.
#[derive(Debug, Clone)]
pub struct ShaderLibrary {
    pub(crate) context: GpuContext,
    /// Text replacement in the joined sources; see [`Self::with_mutation`].
    mutation: Option<Arc<ShaderMutation>>,
    pipelines: Arc<Mutex<HashMap<PipelineKey, PipelineSlot>>>,
    /// Bind-group layouts, by the address of their slots and the format of targets.
    groups: Arc<Mutex<HashMap<LayoutKey, BindingGroup>>>,
    cache: Option<PipelineCache>,
    /// Time that callers have waited for compilations, in microseconds.
    wait_us: Arc<AtomicU64>,
}

/// Text replacement in joined sources.
#[derive(Debug)]
struct ShaderMutation {
    from: String,
    to: String,
    /// Library of the sources that do not contain the text.
    intact: ShaderLibrary,
}

/// Place of a pipeline, locked while it is compiled.
type PipelineSlot = Arc<Mutex<Option<ShaderPipeline>>>;

impl ShaderLibrary {
    /// Creates an empty library for a device.
    pub fn new(context: &GpuContext) -> Self {
        Self {
            context: context.clone(),
            mutation: None,
            pipelines: Arc::default(),
            groups: Arc::default(),
            cache: None,
            wait_us: Arc::default(),
        }
    }

    /// Creates a library that caches the driver's compiled shaders in a folder, where the backend can.
    #[must_use]
    pub fn with_cache(context: &GpuContext, folder: &Path) -> Self {
        Self { cache: PipelineCache::open(context, folder), ..Self::new(context) }
    }

    /// Returns the device whose pipelines these are.
    pub fn context(&self) -> &GpuContext {
        &self.context
    }

    /// Writes the pipeline cache to its file, for the next start.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn save_cache(&self) -> Result<(), WriteError> {
        self.cache.as_ref().map_or(Ok(()), PipelineCache::save)
    }

    /// Returns a library that replaces `from` by `to` in every shader that contains it. Tests use it to prove that they
    /// detect a wrong shader.
    #[cfg(feature = "testing")]
    #[must_use]
    pub fn with_mutation(&self, from: &str, to: &str) -> Self {
        let mutation = ShaderMutation { from: from.to_owned(), to: to.to_owned(), intact: self.clone() };
        Self { mutation: Some(Arc::new(mutation)), ..Self::new(&self.context) }
    }

    /// Returns the library for 32-bit storage where the adapter can filter it; pipelines are shared.
    #[cfg(feature = "testing")]
    #[must_use]
    pub fn with_full_precision(&self) -> Self {
        Self { context: self.context.clone().with_full_precision(), ..self.clone() }
    }

    /// Returns a shader with all imports and all its conditional parts, for storage textures of `format` and targets
    /// of `target`.
    ///
    /// # Errors
    /// Returns an error if a file is missing.
    pub fn source(
        name: &str,
        format: wgpu::TextureFormat,
        target: wgpu::TextureFormat,
    ) -> Result<String, GpuError> {
        // Larger than any bound in a condition, so that all parts are included.
        Self::preprocessed_source(name, format, target, &|_| f64::INFINITY)
    }

    /// Returns a shader with those conditional parts (`preprocessor.rs`) whose conditions hold; `value` gives the
    /// number of each name.
    ///
    /// # Errors
    /// Returns an error if a file is missing, or a condition is malformed or not declared.
    pub fn preprocessed_source(
        name: &str,
        format: wgpu::TextureFormat,
        target: wgpu::TextureFormat,
        value: &dyn Fn(&str) -> f64,
    ) -> Result<String, GpuError> {
        let mut joined = String::new();
        resolve_imports(name, &mut Vec::new(), &mut joined)?;
        let joined = preprocess(&joined, &|condition| value_in_shader(name, condition, value))?;
        let wgsl = |format| match format {
            wgpu::TextureFormat::R32Float => "r32float",
            wgpu::TextureFormat::R8Unorm => "r8unorm",
            wgpu::TextureFormat::Rgba8Unorm => "rgba8unorm",
            wgpu::TextureFormat::Rgba16Float => "rgba16float",
            wgpu::TextureFormat::Rgba32Float => "rgba32float",
            wgpu::TextureFormat::Rg16Float => "rg16float",
            wgpu::TextureFormat::Rg32Float => "rg32float",
            _ => "r16float",
        };
        Ok(joined
            .replace("STORAGE_FORMAT", wgsl(format))
            .replace("TARGET_FORMAT", wgsl(target))
            .replace("RING_FORMAT", wgsl(ring_format(format))))
    }

    /// Returns the pipeline of a variant, compiled on first use.
    ///
    /// # Errors
    /// Returns an error if the shader is invalid.
    pub(crate) fn pipeline(&self, variant: &impl PipelineVariant) -> Result<ShaderPipeline, GpuError> {
        self.pipeline_into(variant, self.context.storage_format)
    }

    /// Returns the pipeline of a variant that writes into textures of the format `target`.
    ///
    /// # Errors
    /// Same as [`Self::pipeline`].
    pub(crate) fn pipeline_into(
        &self,
        variant: &impl PipelineVariant,
        target: wgpu::TextureFormat,
    ) -> Result<ShaderPipeline, GpuError> {
        let begun = Instant::now();
        let found =
            self.known_or_compiled(&PipelineKey::new(variant, self.context.storage_format, target))?;
        self.wait_us.fetch_add(begun.elapsed().as_micros() as u64, Ordering::Relaxed);
        Ok(found)
    }

    fn known_or_compiled(&self, key: &PipelineKey) -> Result<ShaderPipeline, GpuError> {
        let slot = self.slot(key);
        // Only this pipeline is locked: the window must not wait for variants that another thread makes.
        let mut pipeline = lock(&slot);
        match &*pipeline {
            Some(known) => Ok(known.clone()),
            None => Ok(pipeline.insert(self.compile(key)?).clone()),
        }
    }

    /// Starts to compile a variant on another thread, so that it is ready or nearly so when [`Self::pipeline`] asks for
    /// it; `None` if it is known or being compiled. Errors are left to that call.
    pub(crate) fn prepare(&self, variant: &impl PipelineVariant) -> Option<PipelinePreparation> {
        let format = self.context.storage_format;
        let key = PipelineKey::new(variant, format, format);
        let slot = self.slot(&key);
        if slot.try_lock().map_or(true, |pipeline| pipeline.is_some()) {
            return None;
        }
        let library = self.clone();
        let compile = move || {
            let mut pipeline = lock(&slot);
            if pipeline.is_none() {
                *pipeline = library.compile(&key).ok();
            }
        };
        let thread = std::thread::Builder::new().name("pipeline".to_owned()).spawn(compile).ok()?;
        Some(PipelinePreparation(Some(thread)))
    }

    /// Returns the time that callers have waited for compilations so far, in milliseconds: for parsing and checking
    /// sources, for translation for the driver and, as far as it compiles at once, for the driver.
    pub fn compile_ms(&self) -> f64 {
        self.wait_us.load(Ordering::Relaxed) as f64 / 1000.0
    }

    /// Returns the number of pipelines made so far.
    pub fn pipeline_count(&self) -> usize {
        let is_made = |slot: &&PipelineSlot| slot.try_lock().is_ok_and(|pipeline| pipeline.is_some());
        lock(&self.pipelines).values().filter(is_made).count()
    }

    /// Returns the place of a pipeline, empty if it is new.
    fn slot(&self, key: &PipelineKey) -> PipelineSlot {
        let mut pipelines = lock(&self.pipelines);
        match pipelines.get(key) {
            Some(known) => Arc::clone(known),
            None => Arc::clone(pipelines.entry(key.clone()).or_default()),
        }
    }

    /// Returns the bind groups of a shader; equal ones share one layout.
    fn bind_groups(
        &self,
        shader: &str,
        target: wgpu::TextureFormat,
    ) -> Result<Arc<[BindingGroup]>, GpuError> {
        let declared = layouts().find(|(known, _)| *known == shader);
        let (_, groups) =
            declared.ok_or_else(|| GpuError::Internal(format!("there is no layout for {shader}")))?;
        let mut known = lock(&self.groups);
        let group = |slots: &&'static [BindingSlot]| {
            let fresh = || BindingGroup::new(&self.context, slots, target);
            known.entry((slots, target)).or_insert_with(fresh).clone()
        };
        Ok(groups.iter().map(group).collect())
    }

    fn compile(&self, key: &PipelineKey) -> Result<ShaderPipeline, GpuError> {
        let &PipelineKey { shader, ref constants, storage, target } = key;
        let constants: Vec<_> = constants.iter().map(|(name, bits)| (*name, f64::from_bits(*bits))).collect();
        // Mesa's compiler does not check its allocations and crashes the process when one fails.
        if self.context.is_software() {
            check_address_space(&format!("the pipeline of {shader}"), COMPILER_ADDRESS_BYTES)?;
        }
        let value = |wanted: &str| {
            constants.iter().find(|(name, _)| *name == wanted).map_or(0.0, |(_, value)| *value)
        };
        let mut source = Self::preprocessed_source(shader, storage, target, &value)?;
        let overrides = override_constants(&constants)?;
        if let Some(mutation) = &self.mutation {
            if !source.contains(&mutation.from) {
                return mutation.intact.known_or_compiled(key);
            }
            source = source.replace(&mutation.from, &mutation.to);
        }
        if fault::is_on(InjectedFault::Shader) {
            source.push_str("a fault was injected");
        }
        let groups = self.bind_groups(shader, target)?;
        let device = &self.context.device;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(shader),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layouts: Vec<_> = groups.iter().map(|group| Some(&group.layout)).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(shader),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        let raw = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&format!("{shader} {constants:?} {target:?}")),
            layout: Some(&layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &overrides,
                zero_initialize_workgroup_memory: false,
            },
            cache: self.cache.as_ref().map(|known| &known.cache),
        });
        match pollster::block_on(scope.pop()) {
            Some(err) => Err(GpuError::Internal(format!("{shader}: {err}"))),
            None => Ok(ShaderPipeline { raw, groups }),
        }
    }
}

/// Key of a bind-group layout: address of the declared slots, and format of targets.
type LayoutKey = (&'static [BindingSlot], wgpu::TextureFormat);

/// Key of a pipeline: shader, constants in a canonical order, and formats of storage and of the targets that it writes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct PipelineKey {
    shader: &'static str,
    /// Names and the bits of their values, sorted by name.
    constants: Vec<(&'static str, u64)>,
    storage: wgpu::TextureFormat,
    target: wgpu::TextureFormat,
}

impl PipelineKey {
    fn new(
        variant: &impl PipelineVariant,
        storage: wgpu::TextureFormat,
        target: wgpu::TextureFormat,
    ) -> Self {
        let mut constants: Vec<_> =
            variant.constants().into_iter().map(|(name, value)| (name, value.to_bits())).collect();
        constants.sort_unstable();
        Self { shader: variant.shader(), constants, storage, target }
    }
}

/// Compilation of a pipeline on another thread; dropping it waits for that thread, since drivers crash where a program
/// ends while they compile.
#[derive(Debug)]
pub(crate) struct PipelinePreparation(Option<std::thread::JoinHandle<()>>);

impl Drop for PipelinePreparation {
    fn drop(&mut self) {
        // A panic is repeated by the thread that needs the pipeline.
        let _ = self.0.take().map(std::thread::JoinHandle::join);
    }
}

/// Locks what a thread that panicked has not left half done.
pub(super) fn lock<T>(shared: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

fn resolve_imports(name: &str, seen: &mut Vec<String>, joined: &mut String) -> Result<(), GpuError> {
    if seen.iter().any(|known| known == name) {
        return Ok(());
    }
    seen.push(name.to_owned());
    let (_, text) = SHADERS
        .iter()
        .find(|(known, _)| *known == name)
        .ok_or_else(|| GpuError::Internal(format!("there is no shader file {name}")))?;
    for line in text.lines() {
        if let Some(import) = line.strip_prefix("#import \"").and_then(|rest| rest.strip_suffix('"')) {
            resolve_imports(import, seen, joined)?;
        } else {
            joined.push_str(line);
            joined.push('\n');
        }
    }
    Ok(())
}
