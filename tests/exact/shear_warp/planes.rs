//! The base plane itself: its size, and where there is none.

use super::{plane, settings, sheared, shots};
use crate::shared::PictureCase;
use glam::{DVec3, dvec3};
use stratavox::camera::Projection;
use stratavox::technique::{Error, Intermediate, Mode};

#[test]
fn the_intermediate_image_does_not_know_the_size_of_the_picture() {
    for shot in shots(sheared(), &settings(Mode::Composite, 1.0)) {
        let small = plane(&shot).unwrap();
        let large = PictureCase {
            extent: shot.extent.map(|n| 2 * n),
            ..shot.clone()
        };
        let large = plane(&large).unwrap();
        assert_eq!((small.rays, small.extent), (large.rays, large.extent));
        // With `pixels` it does.
        let fine = |extent| {
            let shot = shot.with(|settings| settings.intermediate = Intermediate::Pixels);
            plane(&PictureCase { extent, ..shot }).unwrap().per_voxel
        };
        let [small, large] = [fine(shot.extent), fine(shot.extent.map(|n| 2 * n))];
        assert!((large / small - 2.0).abs() < 1e-6, "{small}, {large}");
    }
}

#[test]
fn an_eye_among_the_slices_and_images_without_end_are_refused_by_name() {
    let [_, mut shot] = shots(sheared(), &settings(Mode::Composite, 1.0));
    shot.settings.stack = Some(2);
    let inside = sheared()
        .world_from_voxel
        .transform_point3(dvec3(-9.0, 3.0, 6.0));
    shot.camera.eye = inside;
    assert_eq!(plane(&shot), Err(Error::EyeAmongSlices));
    let [mut steep, _] = shots(sheared(), &settings(Mode::Composite, 1.0));
    steep.settings.stack = Some(0);
    let beside = steep
        .grid
        .world_from_voxel
        .transform_vector3(dvec3(1e-4, 0.3, 1.0));
    steep.camera.eye = steep.camera.target - 40.0 * beside.normalize();
    steep.camera.up = DVec3::X;
    steep.camera.projection = Projection::Orthographic { view_height: 1e6 };
    let found = plane(&steep);
    assert!(
        matches!(found, Err(Error::IntermediateTooLarge { .. })),
        "{found:?}"
    );
}
