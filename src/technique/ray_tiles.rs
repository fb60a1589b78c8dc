//! Which tiles of a picture are drawn by rays, and which part of their rays.
//!
//! ```text
//! list(tile) = some of its rays may meet a macro cell with matter; what of a ray lies between the first and the last
//! ```
//!
//! The list is made on the device (`shaders/ray_tiles.wgsl`), which then draws as many workgroups as it holds. What is
//! left out would have added nothing, and the picture is the same to the bit.
//!
//! The host writes nothing for it, so that a host may record several parts of a picture before the first is done: which
//! tiles are looked through is said by the places of the search's workgroups.

use super::Inputs;
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Gpu, Groups, Image, ImageDesc, ImageKind, Memory,
    Resource, Tile, Use, barriers,
};
use crate::shaders::{BLOCK_TILES, MOST_BLOCKS, Shader, shader};
use ash::vk;
use std::sync::Arc;

/// The list of one recording at a time: a host that has several pictures in flight has one for each.
#[derive(Clone, Debug)]
pub struct RayTiles {
    /// How many there are, as a dispatch.
    list: Arc<Buffer>,
    /// Which they are.
    tiles: Arc<Image>,
}

impl RayTiles {
    /// Room for pictures of `extent` pixels.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no images of that size.
    pub fn new(gpu: &Arc<Gpu>, extent: [u32; 2]) -> Result<Self, Error> {
        use vk::BufferUsageFlags as Usage;
        let bytes = size_of::<vk::DispatchIndirectCommand>() as u64;
        let usage = Usage::STORAGE_BUFFER | Usage::INDIRECT_BUFFER | Usage::TRANSFER_DST;
        let [across, down] = extent.map(|n| n.div_ceil(Tile::STEP).max(1));
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [across, down, 1],
            format: vk::Format::R32G32B32A32_SFLOAT,
            usage: vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED,
            name: "tiles of rays",
        };
        let list = Buffer::new(gpu, bytes, usage, Memory::Device, "list of tiles")?;
        Ok(Self {
            list: Arc::new(list),
            tiles: Arc::new(Image::new(gpu, &desc)?),
        })
    }

    /// Whether all tiles of such a picture fit.
    fn holds(&self, extent: [u32; 2]) -> bool {
        let [across, down, _] = self.tiles.extent();
        let wanted = extent.map(|n| n.div_ceil(Tile::STEP));
        wanted[0] <= across && wanted[1] <= down
    }
}

/// What is bound for the search and for the rays.
#[derive(Debug)]
pub struct RayBindings {
    search: Bindings,
    rays: Bindings,
    tiles: RayTiles,
}

/// A compute pass over the tiles of a picture in which its rays may meet something.
#[derive(Debug)]
pub(super) struct TilePass {
    gpu: Arc<Gpu>,
    search: ComputePipeline,
    rays: ComputePipeline,
}

/// What is empty for the rays of a pass, and what they leave where they meet nothing.
#[derive(Clone, Copy, Debug)]
pub(super) enum Nothing {
    /// Cells without matter; a picture of no light.
    OfComposite,
    /// Beyond the box of the volume; the same picture.
    Beyond,
    /// The same; the picture of MIDA.
    BeyondMida,
    /// The same; no number.
    BeyondProjection,
    /// No tile.
    Nowhere,
    /// The same of projections.
    NowhereOfProjection,
}

impl Nothing {
    fn shader(self) -> &'static str {
        match self {
            Self::OfComposite => "ray_tiles.distances.picture",
            Self::Beyond => "ray_tiles.box.picture",
            Self::BeyondMida => "ray_tiles.box.mida",
            Self::BeyondProjection => "ray_tiles.box.number",
            Self::Nowhere => "ray_tiles.everywhere.picture",
            Self::NowhereOfProjection => "ray_tiles.everywhere.number",
        }
    }
}

impl TilePass {
    /// Compiles the shader of the rays and the search for its tiles.
    pub fn new(gpu: &Arc<Gpu>, rays: &Shader, nothing: Nothing) -> Result<Self, Error> {
        Ok(Self {
            gpu: Arc::clone(gpu),
            search: ComputePipeline::new(gpu, shader(nothing.shader()))?,
            rays: ComputePipeline::new(gpu, rays)?,
        })
    }

    /// Binds inputs, the images that rays fill, and the list.
    pub fn bind(
        &self,
        inputs: &Inputs,
        tiles: &RayTiles,
        images: &[(&str, &Image)],
        host_depth: Resource,
    ) -> Result<RayBindings, Error> {
        let images = images
            .iter()
            .map(|&(name, image)| (name, Resource::written(image)));
        let images: Vec<_> = images.collect();
        let bind = |pass: &ComputePipeline, more: &[(&'static str, Resource)]| {
            let outputs: Vec<_> = images.iter().chain(more).copied().collect();
            inputs.bind(&self.gpu, pass.layout(), &outputs)
        };
        let list = ("ray_list", Resource::Storage(&tiles.list));
        let made = ("ray_tiles", Resource::written(&tiles.tiles));
        let drawn = ("ray_tiles", Resource::sampled_or_read(&tiles.tiles));
        Ok(RayBindings {
            search: bind(&self.search, &[list, made])?,
            rays: bind(&self.rays, &[drawn, ("host_depth", host_depth)])?,
            tiles: tiles.clone(),
        })
    }

    /// Records parts of a picture of `extent`.
    ///
    /// # Errors
    /// A part whose corners are not at multiples of [`Tile::STEP`] or at the picture's edge, and a picture larger than
    /// the list that was bound has room for.
    ///
    /// # Safety
    /// As [`super::raycast::Raycast::record_tiles`].
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &RayBindings,
        offset: u32,
        extent: [u32; 2],
        parts: impl IntoIterator<Item = Tile>,
    ) -> Result<(), Error> {
        if !bindings.tiles.holds(extent) {
            let [across, down, _] = bindings.tiles.tiles.extent();
            return Err(Error::Argument {
                doing: "list the tiles of a picture".into(),
                wanted: format!("{across} x {down} tiles of {} pixels at most", Tile::STEP),
                found: format!("{extent:?} pixels"),
            });
        }
        let [most, ..] = self.gpu.limits().max_workgroup_count;
        let offsets = [offset];
        // Of the list that is being made.
        let mut room = None;
        for part in parts {
            let mut left = self.rays.groups_of(extent, part)?;
            while let Some(rows) = take(&mut left, room.unwrap_or(most)) {
                if rows.count[1] == 0 {
                    // SAFETY: the caller's promises, here and below.
                    unsafe { self.record_rays(cmd, bindings, offset) };
                    room = None;
                    continue;
                }
                if room.is_none() {
                    // SAFETY: as above.
                    unsafe { self.record_empty(cmd, &bindings.tiles) };
                }
                room = Some(room.unwrap_or(most) - rows.count[0] * rows.count[1]);
                // SAFETY: as above; no more tiles are looked through than the list and a dispatch have room for.
                unsafe {
                    let (bound, blocks) = (&bindings.search, blocks(rows, extent));
                    self.search.dispatch_boxes(cmd, bound, &offsets, blocks);
                }
            }
        }
        if room.is_some() {
            // SAFETY: as above.
            unsafe { self.record_rays(cmd, bindings, offset) };
        }
        Ok(())
    }

    /// Empties the list.
    ///
    /// # Safety
    /// As [`Self::record`].
    unsafe fn record_empty(&self, cmd: vk::CommandBuffer, tiles: &RayTiles) {
        let (gpu, RayTiles { list, tiles }) = (&self.gpu, tiles);
        let written = Use::ComputeWrite;
        let drawn = (&**list, Use::DrawIndirect, Use::TransferWrite);
        let read = (&**tiles, Use::ComputeDone, written);
        let emptied = (&**list, Use::TransferWrite, written);
        // SAFETY: the caller's promises; what is written lies in the list.
        unsafe {
            // Pixels that the search leaves and those that rays fill lie in the same images.
            barriers(gpu, cmd, [(written, written)], [drawn], [read]);
            // A dispatch of no workgroups across, one down and one deep.
            gpu.record(|device| {
                device.cmd_fill_buffer(cmd, list.raw(), 0, 4, 0);
                device.cmd_fill_buffer(cmd, list.raw(), 4, vk::WHOLE_SIZE, 1);
            });
            barriers(gpu, cmd, [], [emptied], []);
        }
    }

    /// Draws what was listed.
    ///
    /// # Safety
    /// As [`Self::record`].
    unsafe fn record_rays(&self, cmd: vk::CommandBuffer, bindings: &RayBindings, offset: u32) {
        let (list, written) = (&*bindings.tiles.list, Use::ComputeWrite);
        let listed = (list, written, Use::DrawIndirect);
        // SAFETY: the caller's promises.
        unsafe {
            barriers(&self.gpu, cmd, [(written, written)], [listed], []);
            self.rays
                .dispatch_indirect(cmd, &bindings.rays, &[offset], list);
        }
    }
}

/// As many rows of `part` as there is room for; `None` where none is left.
fn take(part: &mut Groups, room: u32) -> Option<Groups> {
    let [across, down, _] = part.count;
    if across == 0 || down == 0 {
        return None;
    }
    let mut rows = *part;
    rows.count[1] = down.min(room / across);
    part.base[1] += rows.count[1];
    part.count[1] -= rows.count[1];
    Some(rows)
}

/// Workgroups of the search for a rectangle of tiles of a picture: boxes of blocks that are looked through alike. What
/// lies beyond the edge of the picture is in none of them: the shader leaves it out.
fn blocks(tiles: Groups, extent: [u32; 2]) -> impl Iterator<Item = Groups> {
    let [across, down] = [0, 1].map(|k| {
        let end = tiles.base[k] + tiles.count[k];
        let end = match end * Tile::STEP >= extent[k] {
            true => end.next_multiple_of(BLOCK_TILES),
            false => end,
        };
        runs(tiles.base[k], end)
    });
    across.flat_map(move |[x, width]| {
        down.clone().map(move |[y, height]| Groups {
            base: [0, x, y],
            count: [1, width, height],
        })
    })
}

/// Blocks of the tiles from `first` to before `end` of one axis: the place of the first of them, which says how many
/// tiles are left out before and behind, too; and how many blocks.
fn runs(first: u32, end: u32) -> impl Iterator<Item = [u32; 2]> + Clone {
    let mut at = first;
    std::iter::from_fn(move || {
        let (block, before) = (at / BLOCK_TILES, at % BLOCK_TILES);
        let count = match before {
            0 => ((end - at) / BLOCK_TILES).max(1),
            _ => 1,
        };
        let after = BLOCK_TILES * (block + count);
        let left_out = before + BLOCK_TILES * after.saturating_sub(end);
        let run = (at < end).then_some([block + MOST_BLOCKS * left_out, count]);
        at = end.min(after);
        run
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(base: [u32; 2], count: [u32; 2]) -> Groups {
        Groups {
            base: [base[0], base[1], 0],
            count: [count[0], count[1], 1],
        }
    }

    #[test]
    fn parts_are_cut_by_rows_where_there_are_too_many_tiles_and_none_is_lost() {
        let mut left = groups([3, 5], [7, 10]);
        let taken: Vec<_> = std::iter::from_fn(|| take(&mut left, 30)).collect();
        let wanted = [(5, 4), (9, 4), (13, 2)].map(|(y, rows)| groups([3, y], [7, rows]));
        assert_eq!(taken, wanted);
        assert_eq!(
            take(&mut groups([0, 0], [7, 1]), 6),
            Some(groups([0, 0], [7, 0]))
        );
    }

    /// As the shader takes the places of its invocations.
    #[test]
    fn blocks_have_each_tile_of_a_part_once_and_no_other() {
        // In tiles.
        let extent = [29, 34];
        for (base, count) in [
            ([0, 0], [29, 34]),
            ([0, 0], [16, 16]),
            ([0, 0], [5, 23]),
            ([8, 16], [8, 8]),
            ([3, 5], [2, 1]),
            ([3, 5], [5, 29]),
            ([7, 1], [22, 7]),
        ] {
            let part = groups(base, count);
            let mut seen = [[0; 40]; 40];
            for Groups { base, count } in blocks(part, extent.map(|n| 8 * n - 3)) {
                assert_eq!((base[0], count[0]), (0, 1));
                let of_axis = |k: usize| {
                    let left_out = base[k] / MOST_BLOCKS;
                    let (before, behind) = (left_out % 8, left_out / 8);
                    let first = 8 * (base[k] % MOST_BLOCKS);
                    let tiles = first..(first + 8 * count[k]).min(extent[k - 1]);
                    tiles.filter(move |tile| tile % 8 >= before && tile % 8 + behind < 8)
                };
                for y in of_axis(2) {
                    of_axis(1).for_each(|x| seen[y as usize][x as usize] += 1);
                }
            }
            for (y, row) in (0..).zip(seen) {
                for (x, seen) in (0..).zip(row) {
                    let is_in = |k: usize, at: u32| at >= base[k] && at < base[k] + count[k];
                    let wanted = u32::from(is_in(0, x) && is_in(1, y));
                    assert_eq!(seen, wanted, "{part:?} at {x}, {y}");
                }
            }
        }
        // Whole pictures in one box.
        let whole = blocks(groups([0, 0], [29, 34]), extent.map(|n| 8 * n - 3));
        let wanted = Groups {
            base: [0; 3],
            count: [1, 4, 5],
        };
        assert_eq!(whole.collect::<Vec<_>>(), [wanted]);
    }
}
