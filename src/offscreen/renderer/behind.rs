//! Geometry in the pictures of a device: what is seen of it, and its depths in an image of the device.

use super::Renderer;
use crate::camera::{Camera, HostDepth};
use crate::geometry::{Geometry, Seen};
use crate::gpu::{
    self, Buffer, Gpu, Headless, Image, ImageDesc, ImageKind, Memory, Region, Use, buffer_to_image,
    image_barrier,
};
use crate::offscreen::{Error, behind, check_geometry};
use crate::picture::{Layer, Picture};
use crate::scene::Scene;
use crate::technique::{ClipPlane, DepthAccess, InPixel, Recording, Settings};
use ash::vk;
use glam::DVec3;
use std::sync::Arc;

/// Geometry, and what of it is seen through one place in each pixel.
#[derive(Debug)]
pub(super) struct Behind {
    geometry: Arc<Geometry>,
    /// What was seen last, from where, and cut by which planes.
    seen: Option<(SeenBy, Seen)>,
    /// Its depths on the device.
    image: Option<DepthImage>,
}

/// From where, through which place of each pixel, behind which planes, and as which depths.
type SeenBy = (Camera, InPixel, Vec<ClipPlane>, HostDepth);

#[derive(Debug)]
struct DepthImage {
    image: Image,
    staging: Buffer,
    is_filled: bool,
}

/// Where rays and slices end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends<'a> {
    depth: HostDepth,
    access: DepthAccess,
    /// The depth of each pixel.
    pub image: &'a Image,
}

impl Renderer<'_> {
    /// From here on pictures show this geometry too, `None`: none. It takes rays through the same place of all pixels.
    pub fn set_geometry(&mut self, geometry: Option<Arc<Geometry>>) {
        self.behind = geometry.map(|geometry| Behind {
            geometry,
            seen: None,
            image: None,
        });
    }

    /// What of the geometry is seen through this place in each pixel, ready for rays and slices to end there.
    pub(super) fn look_behind(&mut self, scene: &Scene, in_pixel: InPixel) -> Result<(), Error> {
        match &mut self.behind {
            Some(behind) => behind.look(&mut self.device, scene, in_pixel),
            None => Ok(()),
        }
    }

    /// Lays the geometry over the picture of a mode that projects.
    pub(super) fn put_geometry_over(
        &mut self,
        scene: &Scene,
        picture: &mut Picture,
    ) -> Result<(), Error> {
        let Some(behind) = &self.behind else {
            return Ok(());
        };
        if !scene.settings.mode.is_projection() {
            return Ok(());
        }
        check_geometry(scene.settings)?;
        let geometry = &behind.geometry;
        behind::put_over(scene, picture, |at| behind::seen(geometry, scene, at));
        Ok(())
    }

    /// Which lines are seen.
    pub(super) fn lines(&self, scene: &Scene) -> Result<Layer, Error> {
        let behind = self.behind.as_ref().ok_or(Error::NoLines)?;
        Ok(behind::lines(&behind.geometry, scene))
    }

    /// Depths and positions of what is nearer, volume or geometry.
    pub(super) fn bring_nearer(&self, scene: &Scene, layers: &mut [Layer]) {
        if let Some(behind) = &self.behind {
            behind::bring_nearer(&behind.geometry, scene, layers);
        }
    }

    /// What hides samples of slices in such pictures.
    pub(super) fn depth_access(&self, settings: &Settings) -> DepthAccess {
        match self.behind.is_none() || settings.mode.is_projection() {
            true => DepthAccess::None,
            false => behind::access(settings),
        }
    }
}

impl Behind {
    /// Looks from the camera of the scene, and brings the depths to the device where something is to end there.
    pub fn look(
        &mut self,
        device: &mut Headless,
        scene: &Scene,
        in_pixel: InPixel,
    ) -> Result<(), Error> {
        check_geometry(scene.settings)?;
        if scene.settings.mode.is_projection() {
            return Ok(());
        }
        let (camera, extent) = (*scene.camera, scene.extent_pixels);
        let depth = behind::host_depth(scene);
        let from = (camera, in_pixel, scene.settings.clip_planes.clone(), depth);
        let is_there = self.seen.as_ref().is_some_and(|(was, seen)| {
            *was == from && seen.pixels.len() == extent[0] as usize * extent[1] as usize
        });
        if is_there {
            return Ok(());
        }
        let seen = behind::seen(&self.geometry, scene, in_pixel);
        let depths = behind::depths(&depth, scene, in_pixel, &seen);
        let is_other = |image: &DepthImage| image.image.extent()[..2] != extent;
        if self.image.as_ref().is_none_or(is_other) {
            self.image = Some(DepthImage::new(device.gpu(), extent)?);
        }
        self.image
            .as_mut()
            .expect("made above")
            .fill(device, &depths)?;
        self.seen = Some((from, seen));
        Ok(())
    }

    /// What a recording is told, and what it binds.
    pub fn ends(&self, settings: &Settings) -> Option<Ends<'_>> {
        let ((.., depth), _) = self.seen.as_ref()?;
        let image = self.image.as_ref()?;
        (!settings.mode.is_projection()).then(|| Ends {
            depth: *depth,
            access: behind::access(settings),
            image: &image.image,
        })
    }

    /// Puts what was seen last behind the pixels of a volume; over those of a projection it lies later.
    pub fn put(&self, pixels: &mut [[f32; 4]], settings: &Settings) {
        if let (Some((_, seen)), false) = (&self.seen, settings.mode.is_projection()) {
            behind::put(seen, pixels, settings.color_space);
        }
    }
}

impl Ends<'_> {
    /// Puts what is recorded behind it. `center` is that of the grid.
    pub fn tell(&self, recording: &mut Recording, center: DVec3) {
        match self.access {
            DepthAccess::Tested => recording.tested_in_copy(&self.depth, center),
            DepthAccess::None | DepthAccess::Sampled => recording.behind(&self.depth, center),
        }
    }
}

impl DepthImage {
    fn new(gpu: &Arc<Gpu>, [width, height]: [u32; 2]) -> Result<Self, gpu::Error> {
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [width, height, 1],
            format: vk::Format::R32_SFLOAT,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: "depths of geometry",
        };
        let bytes = 4 * u64::from(width) * u64::from(height);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        Ok(Self {
            image: Image::new(gpu, &desc)?,
            staging: Buffer::new(gpu, bytes, usage, Memory::Upload, "depths of geometry")?,
            is_filled: false,
        })
    }

    fn fill(&mut self, device: &mut Headless, depths: &[f32]) -> Result<(), gpu::Error> {
        self.staging.write(0, bytemuck::cast_slice(depths))?;
        let gpu = Arc::clone(device.gpu());
        let was = if self.is_filled {
            Use::Sampled
        } else {
            Use::Nothing
        };
        let (image, region) = (&self.image, Region::whole(&self.image));
        // SAFETY: recorded outside rendering; `run` waits, and `self` lives meanwhile.
        device.run(|cmd| unsafe {
            image_barrier(&gpu, cmd, image, was, Use::TransferWrite);
            buffer_to_image(&gpu, cmd, &self.staging, 0, image, region)?;
            image_barrier(&gpu, cmd, image, Use::TransferWrite, Use::Sampled);
            Ok::<_, gpu::Error>(())
        })?;
        self.is_filled = true;
        Ok(())
    }
}
