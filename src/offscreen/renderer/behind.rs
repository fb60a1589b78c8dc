//! Opaque geometry in a picture: what rays find in the volume before it, over its own colour.
//!
//! ```text
//! rays end at the geometry      picture = volume + (1 - alpha) geometry
//! modes that project            have no order along a ray: the geometry lies over the picture
//! clip planes                   cut the geometry too, and their cuts through it are seen
//! ```
//!
//! Its distances come to the device as the depth buffer of a host whose depth is the distance along the line of sight.

use super::Renderer;
use crate::camera::{Camera, DepthConvention, HostDepth};
use crate::color::encode_srgb;
use crate::geometry::{Geometry, Seen};
use crate::gpu::{
    self, Buffer, Gpu, Headless, Image, ImageDesc, ImageKind, Memory, Region, Use, buffer_to_image,
    image_barrier,
};
use crate::named::Named;
use crate::offscreen::Error;
use crate::picture::{ColorSpace, Picture};
use crate::scene::{Scene, positions_in_pixel};
use crate::technique::{self, ClipPlane, InPixel, Settings};
use ash::vk;
use std::sync::Arc;

/// A depth that is as good as infinite, and that f32 can multiply.
const NOTHING: f32 = 1e30;

/// Geometry, and what of it is seen through one place in each pixel.
#[derive(Debug)]
pub(super) struct Behind {
    geometry: Arc<Geometry>,
    /// What was seen last, from where, and cut by which planes.
    seen: Option<(SeenBy, Seen)>,
    /// Its depths on the device.
    image: Option<DepthImage>,
}

/// From where, through which place of each pixel, and behind which planes.
type SeenBy = (Camera, InPixel, Vec<ClipPlane>);

#[derive(Debug)]
struct DepthImage {
    image: Image,
    staging: Buffer,
    is_filled: bool,
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

    /// What of the geometry is seen through this place in each pixel, ready for rays to end there.
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
        let Some(behind) = &mut self.behind else {
            return Ok(());
        };
        if !scene.settings.mode.is_projection() {
            return Ok(());
        }
        let share = 1.0 / scene.settings.rays_per_side.pow(2) as f32;
        let mut over = vec![[0.0; 4]; picture.pixels.len()];
        for in_pixel in positions_in_pixel(scene.settings) {
            behind.look(&mut self.device, scene, in_pixel)?;
            let mut own = vec![[0.0; 4]; over.len()];
            behind.put(&mut own, scene.settings);
            for (sum, own) in over.iter_mut().zip(own) {
                *sum = std::array::from_fn(|c| sum[c] + share * own[c]);
            }
        }
        for (pixel, over) in picture.pixels.iter_mut().zip(over) {
            *pixel = std::array::from_fn(|c| over[c] + (1.0 - over[3]) * pixel[c]);
        }
        Ok(())
    }
}

/// Whether pictures of these settings can show geometry.
///
/// # Errors
/// [`technique::Error::NotFor`].
pub fn check_geometry(settings: &Settings) -> Result<(), technique::Error> {
    let refuse = |found: &str| {
        Err(technique::Error::NotFor {
            wanted: "geometry in the picture",
            of: "rays through the same places of all pixels",
            found: found.to_owned(),
        })
    };
    let technique = settings.technique;
    match () {
        () if !technique.has_depth() || technique.splats() => refuse(technique.name()),
        () if settings.uneven_rays => refuse("rays at uneven places"),
        () => Ok(()),
    }
}

impl Behind {
    /// Looks from the camera of the scene, and brings the depths to the device where rays are to end there.
    pub fn look(
        &mut self,
        device: &mut Headless,
        scene: &Scene,
        in_pixel: InPixel,
    ) -> Result<(), Error> {
        check_geometry(scene.settings)?;
        let (camera, extent) = (*scene.camera, scene.extent_pixels);
        let from = (camera, in_pixel, scene.settings.clip_planes.clone());
        let is_there = self.seen.as_ref().is_some_and(|(was, seen)| {
            *was == from && seen.pixels.len() == extent[0] as usize * extent[1] as usize
        });
        if is_there {
            return Ok(());
        }
        let planes: Vec<_> = from.2.iter().map(ClipPlane::unit).collect();
        let seen = self
            .geometry
            .seen_cut(&camera, extent, in_pixel.at, &planes);
        if !scene.settings.mode.is_projection() {
            let depths = depths(&camera, extent, in_pixel, &seen);
            let is_other = |image: &DepthImage| image.image.extent()[..2] != extent;
            if self.image.as_ref().is_none_or(is_other) {
                self.image = Some(DepthImage::new(device.gpu(), extent)?);
            }
            self.image
                .as_mut()
                .expect("made above")
                .fill(device, &depths)?;
        }
        self.seen = Some((from, seen));
        Ok(())
    }

    /// What a recording is told, and what it binds.
    pub fn depth(&self, camera: &Camera) -> Option<(HostDepth, &Image)> {
        let image = self.image.as_ref()?;
        Some((line_of_sight(camera), &image.image))
    }

    /// Puts what was seen last behind the pixels of a volume.
    pub fn put(&self, pixels: &mut [[f32; 4]], settings: &Settings) {
        let Some((_, seen)) = &self.seen else {
            return;
        };
        for (pixel, own) in pixels.iter_mut().zip(&seen.pixels) {
            if own[3] == 0.0 {
                continue;
            }
            let own = match settings.color_space {
                ColorSpace::Linear => *own,
                ColorSpace::Display => {
                    let [r, g, b, a] = *own;
                    [encode_srgb(r), encode_srgb(g), encode_srgb(b), a]
                }
            };
            let through = 1.0 - pixel[3];
            *pixel = std::array::from_fn(|c| pixel[c] + through * own[c]);
        }
    }
}

/// Depths that are distances along the line of sight.
fn line_of_sight(camera: &Camera) -> HostDepth {
    let forward = camera.frame().forward;
    HostDepth {
        z: forward.extend(-forward.dot(camera.eye)),
        w: glam::DVec4::W,
        nearer: DepthConvention::Standard,
    }
}

fn depths(camera: &Camera, extent: [u32; 2], in_pixel: InPixel, seen: &Seen) -> Vec<f32> {
    let rays = camera.rays(extent);
    let depth = line_of_sight(camera);
    let of = |(i, &distance): (usize, &f64)| {
        if !distance.is_finite() {
            return NOTHING;
        }
        let [x, y] = [i % extent[0] as usize, i / extent[0] as usize].map(|n| n as f64 + 0.5);
        let (origin, direction) = rays.at(x + in_pixel.at[0], y + in_pixel.at[1]);
        depth.of(origin + distance * direction) as f32
    };
    seen.distances.iter().enumerate().map(of).collect()
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
