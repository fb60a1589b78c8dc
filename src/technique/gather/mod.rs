//! The passes in which a technique makes a picture: its pipelines, the images of one picture, what is bound for its
//! bricks, and what is recorded.
//!
//! ```text
//! technique.desc().gather(&desc)             pipelines, once
//!     gather.canvas(&desc)                   images of one picture at a time
//!     gather.bind(&canvas, inputs)           descriptor sets of all bricks
//!         bound.record(player, bricks, part)     passes; parts follow each other
//! ```
//!
//! Frames of a host, pictures of our own queue and volumes that come brick by brick all play these passes, through one
//! [`Player`], which puts the barriers between them. A pass is a call of the player that names the images that it uses;
//! no list of passes is stored, for nothing would read it but the player.

mod canvas;
mod patches;
mod player;
mod rays;
#[cfg(test)]
mod seams;
mod slices;

pub(crate) use canvas::{Canvas, CanvasDesc, PICTURE};
pub(crate) use player::Player;
pub(crate) use rays::{LAYERS, PATH_LAYERS, depth_of_slices};
pub(super) use {
    rays::{RayPass, rays, rays_of},
    slices::slices,
};

use super::blend::Drawn;
use super::{DepthAccess, Inputs, Order, Settings, ShaderVariant};
use crate::gpu::{Error, Gpu, Resource, Tile};
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

/// What the pipelines of a technique depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatherDesc<'a> {
    pub gpu: &'a Arc<Gpu>,
    pub settings: &'a Settings,
    pub variant: &'a ShaderVariant,
    /// Of slices: the picture, or how many samples it takes.
    pub drawn: Drawn,
    /// What hides samples of slices.
    pub depth_access: DepthAccess,
    /// Of slices only patches are drawn, which the canvas has lists for.
    pub is_patched: bool,
}

/// The pipelines of a technique.
pub(crate) trait Gather: Debug + Send + Sync {
    /// Images and lists of one picture at a time.
    ///
    /// # Errors
    /// An extent over a limit of the device, no memory.
    fn canvas(&self, desc: &CanvasDesc) -> Result<Canvas, Error>;

    /// Binds the inputs of all bricks, the canvas, and the depth buffer of a host, a texture as large as the picture.
    ///
    /// # Errors
    /// Where an input is missing.
    fn bind(
        &self,
        canvas: &Canvas,
        bricks: &[Inputs],
        host_depth: Option<Resource>,
    ) -> Result<Box<dyn Bound>, Error>;
}

/// What is bound for all bricks of a picture.
pub(crate) trait Bound: Debug + Send + Sync {
    /// How many steps make a picture that is no sum of tiles, where steps that can be are cut into so many bands;
    /// `None`: it is cut by tiles.
    fn steps(&self, _: &Canvas, _: &[BrickPass], _bands: u32) -> Option<u64> {
        None
    }

    /// Records a part of a picture: all `bricks`, in their order, of some of its tiles, or some of its steps. The last
    /// part leaves the images of the canvas in [`Use::FragmentSampled`](crate::gpu::Use::FragmentSampled).
    ///
    /// # Errors
    /// A picture larger than the device can dispatch.
    ///
    /// # Safety
    /// - the player records outside rendering, into the canvas that was bound;
    /// - parts are recorded and submitted in their order; all that is bound lives until the last has run;
    /// - the inputs are in `Use::Sampled`; a host's depth is visible to compute and fragment shaders.
    unsafe fn record(
        &self,
        player: &mut Player,
        bricks: &[BrickPass],
        part: &Part,
    ) -> Result<(), Error>;
}

/// What is recorded for one brick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BrickPass {
    /// Which of those that were bound.
    pub number: usize,
    /// Of its parameters in the ring.
    pub offset: u32,
    /// Slices to draw.
    pub slices: u32,
    /// How they are blended.
    pub order: Order,
    /// The pixels that it may change, where those are known; the first of several has to write all.
    pub seen: Option<Tile>,
}

/// A part of a picture.
#[derive(Clone, Debug)]
pub(crate) struct Part<'a> {
    /// The pixels, of what is cut by tiles.
    pub tiles: &'a [Tile],
    /// The steps ([`Bound::steps`]) of what is not, and how many bands each of them was cut into.
    pub steps: Range<u64>,
    /// See above.
    pub bands: u32,
    /// No other part is recorded before it.
    pub is_first: bool,
    /// None comes after it.
    pub is_last: bool,
}
