//! Plays passes: from what each of them does with the images of the canvas follow the barriers between them.
//!
//! ```text
//! pass k uses image i as u; it was last used as v        barrier v -> u, unless v = u and both read
//! ```

use super::{Canvas, PICTURE};
use crate::gpu::{
    Gpu, Image, Load, Tile, Use, begin_rendering_behind, clear_image, end_rendering, image_barriers,
};
use ash::vk;

/// Images that one pass uses, at most.
const MOST_USES: usize = 4;

/// Records passes that use the images of one canvas.
#[derive(Debug)]
pub(crate) struct Player<'a> {
    pub gpu: &'a Gpu,
    pub cmd: vk::CommandBuffer,
    pub canvas: &'a mut Canvas,
}

impl Player<'_> {
    /// Orders what comes after what was last done with these images, in one barrier.
    ///
    /// # Safety
    /// The command buffer records outside rendering, and what is recorded next uses the images so.
    pub unsafe fn bring(&mut self, uses: impl IntoIterator<Item = (usize, Use)>) {
        let mut moved = [(PICTURE, Use::Nothing, Use::Nothing); MOST_USES];
        let mut count = 0;
        for (number, next) in uses {
            let last = std::mem::replace(self.canvas.last_use(number), next);
            if last != next || !next.is_read() {
                moved[count] = (number, last, next);
                count += 1;
            }
        }
        let moved = &moved[..count];
        let of =
            |&(number, last, next): &(usize, Use, Use)| (self.canvas.image(number), last, next);
        // SAFETY: the caller's promise; images live as long as their canvas.
        unsafe { image_barriers::<MOST_USES>(self.gpu, self.cmd, moved.iter().map(of)) };
    }

    /// What an image of depths holds is of no use any more.
    pub fn give_up_depth(&mut self, number: usize) {
        let last = self.canvas.last_use(number);
        if *last == Use::DepthTarget {
            *last = Use::DepthDone;
        }
    }

    /// Fills an image with zeros.
    ///
    /// # Safety
    /// As [`Self::bring`].
    pub unsafe fn clear(&mut self, number: usize) {
        // SAFETY: the caller's promise.
        unsafe {
            self.bring([(number, Use::TransferWrite)]);
            clear_image(self.gpu, self.cmd, self.image(number), [0.0; 4]);
        }
    }

    /// One rendering to an image that is in [`Use::ColorTarget`], with a depth attachment that is cleared to a depth.
    ///
    /// # Safety
    /// As [`Self::bring`]; `draw` records what may stand inside rendering.
    pub unsafe fn render(
        &self,
        (target, load): (usize, Load),
        depth: Option<(usize, f32)>,
        tile: Tile,
        draw: impl FnOnce(vk::CommandBuffer),
    ) {
        let attached = depth.map(|(number, depth)| (self.image(number).view(), depth));
        // SAFETY: the caller's promises.
        unsafe {
            let target = [(self.image(target).view(), load)];
            begin_rendering_behind(self.gpu, self.cmd, &target, attached, tile);
            draw(self.cmd);
            end_rendering(self.gpu, self.cmd);
        }
    }

    /// An image of the canvas.
    pub fn image(&self, number: usize) -> &Image {
        self.canvas.image(number)
    }
}
