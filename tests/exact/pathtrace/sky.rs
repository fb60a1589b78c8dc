//! Light from all around by a picture of it.

use super::{
    around_blobs, assert_near, at, blobs, drawn, eye, layer, matter, mean, scene, settings,
};
use glam::{DVec3, dvec3};
use std::f64::consts::{PI, TAU};
use stratavox::technique::Settings;
use stratavox::technique::pathtrace::{PathTracing, Phase, SkyPicture};

const SIZE: [u32; 2] = [32, 16];

/// Little light, and a sun in one texel, which reaches half way into those around.
fn sunny() -> Vec<[f32; 3]> {
    let pixel = |i: usize| match i {
        // Row 4 of 16, column 10 of 32.
        138 => [4000.0, 2000.0, 1000.0],
        _ => [0.5, 0.5 + 0.02 * (i % 5) as f32, 0.02 * (i / 32) as f32],
    };
    (0..SIZE[0] as usize * SIZE[1] as usize)
        .map(pixel)
        .collect()
}

/// Bilinear between the middles of texels, straight from the definition.
fn radiance(pixels: &[[f32; 3]], way: DVec3, turn: f64, channel: usize) -> f64 {
    let u = (0.5 - way.y.atan2(way.x) / TAU + turn).rem_euclid(1.0);
    let v = 0.5 - way.z.clamp(-1.0, 1.0).asin() / PI;
    let [x, y] = [u * 32.0 - 0.5, v * 16.0 - 0.5];
    let at = |i: f64, j: f64| {
        let (i, j) = (i.rem_euclid(32.0) as usize, j.clamp(0.0, 15.0) as usize);
        f64::from(pixels[j * 32 + i][channel])
    };
    let (a, b) = (x - x.floor(), y - y.floor());
    let row = |j: f64| (1.0 - a) * at(x.floor(), j) + a * at(x.floor() + 1.0, j);
    (1.0 - b) * row(y.floor()) + b * row(y.floor() + 1.0)
}

/// Light scattered once by a layer, from above and from below, integrated over all directions.
#[test]
fn a_layer_scatters_the_light_of_a_sky_with_a_sun() {
    let pixels = sunny();
    let picture = SkyPicture::new(SIZE, &pixels).expect("a sky");
    let (mu, depth, degrees) = (0.6, 1.5, 35.0);
    let g = 0.4;
    for phase in [Phase::Isotropic, Phase::HenyeyGreenstein(g)] {
        let path = PathTracing {
            samples: 32,
            bounces: Some(1),
            phase,
            sky: [0.7; 3],
            sky_picture: Some(picture.clone()),
            sky_turn_degrees: degrees,
            ..PathTracing::default()
        };
        let function = matter([1.0; 3], &[(0.0, 0.0), (0.5, depth), (1.0, depth)]);
        let (volume, camera) = (layer(|_| 1.0), eye(at(mu, 0.0)));
        let settings = settings(path);
        let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
        let found = drawn(&scene);
        let incoming = -at(mu, 0.0);
        let density = |way: DVec3| match phase {
            Phase::Isotropic => 1.0 / (4.0 * PI),
            _ => (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * incoming.dot(way)).powf(1.5)),
        };
        // Of the way into the layer and out of it, above and below.
        let part = |mu0: f64| match mu0 > 0.0 {
            true => mu0 / (mu + mu0) * (1.0 - (-depth * (1.0 / mu + 1.0 / mu0)).exp()),
            false => {
                let m = -mu0;
                m / (m - mu) * ((-depth / m).exp() - (-depth / mu).exp())
            }
        };
        let (rows, columns) = (600, 600);
        for channel in 0..2 {
            let mut wanted = 0.0;
            for j in 0..rows {
                let z = -1.0 + 2.0 * (f64::from(j) + 0.5) / f64::from(rows);
                for i in 0..columns {
                    let way = at(z, TAU * (f64::from(i) + 0.5) / f64::from(columns));
                    let light = radiance(&pixels, way, degrees / 360.0, channel);
                    wanted += light * density(way) * part(z);
                }
            }
            wanted *= 0.7 * 2.0 * TAU / f64::from(rows * columns);
            assert_near(&format!("{phase:?}"), mean(&found, channel), wanted);
        }
    }
}

/// White matter in a white picture of the sky, found by both ways at each collision, is 1 in the mean; what is behind it is
/// the sky where that is shown.
#[test]
fn white_matter_under_a_white_picture_is_white_in_the_mean() {
    let white = SkyPicture::new([8, 4], &[[1.0; 3]; 32]).expect("a sky");
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    for (surface, f0) in [(0.0, 0.0), (3.0, 0.0)] {
        let settings = settings(PathTracing {
            samples: 16,
            surface,
            f0,
            sky: [1.0; 3],
            sky_picture: Some(white.clone()),
            shows_sky: true,
            ..PathTracing::default()
        });
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        let picture = drawn(&scene);
        assert!(picture.pixels.iter().all(|p| p[3] == 1.0));
        for channel in 0..3 {
            assert_near("furnace", mean(&picture, channel), 1.0);
        }
    }
}

/// A picture that is turned lights as the volume and the camera turned back do.
#[test]
fn a_turned_sky_is_a_turned_world() {
    let picture = SkyPicture::new(SIZE, &sunny()).expect("a sky");
    let function = matter([0.9, 0.7, 0.4], &[(0.0, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let camera = around_blobs();
    let mut seen = Vec::new();
    for quarter in [false, true] {
        let mut volume = blobs();
        let mut camera = camera;
        if quarter {
            let turn = glam::DAffine3::from_rotation_z(0.5 * PI);
            volume.world_from_voxel = turn * volume.world_from_voxel;
            (camera.eye, camera.target) = (
                turn.transform_point3(camera.eye),
                turn.transform_point3(camera.target),
            );
            camera.up = turn.transform_vector3(dvec3(0.0, 1.0, 0.0));
        }
        let settings: Settings = settings(PathTracing {
            samples: 16,
            sky: [1.0; 3],
            sky_picture: Some(picture.clone()),
            sky_turn_degrees: if quarter { 90.0 } else { 0.0 },
            shows_sky: true,
            ..PathTracing::default()
        });
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        seen.push(drawn(&scene));
    }
    // Eye rays that meet nothing see the same sky.
    let pairs = || seen[0].pixels.iter().zip(&seen[1].pixels);
    for channel in 0..3 {
        let off = pairs().map(|(a, b)| f64::from(a[channel] - b[channel]));
        let n = seen[0].pixels.len() as f64;
        let mean = off.clone().sum::<f64>() / n;
        let error = (off.map(|x| x * x).sum::<f64>() / n / n).sqrt();
        assert!(mean.abs() < 4.0 * error.max(1e-7), "{mean} +- {error}");
    }
}
