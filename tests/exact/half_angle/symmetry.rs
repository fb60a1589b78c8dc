//! What does not change when scene and light are mirrored, and how far apart samples are.

use super::{half_angle, on_device, plain, shots};
use crate::shared::{PictureCase, Worst, oblique_camera, projections, ramps, volume_of, waves};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::Camera;
use stratavox::technique::{Order, Settings};

/// x against the middle of the box.
fn mirrored(p: DVec3, width: f64) -> DVec3 {
    dvec3(width - p.x, p.y, p.z)
}

#[test]
fn a_mirrored_scene_in_mirrored_light_is_the_mirrored_picture() {
    let dims = [17, 21, 13];
    let field = |p: DVec3| waves(p);
    let volume = volume_of(dims, DAffine3::IDENTITY, field);
    let mirror = volume_of(dims, DAffine3::IDENTITY, |p| field(mirrored(p, 17.0)));
    let grid = volume.grid();
    for projection in projections(&grid) {
        for side in [1.0, -1.0] {
            let camera = oblique_camera(&grid, projection);
            let towards = dvec3(-0.7, -0.9 * side, 0.8);
            let shot = PictureCase {
                grid,
                camera,
                extent: [30, 26],
                settings: Settings {
                    shading: plain(towards),
                    ..half_angle()
                },
            };
            let other = PictureCase {
                camera: Camera {
                    eye: mirrored(camera.eye, 17.0),
                    target: mirrored(camera.target, 17.0),
                    up: mirrored(camera.up, 0.0),
                    ..camera
                },
                ..shot.with(|settings| settings.shading = plain(mirrored(towards, 0.0)))
            };
            let wanted = on_device(&volume, &shot, &ramps());
            let mut found = on_device(&mirror, &other, &ramps());
            for row in found.pixels.chunks_mut(30) {
                row.reverse();
            }
            let what = format!("mirrored, {projection:?}, {side}");
            Worst::between(what, 30, &wanted.pixels, &found.pixels, 1e-3).assert_holds();
        }
    }
}

/// s halves the angle of view and light, or of the way back and light; it points away from the light, and the eye sees
/// slices in the order in which they come from there.
#[test]
fn samples_are_as_far_apart_along_the_light_as_along_the_view() {
    let [parallel, _] = shots();
    let forward = parallel.camera.frame().forward;
    let mut farthest: f64 = 0.0;
    for i in 0..200 {
        let (turn, lift) = (2.399_963 * f64::from(i), (f64::from(i) + 0.5) / 100.0 - 1.0);
        let flat = (1.0 - lift * lift).sqrt();
        let light = dvec3(flat * turn.cos(), flat * turn.sin(), lift);
        let shot = parallel.with(|settings| settings.shading = plain(-light));
        let half = shot.view().half_angle().unwrap();
        let [along_view, along_light] = [forward, light].map(|r| 1.0 / half.normal.dot(r));
        assert!((along_view.abs() - along_light).abs() < 1e-9, "{light}");
        assert_eq!(
            along_view > 0.0,
            half.order == Order::FrontToBack,
            "{light}"
        );
        assert_eq!(forward.dot(light) >= 0.0, half.order == Order::FrontToBack);
        farthest = farthest.max(along_light);
    }
    let across = parallel.camera.frame().up;
    let shot = parallel.with(|settings| settings.shading = plain(across));
    let half = shot.view().half_angle().unwrap();
    let at_right_angles = 1.0 / half.normal.dot(-across);
    println!("spacing factor {farthest} of 200 lights, {at_right_angles} at a right angle");
    assert!((at_right_angles - 2f64.sqrt()).abs() < 1e-12);
    assert!(farthest <= at_right_angles + 1e-12 && farthest > 1.4);
}
