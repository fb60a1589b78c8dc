//! Work on numbered items in stages that run at once: items are made by some threads, finished by others, and put in
//! order by the thread that waits for them all.
//!
//! ```text
//! read k + 1   |   draw k   |   encode k - 1, k - 2   |   write k - 3
//! ```
//!
//! No item is begun before those far enough below it are put, so that no more than a few wait in memory whichever
//! stage is the slowest. What comes out does not depend on who was faster: items are put by their numbers, and of
//! several errors the first one in that order counts.

use super::Error;
use std::{
    collections::BTreeMap,
    num::NonZero,
    sync::{
        Condvar, Mutex, MutexGuard, PoisonError,
        mpsc::{Receiver, channel},
    },
    thread,
};

/// How far the work is.
#[derive(Debug)]
pub struct Line {
    state: Mutex<State>,
    moved: Condvar,
    /// Items that may be under way at once.
    most: usize,
}

#[derive(Debug, Default)]
struct State {
    put: usize,
    is_stopped: bool,
}

impl Line {
    /// For at most so many items under way, one at least.
    pub fn new(most: usize) -> Self {
        Self {
            state: Mutex::default(),
            moved: Condvar::new(),
            most: most.max(1),
        }
    }

    /// Waits until item `at` may be begun. False: the work was stopped, and nothing more is wanted.
    pub fn enter(&self, at: usize) -> bool {
        let mut state = self.state();
        while !state.is_stopped && at >= state.put + self.most {
            state = self
                .moved
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
        !state.is_stopped
    }

    /// Nothing more is begun.
    pub fn stop(&self) {
        self.state().is_stopped = true;
        self.moved.notify_all();
    }

    /// Takes items as they come, lets `threads` threads finish them, and puts them in order, from 0 up and without a
    /// gap, until all senders are gone or `put` fails.
    pub fn run<A: Send, B: Send>(
        &self,
        items: Receiver<(usize, A)>,
        threads: usize,
        finish: impl Fn(usize, A) -> B + Sync,
        mut put: impl FnMut(usize, B) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (sender, finished) = channel();
        let (items, finish) = (&Mutex::new(items), &finish);
        thread::scope(|scope| {
            for _ in 0..threads.max(1) {
                let sender = sender.clone();
                scope.spawn(move || {
                    let _stops = self.stops_in_panic();
                    loop {
                        let item = items.lock().unwrap_or_else(PoisonError::into_inner).recv();
                        let Ok((at, item)) = item else { return };
                        if sender.send((at, finish(at, item))).is_err() {
                            return;
                        }
                    }
                });
            }
            drop(sender);
            let _stops = self.stops_in_panic();
            let mut waiting = BTreeMap::new();
            let mut next = 0;
            for (at, item) in finished {
                waiting.insert(at, item);
                while let Some(item) = waiting.remove(&next) {
                    put(next, item).inspect_err(|_| self.stop())?;
                    next += 1;
                    self.state().put = next;
                    self.moved.notify_all();
                }
            }
            Ok(())
        })
    }

    /// Held by a thread of the work: nobody waits for one that has panicked.
    pub fn stops_in_panic(&self) -> impl Drop {
        StopsInPanic(self)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct StopsInPanic<'a>(&'a Line);

impl Drop for StopsInPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.stop();
        }
    }
}

/// Threads that encode pictures of so many pixels: as many as there are cores, few enough that what waits for them
/// stays small.
pub fn encoders([width, height]: [u32; 2]) -> usize {
    const MOST: usize = 4;
    const MOST_BYTES: usize = 512 << 20;
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let bytes = width as usize * height as usize * size_of::<[f32; 4]>();
    (MOST_BYTES / bytes.max(1)).clamp(1, cores.min(MOST))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    /// Numbers from 0 up, made by `makers` threads and slow or fast by what they are; what was put, and the most that
    /// were under way.
    fn put_by(makers: usize, most: usize, failing: Option<usize>) -> (Vec<usize>, usize, bool) {
        const COUNT: usize = 60;
        let line = &Line::new(most);
        let (next, under_way, peak) = (
            AtomicUsize::new(0),
            AtomicUsize::new(0),
            AtomicUsize::new(0),
        );
        let [next, under_way, peak] = [&next, &under_way, &peak];
        let (sender, items) = channel();
        let mut put = Vec::new();
        let ended = thread::scope(|scope| {
            for _ in 0..makers {
                let sender = sender.clone();
                scope.spawn(move || {
                    loop {
                        let at = next.fetch_add(1, Ordering::SeqCst);
                        if at >= COUNT || !line.enter(at) {
                            return;
                        }
                        let now = under_way.fetch_add(1, Ordering::SeqCst) + 1;
                        peak.fetch_max(now, Ordering::SeqCst);
                        thread::sleep(Duration::from_micros(97 * (at as u64 * 7 % 5)));
                        if sender.send((at, at)).is_err() {
                            return;
                        }
                    }
                });
            }
            drop(sender);
            line.run(
                items,
                3,
                |at, item| {
                    thread::sleep(Duration::from_micros(89 * (at as u64 * 11 % 7)));
                    3 * item
                },
                |at, item| {
                    assert_eq!(item, 3 * at);
                    if Some(at) == failing {
                        return Err(Error::Memory(at.to_string()));
                    }
                    under_way.fetch_sub(1, Ordering::SeqCst);
                    put.push(at);
                    Ok(())
                },
            )
        });
        (put, peak.load(Ordering::SeqCst), ended.is_ok())
    }

    #[test]
    fn items_are_put_in_order_whoever_is_faster() {
        for (makers, most) in [(1, 1), (1, 4), (3, 2), (4, 5)] {
            let (put, peak, is_ok) = put_by(makers, most, None);
            assert!(is_ok && put == (0..60).collect::<Vec<_>>(), "{put:?}");
            assert!(peak <= most, "{peak} under way, {most} allowed");
        }
    }

    #[test]
    fn an_item_that_cannot_be_put_ends_the_work_and_those_before_it_are_put() {
        for makers in [1, 3] {
            let (put, _, is_ok) = put_by(makers, 4, Some(17));
            assert!(!is_ok && put == (0..17).collect::<Vec<_>>(), "{put:?}");
        }
    }

    #[test]
    fn a_large_picture_has_one_encoder_and_a_small_one_no_more_than_cores() {
        assert_eq!(encoders([32_768, 32_768]), 1);
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        assert!((1..=cores).contains(&encoders([64, 64])));
    }
}
