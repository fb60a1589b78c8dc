//! The axes of the grid: those of the world, and of points in one plane two in it and its normal.

use crate::points::distances::bounds;
use glam::{DMat3, DVec3};

/// Parts of the longest edge of the box of points that are nothing.
const FLAT: f64 = 1e-6;

/// Axes, each of length 1, at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// From the axes to space.
    pub space_from_frame: DMat3,
    /// The axis that is the normal of the plane of all points, where they lie in one.
    pub normal: Option<usize>,
}

impl Frame {
    /// Of places; `None` of places on one line.
    pub fn of(places: &[DVec3]) -> Option<Self> {
        let [low, high] = bounds(places.iter().copied());
        let longest = (high - low).max_element();
        let first = *places.first()?;
        let away = |of: &dyn Fn(DVec3) -> f64| {
            let farther = |a: DVec3, b: &DVec3| {
                if of(*b - first) > of(a - first) {
                    *b
                } else {
                    a
                }
            };
            places.iter().fold(first, farther) - first
        };
        let along = away(&|p| p.length_squared()).try_normalize()?;
        let across = away(&|p| p.reject_from_normalized(along).length_squared());
        let across = across.reject_from_normalized(along);
        if across.length() <= FLAT * longest {
            return None;
        }
        let normal = along.cross(across.normalize()).normalize();
        let world = |normal| Self {
            space_from_frame: DMat3::IDENTITY,
            normal,
        };
        let thickness = away(&|p| p.dot(normal).abs()).dot(normal).abs();
        if thickness > FLAT * longest {
            return Some(world(None));
        }
        if let Some(axis) = (0..3).find(|&k| (high - low)[k] <= FLAT * longest) {
            return Some(world(Some(axis)));
        }
        // The first axis is level.
        let level = DVec3::Z.cross(normal).normalize();
        Some(Self {
            space_from_frame: DMat3::from_cols(level, normal.cross(level), normal),
            normal: Some(2),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn planes_have_axes_in_them_and_lines_none() {
        let places = |of: &dyn Fn(f64, f64) -> DVec3| -> Vec<DVec3> {
            let steps = || (0..5).map(f64::from);
            steps()
                .flat_map(|a| steps().map(move |b| (a, b)))
                .map(|(a, b)| of(a, b))
                .collect()
        };
        let normal = |of: &dyn Fn(f64, f64) -> DVec3| Frame::of(&places(of)).map(|f| f.normal);
        assert_eq!(normal(&|a, b| dvec3(a, b, a * b)), Some(None));
        assert_eq!(normal(&|a, b| dvec3(a, b, 7.0)), Some(Some(2)));
        assert_eq!(normal(&|a, b| dvec3(7.0, a, b)), Some(Some(0)));
        assert_eq!(normal(&|a, b| dvec3(a, b, 1e-4 * a * b)), Some(None));
        assert_eq!(
            normal(&|a, b| dvec3(a, a + 3.0, a) * (1.0 + b)),
            Some(Some(2))
        );
        assert_eq!(normal(&|a, _| dvec3(a, 2.0 * a, 3.0 * a)), None);
        assert_eq!(normal(&|_, _| dvec3(1.0, 2.0, 3.0)), None);
        let oblique = Frame::of(&places(&|a, b| dvec3(a, b, a + 2.0 * b))).expect("a plane");
        let axes = oblique.space_from_frame;
        assert!((axes.determinant() - 1.0).abs() < 1e-12);
        assert!(axes.z_axis.dot(dvec3(1.0, 0.0, 1.0)).abs() < 1e-12);
        assert!(axes.z_axis.dot(dvec3(0.0, 1.0, 2.0)).abs() < 1e-12);
        assert_eq!(axes.x_axis.z, 0.0);
    }
}
