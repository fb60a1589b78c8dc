//! A camera from the matrices that a host draws its own geometry with, and what its depth buffer says.
//!
//! ```text
//! clip = clip_from_view view_from_world (p, 1)        ndc = clip.xyz / clip.w, x right, y down, depth 0 to 1
//!
//! perspective    w = k d        d = +-z_view the depth       x_view / d = (ndc.x k -+ m02) / m00
//! orthographic   w = k                                       x_view     = (ndc.x k - m03) / m00
//! ```
//!
//! The sides of the picture are where `ndc.x` and `ndc.y` are -1 and 1, the upper one where `ndc.y` is -1. A host that
//! draws through a viewport of negative height flips the second row of its matrix before it gives it away.

use super::{Camera, Error, Projection, Sides};
use glam::{DMat4, DVec3, DVec4};

/// How far a view matrix may be from a turn and a shift: hosts compute in f32.
const LARGEST_SHEAR: f64 = 1e-4;

/// Which of two depths in a host's depth buffer is nearer to the eye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthConvention {
    /// The smaller one: 0 is the near plane.
    #[default]
    Standard,
    /// The larger one: 1 is the near plane ("reverse Z").
    Reversed,
}

impl DepthConvention {
    /// The depth of the near plane.
    pub fn near(self) -> f64 {
        match self {
            Self::Standard => 0.0,
            Self::Reversed => 1.0,
        }
    }
}

/// Where a point of the world lies in a host's depth buffer: `z . (p, 1) / w . (p, 1)`, for a viewport whose depth goes
/// from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostDepth {
    /// Clip z of a world point.
    pub z: DVec4,
    /// Clip w of a world point: its depth along the line of sight, or 1.
    pub w: DVec4,
    /// Which depth is nearer.
    pub nearer: DepthConvention,
}

impl HostDepth {
    /// The depth of a world point.
    pub fn of(&self, point: DVec3) -> f64 {
        self.z.dot(point.extend(1.0)) / self.w.dot(point.extend(1.0))
    }

    /// How far along a ray the depth is `depth`, which may be infinite; negative behind where it starts.
    pub fn distance(&self, origin: DVec3, direction: DVec3, depth: f64) -> f64 {
        let row = self.z - depth * self.w;
        -row.dot(origin.extend(1.0)) / row.dot(direction.extend(0.0))
    }

    /// The same depths of a world that was moved by `-center`.
    pub fn centered(&self, center: DVec3) -> Self {
        let moved = |row: DVec4| row.truncate().extend(row.dot(center.extend(1.0)));
        Self {
            z: moved(self.z),
            w: moved(self.w),
            nearer: self.nearer,
        }
    }
}

impl Camera {
    /// The camera of a host's matrices, and what its depth buffer says. Any projection that takes planes parallel to
    /// the picture to such planes will do: off the middle, without a far plane, mirrored, in perspective with oblique
    /// near planes.
    ///
    /// # Errors
    /// [`Error::NotRigid`] for a view matrix that is more than a turn (or a mirror) and a shift,
    /// [`Error::NoProjection`] for a projection that is neither perspective nor orthographic.
    pub fn from_matrices(
        view_from_world: &DMat4,
        clip_from_view: &DMat4,
        nearer: DepthConvention,
    ) -> Result<(Self, HostDepth), Error> {
        let [x_axis, y_axis, z_axis] = rigid(view_from_world)?;
        let [x, y, z, w] = [0, 1, 2, 3].map(|k| clip_from_view.row(k));
        if ![x, y, z, w].iter().all(|row| row.is_finite()) {
            return Err(Error::NotFinite("projection matrix"));
        }
        let wrong = |reason| Err(Error::NoProjection { reason });
        let is_perspective = w.z != 0.0;
        if w.x != 0.0 || w.y != 0.0 || (is_perspective && w.w != 0.0) {
            return wrong("its last row is neither (0, 0, a, 0) nor (0, 0, 0, a)");
        }
        let scale = if is_perspective { w.z } else { w.w };
        if scale == 0.0 || x.x == 0.0 || y.y == 0.0 {
            return wrong("it maps everything to a plane");
        }
        if x.y != 0.0 || y.x != 0.0 {
            return wrong("it turns the picture");
        }
        let (k, x_from_z, y_from_z) = match is_perspective {
            true => (scale.abs(), scale.signum() * x.z, scale.signum() * y.z),
            false => (scale, x.w, y.w),
        };
        let (along, other) = match is_perspective {
            true => ([x.w, y.w], "it moves the eye"),
            false => (
                [x.z, y.z],
                "its rays are not at right angles to the picture",
            ),
        };
        if along != [0.0; 2] {
            return wrong(other);
        }
        // Parallel rays do not say which way they go: depth does.
        let way = match (is_perspective, nearer) {
            (true, _) => scale.signum(),
            (false, DepthConvention::Standard) => (z.z / scale).signum(),
            (false, DepthConvention::Reversed) => -(z.z / scale).signum(),
        };
        if !is_perspective && z.z == 0.0 {
            return wrong("it has no depth");
        }
        // Parallel rays start at the near plane.
        if !is_perspective && (z.x != 0.0 || z.y != 0.0) {
            return wrong("its near plane is not parallel to the picture");
        }
        let forward = way * z_axis;
        // The camera's own right hand, of which a matrix may be the mirror.
        let mirror = forward.cross(y_axis).dot(x_axis).signum();
        let sides = Sides {
            left: mirror * (-k - x_from_z) / x.x,
            right: mirror * (k - x_from_z) / x.x,
            top: (-k - y_from_z) / y.y,
            bottom: (k - y_from_z) / y.y,
        };
        let world_from_view = view_from_world.inverse();
        // Parallel rays start at the near plane, which may lie behind the origin of the view.
        let z_start = match is_perspective {
            true => 0.0,
            false => (nearer.near() * scale - z.w) / z.z,
        };
        let eye = world_from_view.transform_point3(DVec3::new(0.0, 0.0, z_start));
        let camera = Self {
            eye,
            target: eye + forward,
            up: y_axis,
            projection: match is_perspective {
                true => Projection::Frustum(sides),
                false => Projection::Parallel(sides),
            },
            zoom: 1.0,
        };
        camera.check()?;
        let clip_from_world = *clip_from_view * *view_from_world;
        let depth = HostDepth {
            z: clip_from_world.row(2) / k,
            w: clip_from_world.row(3) / k,
            nearer,
        };
        if is_perspective && !is_nearer_in_front(&depth, eye, forward) {
            return wrong("what is nearer does not have the depth that is said to be nearer");
        }
        Ok((camera, depth))
    }
}

/// The axes of the view in the world.
fn rigid(view_from_world: &DMat4) -> Result<[DVec3; 3], Error> {
    let rows = [0, 1, 2, 3].map(|k| view_from_world.row(k));
    if !rows.iter().all(|row| row.is_finite()) {
        return Err(Error::NotFinite("view matrix"));
    }
    let axes @ [x, y, z] = [0, 1, 2].map(|k| rows[k].truncate());
    let off = [
        x.length_squared() - 1.0,
        y.length_squared() - 1.0,
        z.length_squared() - 1.0,
        x.dot(y),
        y.dot(z),
        z.dot(x),
    ];
    let shear = off.into_iter().map(f64::abs).fold(0.0, f64::max);
    if shear > LARGEST_SHEAR || rows[3] != DVec4::W {
        return Err(Error::NotRigid { shear });
    }
    Ok(axes.map(DVec3::normalize))
}

/// Whether depth 1 has the nearer depth than depth 2 along the line of sight.
fn is_nearer_in_front(depth: &HostDepth, eye: DVec3, forward: DVec3) -> bool {
    let [near, far] = [1.0, 2.0].map(|d| depth.of(eye + d * forward));
    match depth.nearer {
        DepthConvention::Standard => near < far,
        DepthConvention::Reversed => near > far,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dcamera::{lh, rh};
    use glam::dvec3;

    const EYE: DVec3 = dvec3(30.0, -20.0, 12.0);
    const TARGET: DVec3 = dvec3(1.0, 2.0, 3.0);
    const EXTENT: [u32; 2] = [80, 60];

    fn look() -> DMat4 {
        rh::view::look_at_mat4(EYE, TARGET, dvec3(0.1, 0.0, 1.0))
    }

    fn matrices() -> Vec<(&'static str, DMat4, DMat4, DepthConvention)> {
        use DepthConvention::{Reversed, Standard};
        use rh::proj::{directx, vulkan};
        let (fov, aspect) = (0.7, 4.0 / 3.0);
        let perspective = vulkan::perspective(fov, aspect, 0.5, 90.0);
        let left_handed = lh::view::look_at_mat4(EYE, TARGET, DVec3::Z);
        let of_left_handed = lh::proj::vulkan::perspective(fov, aspect, 0.5, 90.0);
        let upside_down = directx::perspective(fov, aspect, 0.5, 90.0);
        let endless = vulkan::perspective_infinite_reverse(fov, aspect, 0.5);
        let reversed = vulkan::perspective(fov, aspect, 90.0, 0.5);
        let off_the_middle = vulkan::frustum(-0.3, 0.2, -0.1, 0.35, 0.5, 90.0);
        let parallel = vulkan::orthographic(-9.0, 12.0, -7.0, 8.0, -20.0, 70.0);
        let parallel_reversed = vulkan::orthographic(-9.0, 12.0, -7.0, 8.0, 70.0, -20.0);
        vec![
            ("perspective", look(), perspective, Standard),
            ("upside down", look(), upside_down, Standard),
            ("left-handed", left_handed, of_left_handed, Standard),
            ("scaled", look(), perspective * 7.0, Standard),
            ("no far plane, reversed", look(), endless, Reversed),
            ("reversed", look(), reversed, Reversed),
            ("off the middle", look(), off_the_middle, Standard),
            ("parallel", look(), parallel, Standard),
            ("parallel, reversed", look(), parallel_reversed, Reversed),
        ]
    }

    #[test]
    fn a_point_on_a_pixels_ray_has_that_pixels_place_and_its_own_depth_in_clip_space() {
        for (name, view, clip, nearer) in matrices() {
            let (camera, depth) = Camera::from_matrices(&view, &clip, nearer).expect(name);
            let rays = camera.rays(EXTENT);
            for (x, y) in [(0.5, 0.5), (79.5, 3.25), (40.0, 30.0), (12.0, 59.0)] {
                let (origin, direction) = rays.at(x, y);
                let point = origin + 17.0 * direction;
                let found = clip * view * point.extend(1.0);
                let ndc = found / found.w;
                let pixel = [ndc.x, ndc.y];
                for (axis, wanted) in [(0, x), (1, y)] {
                    let place = 0.5 * (pixel[axis] + 1.0) * f64::from(EXTENT[axis]);
                    assert!(
                        (place - wanted).abs() < 1e-9,
                        "{name}: {place} for {wanted}"
                    );
                }
                assert!((depth.of(point) - ndc.z).abs() < 1e-12, "{name}: {}", ndc.z);
                let t = depth.distance(origin, direction, ndc.z);
                assert!((t - 17.0).abs() < 1e-6, "{name}: {t}");
                let center = dvec3(3.0, 5.0, -8.0);
                let moved = depth.centered(center).of(point - center);
                assert!((moved - ndc.z).abs() < 1e-12, "{name}: {moved}");
                // What lies behind has the farther depth.
                let behind = depth.of(point + direction);
                assert_eq!(
                    behind > ndc.z,
                    nearer == DepthConvention::Standard,
                    "{name}"
                );
            }
        }
    }

    #[test]
    fn without_a_far_plane_its_depth_is_infinitely_far_away() {
        let clip = rh::proj::vulkan::perspective_infinite_reverse(0.7, 1.0, 0.5);
        let (camera, depth) =
            Camera::from_matrices(&look(), &clip, DepthConvention::Reversed).unwrap();
        let (origin, direction) = camera.rays(EXTENT).at(3.0, 4.0);
        assert_eq!(depth.distance(origin, direction, 0.0).abs(), f64::INFINITY);
    }

    #[test]
    fn matrices_that_are_no_camera_are_refused_by_name() {
        let clip = rh::proj::vulkan::perspective(0.7, 1.0, 0.5, 90.0);
        let refused = |view: DMat4, clip: DMat4, nearer| {
            let refused = Camera::from_matrices(&view, &clip, nearer);
            refused.expect_err("no camera").to_string()
        };
        let smaller = DepthConvention::Standard;
        let mut oblique = rh::proj::vulkan::orthographic(-9.0, 12.0, -7.0, 8.0, -20.0, 70.0);
        oblique.x_axis.z = 0.01;
        for (text, view, clip, nearer) in [
            ("view matrix", look() * 2.0, clip, smaller),
            ("view matrix", look() * f64::NAN, clip, smaller),
            ("plane", look(), DMat4::from_cols_array(&[0.0; 16]), smaller),
            ("not parallel", look(), oblique, smaller),
            ("last row", look(), clip + DMat4::IDENTITY, smaller),
            ("nearer", look(), clip, DepthConvention::Reversed),
            ("turns", look(), clip * DMat4::from_rotation_z(0.3), smaller),
        ] {
            let found = refused(view, clip, nearer);
            assert!(found.contains(text), "wanted {text}, found: {found}");
        }
    }
}
