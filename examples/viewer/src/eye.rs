//! Where the eye is: the numbers that a hand changes, and the camera that they make.
//!
//! ```text
//! turn    azimuth -= 0.4 degrees a point to the right, elevation += 0.4 degrees a point down
//! move    the target goes with the pointer: one pixel is  plane height / picture height  of the world at its distance
//! zoom    a notch of the wheel is a factor of 1.2, towards what the pointer is on
//! fit     zoom so that the corners of the box reach to 0.94 of the way from the middle of the picture to its sides
//! ```

use glam::DVec3;
use stratavox::camera::{BoundingSphere, Camera, Error, Lens, Orbit};
use stratavox::volume::Grid;

const DEGREES_PER_POINT: f64 = 0.4;
/// At the very poles the picture's upright is another one.
const STEEPEST_DEGREES: f64 = 89.9;
const FOV_DEGREES: f64 = 30.0;
/// Where the farthest corner of a box that fits is, on the way from the middle of the picture to its side.
const FIT: f64 = 0.94;

#[derive(Clone, Debug, PartialEq)]
pub struct Eye {
    grid: Grid,
    bounds: BoundingSphere,
    side: Orbit,
    /// Small pictures choose the side, each time that it is fitted.
    pub may_choose_side: bool,
    /// False until the zoom is that of [`Eye::fit`], or a hand's.
    is_fitted: bool,
    pub orbit: Orbit,
    pub target: DVec3,
    pub zoom: f64,
    pub is_parallel: bool,
}

impl Eye {
    /// All of the box of `grid`, from `side`.
    pub fn new(grid: Grid, side: Orbit) -> Self {
        let bounds = BoundingSphere::of_grid(&grid.world_from_voxel, grid.dims);
        Self {
            target: bounds.center,
            grid,
            bounds,
            side,
            may_choose_side: false,
            is_fitted: false,
            orbit: side,
            zoom: 1.0,
            is_parallel: false,
        }
    }

    /// Zooms so that the box just fits a picture of this size, the first time and after [`Eye::reset`].
    pub fn fit(&mut self, extent: [u32; 2]) {
        if self.is_fitted {
            return;
        }
        self.zoom = 1.0;
        let Ok(camera) = self.camera(extent) else {
            return;
        };
        let frame = camera.frame();
        let half_height = 0.5 * camera.plane_height();
        let half_width = half_height * f64::from(extent[0]) / f64::from(extent[1]);
        let far = self.grid.far_corner();
        let reach = (0..8).map(|k| {
            let side = |axis: usize| if k >> axis & 1 == 1 { far[axis] } else { 0.0 };
            let voxel = DVec3::new(side(0), side(1), side(2));
            let from_eye = self.grid.world_from_voxel.transform_point3(voxel) - camera.eye;
            let depth = match self.is_parallel {
                true => 1.0,
                false => from_eye.dot(frame.forward),
            };
            let [x, y] = [frame.right, frame.up].map(|axis| (from_eye.dot(axis) / depth).abs());
            (x / half_width).max(y / half_height)
        });
        self.zoom = FIT / reach.fold(f64::MIN_POSITIVE, f64::max);
        self.is_fitted = true;
    }

    /// True until it is fitted, and after [`Eye::reset`].
    pub fn is_to_be_fitted(&self) -> bool {
        !self.is_fitted
    }

    /// The same, beginning at another side.
    pub fn with_side(&self, side: Orbit) -> Self {
        Self {
            side,
            orbit: side,
            ..self.clone()
        }
    }

    /// Fitted as `camera` is, which looks from the same side.
    pub fn take(&mut self, camera: &Camera) {
        (self.target, self.zoom) = (camera.target, camera.zoom);
        self.is_fitted = true;
    }

    /// Back to where it began, with the projection that it has.
    pub fn reset(&mut self) {
        (self.orbit, self.target) = (self.side, self.bounds.center);
        self.is_fitted = false;
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

    /// DepthConvention (over 1) or farther; what lies `at` a pixel from the middle stays there.
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
    use glam::DAffine3;
    use stratavox::camera::View;

    const EXTENT: [u32; 2] = [640, 480];

    fn eye() -> Eye {
        let grid = Grid {
            dims: [64, 50, 20],
            world_from_voxel: DAffine3::from_translation(DVec3::new(3.0, -2.0, 7.0)),
        };
        Eye::new(grid, View::Anterior.orbit())
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
    fn a_box_that_fits_reaches_almost_to_the_side() {
        // From the front the near face is 64 wide and 20 high, 25 nearer than the middle.
        for (is_parallel, extent) in [(false, EXTENT), (true, EXTENT), (false, [100, 400])] {
            let mut eye = Eye {
                is_parallel,
                ..eye()
            };
            eye.fit(extent);
            let camera = eye.camera(extent).unwrap();
            let nearer = if is_parallel {
                1.0
            } else {
                (camera.target - camera.eye).length() - 25.0
            };
            let half_height = 0.5 * camera.plane_height() * nearer;
            let half_width = half_height * f64::from(extent[0]) / f64::from(extent[1]);
            let found = (32.0 / half_width).max(10.0 / half_height);
            assert!((found - FIT).abs() < 1e-12, "{found}");
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
