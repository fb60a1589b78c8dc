//! Where a brick lies in a picture.
//!
//! ```text
//! w = forward . (p - eye)        pixel = ((p - eye) / w - direction) . d / |d|^2        d: from pixel to pixel
//! ```

use crate::camera::{Camera, Rays};
use crate::volume::{Grid, VoxelBox};
use glam::{DAffine3, DVec3};

/// Pixels around the projection of a box that count as its own: rays go through places in a pixel, and f32 rounds.
const MARGIN_PIXELS: f64 = 2.0;

/// Who looks at the bricks of a grid.
#[derive(Clone, Debug)]
pub struct Eye {
    rays: Rays,
    extent_pixels: [u32; 2],
    world_from_voxel: DAffine3,
    voxel_from_world: DAffine3,
    /// [`MARGIN_PIXELS`] at the farthest corner of the grid, in voxels along each axis.
    margin: DVec3,
}

/// Where a brick is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The first and behind the last pixel, across and down, whose rays may meet the brick.
    pub pixels: [[u32; 2]; 2],
    low: DVec3,
    high: DVec3,
}

impl Eye {
    /// That of a camera.
    pub fn new(grid: &Grid, camera: &Camera, extent_pixels: [u32; 2]) -> Self {
        let rays = camera.rays(extent_pixels);
        let far = grid.far_corner();
        let depths = corners([DVec3::ZERO, far]).map(|corner| {
            let point = grid.world_from_voxel.transform_point3(corner);
            rays.forward.dot(point - rays.origin)
        });
        let farthest = depths.into_iter().fold(0.0, f64::max);
        let side = |dx: DVec3, dy: DVec3| dx.length().max(dy.length());
        let pixel_world = side(rays.origin_dx, rays.origin_dy)
            + side(rays.direction_dx, rays.direction_dy) * farthest;
        let rows = grid.voxel_rows().map(DVec3::length);
        Self {
            margin: MARGIN_PIXELS * pixel_world * DVec3::from_array(rows) + 1e-3,
            rays,
            extent_pixels,
            world_from_voxel: grid.world_from_voxel,
            voxel_from_world: grid.world_from_voxel.inverse(),
        }
    }

    /// Where the voxels of a box are seen; `None` where they lie beside the picture or behind the eye.
    pub fn place_of(&self, own: VoxelBox) -> Option<Place> {
        let ends = [own.min, own.max].map(|corner| DVec3::from_array(corner.map(f64::from)));
        let pixels = self.pixels_of(ends)?;
        Some(Place {
            pixels,
            low: ends[0] - self.margin,
            high: ends[1] + self.margin,
        })
    }

    fn pixels_of(&self, ends: [DVec3; 2]) -> Option<[[u32; 2]; 2]> {
        let Self {
            rays,
            extent_pixels,
            ..
        } = self;
        let is_perspective = rays.origin_dx == DVec3::ZERO;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut behind = 0;
        for corner in corners(ends) {
            let from_eye = self.world_from_voxel.transform_point3(corner) - rays.origin;
            let depth = rays.forward.dot(from_eye);
            let (seen, across) = match is_perspective {
                true if depth <= 0.0 => {
                    behind += 1;
                    continue;
                }
                true => (
                    from_eye / depth - rays.direction,
                    [rays.direction_dx, rays.direction_dy],
                ),
                false => (from_eye, [rays.origin_dx, rays.origin_dy]),
            };
            for k in 0..2 {
                let pixel = seen.dot(across[k]) / across[k].length_squared();
                (low[k], high[k]) = (low[k].min(pixel), high[k].max(pixel));
            }
        }
        if behind == 8 {
            return None;
        }
        if behind > 0 {
            return Some([[0; 2], *extent_pixels]);
        }
        let first = low.map(|x| (x - MARGIN_PIXELS).floor().max(0.0));
        let end = [0, 1].map(|k| {
            let end = (high[k] + MARGIN_PIXELS).ceil();
            end.min(f64::from(extent_pixels[k]))
        });
        let is_inside = (0..2).all(|k| first[k] < end[k]);
        is_inside.then(|| [first, end].map(|ends| ends.map(|x| x as u32)))
    }

    /// Whether rays of a pixel may meet the brick, by its slabs (Kay and Kajiya 1986).
    pub fn meets(&self, place: &Place, [x, y]: [u32; 2]) -> bool {
        let (origin, direction) = self.rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let origin = self.voxel_from_world.transform_point3(origin);
        let direction = self.voxel_from_world.transform_vector3(direction);
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for k in 0..3 {
            let at = |bound: f64| (bound - origin[k]) / direction[k];
            let [a, b] = [at(place.low[k]), at(place.high[k])];
            // In a slab and along it: no bound. NaN of 0 / 0 is none either.
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter <= leave
    }
}

fn corners([low, high]: [DVec3; 2]) -> [DVec3; 8] {
    std::array::from_fn(|corner| {
        let end = |k: usize| {
            if corner >> k & 1 == 0 {
                low[k]
            } else {
                high[k]
            }
        };
        DVec3::new(end(0), end(1), end(2))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use glam::{DAffine3, dvec3};

    #[test]
    fn rays_that_meet_a_box_go_through_its_pixels() {
        let affine = DAffine3::from_cols(
            dvec3(1.0, 0.2, 0.0),
            dvec3(-0.1, 2.0, 0.3),
            dvec3(0.0, 0.0, 0.7),
            dvec3(-20.0, -30.0, 4.0),
        );
        let grid = Grid {
            dims: [40; 3],
            world_from_voxel: affine,
        };
        let extent = [61, 47];
        let (mut beside, mut loose, mut met) = (0, 0, 0);
        for projection in [
            Projection::Perspective { fov_degrees: 60.0 },
            Projection::Orthographic { view_height: 30.0 },
        ] {
            for eye in [
                dvec3(60.0, 10.0, 50.0),
                dvec3(3.0, 5.0, 20.0),
                dvec3(-90.0, 4.0, 0.0),
            ] {
                let camera = Camera {
                    eye,
                    target: dvec3(0.0, 8.0, 15.0),
                    up: dvec3(0.0, 0.3, 1.0),
                    projection,
                    zoom: 1.0,
                };
                let rays = camera.rays(extent);
                let eye = Eye::new(&grid, &camera, extent);
                for nth in 0..27 {
                    let min = [nth % 3, nth / 3 % 3, nth / 9].map(|n| n * 13);
                    let own = VoxelBox {
                        min,
                        max: min.map(|n| n + 13),
                    };
                    let place = eye.place_of(own);
                    beside += usize::from(place.is_none());
                    for (x, y) in (0..extent[1]).flat_map(|y| (0..extent[0]).map(move |x| (x, y))) {
                        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
                        let inverse = affine.inverse();
                        let (origin, direction) = (
                            inverse.transform_point3(origin),
                            inverse.transform_vector3(direction),
                        );
                        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
                        for k in 0..3 {
                            let at = |n: u32| (f64::from(n) - origin[k]) / direction[k];
                            let (a, b) = (at(own.min[k]), at(own.max[k]));
                            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
                        }
                        let is_in = place.is_some_and(|place| {
                            let [first, end] = place.pixels;
                            (first[0]..end[0]).contains(&x)
                                && (first[1]..end[1]).contains(&y)
                                && eye.meets(&place, [x, y])
                        });
                        assert!(
                            enter >= leave || is_in,
                            "{projection:?}: pixel {x}, {y} meets {own:?}, not in {place:?}"
                        );
                        let is_near = place.is_some_and(|place| eye.meets(&place, [x, y]));
                        loose += usize::from(enter >= leave && is_near);
                        met += usize::from(enter < leave);
                    }
                }
            }
        }
        assert!(beside > 10, "{beside} boxes lie beside the picture");
        assert!(loose < met, "{met} pixels meet a box, {loose} others may");
    }
}
