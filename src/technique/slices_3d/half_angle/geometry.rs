//! Where half-angle slices lie, in which order the eye blends them, and the picture that the light has of them.
//!
//! ```text
//! v the direction in which the camera looks, l that in which the light travels, unit vectors
//!
//! v.l >= 0    s = (v + l) / |v + l|    the eye sees the slices from front to back
//! v.l <  0    s = (l - v) / |l - v|    the eye sees them from back to front
//!
//! plane k:    s.x = (k + 1/2) h,       k rising away from the light
//! ```
//!
//! s.l = |s.v|, so samples are as far apart along the light as along the view: h / |s.v|, at most sqrt(2) h. Rays
//! beside the middle of a perspective picture meet the slices steeper or flatter, which their own lengths say.
//!
//! The light is infinitely far away: its picture is orthographic, a square that the domain fits into.
//!
//! Kniss, Premoze, Hansen, Shirley and McPherson, "A Model for Volume Lighting and Modeling", IEEE TVCG 9(2), 2003.

use crate::camera::Rays;
use crate::shaders::FrameFields;
use crate::technique::clip_rows::clip_rows;
use crate::technique::{Error, Order, View};
use glam::{DVec3, dvec3};

/// Texels along a side of the light's picture, at most: a device has as many, and 256 MiB hold them.
const MAX_LIGHT_SIDE: u32 = 4096;

/// The least cosine between a ray and the normal of the slices: samples are at most four steps apart.
const LEAST_COSINE: f64 = 0.25;

/// Slices half way between the eye and the light, in the centred world.
#[derive(Clone, Copy, Debug)]
pub struct HalfAngle {
    /// Normal of the slices, a unit vector that points away from the light.
    pub normal: DVec3,
    /// How the eye blends slices that come from the light.
    pub order: Order,
    /// Of the light's picture: parallel, along the light.
    pub light_rays: Rays,
    /// Texels of the light's picture.
    pub light_extent: [u32; 2],
    /// World length of a texel.
    texel_world: f64,
}

/// [`View::light_extent`] of any view of so many voxels.
pub fn light_extent(dims: [u32; 3], extent_pixels: [u32; 2]) -> [u32; 2] {
    let voxels = DVec3::from_array(dims.map(f64::from)).length();
    let pixels = extent_pixels.into_iter().max().unwrap_or_default();
    [(voxels.ceil() as u32).max(pixels).clamp(8, MAX_LIGHT_SIDE); 2]
}

impl View<'_> {
    /// Texels of the light's picture: as many a side as the larger side of the picture has pixels, and not fewer
    /// than there are voxels along the diagonal of the grid; at most 4096. Does not depend on camera and light.
    pub fn light_extent(&self) -> [u32; 2] {
        light_extent(self.grid.dims, self.extent_pixels)
    }

    /// The slices for this camera and the one light of the settings; without one, it shines the way the camera looks.
    ///
    /// # Errors
    /// [`Error::NoWayToLight`] and [`Error::TooSteep`].
    pub fn half_angle(&self) -> Result<HalfAngle, Error> {
        let forward = self.rays().forward;
        let mut lights = self.settings.shading.iter().flat_map(|s| &s.lights);
        let light = match lights.next() {
            Some(light) => -light.way(&self.camera.frame())?,
            None => forward,
        };
        let (half, order) = if forward.dot(light) >= 0.0 {
            (forward + light, Order::FrontToBack)
        } else {
            (light - forward, Order::BackToFront)
        };
        let normal = half.normalize();
        self.check_steepness(match order {
            Order::FrontToBack => normal,
            Order::BackToFront => -normal,
        })?;
        let (light_rays, texel_world) = self.light_rays(light);
        Ok(HalfAngle {
            normal,
            order,
            light_rays,
            light_extent: self.light_extent(),
            texel_world,
        })
    }

    /// The corners of the domain in the centred world.
    fn corners(&self) -> [DVec3; 8] {
        let ([low, high], world_from_voxel) = (self.domain(), self.world_from_voxel());
        std::array::from_fn(|i| {
            let part = dvec3((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
            world_from_voxel.transform_point3(low + part * (high - low))
        })
    }

    /// Whether every ray that meets the domain crosses the slices from one side, and none along them. `normal` points
    /// away from the eye.
    ///
    /// The cosine is concave along arcs on which it is positive, so it is least at a corner: of the box as the eye
    /// sees it, and of the picture. Rays are inside of both.
    fn check_steepness(&self, normal: DVec3) -> Result<(), Error> {
        if !self.camera.projection.is_perspective() {
            return Ok(());
        }
        let rays = self.rays();
        let cosine = |ray: DVec3| normal.dot(ray.normalize_or_zero());
        let least = |cosines: &mut dyn Iterator<Item = f64>| cosines.fold(1.0, f64::min);
        let of_box = least(&mut self.corners().iter().map(|c| cosine(c - rays.origin)));
        let [width, height] = self.extent_pixels.map(f64::from);
        let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
        let of_picture = least(&mut corners.iter().map(|&[x, y]| cosine(rays.at(x, y).1)));
        let found = of_box.max(of_picture);
        if found >= LEAST_COSINE {
            return Ok(());
        }
        Err(Error::TooSteep {
            degrees: found.acos().to_degrees(),
            limit_degrees: LEAST_COSINE.acos().to_degrees(),
        })
    }

    /// Parallel rays along `light` through a square with a rim of one texel around the domain, and the side of a
    /// texel. Across and down lie as the axes of the world do, so that shadows stand still while the camera moves.
    fn light_rays(&self, light: DVec3) -> (Rays, f64) {
        let (x, y, z) = (light.x.abs(), light.y.abs(), light.z.abs());
        let axis = match () {
            () if x <= y && x <= z => DVec3::X,
            () if y <= z => DVec3::Y,
            () => DVec3::Z,
        };
        let across = light.cross(axis).normalize();
        let down = light.cross(across);
        let corners = self.corners();
        let range = |direction: DVec3| {
            let heights = corners.map(|corner| direction.dot(corner));
            let low = heights.into_iter().fold(f64::INFINITY, f64::min);
            [low, heights.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        };
        let (ranges, depth) = ([range(across), range(down)], range(light));
        let side = ranges.iter().map(|[low, high]| high - low);
        let texels = f64::from(self.light_extent()[0]);
        let texel = side.fold(f64::MIN_POSITIVE, f64::max) / (texels - 2.0);
        let [x, y] = ranges.map(|[low, high]| 0.5 * (low + high) - 0.5 * texels * texel);
        let rays = Rays {
            // A texel before the domain: rays start outside.
            origin: x * across + y * down + (depth[0] - texel) * light,
            origin_dx: texel * across,
            origin_dy: texel * down,
            direction: light,
            direction_dx: DVec3::ZERO,
            direction_dy: DVec3::ZERO,
            forward: light,
        };
        (rays, texel)
    }
}

impl HalfAngle {
    /// The parameters of the eye's pass and of the light's, made of those of the view, and how many slices there are.
    pub(in crate::technique) fn fields(
        &self,
        view: &View,
        fields: &FrameFields,
    ) -> ([FrameFields; 2], u32) {
        let v = |v: DVec3| v.as_vec3().to_array();
        let world_from_voxel = view.world_from_voxel();
        let [first, last] = self.plane_range(view);
        let rays = &self.light_rays;
        let eye = FrameFields {
            forward: v(self.normal),
            forward_voxel: v(world_from_voxel.matrix3.transpose() * self.normal),
            light_rows: self.light_rows(),
            slice_first: first,
            slice_direction: 1,
            slice_turn: (last - first + 1) as u32,
            ..*fields
        };
        // Two texels, as slicers have two pixels: rounding in the rasterizer never uncovers one.
        let rows = DVec3::from_array(view.grid.voxel_rows().map(|row| row.length()));
        let margin = 2.0 * self.texel_world * rows + 1e-3;
        let [low, high] = view.domain();
        let light = FrameFields {
            origin: v(rays.origin),
            origin_dx: v(rays.origin_dx),
            origin_dy: v(rays.origin_dy),
            direction: v(rays.direction),
            direction_dx: [0.0; 3],
            direction_dy: [0.0; 3],
            clip_from_world: clip_rows(rays, self.light_extent),
            extent_pixels: self.light_extent,
            cover_min: v(low - margin),
            cover_max: v(high + margin),
            // What is opaque takes light whatever its colour: no surface is lit.
            light_count: 0,
            // Its texels are places, not rays of a picture.
            is_uneven: 0,
            ..eye
        };
        ([eye, light], eye.slice_turn)
    }

    /// The planes that meet the domain, one more at each end against rounding. Those behind the eye too: they throw
    /// shadows on what it sees.
    fn plane_range(&self, view: &View) -> [i32; 2] {
        let step = view.step_world();
        let heights = view.corners().map(|corner| self.normal.dot(corner));
        let low = heights.into_iter().fold(f64::INFINITY, f64::min);
        let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        [
            (low / step - 0.5).floor() as i32,
            (high / step - 0.5).ceil() as i32,
        ]
    }

    /// Texels of the light's picture from the centred world, across and down.
    fn light_rows(&self) -> [[f32; 4]; 2] {
        let rays = &self.light_rays;
        let row = |direction: DVec3| {
            let slope = direction / (self.texel_world * self.texel_world);
            slope.extend(-slope.dot(rays.origin)).as_vec4().to_array()
        };
        [row(rays.origin_dx), row(rays.origin_dy)]
    }
}
