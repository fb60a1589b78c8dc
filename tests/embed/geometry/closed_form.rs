//! A capsule and a cone across the line of sight, far away, in closed form.
//!
//! ```text
//! side      z = sqrt(h^2 - y^2),  h = (r_a - (x - x_a) sin g) / cos g,  sin g = (r_a - r_b) / (x_b - x_a)
//!           between x_a + r_a sin g and x_b + r_b sin g
//! ends      z = sqrt(r^2 - y^2 - (x - x_end)^2)
//! ```

use super::drawn;
use crate::driver_faults::{CONE_FAULTS, alone, faulty, tell, told};
use crate::embed_shared::Host;
use glam::dcamera::rh::{proj::vulkan, view::look_at_mat4};
use glam::{DVec3, dvec3};
use stratavox::camera::{Camera, DepthConvention};
use stratavox::geometry::{RoundCones, Vertex};

/// Radii of the ends, which lie at -2 and 2 on the x axis.
struct Cone([f64; 2]);

/// Where a line through (x, y) along z leaves it at the top, and the cosine of the normal there; the part between the ends.
fn top(Cone([ra, rb]): &Cone, x: f64, y: f64) -> Option<(f64, f64, f64)> {
    let sin = (ra - rb) / 4.0;
    let cos = (1.0 - sin * sin).sqrt();
    let (first, last) = (-2.0 + ra * sin, 2.0 + rb * sin);
    let of_sphere = |r: f64, end: f64, part: f64| {
        let square = r * r - y * y - (x - end).powi(2);
        (square > 0.0).then(|| (square.sqrt(), square.sqrt() / r, part))
    };
    if x <= first {
        return of_sphere(*ra, -2.0, 0.0);
    }
    if x >= last {
        return of_sphere(*rb, 2.0, 1.0);
    }
    let h = (ra - (x + 2.0) * sin) / cos;
    let square = h * h - y * y;
    // The normal of the side is tilted by g, and turned around the axis.
    let found = |z: f64| (z, cos * z / h, (x - first) / (last - first));
    (square > 0.0).then(|| found(square.sqrt()))
}

#[test]
fn far_cones_have_the_outline_depth_and_light_of_their_closed_form() {
    assert_eq!(off(&Host::new()), Ok(()));
}

#[test]
fn each_fault_of_cones_is_seen() {
    let _alone = alone();
    for (what, fault) in CONE_FAULTS {
        tell(Some(*fault));
        // SAFETY: its functions are Vulkan's, but for shaders that are others.
        let found = off(&unsafe { Host::through(faulty) });
        assert!(told() > 0, "{what}: no shader has it");
        tell(None);
        println!("{what}: {}", found.expect_err(what));
    }
}

/// The first pixel that is off, in words.
fn off(host: &Host) -> Result<(), String> {
    let extent = [128, 64];
    // Unit lengths are 16 pixels: rays are exact numbers.
    for (distance, far, allowed) in [(100.0, 128.0, 1e-5), (1000.0, 1024.0, 2e-4)] {
        for cone in [Cone([1.0, 1.0]), Cone([1.25, 0.5]), Cone([0.25, 1.5])] {
            let radii = cone.0;
            let mut cones = RoundCones::default();
            let colors = [[0.75, 0.5, 0.25], [0.25, 0.5, 0.5]];
            cones.add_line([0, 1].map(|end| Vertex {
                place: dvec3(4.0 * end as f64 - 2.0, 0.0, 0.0),
                radius: radii[end],
                color: colors[end],
            }));
            let eye = dvec3(0.0, 0.0, distance);
            let view = look_at_mat4(eye, DVec3::ZERO, DVec3::Y);
            let clip = vulkan::orthographic(-4.0, 4.0, -2.0, 2.0, 0.0, far);
            let standard = DepthConvention::Standard;
            let (camera, depth) = Camera::from_matrices(&view, &clip, standard).unwrap();
            let found = drawn(host, &cones.into(), (&camera, &depth), extent);
            let (mut met, mut worst) = (0, [0.0f64; 2]);
            for (i, (pixel, depth)) in found.pixels.iter().zip(&found.depths).enumerate() {
                let [column, row] = [i % 128, i / 128].map(|n| (n as f64 + 0.5) / 16.0);
                let (x, y) = (column - 4.0, 2.0 - row);
                let place = || format!("{radii:?} at {distance}: ({x}, {y})");
                let Some((z, facing, part)) = top(&cone, x, y) else {
                    if (pixel, *depth) != (&[0.0; 4], 1.0) {
                        return Err(format!("{} is covered", place()));
                    }
                    continue;
                };
                met += 1;
                let off = f64::from(*depth) * far - (distance - z);
                if off.abs() >= allowed {
                    return Err(format!("{} has its depth off by {off:.1e}", place()));
                }
                worst[0] = worst[0].max(off.abs() / allowed);
                // 16 roundings of squares move z^2 by some 16 2^-24 r^2, and so the cosine.
                let of_cosine = 16.0 * 2f64.powi(-24) / facing;
                let slack = (0.7 + 0.2 * 30.0) * of_cosine + 2f64.powi(-21);
                for c in 0..3 {
                    let [a, b] = colors.map(|color: [f32; 3]| f64::from(color[c]));
                    let own = a + part * (b - a);
                    let wanted = (0.3 + 0.7 * facing) * own + 0.2 * facing.powi(30);
                    let off = (pixel[c] - wanted.min(1.0)).abs();
                    if off >= slack || off.is_nan() {
                        return Err(format!("{} has {pixel:?}, off by {off:.1e}", place()));
                    }
                    worst[1] = worst[1].max(off / slack);
                }
            }
            println!("{radii:?} at {distance}: {met} pixels, {worst:.2?} of what is allowed");
            if met <= 1500 {
                return Err(format!("{met} pixels see {radii:?}"));
            }
        }
    }
    Ok(())
}
