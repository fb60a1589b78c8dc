//! Half-angle slices in steps, so that no submission takes long: of each slice first what the eye sees, then what the
//! light sees, each in bands.

use super::{HalfAngleBindings, HalfAngleSlicer, HalfAngleSlices};
use crate::gpu::{Image, Tile};
use ash::vk;
use std::ops::Range;

/// All slices of a picture, cut into steps that follow each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps {
    slices: HalfAngleSlices,
    eye: Bands,
    light: Bands,
}

/// A picture from top to bottom in bands.
#[derive(Clone, Copy, Debug)]
struct Bands {
    extent: [u32; 2],
    rows: u32,
}

impl Bands {
    /// So many, as far as its rows go.
    fn new(extent: [u32; 2], count: u32) -> Self {
        let rows = extent[1].div_ceil(count.max(1)).max(1);
        Self { extent, rows }
    }

    fn count(&self) -> u64 {
        self.extent[1].div_ceil(self.rows).into()
    }

    fn tile(&self, number: u64) -> Tile {
        let first = number as u32 * self.rows;
        Tile {
            origin: [0, first],
            extent: [self.extent[0], self.rows.min(self.extent[1] - first)],
        }
    }
}

impl Steps {
    /// Of the pictures of eye and light, each of them in so many bands.
    pub fn new(slices: HalfAngleSlices, [eye, light]: [[u32; 2]; 2], bands: u32) -> Self {
        Self {
            slices,
            eye: Bands::new(eye, bands),
            light: Bands::new(light, bands),
        }
    }

    /// How many there are: at least one, which clears.
    pub fn count(&self) -> u64 {
        (self.a_slice() * u64::from(self.slices.count)).max(1)
    }

    fn a_slice(&self) -> u64 {
        self.eye.count() + self.light.count()
    }

    /// Records some of them; the first clears.
    ///
    /// # Safety
    /// As [`HalfAngleSlicer::record`], in the order of the steps.
    pub unsafe fn record(
        &self,
        slicer: &HalfAngleSlicer,
        cmd: vk::CommandBuffer,
        bindings: &HalfAngleBindings,
        picture: &Image,
        light: &Image,
        part: Range<u64>,
    ) {
        let (slices, target) = (self.slices, (picture, self.eye.extent));
        let (per_slice, of_eye) = (self.a_slice(), self.eye.count());
        if part.start == 0 {
            // SAFETY: the caller's promises, here and below.
            unsafe { slicer.record_clear(cmd, target, light) };
        }
        for step in part {
            let (slice, step) = ((step / per_slice) as u32, step % per_slice);
            if slice >= slices.count {
                break;
            }
            // SAFETY: as above.
            unsafe {
                match step.checked_sub(of_eye) {
                    None => {
                        let place = (slice, self.eye.tile(step));
                        slicer.record_eye(cmd, bindings, slices, target, light, place);
                    }
                    Some(step) => {
                        let place = (slice, self.light.tile(step));
                        slicer.record_light(cmd, bindings, slices, light, place);
                    }
                }
            }
        }
    }
}
