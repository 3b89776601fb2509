//! Main loop of the window: after the loss of a graphics device, a successor window is opened.

use std::path::PathBuf;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui;

use super::error::AppError;
use super::handover::HandoverSlot;
use super::icon;
use super::options::WindowOptions;
use crate::app::persistence::{check_window_state, write_all_pending};
use crate::app::{App, text};
use chiaroscuro_render::{check_driver_address_space, device_descriptor};

/// Application identifier of the window for the desktop, and name of the storage folder.
const APP_ID: &str = "chiaroscuro";

/// Returns the storage folder of the program for this user.
pub fn storage_folder() -> Option<PathBuf> {
    eframe::storage_dir(APP_ID)
}

/// Returns the set-up of the window's device: the limits and features that the renderer can use.
pub fn wgpu_setup() -> eframe::egui_wgpu::WgpuSetupCreateNew {
    let mut setup = eframe::egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor = Arc::new(device_descriptor);
    setup
}

/// Opens the window and returns when it is closed. After the loss of its graphics device, a successor takes its
/// place.
///
/// # Errors
/// When there is no display or no usable graphics adapter.
pub fn run(options: WindowOptions) -> Result<(), AppError> {
    check_driver_address_space()?;
    let damaged = options.storage.as_deref().and_then(check_window_state);
    let default = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |what| {
        write_all_pending();
        default(what);
    }));
    let legacy = HandoverSlot::default();
    let theirs = HandoverSlot::clone(&legacy);
    open_window(false, move |cc| {
        let mut app = App::start(cc, options, theirs)?;
        if let Some(notice) = damaged {
            app.add_notice(notice);
        }
        Ok(app)
    })?;
    let mut losses: Vec<Instant> = Vec::new();
    loop {
        let Some(carried) = legacy.lock().unwrap_or_else(PoisonError::into_inner).take() else {
            return Ok(());
        };
        losses.retain(|when| when.elapsed() < REPEATED_LOSS_TIME);
        losses.push(Instant::now());
        // A user who has chosen the CPU is not asked again.
        let (asks, on_cpu) = (losses.len() > 1 && !carried.on_cpu, carried.on_cpu);
        let theirs = HandoverSlot::clone(&legacy);
        open_window(on_cpu, move |cc| App::resume(cc, carried, theirs, asks))?;
    }
}

/// Interval within which a second loss means that the device will be lost again.
const REPEATED_LOSS_TIME: Duration = Duration::from_mins(1);

/// Opens a window, on the software adapter if `on_cpu`, and returns when it is closed.
fn open_window(
    on_cpu: bool,
    begin: impl FnOnce(&eframe::CreationContext<'_>) -> Result<App, AppError>,
) -> Result<(), AppError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title(text::opening::PROGRAM)
        .with_app_id(APP_ID)
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([560.0, 360.0])
        .with_icon(icon::icon());
    let mut setup = wgpu_setup();
    if on_cpu {
        setup.native_adapter_selector = Some(Arc::new(|adapters, _surface| {
            let is_cpu = |adapter: &&wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
            adapters.iter().find(is_cpu).cloned().ok_or_else(|| text::messages::NO_CPU_ADAPTER.to_owned())
        }));
    }
    let wgpu_options =
        eframe::egui_wgpu::WgpuConfiguration { wgpu_setup: setup.into(), ..Default::default() };
    // Without dithering, the picture reaches the screen byte for byte.
    let native = eframe::NativeOptions { viewport, wgpu_options, dithering: false, ..Default::default() };
    let start = |cc: &eframe::CreationContext<'_>| Ok(Box::new(begin(cc)?) as Box<dyn eframe::App>);
    eframe::run_native(text::opening::PROGRAM, native, Box::new(start))?;
    Ok(())
}
