//! Marks of `--annotate`, drawn by the CPU and laid into the picture of the volume in linear light:
//!
//! ```text
//! background -> edges of the box that lie behind -> volume -> all other marks
//! ```
//!
//! So what lies behind the volume shows through it, and pictures in files have the marks too. Ink is chosen by the
//! background: what the volume looks like is on the device, and waiting for it would stall each frame.

use crate::drawing::Canvas;
use crate::error::Error;
use crate::painter::words;
use crate::view::View;
use ash::vk;
use std::sync::Arc;
use stratavox::annotate::{Drawn, GeometryLegend, Seen};
use stratavox::camera::Camera;
use stratavox::gpu::{
    Bindings, Blend, Buffer, DepthUse, Gpu, Image, ImageDesc, ImageKind, Load, Memory, RasterDesc,
    RasterPipeline, Region, Resource, Use, begin_rendering, buffer_to_image, end_rendering,
    image_barrier, set_area,
};
use stratavox::picture::{ColorSpace, Picture};
use stratavox::scene::Beside;
use stratavox::shaders::{BindingKind, BindingSlot, Code, Shader, Stage};

const IMAGE: BindingSlot = BindingSlot {
    name: "image",
    binding: 1,
    kind: BindingKind::Texture,
};

/// Lays marks into pictures of one format.
pub struct Marker {
    gpu: Arc<Gpu>,
    pipeline: RasterPipeline,
}

/// The marks of one frame, on the device.
pub struct Layers {
    /// Edges that lie behind the volume.
    pub behind: Option<Layer>,
    pub front: Layer,
}

pub struct Layer {
    bindings: Bindings,
    /// What `bindings` reads.
    _image: Image,
}

impl Marker {
    pub fn new(gpu: &Arc<Gpu>, format: vk::Format) -> Result<Self, Error> {
        let shader = |stage, bytes: &'static [u8], bindings| Shader {
            name: "marks",
            stage,
            code: Code::Words(words(bytes)),
            constants: &[],
            bindings,
        };
        let vertex = include_bytes!(concat!(env!("OUT_DIR"), "/marks.vertex.spv"));
        let fragment = include_bytes!(concat!(env!("OUT_DIR"), "/marks.fragment.spv"));
        let desc = RasterDesc {
            vertex: &shader(Stage::Vertex, vertex, &[]),
            fragment: &shader(Stage::Fragment, fragment, &[IMAGE]),
            target: format.into(),
            blend: Blend::Over,
            depth: DepthUse::Ignored,
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline: RasterPipeline::new(gpu, &desc)?,
        })
    }

    /// Records the upload of marks for a picture of `extent`.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering, after [`Gpu::announce`], and is submitted.
    pub unsafe fn lay(
        &self,
        cmd: vk::CommandBuffer,
        drawn: &Drawn,
        extent: [u32; 2],
    ) -> Result<Layers, Error> {
        // SAFETY: the caller's promise.
        let layer = |pixels| unsafe { self.layer(cmd, pixels, extent) };
        Ok(Layers {
            behind: match drawn.behind.is_empty() {
                true => None,
                false => Some(layer(&drawn.behind)?),
            },
            front: layer(&drawn.front)?,
        })
    }

    /// # Safety
    /// As [`Marker::lay`].
    unsafe fn layer(
        &self,
        cmd: vk::CommandBuffer,
        pixels: &[[f32; 4]],
        [width, height]: [u32; 2],
    ) -> Result<Layer, Error> {
        let bytes: &[u8] = bytemuck::cast_slice(pixels);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let count = bytes.len() as u64;
        let staging = Buffer::new(&self.gpu, count, usage, Memory::Upload, "marks")?;
        staging.write(0, bytes)?;
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [width, height, 1],
            // Every device samples it; nothing filters here.
            format: vk::Format::R32G32B32A32_SFLOAT,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: "marks",
        };
        let image = Image::new(&self.gpu, &desc)?;
        let whole = Region::whole(&image);
        // SAFETY: the caller's promise; the staging buffer waits, dropped, for the frame.
        unsafe {
            image_barrier(&self.gpu, cmd, &image, Use::Nothing, Use::TransferWrite);
            buffer_to_image(&self.gpu, cmd, &staging, 0, &image, whole)?;
            let (written, read) = (Use::TransferWrite, Use::FragmentSampled);
            image_barrier(&self.gpu, cmd, &image, written, read);
        }
        let resources = [(IMAGE.name, Resource::sampled(&image))];
        Ok(Layer {
            bindings: Bindings::new(&self.gpu, self.pipeline.layout(), &resources)?,
            _image: image,
        })
    }

    /// Draws a layer over what `load` says of the picture.
    ///
    /// # Safety
    /// As [`Marker::lay`], after it; the picture is in [`Use::ColorTarget`], of the layer's extent.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer, layer: &Layer, canvas: &Canvas, load: Load) {
        // SAFETY: the caller's promise; bindings and image wait, dropped, for the frame.
        unsafe {
            let target = [(canvas.image.view(), load)];
            begin_rendering(&self.gpu, cmd, &target, canvas.extent);
            set_area(&self.gpu, cmd, canvas.extent);
            self.pipeline.draw(cmd, &layer.bindings, &[], 3, 0..1);
            end_rendering(&self.gpu, cmd);
        }
    }
}

/// The marks of what is seen, in a picture that is shrunk to so many parts of its sides.
pub fn drawn(view: &View, camera: &Camera, extent: [u32; 2], parts: u32) -> Result<Drawn, Error> {
    let [width, height] = extent;
    let (look, subject) = (&view.look, &view.subject);
    let background = Picture {
        width,
        height,
        pixels: vec![look.backdrop(); width as usize * height as usize],
        color_space: ColorSpace::Linear,
        layers: Vec::new(),
    };
    let settings = look.settings();
    let seen = Seen {
        camera,
        settings: &settings,
        function: look.function(),
        beside: Beside::Nothing,
        grid: subject.voxels.grid(),
        height_factor: subject.way.height_factor,
        time: f64::from(subject.time),
        projected: None,
        geometry: GeometryLegend::default(),
    };
    let mut annotation = view.annotation.clone();
    // Words are as large in the window, however many pixels the picture has.
    let em = annotation.em(height * parts) / f64::from(parts);
    annotation.size = Some(em);
    let drawn = annotation.draw(&background, &seen);
    drawn.map_err(|error| Error::Arguments(error.to_string()))
}
