//! What is recorded for the window: the picture in its place, the panel over it, copies for screenshots.

use super::{Save, Window};
use crate::error::Error;
use crate::frames::Begun;
use crate::painter::pixels;
use crate::shot::Screenshot;
use ash::vk;
use egui::FullOutput;
use stratavox::gpu::{
    Load, Region, Target, TargetState, Use, begin_rendering, buffer_barrier, end_rendering,
    image_barrier, image_to_buffer,
};

impl Window {
    /// Records all of a frame; gives the screenshots that will be in it.
    pub(super) fn record(
        &mut self,
        begun: Begun,
        output: FullOutput,
    ) -> Result<Vec<Screenshot>, Error> {
        let swapchain = self.swapchain.as_ref().expect("frames have one");
        let window = swapchain.extent;
        let per_point = output.pixels_per_point;
        let place = pixels(self.view.picture, per_point, window);
        let FullOutput {
            textures_delta,
            shapes,
            ..
        } = output;
        let primitives = self.context.tessellate(shapes, per_point);
        let (cmd, frame) = (begun.cmd, begun.frame);
        let mut shots = Vec::new();
        // SAFETY: the command buffer is recording outside rendering; its frame in flight is free, and everything that
        // is used lives until it is done, because what is dropped waits for that.
        unsafe {
            let painter = self.painter.as_mut().expect("made with the swapchain");
            painter.prepare(cmd, frame, textures_delta, &primitives, per_point, window)?;
            if place.extent.width > 0 && place.extent.height > 0 {
                self.draw_volume(begun, [place.extent.width, place.extent.height])?;
            }
            self.save_pictures(cmd, &mut shots)?;
        }
        let swapchain = self.swapchain.as_ref().expect("frames have one");
        let painter = self.painter.as_ref().expect("made with the swapchain");
        let shown = &swapchain.images[begun.image];
        let (gpu, device) = (self.host.gpu(), &self.host.device);
        let mut target = Target {
            image: shown.image,
            view: shown.view,
            format: swapchain.format,
            extent: window,
            // What it showed is given up. The semaphore of its acquisition is waited for at this stage: so the change
            // of layout, which begins here, waits for it too.
            before: TargetState {
                layout: vk::ImageLayout::UNDEFINED,
                stage: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
                access: vk::AccessFlags2::NONE,
                queue_family: vk::QUEUE_FAMILY_IGNORED,
            },
            // Presentation waits for a semaphore, which makes all visible.
            after: TargetState {
                layout: vk::ImageLayout::PRESENT_SRC_KHR,
                stage: vk::PipelineStageFlags2::NONE,
                access: vk::AccessFlags2::NONE,
                queue_family: vk::QUEUE_FAMILY_IGNORED,
            },
        };
        // SAFETY: as above.
        unsafe {
            target.enter(gpu, cmd, Use::ColorTarget);
            let black = Load::Clear([0.0, 0.0, 0.0, 1.0]);
            begin_rendering(gpu, cmd, &[(target.view, black)], window);
            if let Some(drawing) = self.drawing.as_ref().filter(|_| place.extent.width > 0) {
                let viewport = vk::Viewport {
                    x: place.offset.x as f32,
                    y: place.offset.y as f32,
                    width: place.extent.width as f32,
                    height: place.extent.height as f32,
                    min_depth: 0.0,
                    max_depth: 1.0,
                };
                device.cmd_set_viewport(cmd, 0, &[viewport]);
                device.cmd_set_scissor(cmd, 0, &[place]);
                painter.draw_picture(cmd, &drawing.canvas.bindings);
            }
            painter.draw(cmd, frame, window);
            end_rendering(gpu, cmd);
            let mut last = Use::ColorTarget;
            for save in std::mem::take(&mut self.saves) {
                let Save::Window(path) = save else {
                    continue;
                };
                if !swapchain.can_be_copied {
                    self.view.message = Some("the driver lets no window be copied".into());
                    continue;
                }
                let shot = Screenshot::new(gpu, path, swapchain.format, window)?;
                if last == Use::ColorTarget {
                    let present = std::mem::replace(&mut target.after, Use::TransferRead.into());
                    target.leave(gpu, cmd, last);
                    (target.after, last) = (present, Use::TransferRead);
                }
                let copy = [vk::BufferImageCopy::default()
                    .image_subresource(vk::ImageSubresourceLayers {
                        aspect_mask: vk::ImageAspectFlags::COLOR,
                        layer_count: 1,
                        ..Default::default()
                    })
                    .image_extent(vk::Extent3D {
                        width: window[0],
                        height: window[1],
                        depth: 1,
                    })];
                let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
                let buffer = &shot.buffer;
                device.cmd_copy_image_to_buffer(cmd, target.image, layout, buffer.raw(), &copy);
                buffer_barrier(gpu, cmd, buffer, Use::TransferWrite, Use::HostRead);
                shots.push(shot);
            }
            target.leave(gpu, cmd, last);
        }
        Ok(shots)
    }

    /// # Safety
    /// The command buffer is recording outside rendering.
    unsafe fn save_pictures(
        &mut self,
        cmd: vk::CommandBuffer,
        shots: &mut Vec<Screenshot>,
    ) -> Result<(), Error> {
        let (gpu, Some(drawing)) = (self.host.gpu(), &self.drawing) else {
            return Ok(());
        };
        let image = &drawing.canvas.image;
        for save in std::mem::take(&mut self.saves) {
            let Save::Picture(path) = save else {
                self.saves.push(save);
                continue;
            };
            let shot = Screenshot::new(gpu, path, image.format(), drawing.canvas.extent)?;
            // SAFETY: the caller's promise; the picture is sampled before and after.
            unsafe {
                image_barrier(gpu, cmd, image, Use::FragmentSampled, Use::TransferRead);
                image_to_buffer(gpu, cmd, image, Region::whole(image), &shot.buffer, 0)?;
                image_barrier(gpu, cmd, image, Use::TransferRead, Use::FragmentSampled);
                buffer_barrier(gpu, cmd, &shot.buffer, Use::TransferWrite, Use::HostRead);
            }
            shots.push(shot);
        }
        Ok(())
    }
}
