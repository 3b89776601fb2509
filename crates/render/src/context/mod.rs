//! Graphics device: its queue, limits and features, and its errors.

mod adapters;
mod address_space;
mod device_errors;
mod device_state;
pub(super) mod error;
pub(super) mod gpu_clock;
mod texture_formats;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

pub use self::adapters::device_descriptor;
use self::adapters::{ADAPTER_HELP, OPTIONAL_FEATURES, check_driver};
pub use self::address_space::check_driver_address_space;
pub(super) use self::address_space::{COMPILER_ADDRESS_BYTES, check_address_space};
use self::device_errors::DeviceErrors;
use self::device_state::DeviceState;
pub use self::device_state::OpeningTimes;
pub(super) use self::texture_formats::pair_format;
use super::GpuError;
use chiaroscuro_files::{
    fault::{self, FaultEvent, InjectedFault},
    sanitised,
};

/// Advice when a device was opened with fewer features than its adapter has, and too few.
const DEVICE_HELP: &str = "open the device with the features of chiaroscuro_render::device_descriptor";

/// Graphics device with its queue and the capabilities that the renderer depends on. Cheap to clone.
#[derive(Debug, Clone)]
pub struct GpuContext {
    adapter: wgpu::Adapter,
    /// Device, which creates resources.
    pub device: wgpu::Device,
    /// Queue, to which work is submitted.
    pub queue: wgpu::Queue,
    /// Name, driver and kind of the adapter.
    pub info: wgpu::AdapterInfo,
    /// Format of attenuation volumes, sheets and pyramid: 16-bit floats where they can be stored, else 32-bit.
    pub storage_format: wgpu::TextureFormat,
    /// `true` if light volumes can have one byte per voxel.
    pub has_byte_volumes: bool,
    /// `true` if 16-bit normalised textures are available for density.
    pub has_unorm16: bool,
    /// Errors that no error scope caught, kept until they are taken.
    device_errors: DeviceErrors,
    /// State that all clones share.
    state: Arc<DeviceState>,
}

/// Longest wait for submitted work before the device counts as lost. Parts of pictures are sized to take a tenth of a
/// second; the slowest driver on a busy machine has needed ten seconds.
const DEVICE_TIMEOUT: Duration = Duration::from_mins(2);

/// Interval at which a waiting thread checks that the device is not lost.
const LOSS_CHECK_INTERVAL: Duration = Duration::from_secs(2);

impl GpuContext {
    /// Opens a device without a window: on the adapter named by `WGPU_ADAPTER_NAME`, else on the fastest.
    ///
    /// # Errors
    /// Returns an error if there is no adapter, or if it cannot store the textures that the renderer needs.
    pub fn headless() -> Result<Self, GpuError> {
        Self::headless_on(0)
    }

    /// Opens a device as [`Self::headless`] does, on one of the adapters from the fastest on, counted from 0: a machine
    /// may have several graphics cards.
    ///
    /// # Errors
    /// Returns an error as [`Self::headless`] does, or if there are fewer adapters.
    pub fn headless_on(number: usize) -> Result<Self, GpuError> {
        let begin = Instant::now();
        check_driver_address_space()?;
        let adapter = adapters::nth_fastest_adapter(number)?;
        let instance = begin.elapsed();
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(&adapter)))
            .map_err(|err| GpuError::NoAdapter { reason: err.to_string(), help: ADAPTER_HELP })?;
        let opened = begin.elapsed().saturating_sub(instance);
        let [instance_ms, device_ms] = [instance, opened].map(|took| took.as_secs_f64() * 1000.0);
        Self::with_opening_times(&adapter, device, queue, OpeningTimes { instance_ms, device_ms })
    }

    /// Creates a context on a device that the caller opened with [`device_descriptor`], or with more features. Sets
    /// the device's handler for uncaptured errors: they are reported by [`Self::check`], including those of other
    /// work on the same thread. Programs with a handler of their own install it afterwards.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot store the textures that the renderer needs, if the device was opened
    /// without the feature for it, or if its driver is known to crash.
    pub fn new(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, GpuError> {
        Self::with_opening_times(adapter, device, queue, OpeningTimes::default())
    }

    /// Creates a context like [`Self::new`] on a device that took this time to open.
    fn with_opening_times(
        adapter: &wgpu::Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
        opening_times: OpeningTimes,
    ) -> Result<Self, GpuError> {
        check_driver(&adapter.get_info())?;
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
            // Pyramids of volumes with missing voxels store presence as a second channel.
            .find(|&format| usable(format) && usable(pair_format(format)))
            .ok_or_else(|| GpuError::NoAdapter {
                reason: format!(
                    "{} can neither store 16-bit nor filter 32-bit float volumes",
                    adapter.get_info().name
                ),
                // The adapter may have the feature even though the device was opened without it.
                help: if features.contains(adapter.features() & OPTIONAL_FEATURES) {
                    ADAPTER_HELP
                } else {
                    DEVICE_HELP
                },
            })?;
        let byte_volumes = usable(wgpu::TextureFormat::R8Unorm);
        let complaints = DeviceErrors::default();
        let for_errors = complaints.clone();
        device.on_uncaptured_error(Arc::new(move |err: wgpu::Error| {
            let err = match err {
                wgpu::Error::OutOfMemory { .. } => {
                    GpuError::OutOfMemory { what: "a resource".to_owned(), mebibytes: 0 }
                }
                wgpu::Error::Validation { .. } => GpuError::Internal(err.to_string()),
                wgpu::Error::Internal { .. } => GpuError::Refused(err.to_string()),
            };
            log::error!("{err}");
            for_errors.store(err);
        }));
        let state = Arc::new(DeviceState { is_lost: AtomicBool::new(false), opening_times });
        let (for_loss, shared) = (complaints.clone(), Arc::clone(&state));
        device.set_device_lost_callback(move |reason, message| {
            shared.is_lost.store(true, Ordering::Relaxed);
            let why = if message.is_empty() { format!("{reason:?}") } else { message };
            let err = GpuError::DeviceLost(why);
            log::error!("{err}");
            for_loss.store(err);
        });
        let unorm16 = features.contains(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM);
        let (adapter, info) = (adapter.clone(), adapter.get_info());
        Ok(Self {
            adapter,
            device,
            queue,
            info,
            storage_format,
            has_byte_volumes: byte_volumes,
            has_unorm16: unorm16,
            device_errors: complaints,
            state,
        })
    }

    /// Returns this context with 32-bit sheets, pyramid and light volumes, where the device can filter them: for
    /// tests that must not see the rounding of 16-bit floats.
    #[cfg(feature = "testing")]
    #[must_use]
    pub fn with_full_precision(mut self) -> Self {
        if self.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE) {
            self.storage_format = wgpu::TextureFormat::R32Float;
        }
        self
    }

    /// Returns the name, backend and driver of the adapter, for the user.
    pub fn description(&self) -> String {
        let info = &self.info;
        let words = format!("{} · {:?} · {} {}", info.name, info.backend, info.driver, info.driver_info);
        // Names come from the driver and may contain any characters.
        sanitised(words.trim(), 400)
    }

    /// Opens another device on the same adapter, for work beside a window: long work on the window's queue would
    /// delay its frames, and a surface cannot be resized while other threads submit to its device.
    ///
    /// # Errors
    /// Returns an error if the adapter provides no second device.
    pub fn second_device(&self) -> Result<Self, GpuError> {
        // Mesa's software driver signals a fence of one device only after the work of all devices of that instance is
        // done: every wait would last a frame of the window longer. An instance of its own avoids that.
        let adapter = if self.is_software() { self.adapter_of_new_instance() } else { None };
        let adapter = adapter.as_ref().unwrap_or(&self.adapter);
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(adapter)))
            .map_err(|err| GpuError::NoAdapter { reason: err.to_string(), help: ADAPTER_HELP })?;
        let sibling = Self::new(adapter, device, queue)?;
        Ok(Self { storage_format: self.storage_format, ..sibling })
    }

    /// Returns this adapter as enumerated by a new instance, if it is found there.
    fn adapter_of_new_instance(&self) -> Option<wgpu::Adapter> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: self.info.backend.into(),
            ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(self.info.backend.into()));
        adapters.into_iter().find(|adapter| adapter.get_info() == self.info)
    }

    /// Returns the time in which [`Self::headless`] opened this context.
    pub fn opening_times(&self) -> OpeningTimes {
        self.state.opening_times
    }

    /// Returns true if the adapter is a software driver on the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Waits until all submitted work is done, and reports the errors of this thread's work since the last call.
    ///
    /// # Errors
    /// Returns the device's error; [`GpuError::DeviceLost`] also where the adapter has not answered for two minutes.
    pub fn wait(&self) -> Result<(), GpuError> {
        let begin = Instant::now();
        std::thread::sleep(fault::adapter_delay());
        loop {
            let all = wgpu::PollType::Wait { submission_index: None, timeout: Some(LOSS_CHECK_INTERVAL) };
            match self.poll(&all) {
                Err(wgpu::PollError::Timeout) if self.state.is_lost.load(Ordering::Relaxed) => {}
                Err(wgpu::PollError::Timeout) if begin.elapsed() > DEVICE_TIMEOUT => {
                    self.state.is_lost.store(true, Ordering::Relaxed);
                    let why =
                        format!("{} has not answered for {} s", self.info.name, DEVICE_TIMEOUT.as_secs());
                    return Err(GpuError::DeviceLost(why));
                }
                Err(wgpu::PollError::Timeout) => continue,
                Err(err) => return Err(GpuError::Internal(err.to_string())),
                Ok(_) => {}
            }
            self.check()?;
            return if self.state.is_lost.load(Ordering::Relaxed) { Err(self.lost_error()) } else { Ok(()) };
        }
    }

    /// Polls the device. wgpu panics if it finds the device lost; the panic is caught and recorded as a loss.
    ///
    /// It also panics in the rare case that a wait has just ended without success when another thread notices that the
    /// queue is empty. A second attempt then succeeds, but not on a lost device.
    fn poll(&self, how: &wgpu::PollType) -> Result<wgpu::PollStatus, wgpu::PollError> {
        let attempt = || catch_unwind(AssertUnwindSafe(|| self.device.poll(how.clone())));
        attempt().or_else(|_| attempt()).unwrap_or_else(|_| {
            self.state.is_lost.store(true, Ordering::Relaxed);
            Ok(wgpu::PollStatus::QueueEmpty)
        })
    }

    /// Returns true if the device is lost for good: after a driver update, sleep, or removal of the card. To be
    /// checked before each use of the device, which might panic otherwise.
    pub fn is_lost(&self) -> bool {
        if !self.state.is_lost.load(Ordering::Relaxed) {
            self.poll(&wgpu::PollType::Poll).ok();
        }
        self.state.is_lost.load(Ordering::Relaxed)
    }

    /// Destroys the device, for fault injection.
    pub fn destroy_device(&self) {
        self.device.destroy();
    }

    /// Returns true if the device is already known to be lost. Does not poll, unlike [`Self::is_lost`], and so never
    /// blocks a thread that is waiting for the device.
    pub fn is_known_lost(&self) -> bool {
        self.state.is_lost.load(Ordering::Relaxed)
    }

    /// Builds the error for a lost device.
    fn lost_error(&self) -> GpuError {
        GpuError::DeviceLost(self.info.name.clone())
    }

    /// Reports the first error of this thread's work since the last call.
    ///
    /// # Errors
    /// Returns the device's error.
    pub fn check(&self) -> Result<(), GpuError> {
        let complaint = self.device_errors.take();
        // Errors of a lost device are meaningless: every resource on it is invalid.
        let is_lost = self.state.is_lost.load(Ordering::Relaxed);
        match complaint {
            Some(complaint) if is_lost && !matches!(complaint, GpuError::DeviceLost(_)) => {
                Err(self.lost_error())
            }
            Some(complaint) => Err(complaint),
            None => Ok(()),
        }
    }

    /// Creates a texture.
    ///
    /// # Errors
    /// Returns an error if an axis exceeds the adapter's limit or memory is exhausted.
    pub fn texture(&self, descriptor: &wgpu::TextureDescriptor<'_>) -> Result<wgpu::Texture, GpuError> {
        let what = descriptor.label.unwrap_or("a texture").to_owned();
        let limits = self.device.limits();
        let limit = match descriptor.dimension {
            wgpu::TextureDimension::D3 => limits.max_texture_dimension_3d,
            wgpu::TextureDimension::D2 | wgpu::TextureDimension::D1 => limits.max_texture_dimension_2d,
        };
        let wgpu::Extent3d { width, height, depth_or_array_layers } = descriptor.size;
        // Array layers have a limit of their own, below that of the axes.
        let most_layers = limits.max_texture_array_layers;
        let (size, limit) = match descriptor.dimension {
            wgpu::TextureDimension::D3 => (width.max(height).max(depth_or_array_layers), limit),
            _ if depth_or_array_layers > most_layers => (depth_or_array_layers, most_layers),
            _ => (width.max(height), limit),
        };
        if size > limit {
            let help = "choose a smaller picture or a volume with fewer voxels";
            return Err(GpuError::OverLimit { what, size: u64::from(size), limit: u64::from(limit), help });
        }
        let texels = u64::from(width) * u64::from(height) * u64::from(depth_or_array_layers);
        let bytes = texels * u64::from(descriptor.format.block_copy_size(None).unwrap_or(16));
        if fault::is_due(FaultEvent::Allocation, InjectedFault::OutOfMemory) {
            return Err(GpuError::OutOfMemory { what, mebibytes: bytes >> 20 });
        }
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let texture = self.device.create_texture(descriptor);
        match pollster::block_on(scope.pop()) {
            None => Ok(texture),
            Some(_) => Err(GpuError::OutOfMemory { what, mebibytes: bytes >> 20 }),
        }
    }

    /// Creates a uniform or storage buffer with these contents, padded to the copy alignment.
    pub fn buffer<T: bytemuck::NoUninit>(
        &self,
        label: &str,
        contents: &[T],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        let aligned = (bytes.len() as u64).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        let buffer = self.uninitialised_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: aligned.max(wgpu::COPY_BUFFER_ALIGNMENT),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        // Not mapped at creation: a buffer whose allocation failed cannot be mapped, and wgpu panics.
        if bytes.len() as u64 == aligned {
            self.queue.write_buffer(&buffer, 0, bytes);
        } else {
            let mut padded = bytes.to_vec();
            padded.resize(aligned as usize, 0);
            self.queue.write_buffer(&buffer, 0, &padded);
        }
        buffer
    }

    /// Creates an uninitialised buffer. If memory is exhausted, the returned buffer is invalid, commands with it have
    /// no effect, and [`Self::check`] reports the error.
    pub(crate) fn uninitialised_buffer(&self, descriptor: &wgpu::BufferDescriptor<'_>) -> wgpu::Buffer {
        let is_refused = fault::is_due(FaultEvent::Allocation, InjectedFault::OutOfMemory);
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let buffer = self.device.create_buffer(descriptor);
        if pollster::block_on(scope.pop()).is_some() || is_refused {
            let what = descriptor.label.unwrap_or("a buffer").to_owned();
            self.device_errors.store(GpuError::OutOfMemory { what, mebibytes: descriptor.size >> 20 });
        }
        if is_refused {
            // Simulates a failed allocation: commands that use the buffer fail, too.
            buffer.destroy();
        }
        buffer
    }

    /// Creates a sampler with linear filtering and clamped coordinates.
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
