//! Tells when the GPU began and ended a batch, without making the window wait.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc;
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use eframe::egui;

/// Milliseconds that a batch took, as soon as it is done; infinite when the device is gone.
pub(super) type Elapsed = Arc<OnceLock<f64>>;

#[derive(Debug)]
enum Ticket {
    /// What is queued before the batch ends here: it is not the batch's time.
    Begin(wgpu::SubmissionIndex),
    /// The batch ends here.
    End(wgpu::SubmissionIndex, Elapsed),
}

/// A thread that waits for submissions. It ends with the clock.
#[derive(Debug)]
pub(super) struct GpuClock {
    sender: mpsc::Sender<Ticket>,
}

impl GpuClock {
    /// Starts the thread.
    pub(super) fn new(device: wgpu::Device, ctx: egui::Context) -> std::io::Result<Self> {
        let (sender, receiver) = mpsc::channel::<Ticket>();
        std::thread::Builder::new().name("gpu-clock".to_owned()).spawn(move || {
            let mut start = Instant::now();
            for ticket in receiver {
                match ticket {
                    Ticket::Begin(before) => {
                        wait(&device, before);
                        start = Instant::now();
                    }
                    Ticket::End(after, elapsed) => {
                        let done = wait(&device, after);
                        let took = start.elapsed().as_secs_f64() * 1000.0;
                        elapsed.get_or_init(|| if done { took } else { f64::INFINITY });
                        ctx.request_repaint();
                    }
                }
            }
        })?;
        Ok(Self { sender })
    }

    /// A batch begins after this submission. To be called before the batch is submitted: software
    /// adapters may do the work within the submission.
    pub(super) fn begin(&self, before: wgpu::SubmissionIndex) {
        // Without its thread the clock answers at the end.
        drop(self.sender.send(Ticket::Begin(before)));
    }

    /// The batch ends with this submission; asks how long it took.
    pub(super) fn end(&self, after: wgpu::SubmissionIndex) -> Elapsed {
        let elapsed = Elapsed::default();
        if self.sender.send(Ticket::End(after, Arc::clone(&elapsed))).is_err() {
            elapsed.get_or_init(|| f64::INFINITY);
        }
        elapsed
    }
}

/// Waits for a submission; `false` when the device is gone, on which polling may panic.
fn wait(device: &wgpu::Device, index: wgpu::SubmissionIndex) -> bool {
    let poll = wgpu::PollType::Wait { submission_index: Some(index), timeout: None };
    catch_unwind(AssertUnwindSafe(|| device.poll(poll).is_ok())).unwrap_or(false)
}
