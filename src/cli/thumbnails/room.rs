//! Memory that volumes share: who reads the next one waits until those before it have left room.

use std::sync::{Condvar, Mutex, PoisonError};

/// So many bytes for all volumes that are there at once.
#[derive(Debug)]
pub struct Room {
    bytes: u64,
    taken: Mutex<u64>,
    given_back: Condvar,
}

/// A part of the room, given back when dropped.
#[derive(Debug)]
pub struct Share<'a> {
    room: &'a Room,
    bytes: u64,
}

impl Room {
    /// Of so many bytes.
    pub fn new(bytes: u64) -> Self {
        Self {
            bytes,
            taken: Mutex::new(0),
            given_back: Condvar::new(),
        }
    }

    /// Waits until there are so many bytes. One that wants more than there are waits until it is alone.
    pub fn share(&self, bytes: u64) -> Share<'_> {
        let bytes = bytes.min(self.bytes);
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        while taken.saturating_add(bytes) > self.bytes {
            taken = self
                .given_back
                .wait(taken)
                .unwrap_or_else(PoisonError::into_inner);
        }
        *taken += bytes;
        Share { room: self, bytes }
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        let mut taken = self
            .room
            .taken
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *taken -= self.bytes;
        self.room.given_back.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{thread, time::Duration};

    #[test]
    fn no_more_is_shared_out_than_there_is_and_the_largest_is_alone() {
        let room = &Room::new(10);
        let peak = &Mutex::new((0, 0));
        thread::scope(|scope| {
            for bytes in [3, 4, 10, 7, 99, 1, 6, 5, 2] {
                scope.spawn(move || {
                    let share = room.share(bytes);
                    let change = |by: i64| {
                        let mut peak = peak.lock().expect("whole");
                        peak.0 += by;
                        peak.1 = peak.1.max(peak.0);
                    };
                    change(share.bytes as i64);
                    thread::sleep(Duration::from_millis(2));
                    change(-(share.bytes as i64));
                });
            }
        });
        let (left, most) = *peak.lock().expect("whole");
        assert!(left == 0 && most <= 10, "{most}");
    }
}
