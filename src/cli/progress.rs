//! Progress with time left, for whatever takes longer than a second; and the user's wish to stop.

use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

/// Time before a bar is shown.
const PATIENCE: Duration = Duration::from_secs(1);
const PARTS: u64 = 1000;

/// A progress bar on stderr. indicatif hides it where stderr is no terminal.
pub(super) struct Meter {
    what: &'static str,
    start: Instant,
    bar: Option<ProgressBar>,
    quiet: bool,
}

impl Meter {
    pub(super) fn new(what: &'static str, quiet: bool) -> Self {
        stopped(); // from here on, the first interrupt is an orderly stop
        Self {
            what,
            start: Instant::now(),
            bar: None,
            quiet,
        }
    }

    /// Shows the share that is done and says whether to go on.
    pub(super) fn update(&mut self, done: f64) -> ControlFlow<()> {
        if !self.quiet && self.bar.is_none() && self.start.elapsed() > PATIENCE {
            let style = ProgressStyle::with_template("{msg} {wide_bar} {percent}% {eta} left")
                .expect("the template is well formed");
            let bar = ProgressBar::new(PARTS).with_style(style);
            bar.set_message(self.what);
            self.bar = Some(bar.with_elapsed(self.start.elapsed()));
        }
        if let Some(bar) = &self.bar {
            bar.set_position((done * PARTS as f64) as u64);
        }
        if stopped().load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// A meter that several threads may tell.
pub(super) fn shared(what: &'static str, quiet: bool) -> impl Fn(f64) + Sync {
    let meter = Mutex::new(Meter::new(what, quiet));
    move |done| {
        if let Ok(mut meter) = meter.lock() {
            let _ = meter.update(done); // an interrupt ends the process at its second time
        }
    }
}

impl Drop for Meter {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Whether the user has interrupted (Ctrl-C, or a scheduler's SIGTERM). A second interrupt ends the process.
fn stopped() -> &'static AtomicBool {
    static STOPPED: OnceLock<&'static AtomicBool> = OnceLock::new();
    STOPPED.get_or_init(|| {
        let flag: &'static AtomicBool = Box::leak(Box::new(AtomicBool::new(false)));
        let handler = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        });
        // Without a handler an interrupt ends the process at once, which loses nothing that is already written.
        drop(handler);
        flag
    })
}
