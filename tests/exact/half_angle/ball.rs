//! An opaque ball above a plate so thin that it hardly shades itself, seen from straight above.

use super::{AMBIENT, half_angle, pictures, plain, white};
use crate::shared::{PictureCase, Worst, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::picture::Picture;
use stratavox::technique::{Filter, Settings};
use stratavox::transfer::TransferFunction;
use stratavox::volume::Volume;

const BALL: DVec3 = DVec3::new(11.0, 16.0, 14.0);
const RADIUS: f64 = 4.0;
const PLATE: f64 = 4.0;

fn ball_above_plate(towards: DVec3) -> (Volume, PictureCase, TransferFunction) {
    let field = |p: DVec3| match () {
        () if p.distance(BALL) < RADIUS => 2.0,
        () if (2.0..PLATE).contains(&p.z) => 1.0,
        () => 0.0,
    };
    let volume = volume_of([32, 32, 20], DAffine3::IDENTITY, field);
    let grid = volume.grid();
    let shot = PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() + dvec3(0.0, 0.0, 40.0),
            target: grid.center(),
            up: DVec3::Y,
            projection: Projection::Orthographic { view_height: 32.0 },
            zoom: 1.0,
        },
        extent: [64; 2],
        settings: Settings {
            filter: Filter::Nearest,
            shading: plain(towards),
            ..half_angle()
        },
    };
    // Of the plate, 2e-4 over 2 voxels, sqrt(2) as long for slanting light: under 6e-4 of the light.
    let transfer = white(&[(0.0, 0.0), (1.0, 2e-4), (2.0, 8.0)]);
    (volume, shot, transfer)
}

/// The part of the light that is left on what a pixel shows, and where on the plate that is.
fn light_on_plate(picture: &Picture, shot: &PictureCase) -> Vec<([u32; 2], DVec3, f64)> {
    let rays = shot.camera.rays(shot.extent);
    let pixels = shot.pixels().zip(&picture.pixels);
    pixels
        .map(|([x, y], pixel)| {
            let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let place = origin + direction * ((PLATE - origin.z) / direction.z);
            let lit = f64::from(pixel[0]) / f64::from(pixel[3]);
            ([x, y], place, (lit - AMBIENT) / (1.0 - AMBIENT))
        })
        .collect()
}

#[test]
fn a_ball_throws_its_shadow_where_geometry_says() {
    let towards = dvec3(-1.0, 0.0, 1.0).normalize();
    let (volume, shot, transfer) = ball_above_plate(towards);
    // A voxel of the ball, a texel of the light, and a slice along the light.
    let texel = 45.0 / (f64::from(shot.view().light_extent()[0]) - 2.0);
    let blur = 0.5 * 3f64.sqrt() + 2f64.sqrt() * texel;
    for (way, picture) in ["f64", "f32", "device"]
        .iter()
        .zip(pictures(&volume, &shot, &transfer))
    {
        let mut worst = Worst::new(format!("shadow of a ball, {way}"));
        let [mut dark, mut beside] = [0, 0];
        for (at, place, light) in light_on_plate(&picture, &shot) {
            if place.truncate().distance(BALL.truncate()) < RADIUS + 1.0 {
                continue;
            }
            // How far the middle of the ball is from the way to the light.
            let to_ball = BALL - place;
            let off = (to_ball - towards * to_ball.dot(towards)).length();
            if off < RADIUS - blur {
                worst.take(at, light, 1e-3);
                dark += 1;
            } else if off > RADIUS + blur {
                worst.take(at, light - 1.0, 1e-3);
            } else {
                beside += 1;
            }
        }
        println!("{dark} pixels in the shadow, {beside} at its edge");
        assert!(dark > 60, "only {dark} pixels are in the shadow");
        worst.assert_holds();
    }
}

/// The light's texels lie on the rays of the picture: each is as bright as if there were no shadow at all.
#[test]
fn light_from_the_eye_shows_no_edge_of_a_shadow() {
    let (volume, mut shot, transfer) = ball_above_plate(DVec3::Z);
    let texels = f64::from(shot.view().light_extent()[0]);
    assert_eq!(texels, 64.0, "a texel a pixel");
    let view_height = 32.0 * texels / (texels - 2.0);
    shot.camera.projection = Projection::Orthographic { view_height };
    let headlight = shot.with(|settings| settings.shading = half_angle().shading);
    for shot in [shot, headlight] {
        for (way, picture) in ["f64", "f32", "device"]
            .iter()
            .zip(pictures(&volume, &shot, &transfer))
        {
            let mut worst = Worst::new(format!("light from the eye, {way}"));
            let drawn = light_on_plate(&picture, &shot).into_iter();
            for (at, _, light) in drawn.filter(|(.., light)| !light.is_nan()) {
                worst.take(at, light - 1.0, 1e-3);
            }
            worst.assert_holds();
        }
    }
}
