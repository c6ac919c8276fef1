//! Jobs in parallel, one simulation a thread.

use super::{Outcome, Plan, Store, SweepError};
use crate::engine::run::Progress;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How often the wish to stop is looked for.
const WATCH: Duration = Duration::from_millis(50);

/// Does the jobs of the store's share that aren't done, on `threads` threads, and keeps each as it finishes. What comes
/// of a job doesn't depend on the others, nor on the number of threads.
///
/// # Errors
/// If `progress` says stop, or results can't be kept.
pub fn run(
    plan: &Plan,
    store: &mut Store,
    threads: NonZeroUsize,
    progress: &mut Progress<'_>,
) -> Result<(), SweepError> {
    let todo = store.todo();
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (sender, results) = mpsc::channel();
    let work = |sender: mpsc::Sender<Outcome>| {
        while !stop.load(Ordering::Relaxed)
            && let Some(job) = todo.get(next.fetch_add(1, Ordering::Relaxed))
            && let Some(outcome) = Outcome::of(plan, *job, &stop)
            && sender.send(outcome).is_ok()
        {}
    };
    let mut kept = Ok(());
    let mut left = todo.len();
    thread::scope(|scope| {
        for _ in 0..threads.get().min(todo.len()) {
            let (work, sender) = (&work, sender.clone());
            // A pool of one keeps the step's own parallel loops from taking up other jobs.
            scope.spawn(move || alone(|| work(sender)));
        }
        drop(sender);
        loop {
            match results.recv_timeout(WATCH) {
                Ok(outcome) => {
                    left -= 1;
                    if kept.is_ok() {
                        kept = store.keep(outcome);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            let done = 1.0 - left as f64 / todo.len() as f64;
            if kept.is_err() || progress(done).is_break() {
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
    kept?;
    match left {
        0 => Ok(()),
        _ => Err(SweepError::Interrupted {
            left,
            jobs: store.share(),
        }),
    }
}

fn alone(work: impl FnOnce() + Send) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("there is room for a thread").install(work);
}
