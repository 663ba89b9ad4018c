//! Progress on stderr, for people who wait.

use super::failure::{Failure, INTERRUPTED_STATUS};
use axistokes::progress::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long a computation stays quiet.
const PATIENCE: Duration = Duration::from_secs(2);

/// Whether Ctrl-C was pressed.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// A bar on stderr: only if that is a terminal, and only after two seconds.
pub struct StderrBar {
    bar: ProgressBar,
    start: Instant,
    hidden: AtomicBool,
}

impl StderrBar {
    /// A bar that is not shown yet.
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg:10} {wide_bar} {pos}/{len} {eta}") {
            bar.set_style(style);
        }
        Self {
            bar,
            start: Instant::now(),
            hidden: AtomicBool::new(stderr().is_terminal()),
        }
    }

    /// The same, and Ctrl-C cancels what it shows. Pressed once more, it ends the program.
    pub fn stopped_by_ctrl_c() -> Result<Self, Failure> {
        ctrlc::set_handler(|| {
            if INTERRUPTED.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(INTERRUPTED_STATUS));
            }
        })
        .map_err(|error| Failure::Other(format!("cannot listen for Ctrl-C: {error}")))?;
        Ok(Self::new())
    }

    fn show_if_late(&self) {
        if self.hidden.load(Ordering::Relaxed)
            && self.start.elapsed() > PATIENCE
            && self.hidden.swap(false, Ordering::Relaxed)
        {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

impl Progress for StderrBar {
    fn begin(&self, stage: &'static str, steps: usize) {
        self.bar.set_message(stage);
        self.bar.set_length(steps as u64);
        self.bar.set_position(0);
        self.show_if_late();
    }

    fn advance(&self, steps: usize) {
        self.bar.inc(steps as u64);
        self.show_if_late();
    }

    fn is_cancelled(&self) -> bool {
        INTERRUPTED.load(Ordering::Relaxed)
    }
}

impl Drop for StderrBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
