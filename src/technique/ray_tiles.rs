//! Which tiles of a picture are drawn by rays, and which part of their rays.
//!
//! ```text
//! list(tile) = some of its rays may meet a macro cell with matter; what of a ray lies between the first and the last
//! ```
//!
//! The list is made on the device (`shaders/ray_tiles.wgsl`), which then draws as many workgroups as it holds. What is
//! left out would have added nothing, and the picture is the same to the bit.

use super::Inputs;
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Gpu, Groups, Image, ImageDesc, ImageKind, Memory,
    Resource, Tile, Use, buffer_barrier, image_barrier, memory_barrier,
};
use crate::shaders::{Shader, shader};
use ash::vk;
use std::sync::Arc;

/// Parts of a picture that are looked through at once: `MAX_PARTS` of the shader.
const MAX_PARTS: usize = 256;
/// Bytes of a dispatch, or of a part.
const ENTRY_BYTES: usize = 16;

/// The list of one recording at a time: a host that has several pictures in flight has one for each.
#[derive(Clone, Debug)]
pub struct RayTiles {
    /// How many there are, and the parts of the picture that are looked through.
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
        let bytes = ((1 + MAX_PARTS) * ENTRY_BYTES) as u64;
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
}

impl Nothing {
    fn shader(self) -> &'static str {
        match self {
            Self::OfComposite => "ray_tiles.rooms.picture",
            Self::Beyond => "ray_tiles.box.picture",
            Self::BeyondMida => "ray_tiles.box.mida",
            Self::BeyondProjection => "ray_tiles.box.number",
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
        let mut some = Parts::new(most);
        for part in parts {
            let mut left = self.rays.groups_of(extent, part)?;
            while some.take(&mut left) {
                // SAFETY: the caller's promises.
                unsafe { self.record_some(cmd, bindings, offset, &some)? };
                some = Parts::new(most);
            }
        }
        // SAFETY: as above.
        unsafe { self.record_some(cmd, bindings, offset, &some) }
    }

    /// # Safety
    /// As [`Self::record`].
    unsafe fn record_some(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &RayBindings,
        offset: u32,
        parts: &Parts,
    ) -> Result<(), Error> {
        if parts.count == 0 {
            return Ok(());
        }
        let [width, height] = parts.largest;
        let groups = self.search.groups([width, height, parts.count as u32])?;
        let (gpu, RayTiles { list, tiles }) = (&self.gpu, &bindings.tiles);
        let written = Use::ComputeWrite;
        // SAFETY: the caller's promises; what is written fits, and there are no more tiles than the dispatch may have
        // workgroups.
        unsafe {
            // Pixels that the search leaves and those that rays fill lie in the same images.
            memory_barrier(gpu, cmd, written, written);
            image_barrier(gpu, cmd, tiles, Use::ComputeDone, written);
            buffer_barrier(gpu, cmd, list, Use::DrawIndirect, Use::TransferWrite);
            gpu.record(|device| device.cmd_update_buffer(cmd, list.raw(), 0, parts.bytes()));
            buffer_barrier(gpu, cmd, list, Use::TransferWrite, written);
            self.search
                .dispatch(cmd, &bindings.search, &[offset], groups);
            memory_barrier(gpu, cmd, written, written);
            buffer_barrier(gpu, cmd, list, written, Use::DrawIndirect);
            self.rays
                .dispatch_indirect(cmd, &bindings.rays, &[offset], list);
        }
        Ok(())
    }
}

/// Parts of a picture as the search reads them, behind a dispatch of nothing.
struct Parts {
    words: [[u32; 4]; 1 + MAX_PARTS],
    count: usize,
    /// Of all parts, and how many there may be.
    tiles: u32,
    most: u32,
    /// The most across and down.
    largest: [u32; 2],
}

impl Parts {
    fn new(most: u32) -> Self {
        let mut words = [[0; 4]; 1 + MAX_PARTS];
        words[0] = [0, 1, 1, 0];
        Self {
            words,
            count: 0,
            tiles: 0,
            most,
            largest: [0; 2],
        }
    }

    /// Takes as many rows of `part` as there is room for. Whether some are left.
    fn take(&mut self, part: &mut Groups) -> bool {
        let [across, down, _] = part.count;
        if across == 0 || down == 0 {
            return false;
        }
        let room = match self.count < MAX_PARTS {
            true => (self.most - self.tiles) / across,
            false => 0,
        };
        let rows = room.min(down);
        if rows > 0 {
            self.count += 1;
            self.words[self.count] = [part.base[0], part.base[1], across, rows];
            self.tiles += across * rows;
            self.largest = [self.largest[0].max(across), self.largest[1].max(rows)];
            part.base[1] += rows;
            part.count[1] -= rows;
        }
        part.count[1] > 0
    }

    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.words[..=self.count])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_cut_by_rows_where_there_are_too_many_tiles_and_none_is_lost() {
        let mut left = Groups {
            base: [3, 5, 0],
            count: [7, 10, 1],
        };
        let mut taken = Vec::new();
        let mut some = Parts::new(30);
        while some.take(&mut left) {
            taken.push((some.words[1], some.tiles));
            some = Parts::new(30);
        }
        taken.push((some.words[1], some.tiles));
        let wanted = [[3, 5, 7, 4], [3, 9, 7, 4], [3, 13, 7, 2]];
        assert_eq!(taken, wanted.map(|part| (part, part[2] * part[3])));
    }

    #[test]
    fn so_are_more_parts_than_a_list_has() {
        let one = |k: u32| Groups {
            base: [k, 0, 0],
            count: [1, 1, 1],
        };
        let mut some = Parts::new(u32::MAX);
        for k in 0..MAX_PARTS as u32 {
            assert!(!some.take(&mut one(k)), "{k}");
        }
        assert!(some.take(&mut one(999)));
        assert_eq!((some.count, some.largest), (MAX_PARTS, [1, 1]));
        assert_eq!(some.bytes().len(), (1 + MAX_PARTS) * ENTRY_BYTES);
    }
}
