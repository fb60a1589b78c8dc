//! Where the eye is and what it sees, in world space, f64.
//!
//! With `f`, `r`, `u` the unit forward, right and up vectors, a picture of W x H pixels, and a pixel of
//! side `p` on the picture plane, the point (x, y) of the picture (x right, y down, the centre of a pixel
//! at +0.5) is looked at along
//!
//! ```text
//! perspective    p = 2 tan(fov / 2) / (zoom H)    from eye
//!                                                 along normalize(f + (x - W/2) p r - (y - H/2) p u)
//! orthographic   p = view_height / (zoom H)       from eye + (x - W/2) p r - (y - H/2) p u
//!                                                 along f
//! ```
//!
//! A host's matrices give the picture's rectangle by its sides instead ([`Projection::Frustum`],
//! [`Projection::Parallel`]): pixels need not be square then, and the eye need not look at the middle
//! (`camera/matrices.rs`).
//!
//! The words of the command line for it stand in `camera/orbit.rs`.

mod fit;
mod matrices;
mod orbit;

pub use fit::PixelBox;
pub use matrices::{DepthConvention, HostDepth};
pub use orbit::{BoundingSphere, Lens, Orbit, View, fitted_view_height, up_for};

use glam::DVec3;

/// A camera. One that passes [`Camera::check`] gives finite rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where rays start (orthographic: a point of the plane where they start).
    pub eye: DVec3,
    /// A point in the middle of the picture.
    pub target: DVec3,
    /// A direction that points up in the picture; not parallel to the one from `eye` to `target`.
    pub up: DVec3,
    /// How rays spread.
    pub projection: Projection,
    /// Divides the picture plane; the eye stays.
    pub zoom: f64,
}

/// How rays spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the eye.
    Perspective {
        /// Full vertical angle at zoom 1.
        fov_degrees: f64,
    },
    /// All rays are parallel.
    Orthographic {
        /// World height of the picture at zoom 1.
        view_height: f64,
    },
    /// All rays start at the eye and go through a rectangle at distance 1 from it.
    Frustum(Sides),
    /// All rays are parallel and start in a rectangle around the eye.
    Parallel(Sides),
}

/// A rectangle of the picture plane, seen from the eye: right and up are positive. Left over right mirrors the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub struct Sides {
    pub left: f64,
    pub right: f64,
    pub bottom: f64,
    pub top: f64,
}

impl Projection {
    /// True where all rays start at the eye.
    pub fn is_perspective(&self) -> bool {
        matches!(self, Self::Perspective { .. } | Self::Frustum(_))
    }
}

/// The camera's own axes in world space: orthonormal, right x up = -forward.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub struct Frame {
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
}

/// The rays of a picture. At the picture point (x, y), pixel centres at +0.5 (the caller adds it):
///
/// ```text
/// origin    = origin + x origin_dx + y origin_dy
/// direction = normalize(direction + x direction_dx + y direction_dy)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rays {
    /// World origin of the ray through the upper left corner of the picture.
    pub origin: DVec3,
    /// Zero in perspective.
    pub origin_dx: DVec3,
    /// Zero in perspective.
    pub origin_dy: DVec3,
    /// World direction through the upper left corner; its length in perspective is not 1.
    pub direction: DVec3,
    /// Zero in orthographic projection.
    pub direction_dx: DVec3,
    /// Zero in orthographic projection.
    pub direction_dy: DVec3,
    /// The unit vector that the camera looks along.
    pub forward: DVec3,
}

/// Why a camera sees nothing at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A coordinate is infinite or not a number.
    #[error("the camera's {0} is not finite")]
    NotFinite(&'static str),
    /// There is no direction to look along.
    #[error("the camera's eye and target are the same point")]
    NoDirection,
    /// There is no picture upright.
    #[error("the camera's up vector is zero or parallel to the direction it looks along")]
    NoUp,
    /// A host's view matrix does more than to turn and to move.
    #[error(
        "the view matrix: wanted a turn and a shift alone, found axes that are off by {shear:.1e}, or a last row that is not (0, 0, 0, 1)"
    )]
    NotRigid {
        /// The largest error of lengths and right angles.
        shear: f64,
    },
    /// A host's projection matrix is none.
    #[error("the projection matrix: wanted a perspective or an orthographic one, but {reason}")]
    NoProjection {
        /// What it does.
        reason: &'static str,
    },
    /// A number of the lens is out of its range.
    #[error("the camera's {what}: wanted {wanted}, found {found}")]
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// What would do.
        wanted: &'static str,
        /// What stands there.
        found: f64,
    },
}

/// Sine of the angle between up and forward under which a picture has no upright.
const SMALLEST_UP_SINE: f64 = 1e-9;

impl Camera {
    /// Errors where rays would not be finite.
    pub fn check(&self) -> Result<(), Error> {
        for (what, point) in [
            ("eye", self.eye),
            ("target", self.target),
            ("up vector", self.up),
        ] {
            if !point.is_finite() {
                return Err(Error::NotFinite(what));
            }
        }
        let Some(forward) = (self.target - self.eye).try_normalize() else {
            return Err(Error::NoDirection);
        };
        match self.up.try_normalize() {
            Some(up) if forward.cross(up).length() > SMALLEST_UP_SINE => {}
            _ => return Err(Error::NoUp),
        }
        let (what, wanted, found, is_good) = match self.projection {
            Projection::Perspective { fov_degrees: f } => (
                "angle of view",
                "over 0 and under 180 degrees",
                f,
                f > 0.0 && f < 180.0,
            ),
            Projection::Orthographic { view_height: h } => {
                ("view height", "over 0", h, h > 0.0 && h.is_finite())
            }
            Projection::Frustum(sides) | Projection::Parallel(sides) => {
                let (width, height) = (sides.right - sides.left, sides.top - sides.bottom);
                // The one of the two that is no length.
                let is_bad = |length: f64| length == 0.0 || !length.is_finite();
                let found = if is_bad(width) { width } else { height };
                (
                    "rectangle's width and height",
                    "not 0",
                    found,
                    !is_bad(width) && !is_bad(height),
                )
            }
        };
        if !is_good {
            return Err(Error::OutOfRange {
                what,
                wanted,
                found,
            });
        }
        if !(self.zoom > 0.0 && self.zoom.is_finite()) {
            return Err(Error::OutOfRange {
                what: "zoom",
                wanted: "over 0",
                found: self.zoom,
            });
        }
        Ok(())
    }

    /// The camera's axes in world space.
    pub fn frame(&self) -> Frame {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        Frame {
            right,
            up: right.cross(forward),
            forward,
        }
    }

    /// World height of the picture: at distance 1 from the eye in perspective, anywhere in orthographic.
    pub fn plane_height(&self) -> f64 {
        match self.projection {
            Projection::Perspective { fov_degrees } => {
                2.0 * (0.5 * fov_degrees.to_radians()).tan() / self.zoom
            }
            Projection::Orthographic { view_height } => view_height / self.zoom,
            Projection::Frustum(sides) | Projection::Parallel(sides) => {
                (sides.top - sides.bottom).abs() / self.zoom
            }
        }
    }

    /// The rays of a picture of so many pixels across and down. Pixels are square, but for the rectangles of hosts.
    pub fn rays(&self, extent_pixels: [u32; 2]) -> Rays {
        let Frame { right, up, forward } = self.frame();
        let [width, height] = extent_pixels.map(f64::from);
        let (dx, dy, corner) = match self.projection {
            Projection::Perspective { .. } | Projection::Orthographic { .. } => {
                let pixel = self.plane_height() / height;
                let (dx, dy) = (pixel * right, -pixel * up);
                (dx, dy, -0.5 * (width * dx + height * dy))
            }
            Projection::Frustum(sides) | Projection::Parallel(sides) => {
                let across = (sides.right - sides.left) / self.zoom;
                let down = (sides.bottom - sides.top) / self.zoom;
                let corner = (sides.left * right + sides.top * up) / self.zoom;
                (across / width * right, down / height * up, corner)
            }
        };
        let rays = Rays {
            origin: self.eye,
            origin_dx: DVec3::ZERO,
            origin_dy: DVec3::ZERO,
            direction: forward,
            direction_dx: DVec3::ZERO,
            direction_dy: DVec3::ZERO,
            forward,
        };
        match self.projection.is_perspective() {
            true => Rays {
                direction: forward + corner,
                direction_dx: dx,
                direction_dy: dy,
                ..rays
            },
            false => Rays {
                origin: self.eye + corner,
                origin_dx: dx,
                origin_dy: dy,
                ..rays
            },
        }
    }
}

impl Rays {
    /// World origin and unit world direction at a point of the picture; pixel centres are at +0.5.
    pub fn at(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        (
            self.origin + x * self.origin_dx + y * self.origin_dy,
            (self.direction + x * self.direction_dx + y * self.direction_dy).normalize(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    fn from_the_front(projection: Projection) -> Camera {
        Camera {
            eye: dvec3(0.0, 10.0, 0.0),
            target: DVec3::ZERO,
            up: DVec3::Z,
            projection,
            zoom: 1.0,
        }
    }

    #[track_caller]
    fn assert_near(found: DVec3, wanted: DVec3) {
        let off = (found - wanted).length();
        assert!(off < 1e-14, "found {found}, wanted {wanted}: off by {off}");
    }

    #[test]
    fn from_the_front_the_patients_left_is_on_the_right_of_the_picture() {
        let frame = from_the_front(Projection::Perspective { fov_degrees: 90.0 }).frame();
        assert_near(frame.forward, -DVec3::Y);
        assert_near(frame.right, -DVec3::X);
        assert_near(frame.up, DVec3::Z);
    }

    #[test]
    fn a_frame_is_orthonormal_where_up_leans() {
        let camera = Camera {
            eye: dvec3(3.0, -2.0, 7.0),
            target: dvec3(1.0, 1.0, 1.0),
            up: dvec3(0.2, 0.9, 0.4),
            projection: Projection::Perspective { fov_degrees: 30.0 },
            zoom: 1.0,
        };
        let Frame { right, up, forward } = camera.frame();
        assert_near(right.cross(up), -forward);
        for (name, dot) in [
            ("right.up", right.dot(up)),
            ("up.forward", up.dot(forward)),
            ("forward.right", forward.dot(right)),
        ] {
            assert!(dot.abs() < 1e-15, "{name} = {dot}");
        }
        assert!(
            up.dot(camera.up) > 0.0,
            "up points down: {}",
            up.dot(camera.up)
        );
    }

    #[test]
    fn perspective_rays_start_at_the_eye_and_open_by_the_vertical_angle() {
        // tan(45 degrees) = 1: the plane at distance 1 is 2 high and, at 4:2, 4 wide.
        let rays = from_the_front(Projection::Perspective { fov_degrees: 90.0 }).rays([4, 2]);
        for (x, y, wanted) in [
            (2.0, 1.0, dvec3(0.0, -1.0, 0.0)),
            (0.0, 0.0, dvec3(2.0, -1.0, 1.0)),
            (4.0, 2.0, dvec3(-2.0, -1.0, -1.0)),
            (0.5, 1.5, dvec3(1.5, -1.0, -0.5)),
        ] {
            let (origin, direction) = rays.at(x, y);
            assert_near(origin, dvec3(0.0, 10.0, 0.0));
            assert_near(direction, wanted.normalize());
        }
    }

    #[test]
    fn orthographic_rays_start_on_the_plane_through_the_eye() {
        let rays = from_the_front(Projection::Orthographic { view_height: 6.0 }).rays([4, 2]);
        for (x, y, wanted) in [
            (0.0, 0.0, dvec3(6.0, 10.0, 3.0)),
            (3.5, 0.5, dvec3(-4.5, 10.0, 1.5)),
        ] {
            let (origin, direction) = rays.at(x, y);
            assert_near(origin, wanted);
            assert_near(direction, -DVec3::Y);
        }
    }

    #[test]
    fn zoom_divides_the_picture_plane_and_leaves_the_eye() {
        for (projection, height) in [
            (Projection::Perspective { fov_degrees: 90.0 }, 2.0),
            (Projection::Orthographic { view_height: 6.0 }, 6.0),
        ] {
            let camera = Camera {
                zoom: 4.0,
                ..from_the_front(projection)
            };
            let found = camera.plane_height();
            assert!(
                (found - height / 4.0).abs() < 1e-15,
                "{projection:?}: {found}"
            );
            assert_near(camera.rays([2, 2]).at(1.0, 1.0).0, camera.eye);
        }
    }

    #[test]
    fn a_camera_that_sees_nothing_says_why() {
        let good = from_the_front(Projection::Perspective { fov_degrees: 30.0 });
        assert_eq!(good.check(), Ok(()));
        let same = Camera {
            target: good.eye,
            ..good
        };
        assert_eq!(same.check(), Err(Error::NoDirection));
        let along = Camera {
            up: dvec3(0.0, -3.0, 0.0),
            ..good
        };
        assert_eq!(along.check(), Err(Error::NoUp));
        let nan = Camera {
            eye: dvec3(f64::NAN, 0.0, 0.0),
            ..good
        };
        assert_eq!(nan.check(), Err(Error::NotFinite("eye")));
        for (projection, zoom, word) in [
            (
                Projection::Perspective { fov_degrees: 180.0 },
                1.0,
                "angle of view",
            ),
            (
                Projection::Orthographic { view_height: 0.0 },
                1.0,
                "view height",
            ),
            (good.projection, 0.0, "zoom"),
            (good.projection, f64::NAN, "zoom"),
        ] {
            let camera = Camera {
                projection,
                zoom,
                ..good
            };
            let text = camera.check().expect_err("out of range").to_string();
            assert!(text.contains(word), "{text}");
        }
    }
}
