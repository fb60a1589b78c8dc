//! Ray casting: one ray a pixel in a compute pass, emission and absorption front to back (Levoy 1988).

#[doc(hidden)]
pub mod reference;

use super::gather::rays;
use super::ray_tiles::{Nothing, TilePass};
use super::registry::TechniqueDesc;
use super::{Inputs, Mode, RayBindings, RayTiles, SampleInputs, SampleKind, ShaderVariant, SkipBy};
use crate::gpu::{Error, Gpu, Image, Resource, Tile};
use crate::resident::TextureLayout;
use crate::shaders::{Shader, shader};
use ash::vk;
use std::sync::Arc;

/// Ray casting, to those who ask.
pub(super) static DESC: TechniqueDesc = TechniqueDesc {
    casts_rays: true,
    draws_stacks: false,
    splats: false,
    traces_paths: false,
    streams: true,
    supports: |_| Ok(()),
    has_half_angle: false,
    base_plane: None,
    layouts: &[TextureLayout::Texture3d],
    layout_of: |_| TextureLayout::Texture3d,
    longest_sample_count: |view| view.longest_sample_count(),
    set_slices: |_, _, _| 0,
    gather: rays,
    slice_shaders: None,
};

/// The compute pass.
#[derive(Debug)]
pub struct Raycast {
    pass: TilePass,
}

impl Raycast {
    /// Compiles this variant, for [`Mode::Composite`].
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn new(gpu: &Arc<Gpu>, variant: &ShaderVariant) -> Result<Self, Error> {
        Self::of_mode(gpu, Mode::Composite, variant)
    }

    /// The same for a mode that composites: [`Mode::Composite`], or of one volume [`Mode::Mida`] and
    /// [`Mode::Iso`]; surfaces of one volume are coloured by a second one where there are two ([`SampleInputs::Channels`]).
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn of_mode(gpu: &Arc<Gpu>, of: Mode, variant: &ShaderVariant) -> Result<Self, Error> {
        let ShaderVariant {
            filter,
            holes,
            lattice,
            transfer,
            mix,
            take,
            is_adaptive,
            skip_by,
            is_scattered,
            ..
        } = variant;
        // Kernels, slices and exact control points have the general variant alone.
        let has_lean = of == Mode::Composite
            && *lattice != "stack"
            && *transfer != "points"
            && !matches!(*filter, "kernel" | "spline");
        let mix = if has_lean { *mix } else { mix.general() };
        let mode = of.shader_key();
        // Where it is not refused.
        let space = match skip_by {
            SkipBy::Cells => String::new(),
            _ => format!(".{skip_by}"),
        };
        let name = match take {
            _ if of == Mode::Iso && mix == SampleInputs::Channels => {
                format!("isosurface.volume.{filter}.{holes}")
            }
            _ if of == Mode::Iso => format!("isosurface.{filter}.{holes}"),
            SampleKind::Preintegrated => {
                let stored = if *transfer == "stored" { ".stored" } else { "" };
                format!("raycast_slab.composite.{lattice}.{filter}.{holes}{stored}")
            }
            // Of one volume without light or holes: nothing else is checked to be right.
            SampleKind::Point if *is_adaptive && of == Mode::Composite => {
                format!("raycast.composite.adaptive.{lattice}.{filter}.{holes}.{transfer}")
            }
            _ if *is_scattered => {
                format!("raycast.{mode}.scattered.{lattice}.{filter}.{holes}.{transfer}")
            }
            _ => format!(
                "raycast.{mode}{}.{lattice}.{filter}.{holes}.{transfer}{space}",
                mix.word()
            ),
        };
        let nothing = match of {
            Mode::Mida => Nothing::BeyondMida,
            _ if *lattice == "stack" => Nothing::Beyond,
            _ => Nothing::OfComposite,
        };
        Ok(Self {
            pass: TilePass::new(gpu, variant.shader(&name), nothing)?,
        })
    }

    /// Rays of another kind that leave a picture and what lies beside it.
    pub(super) fn of_shader(gpu: &Arc<Gpu>, name: &str) -> Result<Self, Error> {
        Self::of_rays(gpu, shader(name))
    }

    /// The same by the shader itself.
    pub(super) fn of_rays(gpu: &Arc<Gpu>, rays: &Shader) -> Result<Self, Error> {
        Ok(Self {
            pass: TilePass::new(gpu, rays, Nothing::Beyond)?,
        })
    }

    /// The same of what may be seen outside of the box of the volume too.
    pub(super) fn everywhere(gpu: &Arc<Gpu>, name: &str) -> Result<Self, Error> {
        Ok(Self {
            pass: TilePass::new(gpu, shader(name), Nothing::Nowhere)?,
        })
    }

    /// Binds inputs and the two images that a recording fills, both R32G32B32A32_SFLOAT storage images:
    /// `picture` gets premultiplied colour and alpha, `layers` (what the mode keeps, depth or -1,
    /// transmittance, samples). `tiles` has room for as many pixels, and is used by no unfinished recording.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(
        &self,
        inputs: &Inputs,
        picture: &Image,
        layers: &Image,
        tiles: &RayTiles,
    ) -> Result<RayBindings, Error> {
        // In place of a depth that is not looked at.
        let depth = Resource::sampled_or_read(layers);
        self.bind_behind(inputs, picture, layers, tiles, depth)
    }

    /// The same behind what a host has drawn: `host_depth` is its depth buffer, a texture as large as the picture, of
    /// which [`super::Recording::behind`] tells the parameters.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind_behind(
        &self,
        inputs: &Inputs,
        picture: &Image,
        layers: &Image,
        tiles: &RayTiles,
        host_depth: Resource,
    ) -> Result<RayBindings, Error> {
        let images = [("picture", picture), ("layers", layers)];
        self.pass.bind(inputs, tiles, &images, host_depth)
    }

    /// The same for paths, which leave an array of images of their own beside the picture; `layers` is what the search for tiles
    /// fills.
    pub(super) fn bind_paths(
        &self,
        inputs: &Inputs,
        [picture, layers, path_layers]: [&Image; 3],
        tiles: &RayTiles,
        host_depth: Resource,
    ) -> Result<RayBindings, Error> {
        let images = [
            ("picture", picture),
            ("layers", layers),
            ("path_layers", path_layers),
        ];
        self.pass.bind(inputs, tiles, &images, host_depth)
    }

    /// Records one picture, all of it at once, of the parameters at `offset` of the ring.
    ///
    /// # Errors
    /// A picture larger than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; what was bound lives until it has run;
    /// - the inputs are in `Use::Sampled`, the images in `Use::ComputeWrite`.
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &RayBindings,
        offset: u32,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        let whole = [Tile::whole(extent)];
        // SAFETY: the caller's promises.
        unsafe { self.record_tiles(cmd, bindings, offset, extent, whole) }
    }

    /// The same for parts of a picture of `extent`, so that no submission takes long: the parts of a picture may be
    /// spread over several recordings and submissions, in any order, each pixel in one of them. Of several bricks all
    /// are recorded for a pixel in their order; only between those a barrier from `Use::ComputeWrite` to the same is
    /// needed, between parts none.
    ///
    /// # Errors
    /// As [`Self::record`], and corners that are not at multiples of [`Tile::STEP`].
    ///
    /// # Safety
    /// As [`Self::record`].
    pub unsafe fn record_tiles(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &RayBindings,
        offset: u32,
        extent: [u32; 2],
        tiles: impl IntoIterator<Item = Tile>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises; the bindings come from `bind`.
        unsafe { self.pass.record(cmd, bindings, offset, extent, tiles) }
    }
}
