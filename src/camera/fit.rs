//! A camera moved so that a part of what it sees fills the picture, its direction kept.
//!
//! A pixel at distance `d` of the target has the side `p` in the world:
//!
//! ```text
//! p        = plane_height d / H  (perspective),   plane_height / H  (orthographic)
//! target'  = target + (x - W/2) p right - (y - H/2) p up,   the eye moves alike      (x, y): middle of the rectangle
//! zoom'    = zoom share min(W / w, H / h)                                            w x h: its size
//! ```
//!
//! Exact in orthographic projection. In perspective an eye that moves sees other sides of things: fit twice.

use super::Camera;
use glam::DVec3;

/// A rectangle of a picture in pixels: left, top, right, bottom; x to the right, y down, pixel centres at +0.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelBox {
    /// Left and top.
    pub min: [f64; 2],
    /// Right and bottom.
    pub max: [f64; 2],
}

impl PixelBox {
    /// The smallest box around points; `None` of none.
    pub fn around(points: impl IntoIterator<Item = [f64; 2]>) -> Option<Self> {
        points.into_iter().fold(None, |found, point| {
            Some(match found {
                None => Self {
                    min: point,
                    max: point,
                },
                Some(found) => found.union(Self {
                    min: point,
                    max: point,
                }),
            })
        })
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self {
            min: [0, 1].map(|k| self.min[k].min(other.min[k])),
            max: [0, 1].map(|k| self.max[k].max(other.max[k])),
        }
    }

    /// Width and height.
    pub fn size(&self) -> [f64; 2] {
        [0, 1].map(|k| self.max[k] - self.min[k])
    }
}

impl Camera {
    /// This camera moved sideways and zoomed so that `part` of its picture fills `share` of the new one, in the middle.
    /// A box without area is only moved to the middle.
    pub fn fitted(&self, part: &PixelBox, extent_pixels: [u32; 2], share: f64) -> Self {
        let extent = extent_pixels.map(f64::from);
        let frame = self.frame();
        let distance = match self.projection.is_perspective() {
            true => self.eye.distance(self.target),
            false => 1.0,
        };
        let pixel = self.plane_height() * distance / extent[1];
        let [x, y] = [0, 1].map(|k| 0.5 * (part.min[k] + part.max[k] - extent[k]) * pixel);
        let shift = x * frame.right - y * frame.up;
        let size = part.size();
        let nearer = [0, 1].map(|k| extent[k] / size[k]);
        let nearer = nearer[0].min(nearer[1]);
        Self {
            eye: self.eye + shift,
            target: self.target + shift,
            zoom: match nearer.is_finite() {
                true => self.zoom * share * nearer,
                false => self.zoom,
            },
            ..*self
        }
    }

    /// Where a point of the world lies in the picture; `None` behind the eye.
    pub fn project(&self, point: DVec3, extent_pixels: [u32; 2]) -> Option<[f64; 2]> {
        let extent = extent_pixels.map(f64::from);
        let frame = self.frame();
        let from_eye = point - self.eye;
        let depth = match self.projection.is_perspective() {
            true => from_eye.dot(frame.forward),
            false => 1.0,
        };
        let pixel = self.plane_height() * depth / extent[1];
        (depth > 0.0).then(|| {
            [
                0.5 * extent[0] + from_eye.dot(frame.right) / pixel,
                0.5 * extent[1] - from_eye.dot(frame.up) / pixel,
            ]
        })
    }

    /// This camera fitted to points of the world; unchanged where one of them lies behind the eye.
    pub fn fitted_to_points(&self, points: &[DVec3], extent_pixels: [u32; 2], share: f64) -> Self {
        // Each round takes away most of what moving the eye changed.
        const ROUNDS: usize = 4;
        let mut camera = *self;
        for _ in 0..ROUNDS {
            let projected = points.iter().map(|&p| camera.project(p, extent_pixels));
            let Some(projected) = projected.collect::<Option<Vec<_>>>() else {
                return *self;
            };
            let Some(part) = PixelBox::around(projected) else {
                return *self;
            };
            camera = camera.fitted(&part, extent_pixels, share);
        }
        camera
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use glam::dvec3;

    fn camera(projection: Projection) -> Camera {
        Camera {
            eye: dvec3(30.0, 20.0, 10.0),
            target: dvec3(1.0, 2.0, 3.0),
            up: DVec3::Z,
            projection,
            zoom: 1.3,
        }
    }

    #[test]
    fn a_projected_point_lies_on_the_ray_of_its_pixel() {
        for projection in [
            Projection::Perspective { fov_degrees: 30.0 },
            Projection::Orthographic { view_height: 20.0 },
        ] {
            let camera = camera(projection);
            let extent = [320, 200];
            let (origin, along) = camera.rays(extent).at(77.0, 151.0);
            let [x, y] = camera
                .project(origin + 25.0 * along, extent)
                .expect("in front");
            assert!(
                (x - 77.0).abs() < 1e-9 && (y - 151.0).abs() < 1e-9,
                "{x} {y}"
            );
        }
    }

    #[test]
    fn points_fill_the_share_and_lie_in_the_middle() {
        let points = [
            dvec3(2.0, 1.0, 0.0),
            dvec3(5.0, 4.0, 2.0),
            dvec3(3.0, 3.0, 4.0),
        ];
        for projection in [
            Projection::Perspective { fov_degrees: 30.0 },
            Projection::Orthographic { view_height: 20.0 },
        ] {
            let extent = [320, 200];
            let fitted = camera(projection).fitted_to_points(&points, extent, 0.9);
            let found = points.map(|p| fitted.project(p, extent).expect("in front"));
            let found = PixelBox::around(found).expect("points");
            let [w, h] = found.size();
            assert!(((w / 320.0).max(h / 200.0) - 0.9).abs() < 1e-3, "{found:?}");
            for (k, side) in [320.0, 200.0].into_iter().enumerate() {
                let middle = 0.5 * (found.min[k] + found.max[k]);
                assert!((middle - 0.5 * side).abs() < 0.1, "{found:?}");
            }
        }
    }
}
