//! Progress on stderr, for people who wait: a bar at a terminal, now and then a line elsewhere.

use super::failure::{Failure, INTERRUPTED_STATUS};
use super::streams;
use axistokes::progress::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long a computation stays quiet.
const PATIENCE: Duration = Duration::from_secs(2);
/// How long it is quiet after a line, at least.
const PAUSE: Duration = Duration::from_secs(2);
/// The same before a line that only says that it goes on; and the part of the time that has passed
/// that is added, so that no night's run fills a log.
const LONG_PAUSE: Duration = Duration::from_secs(5);
const LONGER: f64 = 0.05;

/// Whether Ctrl-C was pressed.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// A bar on stderr, or lines if that is no terminal; both only after two seconds.
pub struct StderrBar {
    bar: ProgressBar,
    start: Instant,
    /// Which of several questions it is, as a prefix.
    question: Mutex<String>,
    /// A bar that is not shown yet.
    hidden: AtomicBool,
    /// When the last line was written, if lines are.
    last_line: Option<Mutex<Option<Instant>>>,
}

impl StderrBar {
    /// A bar that is not shown yet.
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let template = "{prefix}{msg:10} {wide_bar} {pos}/{len} {eta}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let terminal = stderr().is_terminal();
        Self {
            bar,
            start: Instant::now(),
            question: Mutex::default(),
            hidden: AtomicBool::new(terminal),
            last_line: (!terminal).then(|| Mutex::new(None)),
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
        let long = LONG_PAUSE + self.start.elapsed().mul_f64(LONGER);
        self.say(long, || {
            let (stage, round) = (self.bar.message(), self.bar.prefix());
            let part = match (self.bar.position(), self.bar.length()) {
                (done, Some(all)) if all > 0 => format!(" {} %", 100 * done.min(all) / all),
                _ => String::new(),
            };
            format!("{round}{stage}{part}")
        });
    }

    /// Which of several questions it is; empty if there is one.
    fn question(&self) -> String {
        let question = self.question.lock();
        question.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Writes a line, if it is time for one: this long after the last.
    fn say(&self, pause: Duration, line: impl FnOnce() -> String) {
        // Whoever finds it locked would only say the same once more.
        let Some(Ok(mut last)) = self.last_line.as_ref().map(Mutex::try_lock) else {
            return;
        };
        let waited = last.is_none_or(|last| last.elapsed() > pause);
        if waited && self.start.elapsed() > PATIENCE && !self.is_cancelled() {
            streams::complain(&line());
            *last = Some(Instant::now());
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

    fn begin_question(&self, what: &'static str, number: usize, of: usize) {
        let mut question = self.question.lock().unwrap_or_else(PoisonError::into_inner);
        *question = format!("{what} {number} of {of}: ");
    }

    fn begin_round(&self, round: usize, error: Option<f64>) {
        let question = self.question();
        let Some(error) = error else {
            self.bar.set_prefix(question);
            return;
        };
        self.bar.set_prefix(format!(
            "{question}round {round} (error so far {error:.0e}): "
        ));
        self.say(PAUSE, || {
            let ended = round.saturating_sub(1);
            format!(
                "{question}round {ended}: estimated error {error:.1e}, going on with finer panels or modes"
            )
        });
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
