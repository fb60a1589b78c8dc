//! The sphere around what a camera that moves sees, and a camera that just sees all of a sphere from wherever it turns.

use crate::camera::{BoundingSphere, Camera, PixelBox, Projection};
use glam::DVec3;

/// Orthographic cameras that see all of a sphere along -x and along -y.
pub fn along_axes(bounds: &BoundingSphere) -> [Camera; 2] {
    [DVec3::X, DVec3::Y].map(|side| Camera {
        eye: bounds.center + 2.0 * bounds.radius * side,
        target: bounds.center,
        up: DVec3::Z,
        projection: Projection::Orthographic {
            view_height: 2.0 * bounds.radius,
        },
        zoom: 1.0,
    })
}

/// The sphere around the box of what two such cameras see.
pub fn sphere_of(
    cameras: &[Camera; 2],
    parts: [PixelBox; 2],
    extent_pixels: [u32; 2],
) -> BoundingSphere {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (k, (camera, part)) in cameras.iter().zip(parts).enumerate() {
        let rays = camera.rays(extent_pixels);
        for [x, y] in [part.min, part.max] {
            let (point, _) = rays.at(x, y);
            // A camera along x says nothing of x.
            let across = 1 - k;
            low[across] = low[across].min(point[across]);
            high[across] = high[across].max(point[across]);
            low.z = low.z.min(point.z);
            high.z = high.z.max(point.z);
        }
    }
    BoundingSphere {
        center: 0.5 * (low + high),
        radius: 0.5 * low.distance(high),
    }
}

/// The sphere around the corners of a box.
pub fn around_corners(corners: &[DVec3]) -> BoundingSphere {
    let center = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let radius = corners.iter().map(|corner| corner.distance(center));
    BoundingSphere {
        center,
        radius: radius.fold(0.0, f64::max),
    }
}

/// The camera turned to the middle of a sphere that just fits its picture.
pub fn around(camera: &Camera, sphere: &BoundingSphere, extent_pixels: [u32; 2]) -> Camera {
    let shift = sphere.center - camera.target;
    let moved = Camera {
        eye: camera.eye + shift,
        target: sphere.center,
        ..*camera
    };
    let frame = moved.frame();
    let distance = moved.eye.distance(moved.target);
    // Rays graze the sphere nearer than its middle.
    let radius = match moved.projection.is_perspective() {
        true => sphere.radius / (1.0 - (sphere.radius / distance).powi(2)).max(1e-6).sqrt(),
        false => sphere.radius,
    };
    let ends = [frame.right, -frame.right, frame.up, -frame.up];
    let points = ends.map(|end| sphere.center + radius * end);
    let fitted = moved.fitted_to_points(&points, extent_pixels, 1.0);
    Camera {
        zoom: fitted.zoom,
        ..moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_views_of_a_box_give_the_sphere_around_it() {
        let bounds = BoundingSphere {
            center: DVec3::new(1.0, 2.0, 3.0),
            radius: 16.0,
        };
        let cameras = along_axes(&bounds);
        let (low, high) = (DVec3::new(-4.0, 0.0, 1.0), DVec3::new(2.0, 8.0, 7.0));
        let extent = [320, 320];
        let part = |camera: &Camera| {
            let points = [low, high].map(|p| camera.project(p, extent).expect("in front"));
            PixelBox::around(points).expect("points")
        };
        let sphere = sphere_of(&cameras, [part(&cameras[0]), part(&cameras[1])], extent);
        assert!(
            (sphere.center - 0.5 * (low + high)).length() < 1e-9,
            "{sphere:?}"
        );
        assert!(
            (sphere.radius - 0.5 * low.distance(high)).abs() < 1e-9,
            "{sphere:?}"
        );
    }
}
