//! Volumes that are seen together and lie on grids of their own: where a sample of the first lies in another one.
//!
//! ```text
//! p' = A p        A = voxel'_from_world world_from_voxel
//! ```
//!
//! A volume on a grid of its own has data in the box of that alone. CPU reference of `shaders/lib/channels_on_own.wgsl`.

use super::frame::affine_rows;
use super::{Error, Settings, compatibility::refuse};
use crate::real::Real;
use crate::shaders::{CHANNEL_ROWS, Frame, MAX_CHANNELS};
use crate::volume::Grid;

/// What the parameters of a picture say of the grids of its channels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChannelGrids {
    /// Rows of A, three a channel.
    pub from_voxel: [[f32; 4]; CHANNEL_ROWS as usize],
    /// Voxels along the axes of each, and 1 for one on a grid of its own.
    pub dims: [[f32; 4]; MAX_CHANNELS as usize],
}

impl ChannelGrids {
    /// Those of these grids beside the `first`, which is one of them; at most [`MAX_CHANNELS`].
    pub fn new(first: &Grid, grids: impl IntoIterator<Item = Grid>) -> Self {
        let mut made = Self::default();
        let grids = grids.into_iter().enumerate();
        for (c, grid) in grids.take(MAX_CHANNELS as usize) {
            let a = grid.world_from_voxel.inverse() * first.world_from_voxel;
            let is_first = grid.world_from_voxel == first.world_from_voxel;
            let a = if is_first {
                glam::DAffine3::IDENTITY
            } else {
                a
            };
            made.from_voxel[3 * c..3 * c + 3].copy_from_slice(&affine_rows(&a));
            let [x, y, z] = grid.dims.map(|n| n as f32);
            made.dims[c] = [x, y, z, f32::from(u8::from(grid != *first))];
        }
        made
    }
}

/// Where a position in voxels of the volume lies in those of a channel; `None` outside of its box.
pub fn place_in_channel<R: Real>(frame: &Frame, channel: usize, p: [R; 3]) -> Option<[R; 3]> {
    let own: [R; 3] = std::array::from_fn(|k| {
        let [x, y, z, w] = frame.channel_from_voxel[3 * channel + k].map(R::from_f32);
        x * p[0] + y * p[1] + z * p[2] + w
    });
    let [x, y, z, is_own] = frame.channel_dims[channel];
    let is_inside = |(place, dim): (R, f32)| place >= R::from_f64(0.0) && place <= R::from_f32(dim);
    let are_inside = own.into_iter().zip([x, y, z]).all(is_inside);
    (is_own == 0.0 || are_inside).then_some(own)
}

impl Settings {
    /// Whether pictures of volumes on grids of their own can be made.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_own_grids(&self) -> Result<(), Error> {
        // Modes that project draw them one by one.
        if self.mode.is_projection() {
            return refuse(
                self.crop.is_some(),
                "a crop in voxels",
                "volumes on one grid",
                "several on grids of their own",
            );
        }
        let desc = self.technique.desc();
        let takes_places = desc.layouts == [crate::resident::TextureLayout::Texture3d];
        refuse(
            !takes_places || desc.splats,
            OWN_GRIDS,
            "ray casting and 3D slices",
            self.technique,
        )
    }
}

const OWN_GRIDS: &str = "volumes on grids of their own";
