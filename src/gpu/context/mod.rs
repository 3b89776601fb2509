//! The device, what it can do, and what it complains about.

mod adapters;
mod addresses;
pub(super) mod clock;
mod complaints;
pub(super) mod error;
mod formats;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

pub(crate) use self::addresses::check_room_for_drivers;
pub(super) use self::addresses::{OF_THE_COMPILER, check_room};
use self::clock::Clock;
use self::complaints::Complaints;
pub(super) use self::formats::pair_format;
use super::GpuError;
use crate::data::plain;
use crate::fault::{self, Count, Fault};

/// Said when there is no adapter.
const ADAPTER_HELP: &str =
    "install a Vulkan driver (on Debian: mesa-vulkan-drivers, which also brings a software one)";

/// Said when a device has fewer features than its adapter, and too few.
const OPENING_HELP: &str = "open the device with the features of chiaroscuro::gpu::device_descriptor";

/// A device with its queue and what we need to know about it. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Context {
    adapter: wgpu::Adapter,
    /// Makes resources.
    pub device: wgpu::Device,
    /// Takes work.
    pub queue: wgpu::Queue,
    /// Name, driver, kind.
    pub info: wgpu::AdapterInfo,
    /// Format of attenuation volumes, sheets and pyramid: 16-bit floats where they can be stored.
    pub storage_format: wgpu::TextureFormat,
    /// Whether light volumes can have one byte per voxel.
    pub byte_volumes: bool,
    /// Whether 16-bit normalised textures are available for density.
    pub unorm16: bool,
    /// What nobody caught, kept until it is taken.
    complaints: Complaints,
    /// The device is gone.
    lost: Arc<AtomicBool>,
}

/// How long the adapter may take for what was submitted. Parts of pictures are made to take a tenth of a second; the
/// slowest driver on a busy machine has needed ten seconds.
const PATIENCE: Duration = Duration::from_mins(2);

/// Textures and buffers that were asked for.
pub(crate) static ALLOCATIONS: Count = Count::new();

/// How often it is looked at whether a device that is waited for is still there.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// Features that we use where an adapter has them.
const WANTED: wgpu::Features = wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
    .union(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM)
    .union(wgpu::Features::FLOAT32_FILTERABLE)
    .union(wgpu::Features::PIPELINE_CACHE)
    .union(Clock::FEATURES);

/// What to ask of an adapter: the features we can use and its real limits instead of the defaults
/// (which refuse a 2049-voxel axis and a 9000-pixel window on any card).
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("chiaroscuro"),
        required_features: adapter.features() & WANTED,
        required_limits: adapter.limits(),
        ..Default::default()
    }
}

impl Context {
    /// Opens a device without a window: the one named by `WGPU_ADAPTER_NAME`, else the fastest.
    ///
    /// # Errors
    /// When there is no adapter or it cannot store the textures that we need.
    pub fn headless() -> Result<Self, GpuError> {
        check_room_for_drivers()?;
        let adapter = adapters::fastest()?;
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(&adapter)))
            .map_err(|err| GpuError::NoAdapter { why: err.to_string(), help: ADAPTER_HELP })?;
        Self::new(&adapter, device, queue)
    }

    /// A context on a device that somebody else opened with [`device_descriptor`], or with more features. What the
    /// device complains about without being asked, also in the work of others on the same thread, goes to
    /// [`Self::check`] there: programs with a handler of their own set it afterwards.
    ///
    /// # Errors
    /// When the adapter cannot store the textures that we need, or the device was opened without that feature.
    pub fn new(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, GpuError> {
        let features = device.features();
        let usable = |format: wgpu::TextureFormat| {
            let can = format.guaranteed_format_features(features);
            let can = if features.contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES) {
                adapter.get_texture_format_features(format)
            } else {
                can
            };
            can.allowed_usages.contains(wgpu::TextureUsages::STORAGE_BINDING)
                && can.flags.contains(wgpu::TextureFormatFeatureFlags::FILTERABLE)
        };
        let storage_format = [wgpu::TextureFormat::R16Float, wgpu::TextureFormat::R32Float]
            .into_iter()
            // Volumes with missing voxels keep a share beside each density.
            .find(|&format| usable(format) && usable(pair_format(format)))
            .ok_or_else(|| GpuError::NoAdapter {
                why: format!(
                    "{} can neither store 16-bit nor filter 32-bit float volumes",
                    adapter.get_info().name
                ),
                // The adapter may well be able to.
                help: if features.contains(adapter.features() & WANTED) {
                    ADAPTER_HELP
                } else {
                    OPENING_HELP
                },
            })?;
        let byte_volumes = usable(wgpu::TextureFormat::R8Unorm);
        let complaints = Complaints::default();
        let for_errors = complaints.clone();
        device.on_uncaptured_error(Arc::new(move |err: wgpu::Error| {
            let err = match err {
                wgpu::Error::OutOfMemory { .. } => {
                    GpuError::OutOfMemory { what: "a resource".to_owned(), mebibytes: 0 }
                }
                other => GpuError::Refused(other.to_string()),
            };
            log::error!("{err}");
            for_errors.keep(err);
        }));
        let lost = Arc::new(AtomicBool::new(false));
        let (for_loss, flag) = (complaints.clone(), Arc::clone(&lost));
        device.set_device_lost_callback(move |reason, message| {
            flag.store(true, Ordering::Relaxed);
            let why = if message.is_empty() { format!("{reason:?}") } else { message };
            let err = GpuError::Lost(why);
            log::error!("{err}");
            for_loss.keep(err);
        });
        let unorm16 = features.contains(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM);
        let (adapter, info) = (adapter.clone(), adapter.get_info());
        Ok(Self { adapter, device, queue, info, storage_format, byte_volumes, unorm16, complaints, lost })
    }

    /// This device with 32-bit sheets, pyramid and light volumes, where it can filter them: for
    /// checks that must not see the rounding of 16-bit floats.
    #[cfg(feature = "testing")]
    #[must_use]
    pub fn with_full_precision(mut self) -> Self {
        if self.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE) {
            self.storage_format = wgpu::TextureFormat::R32Float;
        }
        self
    }

    /// The adapter and its driver, in words.
    pub fn description(&self) -> String {
        let info = &self.info;
        let words = format!("{} · {:?} · {} {}", info.name, info.backend, info.driver, info.driver_info);
        // A driver may call itself whatever it likes.
        plain(words.trim(), 400)
    }

    /// Another device on the same adapter, for work beside a window: long work on the window's own
    /// queue would hold up its frames, and a surface cannot be resized while others submit to it.
    ///
    /// # Errors
    /// When the adapter gives no second device.
    pub fn sibling(&self) -> Result<Self, GpuError> {
        // Mesa's software driver takes a fence of one device for passed only when what others of the
        // same instance have drawn is done, too: every wait would last a frame of the window longer.
        let adapter = if self.is_software() { self.same_adapter_elsewhere() } else { None };
        let adapter = adapter.as_ref().unwrap_or(&self.adapter);
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(adapter)))
            .map_err(|err| GpuError::NoAdapter { why: err.to_string(), help: ADAPTER_HELP })?;
        let sibling = Self::new(adapter, device, queue)?;
        Ok(Self { storage_format: self.storage_format, ..sibling })
    }

    /// This adapter as an instance of its own sees it.
    fn same_adapter_elsewhere(&self) -> Option<wgpu::Adapter> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: self.info.backend.into(),
            ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(self.info.backend.into()));
        adapters.into_iter().find(|adapter| adapter.get_info() == self.info)
    }

    /// Whether the adapter is the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Waits until everything submitted is done, and reports what went wrong in the work of this thread since the last call.
    ///
    /// # Errors
    /// What the device complained about; that it is lost, also where the adapter has given no answer for two minutes.
    pub fn wait(&self) -> Result<(), GpuError> {
        let begin = Instant::now();
        std::thread::sleep(fault::slowness());
        loop {
            match self.poll(wgpu::PollType::Wait { submission_index: None, timeout: Some(LOOK_AGAIN) }) {
                Err(wgpu::PollError::Timeout) if self.lost.load(Ordering::Relaxed) => {}
                Err(wgpu::PollError::Timeout) if begin.elapsed() > PATIENCE => {
                    self.lost.store(true, Ordering::Relaxed);
                    let why = format!("{} has not answered for {} s", self.info.name, PATIENCE.as_secs());
                    return Err(GpuError::Lost(why));
                }
                Err(wgpu::PollError::Timeout) => continue,
                Err(err) => return Err(GpuError::Refused(err.to_string())),
                Ok(_) => {}
            }
            self.check()?;
            return if self.lost.load(Ordering::Relaxed) { Err(self.gone()) } else { Ok(()) };
        }
    }

    /// Lets the device tell what has happened, without waiting. wgpu panics where it finds a device gone.
    fn poll(&self, how: wgpu::PollType) -> Result<wgpu::PollStatus, wgpu::PollError> {
        catch_unwind(AssertUnwindSafe(|| self.device.poll(how))).unwrap_or_else(|_| {
            self.lost.store(true, Ordering::Relaxed);
            Ok(wgpu::PollStatus::QueueEmpty)
        })
    }

    /// Whether the device is gone, for good: after a driver's update, a sleep, a card that was taken out. To be asked
    /// before anything is drawn with it, which might panic.
    pub fn is_lost(&self) -> bool {
        if !self.lost.load(Ordering::Relaxed) {
            self.poll(wgpu::PollType::Poll).ok();
        }
        self.lost.load(Ordering::Relaxed)
    }

    /// Takes the device away.
    #[cfg(feature = "window")]
    pub(crate) fn lose(&self) {
        self.device.destroy();
    }

    /// As [`Self::is_lost`], as far as somebody has waited for the device: asking does not get into the way of a thread
    /// that does.
    #[cfg(feature = "window")]
    pub(crate) fn was_lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    /// What to say of a device that is gone.
    fn gone(&self) -> GpuError {
        GpuError::Lost(self.info.name.clone())
    }

    /// Reports what went wrong in the work of this thread since it called this last.
    ///
    /// # Errors
    /// What the device complained about.
    pub fn check(&self) -> Result<(), GpuError> {
        let complaint = self.complaints.take();
        // What a device complains about that is gone says nothing: nothing on it is valid any more.
        let is_lost = self.lost.load(Ordering::Relaxed);
        match complaint {
            Some(complaint) if is_lost && !matches!(complaint, GpuError::Lost(_)) => Err(self.gone()),
            Some(complaint) => Err(complaint),
            None => Ok(()),
        }
    }

    /// Makes a texture, or says that memory is out.
    ///
    /// # Errors
    /// When an axis is over the adapter's limit or memory is out.
    pub fn texture(&self, descriptor: &wgpu::TextureDescriptor<'_>) -> Result<wgpu::Texture, GpuError> {
        let what = descriptor.label.unwrap_or("a texture").to_owned();
        let limits = self.device.limits();
        let limit = match descriptor.dimension {
            wgpu::TextureDimension::D3 => limits.max_texture_dimension_3d,
            wgpu::TextureDimension::D2 | wgpu::TextureDimension::D1 => limits.max_texture_dimension_2d,
        };
        let wgpu::Extent3d { width, height, depth_or_array_layers } = descriptor.size;
        // Layers have a limit of their own, below that of the axes.
        let most_layers = limits.max_texture_array_layers;
        let (size, limit) = match descriptor.dimension {
            wgpu::TextureDimension::D3 => (width.max(height).max(depth_or_array_layers), limit),
            _ if depth_or_array_layers > most_layers => (depth_or_array_layers, most_layers),
            _ => (width.max(height), limit),
        };
        if size > limit {
            let help = "a smaller picture or a volume with fewer voxels helps";
            return Err(GpuError::OverLimit { what, size: u64::from(size), limit: u64::from(limit), help });
        }
        let texels = u64::from(width) * u64::from(height) * u64::from(depth_or_array_layers);
        let bytes = texels * u64::from(descriptor.format.block_copy_size(None).unwrap_or(16));
        if fault::is_due(&ALLOCATIONS, Fault::OutOfMemory) {
            return Err(GpuError::OutOfMemory { what, mebibytes: bytes >> 20 });
        }
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let texture = self.device.create_texture(descriptor);
        match pollster::block_on(scope.pop()) {
            None => Ok(texture),
            Some(_) => Err(GpuError::OutOfMemory { what, mebibytes: bytes >> 20 }),
        }
    }

    /// A uniform or storage buffer with these contents.
    pub fn buffer<T: bytemuck::NoUninit>(
        &self,
        label: &str,
        contents: &[T],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        let aligned = (bytes.len() as u64).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        let buffer = self.empty_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: aligned.max(wgpu::COPY_BUFFER_ALIGNMENT),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        // Not mapped from the beginning: memory that was refused cannot be, and wgpu panics.
        if bytes.len() as u64 == aligned {
            self.queue.write_buffer(&buffer, 0, bytes);
        } else {
            let mut padded = bytes.to_vec();
            padded.resize(aligned as usize, 0);
            self.queue.write_buffer(&buffer, 0, &padded);
        }
        buffer
    }

    /// A buffer of anything. Where memory is out it can be used like any other, to no effect, and [`Self::check`]
    /// tells.
    pub(crate) fn empty_buffer(&self, descriptor: &wgpu::BufferDescriptor<'_>) -> wgpu::Buffer {
        let is_refused = fault::is_due(&ALLOCATIONS, Fault::OutOfMemory);
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let buffer = self.device.create_buffer(descriptor);
        if pollster::block_on(scope.pop()).is_some() || is_refused {
            let what = descriptor.label.unwrap_or("a buffer").to_owned();
            self.complaints.keep(GpuError::OutOfMemory { what, mebibytes: descriptor.size >> 20 });
        }
        if is_refused {
            // As one that was refused: what uses it is refused, too.
            buffer.destroy();
        }
        buffer
    }

    /// A sampler that filters linearly and clamps.
    pub fn sampler(&self, label: &str) -> wgpu::Sampler {
        self.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some(label),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        })
    }
}
