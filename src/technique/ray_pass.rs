//! The compute pass of a picture by rays, whatever its mode.

use super::projection::Projection;
use super::raycast::Raycast;
use super::{Inputs, Mix, RayBindings, RayTiles, Settings, Words};
use crate::gpu::{Error, Gpu, Image, Resource, Tile};
use ash::vk;
use std::sync::Arc;

/// Rays that composite, or that project.
#[derive(Debug)]
pub enum RayPass {
    /// Colours, and what lies beside them.
    Raycast(Raycast),
    /// One number a ray, which the resolve classifies.
    Projection(Projection),
}

impl RayPass {
    /// Compiles the variant of the settings and these words.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn new(gpu: &Arc<Gpu>, settings: &Settings, words: &Words) -> Result<Self, Error> {
        let mode = settings.mode;
        Ok(match mode.is_projection() {
            _ if settings.per_mode.exact_maximum => {
                Self::Projection(Projection::exact(gpu, mode, words)?)
            }
            true => Self::Projection(Projection::new(gpu, mode, words)?),
            false => Self::Raycast(Raycast::of_mode(gpu, mode, words)?),
        })
    }

    /// Compiles what finds the depth of slices: rays that take the samples of the slices one after the other
    /// ([`super::View::each_depth_recording`]). `words` are those of the picture; what lights it has no say.
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn along_slices(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        words: &Words,
        mix: Mix,
    ) -> Result<Self, Error> {
        let words = Words { mix, ..*words };
        let words = match settings.technique.draws_stacks() {
            true => Words {
                lattice: "stack",
                transfer: "table",
                ..words
            },
            false => Words {
                lattice: "planes",
                ..words
            },
        };
        Self::new(gpu, settings, &words)
    }

    /// How many images a recording fills: the picture's own and the one beside it, or the first alone. The last of them
    /// has the depth.
    pub fn image_count(&self) -> usize {
        match self {
            Self::Raycast(_) => 2,
            Self::Projection(_) => 1,
        }
    }

    /// Binds inputs and images; `host_depth` as in [`Raycast::bind_behind`].
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(
        &self,
        inputs: &Inputs,
        picture: &Image,
        layers: &Image,
        tiles: &RayTiles,
        host_depth: Option<Resource>,
    ) -> Result<RayBindings, Error> {
        match (self, host_depth) {
            (Self::Raycast(pass), None) => pass.bind(inputs, picture, layers, tiles),
            (Self::Raycast(pass), Some(depth)) => {
                pass.bind_behind(inputs, picture, layers, tiles, depth)
            }
            (Self::Projection(pass), None) => pass.bind(inputs, picture, tiles),
            (Self::Projection(pass), Some(depth)) => {
                pass.bind_behind(inputs, picture, tiles, depth)
            }
        }
    }

    /// Records parts of a picture of `extent`.
    ///
    /// # Errors
    /// As [`Raycast::record_tiles`].
    ///
    /// # Safety
    /// As [`Raycast::record_tiles`].
    pub unsafe fn record_tiles(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &RayBindings,
        offset: u32,
        extent: [u32; 2],
        tiles: impl IntoIterator<Item = Tile>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe {
            match self {
                Self::Raycast(pass) => pass.record_tiles(cmd, bindings, offset, extent, tiles),
                Self::Projection(pass) => pass.record_tiles(cmd, bindings, offset, extent, tiles),
            }
        }
    }
}
