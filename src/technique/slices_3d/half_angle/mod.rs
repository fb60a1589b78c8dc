//! Half-angle slicing: shadows in one pass over the slices, which eye and light draw in turn.
//!
//! ```text
//! light's picture: A = 0
//! for each slice, from the light:
//!     eye:    C, alpha blended by under or over      source alpha (lit(1 - A), 1)
//!     light:  A += (1 - A) alpha                     the same slice, alpha along the light's rays
//! ```
//!
//! A sample gets the light that the slices before its own have left: the picture converges with the first power of
//! the step. Kniss, Premoze, Hansen, Shirley and McPherson, "A Model for Volume Lighting and Modeling", IEEE
//! TVCG 9(2), 2003, section 4.

mod gather;
mod geometry;
#[doc(hidden)]
pub mod reference;

pub(super) use gather::half_angle_slices;
pub use geometry::{HalfAngle, light_extent};

use crate::gpu::{
    Bindings, Blend, DepthUse, Error, Gpu, Image, ImageDesc, ImageKind, Load, RasterDesc,
    RasterPipeline, Resource, Tile, Use, begin_rendering_of, end_rendering, image_barrier,
    set_area_of,
};
use crate::shaders::shader;
use crate::technique::blend::Drawn;
use crate::technique::{
    ACCUMULATION_FORMAT, Inputs, Mode, Order, ShaderVariant, Slicer, Technique,
};
use ash::vk;
use std::sync::Arc;

/// Vertices of the cover of one slice.
const VERTICES: u32 = 12;

/// The pipelines of eye and light. Both blend R32G32B32A32_SFLOAT.
#[derive(Debug)]
pub struct HalfAngleSlicer {
    gpu: Arc<Gpu>,
    over: RasterPipeline,
    under: RasterPipeline,
    light: Slicer,
}

/// What eye and light read.
#[derive(Debug)]
pub struct HalfAngleBindings {
    eye: Bindings,
    light: Bindings,
}

/// What is recorded at once: the two recordings of [`crate::technique::View::recordings`], written into a ring.
#[derive(Clone, Copy, Debug)]
pub struct HalfAngleSlices {
    /// Offsets of the eye's parameters and of the light's.
    pub offsets: [u32; 2],
    /// How many slices there are.
    pub count: u32,
    /// How the eye blends them.
    pub order: Order,
}

/// The image that the light sees: a color target that the eye's pass reads.
///
/// # Errors
/// An extent over a limit of the device, no memory.
pub fn light_buffer(gpu: &Arc<Gpu>, [width, height]: [u32; 2]) -> Result<Image, Error> {
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [width, height, 1],
        format: ACCUMULATION_FORMAT,
        usage: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
        name: "light buffer",
    };
    Image::new(gpu, &desc)
}

impl HalfAngleSlicer {
    /// Compiles the variants of these words, for both orders of blending: the order changes with camera and light.
    ///
    /// # Errors
    /// Where the device does not blend R32G32B32A32_SFLOAT, by its name: halves would lose light slice by slice.
    pub fn new(gpu: &Arc<Gpu>, variant: &ShaderVariant) -> Result<Self, Error> {
        let ShaderVariant {
            filter,
            holes,
            transfer,
            mix,
            ..
        } = variant;
        let fragment = format!(
            "slices_3d_half{}.{filter}.{holes}.{transfer}",
            mix.general().word()
        );
        let pipeline = |blend| {
            let desc = RasterDesc {
                vertex: shader("slices_3d_cover"),
                fragment: shader(&fragment),
                target: ACCUMULATION_FORMAT.into(),
                depth: DepthUse::Ignored,
                blend,
            };
            RasterPipeline::new(gpu, &desc)
        };
        let drawn = Drawn::Picture(Mode::Composite);
        Ok(Self {
            gpu: Arc::clone(gpu),
            over: pipeline(Blend::Over)?,
            under: pipeline(Blend::Under)?,
            light: Slicer::new(
                gpu,
                Technique::Slices3d,
                drawn,
                Order::FrontToBack,
                variant,
                ACCUMULATION_FORMAT,
            )?,
        })
    }

    /// Binds the inputs and the [`light_buffer`].
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(&self, inputs: &Inputs, light_buffer: &Image) -> Result<HalfAngleBindings, Error> {
        let read = [("light_buffer", Resource::sampled(light_buffer))];
        Ok(HalfAngleBindings {
            eye: inputs.bind(&self.gpu, self.over.layout(), &read)?,
            light: self.light.bind(inputs)?,
        })
    }

    /// Records all slices into `picture`, premultiplied colour and alpha, and into `light_buffer`. What both held is
    /// given up.
    ///
    /// | barrier | image | from | to | keeps |
    /// |---|---|---|---|---|
    /// | before the eye's draw of a slice | light buffer | `ColorTarget` | `FragmentSampled` | the eye reads what the light's draws before it have blended |
    /// | after it | light buffer | `FragmentSampled` | `ColorTarget` | the light blends only after that was read |
    /// | between two slices | picture | `ColorTarget` | `ColorTarget` | the next rendering loads what this one has stored |
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; what was bound lives until it has run;
    /// - the inputs are in `Use::Sampled`, `picture` and `light_buffer` in `Use::ColorTarget`, in which they are left;
    /// - `picture` is R32G32B32A32_SFLOAT of at least the extent of the view, `light_buffer` the one that was bound,
    ///   of [`crate::technique::View::light_extent`].
    pub unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &HalfAngleBindings,
        slices: HalfAngleSlices,
        (picture, extent): (&Image, [u32; 2]),
        light_buffer: &Image,
    ) {
        let gpu = &self.gpu;
        let [width, height, _] = light_buffer.extent();
        let (of_eye, of_light) = (Tile::whole(extent), Tile::whole([width, height]));
        let (drawn, read) = (Use::ColorTarget, Use::FragmentSampled);
        let target = |image: &Image, load| [(image.view(), load)];
        let (of_picture, cleared) = (target(picture, Load::Keep), Load::Clear([0.0; 4]));
        // SAFETY: the caller's promises; every image is in the use that its next access needs.
        unsafe {
            for (image, tile) in [(picture, of_eye), (light_buffer, of_light)] {
                begin_rendering_of(gpu, cmd, &target(image, cleared), tile);
                end_rendering(gpu, cmd);
            }
            for slice in 0..slices.count {
                image_barrier(gpu, cmd, light_buffer, drawn, read);
                image_barrier(gpu, cmd, picture, drawn, drawn);
                begin_rendering_of(gpu, cmd, &of_picture, of_eye);
                self.draw_eye(cmd, bindings, slices, extent, (slice, of_eye));
                end_rendering(gpu, cmd);
                image_barrier(gpu, cmd, light_buffer, read, drawn);
                begin_rendering_of(gpu, cmd, &target(light_buffer, Load::Keep), of_light);
                let place = (slice, of_light);
                self.draw_light(cmd, bindings, slices, [width, height], place);
                end_rendering(gpu, cmd);
            }
        }
    }

    /// A tile of what the eye sees of a slice.
    ///
    /// # Safety
    /// As [`Self::record`], inside rendering to the picture of `extent`.
    unsafe fn draw_eye(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &HalfAngleBindings,
        slices: HalfAngleSlices,
        extent: [u32; 2],
        (slice, tile): (u32, Tile),
    ) {
        let pipeline = match slices.order {
            Order::BackToFront => &self.over,
            Order::FrontToBack => &self.under,
        };
        let offsets = [slices.offsets[0]];
        // SAFETY: the caller's promises; the layouts of both pipelines are equal.
        unsafe {
            set_area_of(&self.gpu, cmd, extent, tile);
            pipeline.draw(cmd, &bindings.eye, &offsets, VERTICES, slice..slice + 1);
        }
    }

    /// A tile of what the light sees of a slice.
    ///
    /// # Safety
    /// As [`Self::record`], inside rendering to the light buffer of `extent`.
    unsafe fn draw_light(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &HalfAngleBindings,
        slices: HalfAngleSlices,
        extent: [u32; 2],
        (slice, tile): (u32, Tile),
    ) {
        let (bound, offset, one) = (&bindings.light, slices.offsets[1], slice..slice + 1);
        // SAFETY: the caller's promises.
        unsafe {
            self.light
                .record_tile(cmd, bound, offset, extent, one, tile);
        }
    }
}
