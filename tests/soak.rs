//! Soak test: a light is dragged hundreds of times, as in a window, and no resource may leak.
//!
//! `script/soak HOURS` drags for hours and checks frame times as well.

#![expect(clippy::print_stdout, reason = "what was counted, for whoever reads the log")]

use std::time::{Duration, Instant};

use chiaroscuro_render::{
    GpuContext, RenderOptions, Renderer, TestSwitches, WorkOptions, device_descriptor, plan::RenderRequest,
};
use chiaroscuro_scene::{LightVolumeResolution, ReconstructionKernel, RenderEngine, Settings, first_look};
use chiaroscuro_volume::{Dataset, Histogram, synthetic::builtin};

/// Number of drags in the ordinary run; after every hundred the settings are those of the start.
const DRAGS: usize = 400;

/// Number of drags in the long version.
const MANY_DRAGS: usize = 1000;

/// Number of drags that may still allocate, while pipelines, caches and the driver's pools fill up.
const WARM_UP: usize = 200;
/// Number of previews after which the drag pauses and the picture is drawn at full quality.
const PREVIEWS_PER_REST: usize = 10;

/// Growth of the process after warm-up that is tolerated, in bytes. A leak of a single small object per drag would be
/// seen in the counts; this bounds what is not counted. 4 KiB were seen.
const HOST_GROWTH_LIMIT: u64 = 2 << 20;

/// Largest relative drift of the median preview time over hours.
const MAX_DRIFT: f64 = 0.05;

struct Soak {
    instance: wgpu::Instance,
    renderer: Renderer,
    dataset: Dataset,
    settings: Settings,
    /// Number of light slabs that are marched at a time.
    chunk: Option<u32>,
}

impl Soak {
    fn new() -> Self {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        let adapter = adapters.first().expect("the soak needs a graphics adapter");
        let (device, queue) =
            pollster::block_on(adapter.request_device(&device_descriptor(adapter))).expect("a device");
        let context = GpuContext::new(adapter, device, queue).expect("a usable device");
        let volume = builtin("chair", Some(32)).expect("the chair");
        let settings = first_look::first_settings(&volume, &Histogram::from_volume(&volume));
        let renderer = Renderer::new(&context).expect("a renderer");
        Self { instance, renderer, dataset: Dataset::new(volume), settings, chunk: None }
    }

    /// Moves the light, and sometimes the camera and the transfer function; draws a preview or a full picture.
    fn drag(&mut self, at: usize) -> Duration {
        let start = Instant::now();
        // Three turns in a hundred drags, which end at the start: lists of bricks differ with the light's position.
        let turn = glam::DQuat::from_rotation_z(0.03 * std::f64::consts::TAU * (at % 100) as f64);
        let home = glam::DVec3::new(1.2, -1.5, 1.8);
        self.settings.lights[0].position = (turn * home).into();
        if at.is_multiple_of(7) {
            self.settings.camera.orbit(3.0, 0.2);
        }
        if at.is_multiple_of(50) {
            self.settings.layer_mut().transfer.points[0].value +=
                if at.is_multiple_of(100) { 0.5 } else { -0.5 };
        }
        self.draw(at.is_multiple_of(PREVIEWS_PER_REST));
        start.elapsed()
    }

    /// Draws a picture at rest, or a preview.
    fn draw(&mut self, is_rest: bool) {
        let mut settings = self.settings.clone();
        if !is_rest {
            settings.sampling.kernel = ReconstructionKernel::Prefiltered;
            settings.shadows.kernel = ReconstructionKernel::Prefiltered;
        }
        let request = RenderRequest {
            volume: self.dataset.id(),
            settings,
            size: if is_rest { [96, 72] } else { [48, 36] },
            preview_resolution: (!is_rest).then_some(LightVolumeResolution::Quarter),
        };
        let options = RenderOptions {
            work: WorkOptions { preview: !is_rest, ..WorkOptions::default() },
            switches: TestSwitches { chunk: self.chunk, ..TestSwitches::default() },
            ..RenderOptions::default()
        };
        let mut job = self.renderer.begin(&self.dataset, request, &options).expect("a job");
        while job.step().expect("a step") {}
        self.renderer.context().wait().expect("it is done");
        self.renderer.read_display().expect("a picture");
    }

    /// Counts of objects of every kind in the graphics library, and bytes of the textures.
    fn resource_counts(&self) -> [(&'static str, u64); 9] {
        self.renderer.context().wait().expect("nothing is in flight");
        let report = self.instance.generate_report().expect("a native library counts");
        let hub = report.hub_report();
        let count = |registry: &wgpu::wgc::registry::RegistryReport| registry.num_allocated as u64;
        [
            ("buffers", count(&hub.buffers)),
            ("textures", count(&hub.textures)),
            ("texture views", count(&hub.texture_views)),
            ("samplers", count(&hub.samplers)),
            ("bind groups", count(&hub.bind_groups)),
            ("bind group layouts", count(&hub.bind_group_layouts)),
            ("compute pipelines", count(&hub.compute_pipelines)),
            ("command buffers", count(&hub.command_buffers) + count(&hub.command_encoders)),
            ("bytes of textures", self.renderer.gpu_bytes()),
        ]
    }
}

/// Resident memory of this process, in bytes, where the system reports it.
fn resident_bytes() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmRSS:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    times.get(times.len() / 2).map_or(0.0, Duration::as_secs_f64)
}

#[test]
fn light_sheets_are_released_with_the_light() {
    let mut soak = Soak::new();
    let textures =
        |soak: &Soak| soak.resource_counts().iter().find(|(what, _)| *what == "textures").map(|(_, n)| *n);
    let orbit = |soak: &mut Soak| {
        soak.settings.camera.orbit(3.0, 0.2);
        soak.draw(true);
    };
    // A picture that fills a light volume leaves its sheets to the next; one that fills none releases them. Two,
    // because two targets alternate.
    soak.draw(true);
    soak.settings.lights[0].position[0] += 0.1;
    soak.draw(true);
    let filled = textures(&soak);
    orbit(&mut soak);
    assert_eq!(textures(&soak), filled.map(|n| n - 1), "the sheets are gone, and nothing holds on to them");
    // Sheets of another size replace them.
    for (chunk, resolution) in [
        (4, LightVolumeResolution::Full),
        (8, LightVolumeResolution::Half),
        (64, LightVolumeResolution::Full),
    ] {
        soak.settings.shadows.resolution = resolution;
        soak.settings.lights[0].position[0] += 0.1;
        soak.chunk = Some(chunk);
        soak.draw(true);
        orbit(&mut soak);
    }
    let drag = |soak: &mut Soak| {
        soak.settings.lights[0].position[0] += 0.1;
        soak.draw(true);
        orbit(soak);
        soak.resource_counts()
    };
    // Spare light volumes have one size after a few drags.
    for _ in 0..3 {
        drag(&mut soak);
    }
    let before = drag(&mut soak);
    for _ in 0..4 {
        assert_eq!(drag(&mut soak), before);
    }
}

#[test]
fn scattering_leaks_nothing() {
    let mut soak = Soak::new();
    soak.settings.sampling.engine = RenderEngine::Scatter;
    let drag = |soak: &mut Soak| {
        soak.settings.lights[0].position[0] += 0.05;
        soak.draw(true);
        soak.resource_counts()
    };
    // Light volumes that are kept beside the current one are allocated first.
    for _ in 0..4 {
        drag(&mut soak);
    }
    let before = drag(&mut soak);
    for _ in 0..4 {
        assert_eq!(drag(&mut soak), before);
    }
}

#[test]
fn drags_leak_nothing() {
    drag_and_check(DRAGS, 0.0);
}

#[test]
#[ignore = "long: counts over 1000 drags, or hours; script/test --all runs it"]
fn a_thousand_drags_leak_nothing() {
    let hours = std::env::var("CHIAROSCURO_SOAK_HOURS");
    drag_and_check(MANY_DRAGS, hours.map_or(0.0, |hours| hours.parse().expect("a number of hours")));
}

/// Drags a number of times, and for a number of hours, and checks the resource counts after every hundred drags.
fn drag_and_check(drags: usize, hours: f64) {
    let mut soak = Soak::new();
    let start = Instant::now();
    let (mut first, mut memory) = (None, None);
    let (mut early, mut late) = (Vec::new(), Vec::new());
    let mut at = 1;
    while at <= drags || start.elapsed().as_secs_f64() < hours * 3600.0 {
        let took = soak.drag(at);
        let share = start.elapsed().as_secs_f64() / (hours * 3600.0).max(1e-9);
        if !at.is_multiple_of(PREVIEWS_PER_REST) && at > WARM_UP {
            if share < 0.1 {
                early.push(took);
            } else if share > 0.9 {
                late.push(took);
            }
        }
        // A hundred drags end at the start: the picture at rest, the transfer function unchanged.
        if at >= WARM_UP && at.is_multiple_of(100) {
            let kept = soak.resource_counts();
            assert_eq!(*first.get_or_insert(kept), kept, "after {at} drags");
            let resident = resident_bytes();
            let before = *memory.get_or_insert(resident);
            if let (Some(before), Some(now)) = (before, resident) {
                assert!(now <= before + HOST_GROWTH_LIMIT, "{before} bytes grew to {now} after {at} drags");
            }
        }
        at += 1;
    }
    println!("{at} drags; {:?}; resident {:?}, {:?} at first", first, resident_bytes(), memory.flatten());
    // Frame times are meaningful only over hours.
    if hours > 0.0 {
        let (early, late) = (median(early), median(late));
        println!("median preview {:.2} ms early, {:.2} ms late", early * 1e3, late * 1e3);
        assert!(late <= early * (1.0 + MAX_DRIFT), "previews got slower");
    }
}
