//! What lies under a pixel.

use super::frame::PICK_BYTES;
use super::{Error, Renderer};
use crate::gpu::{Region, Use, buffer_barrier, image_barrier, image_to_buffer};
use crate::technique::Mode;
use crate::technique::gather::Canvas;
use crate::volume::{Volume, sample::nearest};
use ash::vk;
use glam::DVec3;

/// What the depth of a picture says of one pixel: where a composite has become half opaque, the first surface, the
/// place of a maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// World length from where the ray starts: the eye, or the near plane of parallel rays.
    pub distance: f64,
    /// The place in the world.
    pub position: DVec3,
    /// What the volume has there, as the filter makes it: the projected value, that of the surface, or that of the
    /// sample with which a composite became half opaque. Of a map of labels, which the nearest filter reads, it is the
    /// label. `None` of [`Mode::Mida`], which keeps another number, and of slabs, which have two values.
    pub value: Option<f64>,
    /// Premultiplied colour and alpha of the pixel. Projecting modes have none before they are classified, and rays
    /// that look for the depth of slices end there.
    pub color: Option<[f32; 4]>,
}

impl Pick {
    /// The voxel of another `volume` there, on the CPU: the label of a map beside what is shown. `None` outside, and
    /// where it has no data.
    pub fn voxel_of(&self, volume: &Volume) -> Option<f64> {
        let voxel = volume
            .world_from_voxel
            .inverse()
            .transform_point3(self.position);
        nearest::<f64>(volume, voxel.to_array())
    }
}

impl Renderer {
    /// Records the copy of what lies under a pixel, for [`Renderer::pick`] when the frame is done.
    ///
    /// # Errors
    /// [`Error::NoDepth`], [`Error::NoPixel`], and where nothing was recorded.
    ///
    /// # Safety
    /// As [`Renderer::record`], after it.
    pub unsafe fn record_pick(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: u32,
        pixel: [u32; 2],
    ) -> Result<(), Error> {
        self.gpu.check_alive("record a pick")?;
        let (there, camera, _) = self.recorded(frame, "record_pick")?;
        let has_depth = self.class.settings.mode.has_depth();
        let Some(buffer) = there.pick.as_ref().filter(|_| has_depth) else {
            return Err(Error::NoDepth {
                what: self.class.what(),
            });
        };
        let [x, y] = pixel;
        if x >= self.extent[0] || y >= self.extent[1] {
            return Err(Error::NoPixel {
                found: pixel,
                extent: self.extent,
            });
        }
        let region = Region {
            origin: [x, y, 0],
            extent: [1; 3],
        };
        // SAFETY: the caller's promises; an earlier pick of the same frame comes first.
        unsafe {
            buffer_barrier(
                &self.gpu,
                cmd,
                buffer,
                Use::TransferWrite,
                Use::TransferWrite,
            );
        }
        let images = there.depth_canvas().into_iter().flat_map(Canvas::images);
        for (image, offset) in images.zip((0..).step_by(16)) {
            // SAFETY: the caller's promises; `record` left the images as they are here.
            unsafe {
                let gpu = &self.gpu;
                image_barrier(gpu, cmd, image, Use::FragmentSampled, Use::TransferRead);
                image_to_buffer(gpu, cmd, image, region, buffer, offset)?;
                image_barrier(gpu, cmd, image, Use::TransferRead, Use::FragmentSampled);
            }
        }
        // SAFETY: as above. A fence alone makes nothing visible to the host.
        unsafe {
            buffer_barrier(&self.gpu, cmd, buffer, Use::TransferWrite, Use::HostRead);
        }
        self.frames[frame as usize].picked = Some((pixel, camera));
        Ok(())
    }

    /// What lay under `pixel` in a frame that is done; `None` where nothing has a depth there.
    ///
    /// # Errors
    /// Where nothing was picked.
    pub fn pick(&self, frame: u32, pixel: [u32; 2]) -> Result<Option<Pick>, Error> {
        let there = &self.frames[self.frame_number(frame)?];
        let camera = match there.picked {
            Some((picked, camera)) if picked == pixel => camera,
            _ => return Err(Error::NotPicked { frame, pixel }),
        };
        let Some(buffer) = &there.pick else {
            return Err(Error::NoDepth {
                what: self.class.what(),
            });
        };
        let mut texels = [[0f32; 4]; PICK_BYTES as usize / 16];
        buffer.read(0, bytemuck::cast_slice_mut(&mut texels))?;
        let [picture, layers] = texels;
        let settings = &self.class.settings;
        let mode = settings.mode;
        let (distance, value, color) = match mode.is_projection() {
            true => (picture[2], Some(picture[0]), None),
            false => {
                let has_value = match mode {
                    Mode::Composite => !settings.preintegrated,
                    _ => mode == Mode::Iso,
                };
                let is_whole = settings.technique.casts_rays();
                let value = has_value.then_some(layers[0]);
                (layers[1], value, is_whole.then_some(picture))
            }
        };
        if distance < 0.0 || (mode.is_projection() && picture[1] == 0.0) {
            return Ok(None);
        }
        let rays = camera.rays(self.extent);
        let [x, y] = pixel.map(|n| f64::from(n) + 0.5);
        let (origin, direction) = rays.at(x, y);
        let distance = f64::from(distance);
        Ok(Some(Pick {
            distance,
            position: origin + distance * direction,
            value: value.map(f64::from),
            color,
        }))
    }
}
