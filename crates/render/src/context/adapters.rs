//! Selection of the graphics adapter, the features of its device, and the error message if there is none.

use super::gpu_clock::GpuClock;
use crate::GpuError;
use chiaroscuro_files::sanitised;

/// Advice in the error message when there is no adapter.
pub(super) const ADAPTER_HELP: &str = if cfg!(windows) {
    "install the driver of the graphics card from its maker; where Direct3D fails, WGPU_BACKEND=vulkan chooses Vulkan"
} else {
    "install a Vulkan driver (on Debian: mesa-vulkan-drivers, which also brings a software one)"
};

/// Environment variable that selects an adapter by a part of its name.
const ADAPTER_NAME_VARIABLE: &str = "WGPU_ADAPTER_NAME";

/// Environment variable that selects the graphics APIs (`vulkan`, `metal`, `dx12`).
const BACKEND_VARIABLE: &str = "WGPU_BACKEND";

/// Maximum number of adapters listed in an error message; more than any machine has.
const MAX_LISTED_ADAPTERS: usize = 8;

/// Maximum length, in bytes, of an adapter's or variable's name in an error message.
const MAX_NAME_BYTES: usize = 80;

/// Optional features, requested where the adapter has them.
pub(super) const OPTIONAL_FEATURES: wgpu::Features = wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
    .union(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM)
    .union(wgpu::Features::FLOAT32_FILTERABLE)
    .union(wgpu::Features::PIPELINE_CACHE)
    .union(GpuClock::FEATURES);

/// Returns the descriptor for a device of this adapter.
///
/// It has the features that the renderer can use, and the adapter's real limits instead of the defaults (which refuse
/// a 2049-voxel axis and a 9000-pixel window on any card).
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("chiaroscuro"),
        required_features: adapter.features() & OPTIONAL_FEATURES,
        required_limits: adapter.limits(),
        ..Default::default()
    }
}

/// Returns an adapter among those that the environment variables allow, counted from the fastest, which is 0.
///
/// # Errors
/// Returns [`GpuError::NoAdapter`] if there is none with this number.
pub(super) fn nth_fastest_adapter(number: usize) -> Result<wgpu::Adapter, GpuError> {
    let asked = |variable: &str| std::env::var(variable).ok().filter(|value| !value.is_empty());
    // Other packages may compile in further backends (GL), which lack the features that volume rendering needs.
    let enabled = wgpu::Instance::enabled_backend_features() & wgpu::Backends::PRIMARY;
    let backends = wgpu::Backends::from_env().unwrap_or(enabled) & enabled;
    if backends.is_empty() {
        return Err(no_backend_error(&asked(BACKEND_VARIABLE).unwrap_or_default(), enabled));
    }
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
    });
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let wanted = asked(ADAPTER_NAME_VARIABLE).unwrap_or_default();
    let lower = wanted.to_lowercase();
    adapters.retain(|adapter| adapter.get_info().name.to_lowercase().contains(&lower));
    adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    });
    let allowed: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    adapters.into_iter().nth(number).ok_or_else(|| {
        if allowed.is_empty() {
            no_adapter_error(&names, &wanted, asked(BACKEND_VARIABLE).as_deref())
        } else {
            no_number_error(number, &allowed)
        }
    })
}

/// Checks that an adapter's driver does not crash on the renderer's shaders.
///
/// # Errors
/// Returns [`GpuError::NoAdapter`] for the software driver of Mesa 20, the first that there was: its compiler ends the
/// process on most of them (20.3.5, in Debian 11).
pub(super) fn check_driver(info: &wgpu::AdapterInfo) -> Result<(), GpuError> {
    if info.driver != "llvmpipe" || !info.driver_info.starts_with("Mesa 20.") {
        return Ok(());
    }
    let version = sanitised(&info.driver_info, MAX_NAME_BYTES);
    Err(GpuError::NoAdapter {
        reason: format!("the software driver llvmpipe of {version} crashes on volumes"),
        help: "install a newer one (mesa-vulkan-drivers of Debian 12 has Mesa 22), or the driver of a graphics card",
    })
}

/// Builds the error for a number that no adapter has; `names` are those of all adapters, from the fastest on.
fn no_number_error(number: usize, names: &[String]) -> GpuError {
    let listed: Vec<String> = names
        .iter()
        .enumerate()
        .take(MAX_LISTED_ADAPTERS)
        .map(|(at, name)| format!("{at} is {:?}", sanitised(name, MAX_NAME_BYTES)))
        .collect();
    let reason = format!("there is no adapter {number}: {}", listed.join(", "));
    GpuError::NoAdapter { reason, help: "choose one of these numbers" }
}

/// Builds the error for a `WGPU_BACKEND` that selects no graphics API of this program.
fn no_backend_error(asked: &str, enabled: wgpu::Backends) -> GpuError {
    let names = [
        (wgpu::Backends::VULKAN, "vulkan"),
        (wgpu::Backends::METAL, "metal"),
        (wgpu::Backends::DX12, "dx12"),
    ];
    let known: Vec<&str> =
        names.into_iter().filter(|(backend, _)| enabled.contains(*backend)).map(|(_, name)| name).collect();
    let reason = format!(
        "{BACKEND_VARIABLE} is {:?}, and this program supports only {}",
        sanitised(asked, MAX_NAME_BYTES),
        known.join(" and ")
    );
    GpuError::NoAdapter { reason, help: "unset WGPU_BACKEND" }
}

/// Builds the error for a machine on which no adapter's name contains `wanted`.
fn no_adapter_error(names: &[String], wanted: &str, backend: Option<&str>) -> GpuError {
    if names.is_empty() {
        let through = backend.map_or_else(String::new, |backend| {
            format!(" ({BACKEND_VARIABLE} is {:?})", sanitised(backend, MAX_NAME_BYTES))
        });
        return GpuError::NoAdapter { reason: format!("no driver offers one{through}"), help: ADAPTER_HELP };
    }
    let listed: Vec<String> = names
        .iter()
        .take(MAX_LISTED_ADAPTERS)
        .map(|name| format!("{:?}", sanitised(name, MAX_NAME_BYTES)))
        .collect();
    let why = format!(
        "no adapter is called {:?} ({ADAPTER_NAME_VARIABLE}): there are {}",
        sanitised(wanted, MAX_NAME_BYTES),
        listed.join(", ")
    );
    GpuError::NoAdapter { reason: why, help: "give a part of one of these names, or unset WGPU_ADAPTER_NAME" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_cause() {
        let names = ["llvmpipe (LLVM 15)".to_owned(), "Card\u{1b}[2J".to_owned()];
        let message = no_adapter_error(&names, "nothing", None).to_string();
        assert!(message.contains("no adapter is called \"nothing\" (WGPU_ADAPTER_NAME)"), "{message}");
        assert!(message.contains("there are \"llvmpipe (LLVM 15)\", \"Card·[2J\"; give"), "{message}");
        let said = no_number_error(2, &names).to_string();
        assert!(said.contains("no adapter 2: 0 is \"llvmpipe (LLVM 15)\", 1 is \"Card"), "{said}");
        let said = no_adapter_error(&[], "nothing", Some("vulkan")).to_string();
        assert!(said.contains("no driver offers one (WGPU_BACKEND is \"vulkan\"); install"), "{said}");
        let said = no_backend_error("gl", wgpu::Backends::VULKAN).to_string();
        assert!(
            said.contains("WGPU_BACKEND is \"gl\"") && said.contains("supports only vulkan; unset"),
            "{said}"
        );
    }
    #[test]
    fn the_first_software_driver_of_mesa_is_refused() {
        let info = |driver: &str, version: &str| wgpu::AdapterInfo {
            driver: driver.to_owned(),
            driver_info: version.to_owned(),
            ..wgpu::AdapterInfo::new(wgpu::DeviceType::Cpu, wgpu::Backend::Vulkan)
        };
        let refused = check_driver(&info("llvmpipe", "Mesa 20.3.5 (LLVM 11.0.1)"));
        let message = refused.expect_err("it crashes").to_string();
        assert!(message.contains("Mesa 20.3.5") && message.contains("mesa-vulkan-drivers"), "{message}");
        for (driver, version) in
            [("llvmpipe", "Mesa 22.3.6 (LLVM 15.0.6)"), ("radv", "Mesa 20.3.5"), ("llvmpipe", "")]
        {
            assert!(check_driver(&info(driver, version)).is_ok(), "{driver} {version}");
        }
    }
}
