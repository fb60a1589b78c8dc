//! The frames that are still to be drawn, in order, each with the volume that it shows.
//!
//! A thread reads the next time while the present one is drawn. Where there is no memory for both, it is read when
//! the one before has gone.

use super::{
    ready::Ready,
    volumes::{Moment, Volumes},
};
use crate::cli::{Error, line::Line};
use std::sync::{
    Arc, Mutex, PoisonError,
    atomic::{AtomicUsize, Ordering},
    mpsc::{Receiver, SyncSender},
};

/// The place of a frame among those to be drawn, and its volume.
pub type Next = (usize, Result<Arc<Moment>, Error>);

/// Where those who draw take their next frame.
pub enum Feed<'a> {
    /// One volume for so many frames.
    Still {
        /// It.
        moment: Arc<Moment>,
        /// Frames that were taken.
        taken: AtomicUsize,
        /// Frames.
        count: usize,
    },
    /// Read ahead by another thread, until it is closed.
    Ahead(Mutex<Option<Receiver<Next>>>),
    /// Read when it is asked for, by the only one who draws; frames that were taken.
    Behind(Box<Mutex<(Volumes<'a>, usize)>>, &'a [f64]),
}

/// Reads what a feed hands out.
pub struct Ahead<'a> {
    /// All times.
    pub volumes: Volumes<'a>,
    /// The time of each frame that is to be drawn.
    pub times: &'a [f64],
    /// To the feed: one that waits until a frame is taken.
    pub sender: SyncSender<Next>,
}

impl<'a> Feed<'a> {
    /// Of what another thread reads.
    pub fn ahead(frames: Receiver<Next>) -> Self {
        Self::Ahead(Mutex::new(Some(frames)))
    }

    /// Of volumes that are read one by one.
    pub fn behind(volumes: Volumes<'a>, times: &'a [f64]) -> Self {
        Self::Behind(Box::new(Mutex::new((volumes, 0))), times)
    }

    /// Of one volume.
    pub fn still(moment: &Arc<Moment>, count: usize) -> Self {
        Self::Still {
            moment: Arc::clone(moment),
            taken: AtomicUsize::new(0),
            count,
        }
    }

    /// The next frame; `None` behind the last.
    pub fn next(&self) -> Option<Next> {
        match self {
            Self::Still {
                moment,
                taken,
                count,
            } => {
                let at = taken.fetch_add(1, Ordering::Relaxed);
                (at < *count).then(|| (at, Ok(Arc::clone(moment))))
            }
            Self::Ahead(frames) => {
                let frames = frames.lock().unwrap_or_else(PoisonError::into_inner);
                frames.as_ref()?.recv().ok()
            }
            Self::Behind(state, times) => {
                let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
                let (volumes, taken) = &mut *state;
                let at = *taken;
                let time = *times.get(at)?;
                *taken += 1;
                Some((at, volumes.at(time)))
            }
        }
    }

    /// Nobody takes a frame any more: who reads ahead stops.
    pub fn close(&self) {
        if let Self::Ahead(frames) = self {
            *frames.lock().unwrap_or_else(PoisonError::into_inner) = None;
        }
    }

    /// True where the volume of a frame has to go before the next frame is asked for.
    pub fn has_room_for_one(&self) -> bool {
        matches!(self, Self::Behind(..))
    }
}

/// The times of the frames that are to be drawn.
pub fn times_of(ready: &[Ready], wanted: &[u32]) -> Vec<f64> {
    let time = |&number: &u32| ready[number as usize].time;
    wanted.iter().map(time).collect()
}

impl Ahead<'_> {
    /// Reads one volume after the other, each kept as long as the next frame shows it too.
    pub fn read(mut self, line: &Line) {
        let _stops = line.stops_in_panic();
        let mut last: Option<(f64, Arc<Moment>)> = None;
        for (at, &time) in self.times.iter().enumerate() {
            let volume = match last.take() {
                Some((of, volume)) if of == time => Ok(volume),
                other => {
                    drop(other);
                    self.volumes.at(time)
                }
            };
            last = volume
                .as_ref()
                .ok()
                .map(|volume| (time, Arc::clone(volume)));
            let has_failed = volume.is_err();
            // Nobody takes it: those who draw have stopped.
            if self.sender.send((at, volume)).is_err() || has_failed {
                return;
            }
        }
    }
}
