//! A camera put on a sphere around what it looks at, so that all of it just fits the picture.
//!
//! With azimuth `a`, elevation `e`, radius `R` of the bounding sphere of the uncropped grid box, and `s` the
//! smaller side of the picture:
//!
//! ```text
//! eye       = target + distance (cos e cos a, cos e sin a, sin e)
//! distance  = R / sin(half the angle of s)        perspective
//!           = 2 R                                 orthographic, and s shows 2 R of the world
//! up        = +z;  +y where |e| > 89.999 degrees
//! ```
//!
//! A positive roll turns the picture clockwise: `up' = cos(roll) up - sin(roll) right`.

use super::{Camera, Error, Frame, Projection};
use glam::{DAffine3, DVec3, dvec3};

/// Elevation from which +z is too near the direction of view to be up.
const STEEPEST_DEGREES: f64 = 89.999;

/// The smallest sphere around the middle of a grid box that holds all of it, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub struct BoundingSphere {
    pub center: DVec3,
    pub radius: f64,
}

/// A direction to look from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub struct Orbit {
    pub azimuth_degrees: f64,
    pub elevation_degrees: f64,
    pub roll_degrees: f64,
}

/// A side of a body in RAS+: the camera stands on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum View {
    Anterior,
    Posterior,
    Left,
    Right,
    Superior,
    Inferior,
}

/// A projection whose size may still follow from what is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// With the full vertical angle.
    Perspective {
        /// At zoom 1.
        fov_degrees: f64,
    },
    /// With the world height of the picture; `None`: the bounding sphere fits.
    Orthographic {
        /// At zoom 1.
        view_height: Option<f64>,
    },
}

impl BoundingSphere {
    /// Of the grid box `[0, dims]`; half the longest of its four diagonals is the radius.
    pub fn of_grid(world_from_voxel: &DAffine3, dims: [u32; 3]) -> Self {
        let [x, y, z] = dims.map(f64::from);
        let half_axes = [
            world_from_voxel.transform_vector3(dvec3(0.5 * x, 0.0, 0.0)),
            world_from_voxel.transform_vector3(dvec3(0.0, 0.5 * y, 0.0)),
            world_from_voxel.transform_vector3(dvec3(0.0, 0.0, 0.5 * z)),
        ];
        let [i, j, k] = half_axes;
        Self {
            center: world_from_voxel.transform_point3(0.5 * dvec3(x, y, z)),
            radius: [i + j + k, i + j - k, i - j + k, i - j - k]
                .map(DVec3::length)
                .into_iter()
                .fold(0.0, f64::max),
        }
    }
}

impl View {
    /// +x is right, +y anterior, +z superior.
    pub fn orbit(self) -> Orbit {
        let (azimuth_degrees, elevation_degrees) = match self {
            Self::Right => (0.0, 0.0),
            Self::Anterior => (90.0, 0.0),
            Self::Left => (180.0, 0.0),
            Self::Posterior => (270.0, 0.0),
            Self::Superior => (0.0, 90.0),
            Self::Inferior => (0.0, -90.0),
        };
        Orbit {
            azimuth_degrees,
            elevation_degrees,
            roll_degrees: 0.0,
        }
    }
}

impl Lens {
    /// The projection under which `bounds` fits a picture of `extent_pixels`, where it is not given.
    pub fn projection(self, bounds: &BoundingSphere, extent_pixels: [u32; 2]) -> Projection {
        match self {
            Self::Perspective { fov_degrees } => Projection::Perspective { fov_degrees },
            Self::Orthographic { view_height } => Projection::Orthographic {
                view_height: view_height
                    .unwrap_or_else(|| fitted_view_height(bounds, extent_pixels)),
            },
        }
    }

    /// From the eye to the target when `bounds` fits the smaller side of the picture.
    fn distance(self, bounds: &BoundingSphere, extent_pixels: [u32; 2]) -> f64 {
        match self {
            Self::Perspective { fov_degrees } => {
                let smaller_over_height = 1.0 / height_over_smaller(extent_pixels);
                let half_angle =
                    ((0.5 * fov_degrees.to_radians()).tan() * smaller_over_height).atan();
                bounds.radius / half_angle.sin()
            }
            Self::Orthographic { .. } => 2.0 * bounds.radius,
        }
    }
}

/// World height of an orthographic picture whose smaller side shows the diameter of `bounds`.
pub fn fitted_view_height(bounds: &BoundingSphere, extent_pixels: [u32; 2]) -> f64 {
    2.0 * bounds.radius * height_over_smaller(extent_pixels)
}

fn height_over_smaller([width, height]: [u32; 2]) -> f64 {
    f64::from(height) / f64::from(width.min(height))
}

/// The up vector where none is given: +z, or +y for a camera that looks along z.
pub fn up_for(direction: DVec3) -> DVec3 {
    let sine = direction.z.abs() / direction.length();
    if sine > STEEPEST_DEGREES.to_radians().sin() {
        DVec3::Y
    } else {
        DVec3::Z
    }
}

impl Camera {
    /// Looks at `target` (often the middle of `bounds`) from the side that `orbit` says, all of `bounds` in
    /// the picture at zoom 1. `up` where the picture's upright is not the usual one.
    pub fn orbit(
        bounds: &BoundingSphere,
        target: DVec3,
        orbit: Orbit,
        up: Option<DVec3>,
        lens: Lens,
        extent_pixels: [u32; 2],
    ) -> Result<Self, Error> {
        let (sin_a, cos_a) = sin_cos_degrees(orbit.azimuth_degrees);
        let (sin_e, cos_e) = sin_cos_degrees(orbit.elevation_degrees);
        let from_target = dvec3(cos_e * cos_a, cos_e * sin_a, sin_e);
        let upright = Self {
            eye: target + lens.distance(bounds, extent_pixels) * from_target,
            target,
            up: up.unwrap_or_else(|| up_for(from_target)),
            projection: lens.projection(bounds, extent_pixels),
            zoom: 1.0,
        };
        upright.check()?;
        let Frame { right, up, .. } = upright.frame();
        let (sin_r, cos_r) = sin_cos_degrees(orbit.roll_degrees);
        let rolled = Self {
            up: cos_r * up - sin_r * right,
            ..upright
        };
        rolled.check()?;
        Ok(rolled)
    }
}

/// Exact at whole quarter turns, so that `--azimuth 90` and `--view anterior` are one camera.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let quarter_turns = (degrees / 90.0).round();
    let (sin, cos) = (degrees - 90.0 * quarter_turns).to_radians().sin_cos();
    match quarter_turns.rem_euclid(4.0) {
        0.0 => (sin, cos),
        1.0 => (cos, -sin),
        2.0 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    const UNIT: BoundingSphere = BoundingSphere {
        center: DVec3::ZERO,
        radius: 1.0,
    };
    const THIRTY: Lens = Lens::Perspective { fov_degrees: 30.0 };

    fn seen(view: View) -> Camera {
        Camera::orbit(&UNIT, DVec3::ZERO, view.orbit(), None, THIRTY, [1024, 768])
            .expect("a camera")
    }

    #[track_caller]
    fn assert_near(found: DVec3, wanted: DVec3) {
        let off = (found - wanted).length();
        assert!(off < 1e-14, "found {found}, wanted {wanted}: off by {off}");
    }

    #[test]
    fn a_view_stands_on_the_side_it_names() {
        // R = 1, half angle 15 degrees: distance 1 / 0.2588190451025207 = 3.8637033051562737.
        let d = 3.863_703_305_156_273_7;
        for (view, eye, up) in [
            (View::Anterior, dvec3(0.0, d, 0.0), DVec3::Z),
            (View::Posterior, dvec3(0.0, -d, 0.0), DVec3::Z),
            (View::Left, dvec3(-d, 0.0, 0.0), DVec3::Z),
            (View::Right, dvec3(d, 0.0, 0.0), DVec3::Z),
            (View::Superior, dvec3(0.0, 0.0, d), DVec3::Y),
            (View::Inferior, dvec3(0.0, 0.0, -d), DVec3::Y),
        ] {
            let camera = seen(view);
            assert_near(camera.eye, eye);
            assert_near(camera.frame().up, up);
        }
    }

    #[test]
    fn azimuth_and_elevation_are_those_of_the_formula() {
        let orbit = Orbit {
            azimuth_degrees: 30.0,
            elevation_degrees: 60.0,
            roll_degrees: 0.0,
        };
        let lens = Lens::Orthographic { view_height: None };
        let target = dvec3(1.0, 2.0, 3.0);
        let camera = Camera::orbit(&UNIT, target, orbit, None, lens, [8, 8]).expect("a camera");
        // cos 60 cos 30 = 0.4330127018922193, cos 60 sin 30 = 0.25, sin 60 = 0.8660254037844386; twice that.
        let wanted = target + dvec3(0.866_025_403_784_438_6, 0.5, 1.732_050_807_568_877_2);
        assert_near(camera.eye, wanted);
    }

    #[test]
    fn up_changes_to_y_beyond_89_999_degrees() {
        for (elevation_degrees, up) in [
            (89.998, DVec3::Z),
            (89.9995, DVec3::Y),
            (-89.998, DVec3::Z),
            (-89.9995, DVec3::Y),
        ] {
            let orbit = Orbit {
                azimuth_degrees: 20.0,
                elevation_degrees,
                roll_degrees: 0.0,
            };
            let camera = Camera::orbit(&UNIT, DVec3::ZERO, orbit, None, THIRTY, [8, 8]);
            let found = camera.expect("a camera").frame().up.dot(up);
            let lean = 90.0 - elevation_degrees.abs();
            let wanted = if up == DVec3::Z {
                lean.to_radians().sin()
            } else {
                1.0
            };
            assert!(
                (found - wanted).abs() < 1e-8,
                "{elevation_degrees}: {found}, wanted {wanted}"
            );
        }
    }

    #[test]
    fn the_sphere_fits_the_smaller_side() {
        // Half as wide as high: tan(15 degrees) / 2 = 0.1339745962155614, its atan 0.13318172872917,
        // the sine of that 0.13278848; the distance is its inverse, sqrt(1 + 1/0.1339745962155614^2).
        let tall = THIRTY.distance(&UNIT, [384, 768]);
        let wanted = (1.0 + 1.0 / 0.133_974_596_215_561_4_f64.powi(2)).sqrt();
        assert!((tall - wanted).abs() < 1e-12, "{tall}, wanted {wanted}");
        for (extent, wanted) in [([1024, 768], 2.0), ([768, 768], 2.0), ([384, 768], 4.0)] {
            let found = fitted_view_height(&UNIT, extent);
            assert!(
                (found - wanted).abs() < 1e-15,
                "{extent:?}: {found}, wanted {wanted}"
            );
        }
    }

    #[test]
    fn a_sphere_that_fits_touches_the_edge_of_the_picture() {
        for (lens, extent) in [
            (THIRTY, [1024, 768]),
            (THIRTY, [300, 768]),
            (Lens::Orthographic { view_height: None }, [1024, 768]),
            (Lens::Orthographic { view_height: None }, [300, 768]),
        ] {
            let orbit = View::Anterior.orbit();
            let camera = Camera::orbit(&UNIT, DVec3::ZERO, orbit, None, lens, extent);
            let rays = camera.expect("a camera").rays(extent);
            let [width, height] = extent.map(f64::from);
            let edge = if width < height {
                (0.0, 0.5 * height)
            } else {
                (0.5 * width, 0.0)
            };
            let (origin, direction) = rays.at(edge.0, edge.1);
            let miss = origin.cross(direction).length();
            assert!(
                (miss - 1.0).abs() < 1e-14,
                "{lens:?} {extent:?}: passes at {miss}"
            );
        }
    }

    #[test]
    fn a_positive_roll_turns_the_picture_clockwise() {
        let orbit = Orbit {
            roll_degrees: 90.0,
            ..View::Anterior.orbit()
        };
        let camera =
            Camera::orbit(&UNIT, DVec3::ZERO, orbit, None, THIRTY, [8, 8]).expect("a camera");
        // What stood up (+z) now points right.
        assert_near(camera.frame().right, DVec3::Z);
    }

    #[test]
    fn the_sphere_of_an_oblique_box_holds_its_farthest_corner() {
        let straight = DAffine3::from_mat3_translation(
            DMat3::from_diagonal(dvec3(2.0, 1.0, 3.0)),
            dvec3(5.0, 6.0, 7.0),
        );
        let sphere = BoundingSphere::of_grid(&straight, [4, 4, 4]);
        assert_near(sphere.center, dvec3(9.0, 8.0, 13.0));
        // Half of (8, 4, 12): (4, 2, 6), of length sqrt(56).
        assert!(
            (sphere.radius - 56_f64.sqrt()).abs() < 1e-14,
            "{}",
            sphere.radius
        );

        // Sheared: dims 2 make the columns the half axes. The longest of their four sums is (2, 1, 1) long,
        // and which one it is depends on the signs.
        for (x, z) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
            let columns = DMat3::from_cols(DVec3::X, dvec3(x, 1.0, 0.0), dvec3(0.0, z, 1.0));
            let sphere = BoundingSphere::of_grid(&DAffine3::from_mat3(columns), [2, 2, 2]);
            // |(2, 1 + |z|, 1)|
            let wanted = (4.0 + (1.0 + z.abs()) * (1.0 + z.abs()) + 1.0_f64).sqrt();
            let found = sphere.radius;
            assert!(
                (found - wanted).abs() < 1e-14,
                "{x} {z}: {found}, wanted {wanted}"
            );
        }
    }

    #[test]
    fn an_up_vector_along_the_view_is_refused() {
        let orbit = View::Superior.orbit();
        let camera = Camera::orbit(&UNIT, DVec3::ZERO, orbit, Some(DVec3::Z), THIRTY, [8, 8]);
        assert_eq!(camera, Err(Error::NoUp));
    }
}
