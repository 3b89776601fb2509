//! Tells when the GPU began and ended a batch, without making the window wait.
//!
//! A thread polls the device without blocking: a blocking wait would hold the lock that every
//! submission needs, the window's own frames included, until the batch is done.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use eframe::egui;

/// Milliseconds that a batch took, as soon as it is done; infinite when the device is gone.
pub(super) type Elapsed = Arc<OnceLock<f64>>;

/// How often the thread looks: a thirtieth of a batch.
const LOOK_EVERY: Duration = Duration::from_millis(1);

/// The moment at which the GPU has done what was submitted so far.
type Moment = Arc<OnceLock<Instant>>;

#[derive(Debug)]
struct Ticket {
    began: Moment,
    ended: Moment,
    elapsed: Elapsed,
}

/// Times batches of work on a queue. Its thread ends with it.
#[derive(Debug)]
pub(super) struct GpuClock {
    queue: wgpu::Queue,
    sender: mpsc::Sender<Ticket>,
    began: Moment,
}

impl GpuClock {
    /// Starts the thread.
    pub(super) fn new(device: wgpu::Device, queue: wgpu::Queue, ctx: egui::Context) -> std::io::Result<Self> {
        let (sender, receiver) = mpsc::channel::<Ticket>();
        std::thread::Builder::new().name("gpu-clock".to_owned()).spawn(move || {
            for Ticket { began, ended, elapsed } in receiver {
                let took = wait(&device, &ended).map_or(f64::INFINITY, |end| {
                    let start = began.get().copied().unwrap_or(end);
                    end.saturating_duration_since(start).as_secs_f64() * 1000.0
                });
                elapsed.get_or_init(|| took);
                ctx.request_repaint();
            }
        })?;
        Ok(Self { queue, sender, began: Moment::default() })
    }

    /// A batch begins when what is submitted now is done. To be called before it is submitted.
    pub(super) fn begin(&mut self) {
        self.began = self.moment();
    }

    /// The batch ends with what is submitted now; asks how long it took.
    pub(super) fn end(&self) -> Elapsed {
        let elapsed = Elapsed::default();
        let ticket =
            Ticket { began: Arc::clone(&self.began), ended: self.moment(), elapsed: Arc::clone(&elapsed) };
        if self.sender.send(ticket).is_err() {
            elapsed.get_or_init(|| f64::INFINITY);
        }
        elapsed
    }

    /// Becomes the moment at which the GPU has done everything submitted so far.
    fn moment(&self) -> Moment {
        let moment = Moment::default();
        let done = Arc::clone(&moment);
        self.queue.submit([]);
        self.queue.on_submitted_work_done(move || {
            done.get_or_init(Instant::now);
        });
        moment
    }
}

/// Waits for a moment; `None` when the device is gone, on which polling may panic.
fn wait(device: &wgpu::Device, moment: &Moment) -> Option<Instant> {
    loop {
        let alive = catch_unwind(AssertUnwindSafe(|| device.poll(wgpu::PollType::Poll).is_ok()));
        if let Some(&at) = moment.get() {
            return Some(at);
        }
        if !alive.unwrap_or(false) {
            return None;
        }
        std::thread::sleep(LOOK_EVERY);
    }
}
