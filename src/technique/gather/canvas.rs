//! The images that one picture is gathered in, and what was last done with each.

use super::super::{PatchRoom, Patches, RayTiles};
use crate::gpu::{Image, Use};
use std::sync::Arc;

/// What a technique gathers: premultiplied colour and alpha, or what a resolve classifies. Four f32 a pixel.
pub(crate) const PICTURE: usize = 0;

/// What a canvas is made for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CanvasDesc<'a> {
    /// Pixels across and down.
    pub extent: [u32; 2],
    /// Voxels of what is shown.
    pub dims: [u32; 3],
    /// Pixels of an intermediate image, where there is one.
    pub intermediate_room: [u32; 2],
    /// What rays that composite leave beside the picture is kept: a depth or another layer is asked for, or a brick goes
    /// on where another has ended.
    pub keeps_layers: bool,
    /// A canvas whose pictures are recorded for the same queue: lists that no picture leaves behind are shared with it.
    pub beside: Option<&'a Canvas>,
}

/// Images of one extent, [`PICTURE`] first, those of the technique after it.
#[derive(Debug)]
pub(crate) struct Canvas {
    extent: [u32; 2],
    images: Vec<(Image, Use)>,
    /// What comes next goes on from what is there.
    resumes: bool,
    /// Which tiles rays draw.
    pub tiles: Option<RayTiles>,
    /// Which parts of slices are drawn, and how large the lists of this picture get.
    pub patches: Option<(Arc<Patches>, PatchRoom)>,
}

impl Canvas {
    /// Of images that nothing is in yet.
    pub fn new(extent: [u32; 2], images: impl IntoIterator<Item = Image>) -> Self {
        let images = images.into_iter().map(|image| (image, Use::Nothing));
        Self {
            extent,
            images: images.collect(),
            resumes: false,
            tiles: None,
            patches: None,
        }
    }

    /// Pixels across and down.
    pub fn extent(&self) -> [u32; 2] {
        self.extent
    }

    /// An image by its number.
    pub fn image(&self, number: usize) -> &Image {
        &self.images[number].0
    }

    /// All images.
    pub fn images(&self) -> impl Iterator<Item = &Image> {
        self.images.iter().map(|(image, _)| image)
    }

    /// A picture begins: what the images hold is given up, and nothing unfinished uses them.
    pub fn begin(&mut self) {
        self.resumes = false;
        for (_, last) in &mut self.images {
            *last = Use::Nothing;
        }
    }

    /// The same where frames that are not done may still read the images.
    pub fn begin_anew(&mut self) {
        self.resumes = false;
        for (_, last) in &mut self.images {
            *last = Use::ShadersDone;
        }
    }

    /// A picture goes on: what comes next is put to what the images hold, bricks behind bricks or a frame onto those
    /// before it.
    pub fn resume(&mut self) {
        self.resumes = true;
    }

    /// Whether a picture goes on.
    pub fn resumes(&self) -> bool {
        self.resumes
    }

    pub(super) fn last_use(&mut self, number: usize) -> &mut Use {
        &mut self.images[number].1
    }
}
