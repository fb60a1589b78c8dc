//! Where places of the world lie in the picture.

use crate::{
    camera::{Camera, Frame},
    figure::Point,
};
use glam::DVec3;

/// From world to pixels, x right and y down.
#[derive(Clone, Copy, Debug)]
pub struct Projector {
    camera: Camera,
    /// The camera's axes.
    pub frame: Frame,
    middle: Point,
    /// World length of a pixel: at distance 1 in perspective, anywhere else.
    pixel: f64,
}

impl Projector {
    /// Of a picture of so many pixels across and down.
    pub fn new(camera: &Camera, [width, height]: [f64; 2]) -> Self {
        Self {
            camera: *camera,
            frame: camera.frame(),
            middle: [0.5 * width, 0.5 * height],
            pixel: camera.plane_height() / height,
        }
    }

    /// Whether lengths depend on the distance from the eye.
    pub fn is_perspective(&self) -> bool {
        self.camera.projection.is_perspective()
    }

    /// World length of a pixel in the plane of the target.
    pub fn pixel_at_target(&self) -> f64 {
        match self.is_perspective() {
            true => self.pixel * self.depth(self.camera.target),
            false => self.pixel,
        }
    }

    /// How far in front of the eye a point lies.
    pub fn depth(&self, point: DVec3) -> f64 {
        (point - self.camera.eye).dot(self.frame.forward)
    }

    /// From the eye to a point, or from the plane of the eye.
    pub fn towards(&self, point: DVec3) -> DVec3 {
        match self.is_perspective() {
            true => point - self.camera.eye,
            false => self.frame.forward,
        }
    }

    /// The pixel of a point in front of the eye.
    pub fn point(&self, point: DVec3) -> Point {
        let from = point - self.camera.eye;
        let pixel = match self.is_perspective() {
            true => self.pixel * from.dot(self.frame.forward),
            false => self.pixel,
        };
        [
            self.middle[0] + from.dot(self.frame.right) / pixel,
            self.middle[1] - from.dot(self.frame.up) / pixel,
        ]
    }

    /// The two ends of a line in the picture, as far as it lies in front of the eye.
    pub fn line(&self, [from, to]: [DVec3; 2]) -> Option<[Point; 2]> {
        if !self.is_perspective() {
            return Some([self.point(from), self.point(to)]);
        }
        let least = 1e-3 * (self.camera.target - self.camera.eye).length();
        let [near, far] = [self.depth(from), self.depth(to)];
        if near < least && far < least {
            return None;
        }
        let cut = |point: DVec3, depth: f64, other: DVec3, other_depth: f64| {
            let t = ((least - depth) / (other_depth - depth)).clamp(0.0, 1.0);
            if depth < least {
                point.lerp(other, t)
            } else {
                point
            }
        };
        let ends = [cut(from, near, to, far), cut(to, far, from, near)];
        Some(ends.map(|end| self.point(end)))
    }
}
