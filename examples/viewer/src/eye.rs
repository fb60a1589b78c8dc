//! Where the eye is: the numbers that a hand changes, and the camera that they make.
//!
//! ```text
//! turn    azimuth -= 0.4 degrees a point to the right, elevation += 0.4 degrees a point down
//! move    the target goes with the pointer: one pixel is  plane height / picture height  of the world at its distance
//! zoom    a notch of the wheel is a factor of 1.2, towards what the pointer is on
//! ```

use glam::DVec3;
use stratavox::camera::{BoundingSphere, Camera, Error, Lens, Orbit};

const DEGREES_PER_POINT: f64 = 0.4;
/// At the very poles the picture's upright is another one.
const STEEPEST_DEGREES: f64 = 89.9;
const FOV_DEGREES: f64 = 30.0;

#[derive(Clone, Debug, PartialEq)]
pub struct Eye {
    bounds: BoundingSphere,
    side: Orbit,
    pub orbit: Orbit,
    pub target: DVec3,
    pub zoom: f64,
    pub is_parallel: bool,
}

impl Eye {
    /// All of `bounds`, from `side`.
    pub fn new(bounds: BoundingSphere, side: Orbit) -> Self {
        Self {
            target: bounds.center,
            bounds,
            side,
            orbit: side,
            zoom: 1.0,
            is_parallel: false,
        }
    }

    /// Back to where it began, with the projection that it has.
    pub fn reset(&mut self) {
        (self.orbit, self.target, self.zoom) = (self.side, self.bounds.center, 1.0);
    }

    pub fn camera(&self, extent: [u32; 2]) -> Result<Camera, Error> {
        let lens = match self.is_parallel {
            true => Lens::Orthographic { view_height: None },
            false => Lens::Perspective {
                fov_degrees: FOV_DEGREES,
            },
        };
        let camera = Camera::orbit(&self.bounds, self.target, self.orbit, None, lens, extent)?;
        Ok(Camera {
            zoom: self.zoom,
            ..camera
        })
    }

    pub fn turn(&mut self, right: f64, down: f64) {
        self.orbit.azimuth_degrees =
            (self.orbit.azimuth_degrees - DEGREES_PER_POINT * right).rem_euclid(360.0);
        let elevation = self.orbit.elevation_degrees + DEGREES_PER_POINT * down;
        self.orbit.elevation_degrees = elevation.clamp(-STEEPEST_DEGREES, STEEPEST_DEGREES);
    }

    /// By so many pixels of a picture.
    pub fn shift(&mut self, right: f64, down: f64, extent: [u32; 2]) {
        let Ok(camera) = self.camera(extent) else {
            return;
        };
        let frame = camera.frame();
        let distance = match self.is_parallel {
            true => 1.0,
            false => (camera.target - camera.eye).length(),
        };
        let per_pixel = camera.plane_height() * distance / f64::from(extent[1]);
        self.target += per_pixel * (down * frame.up - right * frame.right);
    }

    /// Nearer (over 1) or farther; what lies `at` a pixel from the middle stays there.
    pub fn approach(&mut self, factor: f64, at: [f64; 2], extent: [u32; 2]) {
        let zoom = (self.zoom * factor).clamp(0.05, 500.0);
        let factor = zoom / self.zoom;
        let [right, down] = at.map(|pixels| pixels * (1.0 - factor) / factor);
        self.shift(right, down, extent);
        self.zoom = zoom;
    }

    /// The words by which `stratavox render` draws the same.
    pub fn words(&self) -> String {
        let Self {
            orbit,
            target,
            zoom,
            is_parallel,
            ..
        } = self;
        let projection = if *is_parallel {
            "orthographic"
        } else {
            "perspective"
        };
        format!(
            "--projection {projection} --azimuth {} --elevation {} --zoom {zoom} --target {},{},{}",
            orbit.azimuth_degrees, orbit.elevation_degrees, target.x, target.y, target.z
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stratavox::camera::View;

    const EXTENT: [u32; 2] = [640, 480];

    fn eye() -> Eye {
        let bounds = BoundingSphere {
            center: DVec3::new(3.0, -2.0, 7.0),
            radius: 50.0,
        };
        Eye::new(bounds, View::Anterior.orbit())
    }

    /// The pixel that a point of the world is seen at, found on the plane through the target.
    fn on_plane(eye: &Eye, x: f64, y: f64) -> DVec3 {
        let camera = eye.camera(EXTENT).unwrap();
        let forward = camera.frame().forward;
        let (origin, direction) = camera.rays(EXTENT).at(x, y);
        let t = (eye.target - origin).dot(forward) / direction.dot(forward);
        origin + t * direction
    }

    #[test]
    fn what_is_dragged_stays_under_the_pointer() {
        for is_parallel in [false, true] {
            let mut eye = Eye {
                is_parallel,
                ..eye()
            };
            eye.turn(31.0, 17.0);
            let plane = eye.target;
            let grabbed = on_plane(&eye, 200.0, 150.0);
            eye.shift(40.0, -25.0, EXTENT);
            // The plane through the old target is that through the new one: the move lies in it.
            let found = on_plane(&eye, 240.0, 125.0);
            assert!((found - grabbed).length() < 1e-9, "{found} {grabbed}");
            assert!(eye.target != plane);
        }
    }

    #[test]
    fn the_wheel_keeps_what_is_under_the_pointer() {
        for is_parallel in [false, true] {
            let mut eye = Eye {
                is_parallel,
                ..eye()
            };
            let [x, y] = [500.0, 100.0];
            let seen = on_plane(&eye, x, y);
            eye.approach(1.7, [x - 320.0, y - 240.0], EXTENT);
            let found = on_plane(&eye, x, y);
            assert!((found - seen).length() < 1e-9, "{found} {seen}");
        }
    }

    #[test]
    fn a_turn_never_goes_over_the_pole() {
        let mut eye = eye();
        eye.turn(0.0, 10_000.0);
        assert_eq!(eye.orbit.elevation_degrees, STEEPEST_DEGREES);
        let up = eye.camera(EXTENT).unwrap().frame().up;
        eye.turn(0.0, -1.0);
        let lower = eye.camera(EXTENT).unwrap().frame().up;
        assert!(up.dot(lower) > 0.999, "{up} {lower}");
    }
}
