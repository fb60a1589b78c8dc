//! Clip space, from the rays of a picture.
//!
//! ```text
//! x = (p / w - d) . dx / |dx|^2        the pixel of a point p, from the eye, at depth w; d the ray direction of depth 1
//! ```

use crate::camera::Rays;
use glam::DVec3;

/// Clip space from the centred world, as rows, from the rays themselves: with w the depth and d the ray
/// direction of depth 1, pixel x of a point p is where (p/w - d) . dx / |dx|^2 finds it. Depth is 1/2
/// everywhere: w > 0 alone clips.
pub(crate) fn clip_rows(rays: &Rays, [width, height]: [u32; 2]) -> [[f32; 4]; 4] {
    let is_perspective = rays.origin_dx == DVec3::ZERO;
    let row = |dx_origin: DVec3, dx_direction: DVec3, pixels: u32| {
        // A point's pixel coordinate times w is dot(slope, p - origin) + at_origin.
        let (slope, start, w_slope) = if is_perspective {
            let slope = dx_direction / dx_direction.length_squared();
            // p - w d, with w = forward . (p - origin); dx is orthogonal to forward.
            (slope, slope.dot(rays.direction), rays.forward)
        } else {
            (dx_origin / dx_origin.length_squared(), 0.0, DVec3::ZERO)
        };
        let pixel_times_w = slope - start * w_slope;
        let clip = 2.0 / f64::from(pixels) * pixel_times_w - w_slope;
        let at_origin = if is_perspective { 0.0 } else { -1.0 };
        clip.extend(at_origin - clip.dot(rays.origin))
            .as_vec4()
            .to_array()
    };
    let x = row(rays.origin_dx, rays.direction_dx, width);
    let y = row(rays.origin_dy, rays.direction_dy, height);
    let w = if is_perspective {
        rays.forward.extend(-rays.forward.dot(rays.origin))
    } else {
        glam::dvec4(0.0, 0.0, 0.0, 1.0)
    };
    [x, y, (0.5 * w).as_vec4().to_array(), w.as_vec4().to_array()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Projection};
    use crate::technique::{InPixel, Settings, View};
    use crate::volume::Grid;
    use glam::{DAffine3, dvec3, dvec4};

    fn view_of<'a>(grid: &'a Grid, camera: &'a Camera, settings: &'a Settings) -> View<'a> {
        View {
            grid,
            camera,
            extent_pixels: [40, 30],
            in_pixel: InPixel::CENTER,
            settings,
        }
    }

    #[test]
    fn a_point_on_a_pixels_ray_is_drawn_at_that_pixel() {
        let grid = Grid {
            dims: [8, 9, 10],
            world_from_voxel: DAffine3::IDENTITY,
        };
        let settings = Settings::default();
        let projections = [
            Projection::Perspective { fov_degrees: 70.0 },
            Projection::Orthographic { view_height: 12.0 },
        ];
        for projection in projections {
            let camera = Camera {
                eye: dvec3(20.0, -7.0, 3.0),
                target: dvec3(1.0, 2.0, 4.0),
                up: dvec3(0.1, 0.2, 1.0),
                projection,
                zoom: 1.3,
            };
            let view = view_of(&grid, &camera, &settings);
            let rays = view.rays();
            let rows = clip_rows(&rays, view.extent_pixels);
            for (x, y) in [(0.5, 0.5), (39.5, 0.5), (11.25, 22.75)] {
                let (origin, direction) = rays.at(x, y);
                let point = (origin + 9.0 * direction).extend(1.0);
                let clip = rows
                    .map(|[a, b, c, d]| point.dot(dvec4(a.into(), b.into(), c.into(), d.into())));
                let pixel = [0, 1]
                    .map(|k| 0.5 * (clip[k] / clip[3] + 1.0) * f64::from(view.extent_pixels[k]));
                let off = (pixel[0] - x).abs().max((pixel[1] - y).abs());
                assert!(
                    off < 1e-4,
                    "{projection:?}: ({x}, {y}) is drawn at {pixel:?}"
                );
            }
        }
    }
}
