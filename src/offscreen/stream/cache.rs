//! Bricks that are on the device, as many as there is room for.
//!
//! What has to leave is first what the picture does not show, longest unused first; then what it has shown, the newest
//! first, for the next picture begins with the others again; what it still waits for comes last.

use super::Stream;
use crate::gpu::{self, Headless};
use crate::offscreen::Error;
use crate::offscreen::upload::fill;
use crate::resident::{EmptySpace, GpuVolume, Halo, MacroCells};
use crate::technique::{Skip, Skippable};
use crate::transfer::VisibleRanges;
use crate::volume::Volume;
use std::collections::{HashMap, HashSet};

/// Each brick has memory of its own, of which Vulkan lets a device have 4096 pieces.
const MOST_BRICKS: usize = 2048;

/// A brick on the device.
#[derive(Debug)]
pub struct Resident {
    /// Its one brick.
    pub volume: GpuVolume,
    cells: Option<(Halo, MacroCells)>,
    empty: Option<EmptySpace>,
    /// As the driver counts them.
    bytes: u64,
    /// Of these the empty space.
    empty_bytes: u64,
    /// Number of the picture that it was last drawn in, and of the brick in it.
    used: (u64, u64),
}

impl Resident {
    /// What recordings are told of where not to look; nothing where the cells were made for a narrower filter.
    pub fn skip(&self, (wanted, halo): (&Skippable, Halo)) -> Skip<'_> {
        match (wanted, self.cells_for(halo), &self.empty) {
            (Skippable::Unseen(_), Some(cells), Some(empty)) => Skip::Unseen(cells, empty),
            (Skippable::Exceeded, Some(cells), _) => Skip::Exceeded(cells),
            _ => Skip::Nothing,
        }
    }

    fn cells_for(&self, halo: Halo) -> Option<&MacroCells> {
        let cells = self.cells.as_ref().filter(|(of, _)| of.covers(halo));
        cells.map(|(_, cells)| cells)
    }
}

/// Bricks by their number.
#[derive(Debug, Default)]
pub struct Cache {
    bricks: HashMap<usize, Resident>,
    bytes: u64,
    /// Of the largest brick so far, with all that was made of it.
    largest_bytes: u64,
    /// What the bricks' empty spaces are of.
    seen: Option<VisibleRanges>,
    /// Bricks that the picture has not drawn yet.
    waiting: HashSet<usize>,
    picture: u64,
    drawn: u64,
    /// Bytes that were brought to the device in all.
    pub uploaded_bytes: u64,
}

impl Cache {
    /// A new picture of these bricks begins.
    pub fn begin(&mut self, shown: &[usize]) {
        self.picture += 1;
        self.drawn = 0;
        self.waiting = shown.iter().copied().collect();
    }

    /// A brick that is there.
    pub fn get(&self, brick: usize) -> Option<&Resident> {
        self.bricks.get(&brick)
    }

    /// Any brick.
    pub fn any(&self) -> Option<&Resident> {
        self.bricks.values().next()
    }

    /// The number of any brick.
    pub fn any_number(&self) -> Option<usize> {
        self.bricks.keys().next().copied()
    }

    /// The brick has been drawn, or is not needed.
    pub fn drawn(&mut self, brick: usize) {
        self.drawn += 1;
        self.waiting.remove(&brick);
        let used = (self.picture, self.drawn);
        if let Some(resident) = self.bricks.get_mut(&brick) {
            resident.used = used;
        }
    }

    /// Lets bricks leave until there is room for one more. False where too few may go, as `kept` stay.
    pub fn make_room(&mut self, device: &mut Headless, stream: &Stream, kept: &[usize]) -> bool {
        // Small things lie in blocks, the largest of 64 MiB.
        let reserve = (stream.all_device_bytes / 16).min(64 << 20);
        loop {
            let more = self.largest_bytes;
            let all = device
                .gpu()
                .memory()
                .reserved_bytes
                .saturating_add(more + reserve);
            let fits = self.bytes + more <= stream.device_bytes
                && all <= stream.all_device_bytes
                && self.bricks.len() < MOST_BRICKS;
            if fits || !self.drop_one(kept) {
                return fits;
            }
            device.tidy();
        }
    }

    /// Brings a brick to the device, with what pictures that leave out `wanted` need of it. Bricks of `kept` stay, all
    /// others may have to leave.
    ///
    /// # Errors
    /// Where the device gives no memory though nothing else is there.
    pub fn put(
        &mut self,
        device: &mut Headless,
        stream: &Stream,
        brick: usize,
        voxels: &Volume,
        (wanted, halo): (&Skippable, Halo),
        kept: &[usize],
    ) -> Result<(), Error> {
        let cell = stream.cells()[brick];
        self.make_room(device, stream, kept);
        let before = device.gpu().memory().used_bytes;
        let made = loop {
            let made = GpuVolume::brick_of(device.gpu(), stream.whole(), cell, voxels);
            match made {
                Err(gpu::Error::OutOfMemory { .. }) if self.drop_one(kept) => device.tidy(),
                made => break made?,
            }
        };
        let texels_bytes = made.staging_bytes(cell.stored);
        fill(device, &made, voxels)?;
        let cells = match wanted {
            Skippable::Nothing | Skippable::UnseenOrAlike(..) => None,
            _ => if_it_fits(MacroCells::of_voxels(device.gpu(), &made, halo, voxels))?,
        };
        let bytes = device.gpu().memory().used_bytes.saturating_sub(before);
        self.bytes += bytes;
        self.largest_bytes = self.largest_bytes.max(bytes);
        self.uploaded_bytes += texels_bytes;
        let resident = Resident {
            volume: made,
            cells: cells.map(|cells| (halo, cells)),
            empty: None,
            bytes,
            empty_bytes: 0,
            used: (0, 0),
        };
        self.bricks.insert(brick, resident);
        Ok(())
    }

    /// Finds out where these bricks are empty, as far as that is not known.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn find_empty_space(
        &mut self,
        device: &mut Headless,
        (wanted, halo): (&Skippable, Halo),
        bricks: &[usize],
    ) -> Result<(), Error> {
        let Skippable::Unseen(seen) = wanted else {
            return Ok(());
        };
        if self.seen.as_ref() != Some(seen) {
            self.seen = Some(seen.clone());
            for there in self.bricks.values_mut() {
                there.empty = None;
                there.bytes -= there.empty_bytes;
                self.bytes -= there.empty_bytes;
                there.empty_bytes = 0;
            }
        }
        let mut made: Vec<(usize, EmptySpace, u64)> = Vec::new();
        for brick in bricks {
            let there = self.bricks.get(brick);
            let there = there.filter(|there| there.empty.is_none());
            let Some(cells) = there.and_then(|there| there.cells_for(halo)) else {
                continue;
            };
            let newest = made.last().map(|(_, empty, _)| empty);
            let before = device.gpu().memory().used_bytes;
            let other = self.bricks.values().find_map(|there| there.empty.as_ref());
            let empty = match newest.or(other) {
                Some(other) => other.of_others(cells),
                None => EmptySpace::new(device.gpu(), cells, seen),
            };
            let bytes = device.gpu().memory().used_bytes.saturating_sub(before);
            made.extend(if_it_fits(empty)?.map(|empty| (*brick, empty, bytes)));
        }
        if made.is_empty() {
            return Ok(());
        }
        device.run(|cmd| {
            for (_, empty, _) in &made {
                // SAFETY: recorded outside rendering; the cells are complete; `run` waits, and all lives meanwhile.
                unsafe { empty.record(cmd)? };
            }
            Ok(())
        })?;
        for (brick, empty, bytes) in made {
            let there = self.bricks.get_mut(&brick).expect("found above");
            there.empty = Some(empty);
            there.empty_bytes = bytes;
            there.bytes += bytes;
            self.bytes += bytes;
            self.largest_bytes = self.largest_bytes.max(there.bytes);
        }
        Ok(())
    }

    /// False where nothing is left that may go.
    fn drop_one(&mut self, kept: &[usize]) -> bool {
        let rank = |brick: usize, used: (u64, u64)| match () {
            () if self.waiting.contains(&brick) => (2, 0),
            () if used.0 == self.picture => (1, u64::MAX - used.1),
            () => (0, used.0),
        };
        let others = self
            .bricks
            .iter()
            .filter(|(brick, _)| !kept.contains(brick));
        let next = others.min_by_key(|&(&brick, there)| (rank(brick, there.used), brick));
        let Some((&brick, _)) = next else {
            return false;
        };
        let gone = self.bricks.remove(&brick).expect("found above");
        self.bytes -= gone.bytes;
        true
    }
}

/// Without memory for it the picture is the same, only slower.
pub fn if_it_fits<T>(made: Result<T, gpu::Error>) -> Result<Option<T>, Error> {
    match made {
        Ok(made) => Ok(Some(made)),
        Err(gpu::Error::Limit { .. } | gpu::Error::OutOfMemory { .. }) => Ok(None),
        Err(other) => Err(other.into()),
    }
}
