//! In which order the updates of a volume come: they are recorded as they were staged, for each was staged from voxels
//! that hold all before it.
//!
//! ```text
//! staged, in order     0  1  2  3
//! recorded             0              next is 1, and no other
//! 2 is dropped                        2 and 3 will never be: 3 was staged from voxels that hold 2
//! ```

use super::Error;
use crate::volume::VoxelBox;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The updates of one volume.
#[derive(Debug, Default)]
pub(super) struct Updates {
    state: Mutex<State>,
    /// How many are recorded.
    done: AtomicU64,
}

#[derive(Debug, Default)]
struct State {
    next: u64,
    /// Those that are staged and not recorded, in their order.
    waiting: VecDeque<u64>,
    /// Where a part of an update is recorded, and not all of it.
    half_changed: Option<VoxelBox>,
}

/// The turn of one update. Dropped before it is done, it takes all later ones with it.
#[derive(Debug)]
pub(super) struct Turn {
    of: Arc<Updates>,
    number: u64,
    region: VoxelBox,
}

impl Updates {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The turn after all that are staged.
    pub fn turn(self: &Arc<Self>, region: VoxelBox) -> Turn {
        let mut state = self.state();
        let number = state.next;
        state.next += 1;
        state.waiting.push_back(number);
        Turn {
            of: Arc::clone(self),
            number,
            region,
        }
    }

    /// How many are recorded.
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Acquire)
    }

    /// Refuses to draw voxels of which a part is new.
    pub fn check_whole(&self) -> Result<(), Error> {
        match self.state().half_changed {
            None => Ok(()),
            Some(region) => Err(Error::HalfUpdated { region }),
        }
    }
}

impl Turn {
    pub fn is_of(&self, updates: &Arc<Updates>) -> bool {
        Arc::ptr_eq(updates, &self.of)
    }

    /// Whether it may be recorded now.
    pub fn check(&self) -> Result<(), Error> {
        let state = self.of.state();
        match state
            .waiting
            .iter()
            .position(|&number| number == self.number)
        {
            Some(0) => {}
            Some(ahead) => {
                return Err(Error::UpdateOrder {
                    wanted: "the update that was staged first of those that are not recorded",
                    found: format!("one with {ahead} before it"),
                });
            }
            None => {
                return Err(Error::UpdateOrder {
                    wanted: "an update of voxels that are there",
                    found: "one that was staged after another, which was given up: stage it anew"
                        .into(),
                });
            }
        }
        match state.half_changed {
            Some(region) if !region.is_in(&self.region) => Err(Error::HalfUpdated { region }),
            _ => Ok(()),
        }
    }

    /// A part of it is recorded.
    pub fn begin(&self) {
        self.of.state().half_changed = Some(self.region);
    }

    /// All of it is recorded.
    pub fn end(&self) {
        let mut state = self.of.state();
        let front = state.waiting.pop_front();
        debug_assert_eq!(front, Some(self.number), "checked before");
        state.half_changed = None;
        self.of.done.fetch_add(1, Ordering::Release);
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        let mut state = self.of.state();
        if let Some(place) = state.waiting.iter().position(|&n| n == self.number) {
            state.waiting.truncate(place);
        }
    }
}
