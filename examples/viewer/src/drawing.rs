//! The picture of the volume: stratavox draws it into an image of ours, level B, and the window shows that image. So a
//! frame in which the volume is as before, because a hand goes over the panel, draws no volume.

use crate::error::Error;
use crate::look::Look;
use crate::marks::{Layers, Marker};
use crate::painter::Painter;
use crate::resting::Resting;
use ash::vk;
use std::sync::Arc;
use stratavox::camera::Camera;
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{
    Bindings, Gpu, Image, ImageDesc, ImageKind, Load, Target, TargetState, Timer, Use,
};
use stratavox::technique::Technique;
use stratavox::transfer::TransferFunction;
use stratavox::volume;

pub struct Drawing {
    gpu: Arc<Gpu>,
    pub renderer: Renderer,
    pub resting: Resting,
    volume: Arc<Volume>,
    pub canvas: Canvas,
}

/// The image that the volume is drawn into.
pub struct Canvas {
    pub image: Image,
    pub bindings: Bindings,
    pub extent: [u32; 2],
}

impl Drawing {
    /// Textures of `voxels`, pipelines and images for `look`; the upload is recorded.
    ///
    /// # Safety
    /// `cmd` is recording outside rendering, after [`Gpu::announce`], and is submitted.
    pub unsafe fn new(
        gpu: &Arc<Gpu>,
        cmd: vk::CommandBuffer,
        painter: &Painter,
        voxels: &volume::Volume,
        look: &Look,
        extent: [u32; 2],
        frames_in_flight: u32,
    ) -> Result<Self, Error> {
        let settings = look.settings();
        let mut volume = Volume::new(gpu, voxels, &settings)?;
        // SAFETY: the caller's promise.
        unsafe { volume.record_upload(gpu, cmd)? };
        let volume = Arc::new(volume);
        let canvas = Canvas::new(gpu, painter, extent)?;
        let class = RendererDesc {
            // Of slices, rays would have to look for the depth of each frame.
            picks: settings.technique == Technique::Raycast && settings.mode.has_depth(),
            settings,
            target: canvas.image.format().into(),
            frames_in_flight,
            host_depth: false,
            gives_depth: false,
            slice_blending: Default::default(),
        };
        let renderer = Renderer::new(gpu, &volume, look.function(), class, extent, &[])?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            renderer,
            resting: Resting::default(),
            volume,
            canvas,
        })
    }

    /// Pictures of another size from now on. What frames in flight use stays until they are done.
    pub fn resize(&mut self, painter: &Painter, extent: [u32; 2]) -> Result<(), Error> {
        if self.canvas.extent != extent {
            self.renderer.resize(extent, &[])?;
            self.canvas = Canvas::new(&self.gpu, painter, extent)?;
        }
        Ok(())
    }

    /// The next time of a series. Where it lies in other textures it takes another renderer.
    pub fn set_volume(
        &mut self,
        volume: &Arc<Volume>,
        function: Option<&TransferFunction>,
    ) -> Result<(), Error> {
        self.volume = Arc::clone(volume);
        match self.renderer.set_volume(volume, function) {
            Err(stratavox::embed::Error::OtherDescription { .. }) => {
                let class = self.renderer.class().clone();
                let extent = self.canvas.extent;
                self.renderer = Renderer::new(&self.gpu, volume, function, class, extent, &[])?;
                Ok(())
            }
            set => Ok(set?),
        }
    }

    /// Records the picture, before `behind` (linear light), with marks; where it `rests`, that of its scattered light
    /// with more paths, or none: false. The image is in [`Use::FragmentSampled`] afterwards.
    ///
    /// # Safety
    /// As [`Renderer::record_into`].
    pub unsafe fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: u32,
        camera: &Camera,
        (look, rests): (&Look, bool),
        marks: Option<(&Marker, &Layers)>,
        timer: Option<&Timer>,
    ) -> Result<bool, Error> {
        let renderer = match rests {
            false => &mut self.renderer,
            true => {
                let resting = &mut self.resting;
                match resting.wait(&self.gpu, &self.volume, look, &self.renderer)? {
                    Some(of_paths) => of_paths,
                    None => return Ok(false),
                }
            }
        };
        let mut target = Target {
            image: self.canvas.image.raw(),
            view: self.canvas.image.view(),
            format: self.canvas.image.format(),
            extent: self.canvas.extent,
            // What it held is given up; but the frame before may still show it, or copy it for a screenshot, and
            // drawing waits for that. Reads need no access, only the stage.
            before: TargetState {
                layout: vk::ImageLayout::UNDEFINED,
                stage: vk::PipelineStageFlags2::FRAGMENT_SHADER
                    | vk::PipelineStageFlags2::ALL_TRANSFER,
                access: vk::AccessFlags2::NONE,
                queue_family: vk::QUEUE_FAMILY_IGNORED,
            },
            // The window's shader reads it next.
            after: Use::FragmentSampled.into(),
        };
        let shot = FrameInfo {
            frame,
            camera,
            depth: None,
        };
        // SAFETY: the caller's promise.
        unsafe {
            if let Some(timer) = timer {
                timer.start(cmd);
            }
            let mut load = Load::Clear(look.backdrop());
            if let Some((marker, layers)) = marks {
                if let Some(layer) = &layers.behind {
                    target.enter(&self.gpu, cmd, Use::ColorTarget);
                    marker.draw(cmd, layer, &self.canvas, load);
                    (target.before, load) = (Use::ColorTarget.into(), Load::Keep);
                }
                target.after = Use::ColorTarget.into();
            }
            renderer.record_into(cmd, &shot, &target, load)?;
            if let Some((marker, layers)) = marks {
                marker.draw(cmd, &layers.front, &self.canvas, Load::Keep);
                target.after = Use::FragmentSampled.into();
                target.leave(&self.gpu, cmd, Use::ColorTarget);
            }
            if let Some(timer) = timer {
                timer.stop(cmd);
            }
        }
        if rests {
            self.resting.show();
        }
        Ok(true)
    }
}

impl Canvas {
    fn new(gpu: &Arc<Gpu>, painter: &Painter, extent: [u32; 2]) -> Result<Self, Error> {
        let [width, height] = extent;
        // Half floats can be blended everywhere; hundreds of faint slices add up better in whole ones.
        let whole = vk::Format::R32G32B32A32_SFLOAT;
        let format = match gpu.format_features(whole).blend {
            true => whole,
            false => vk::Format::R16G16B16A16_SFLOAT,
        };
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [width, height, 1],
            format,
            usage: vk::ImageUsageFlags::COLOR_ATTACHMENT
                | vk::ImageUsageFlags::SAMPLED
                | vk::ImageUsageFlags::TRANSFER_SRC,
            name: "picture of the volume",
        };
        let image = Image::new(gpu, &desc)?;
        Ok(Self {
            bindings: painter.bind_picture(&image)?,
            image,
            extent,
        })
    }
}
