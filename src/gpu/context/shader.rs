//! Shader sources: embedded, joined by `#import "path"` (each file once), turned into pipelines.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use super::pipeline_cache::PipelineCache;
use super::shader_files::SHADERS;
use crate::export::ExportError;
use crate::gpu::{Context, GpuError};

/// The format of the ring of sheets where single channels are stored in `format`.
pub(crate) fn ring_format(format: wgpu::TextureFormat) -> wgpu::TextureFormat {
    match format {
        wgpu::TextureFormat::R32Float => wgpu::TextureFormat::Rgba32Float,
        _ => wgpu::TextureFormat::Rgba16Float,
    }
}

/// Joins sources and makes pipelines, each once.
#[derive(Debug, Clone)]
pub struct ShaderLibrary {
    pub(crate) context: Context,
    /// Replacements in the joined source; see [`Self::with_mutation`].
    mutation: Option<(String, String)>,
    pipelines: Arc<Mutex<HashMap<String, wgpu::ComputePipeline>>>,
    cache: Option<PipelineCache>,
}

impl ShaderLibrary {
    /// An empty library for a device.
    pub fn new(context: &Context) -> Self {
        Self { context: context.clone(), mutation: None, pipelines: Arc::default(), cache: None }
    }

    /// A library that keeps what the driver makes of its shaders in a folder, where the backend can.
    #[must_use]
    pub fn with_cache(context: &Context, folder: &Path) -> Self {
        Self { cache: PipelineCache::open(context, folder), ..Self::new(context) }
    }

    /// Writes what is to be found by the next start.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save_cache(&self) -> Result<(), ExportError> {
        self.cache.as_ref().map_or(Ok(()), PipelineCache::save)
    }

    /// A library that replaces a text in every shader that has it. Tests use it to prove that they
    /// notice a wrong shader.
    #[cfg(feature = "testing")]
    #[must_use]
    pub fn with_mutation(context: &Context, from: &str, to: &str) -> Self {
        Self { mutation: Some((from.to_owned(), to.to_owned())), ..Self::new(context) }
    }

    /// A shader with everything that it imports, for storage textures of `format`, and light volumes of
    /// `attenuation`.
    ///
    /// # Errors
    /// When a file is not there.
    pub fn source(
        name: &str,
        format: wgpu::TextureFormat,
        attenuation: wgpu::TextureFormat,
    ) -> Result<String, GpuError> {
        let mut joined = String::new();
        join(name, &mut Vec::new(), &mut joined)?;
        let wgsl = |format| match format {
            wgpu::TextureFormat::R32Float => "r32float",
            wgpu::TextureFormat::R8Unorm => "r8unorm",
            _ => "r16float",
        };
        let ring = match ring_format(format) {
            wgpu::TextureFormat::Rgba32Float => "rgba32float",
            _ => "rgba16float",
        };
        Ok(joined
            .replace("STORAGE_FORMAT", wgsl(format))
            .replace("ATTENUATION_FORMAT", wgsl(attenuation))
            .replace("RING_FORMAT", ring))
    }

    /// The pipeline of a shader with these override constants, made on first use.
    ///
    /// # Errors
    /// When the shader is not there or the driver refuses it.
    pub fn pipeline(&self, name: &str, constants: &[(&str, f64)]) -> Result<wgpu::ComputePipeline, GpuError> {
        self.pipeline_into(name, constants, self.context.storage_format)
    }

    /// The same for a shader that writes a light volume of some format.
    ///
    /// # Errors
    /// As [`Self::pipeline`].
    pub fn pipeline_into(
        &self,
        name: &str,
        constants: &[(&str, f64)],
        attenuation: wgpu::TextureFormat,
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        let key = format!("{name} {constants:?} {attenuation:?}");
        let pipelines = || self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines().get(&key) {
            return Ok(pipeline.clone());
        }
        // Not locked meanwhile: a window must not wait for the variants that another thread makes.
        let mut source = Self::source(name, self.context.storage_format, attenuation)?;
        if let Some((from, to)) = &self.mutation {
            source = source.replace(from, to);
        }
        let device = &self.context.device;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&key),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                zero_initialize_workgroup_memory: false,
            },
            cache: self.cache.as_ref().map(|known| &known.cache),
        });
        if let Some(err) = pollster::block_on(scope.pop()) {
            return Err(GpuError::Refused(format!("{name}: {err}")));
        }
        pipelines().insert(key, pipeline.clone());
        Ok(pipeline)
    }
}

fn join(name: &str, seen: &mut Vec<String>, joined: &mut String) -> Result<(), GpuError> {
    if seen.iter().any(|known| known == name) {
        return Ok(());
    }
    seen.push(name.to_owned());
    let (_, text) = SHADERS
        .iter()
        .find(|(known, _)| *known == name)
        .ok_or_else(|| GpuError::Refused(format!("there is no shader file {name}")))?;
    for line in text.lines() {
        if let Some(import) = line.strip_prefix("#import \"").and_then(|rest| rest.strip_suffix('"')) {
            join(import, seen, joined)?;
        } else {
            joined.push_str(line);
            joined.push('\n');
        }
    }
    Ok(())
}
