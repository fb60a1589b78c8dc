//! Skin, fat, muscles, vessels, tongue and eyes.

use super::Painting;
use super::air::cartilage;
use super::bone::{CAP_THICKNESS, orbit};
use super::shape::{at, capsule, chain, cone, ellipsoid, join, smoothstep, sphere};
use super::spine::body_y;
use crate::volume::phantom::noise::noise;
use glam::DVec3;

const FAT: f64 = -98.0;
const MUSCLE: f64 = 58.0;

/// Paints all that is not bone, brain or air; `skin`, `room` and `muscles` are the distances to
/// the skin, the room of the brain and [`muscles`].
pub(super) fn paint(painting: &mut Painting, p: DVec3, skin: f64, room: f64, muscles: f64) {
    painting.value = 25.0;
    painting.over(skin + 2.0, FAT + 8.0 * noise(p * 0.2));
    // A thin sheet of muscle over the skull cap, thick at the temples.
    let temple = 4.0
        * smoothstep(30.0, 55.0, p.x)
        * smoothstep(65.0, 20.0, p.z)
        * smoothstep(-60.0, -10.0, p.y);
    painting.over(
        (room - CAP_THICKNESS - 1.6 - temple).max(skin + 3.2),
        MUSCLE - 8.0,
    );
    if p.z > 40.0 {
        return;
    }
    let grain = 5.0 * noise(p * at(0.35, 0.35, 0.12));
    painting.over(muscles.max(skin + 3.0), MUSCLE + grain);
    if p.z < -8.0 && p.x > 15.0 {
        painting.over(glands(p).max(skin + 2.5), 15.0 + 3.0 * grain);
        painting.over(vessels(p), 44.0);
    }
    if p.z < -35.0 && p.y > 5.0 && p.x < 28.0 {
        painting.over(tongue(p), 62.0 + grain);
    }
    if p.z < -70.0 {
        painting.over(cartilage(p), 130.0);
        painting.over(tongue_bone(p), 700.0);
    }
    if p.y > 20.0 && p.z > -22.0 {
        paint_eye(painting, p, skin);
    }
}

/// Distance to the nearest muscle.
pub(super) fn muscles(p: DVec3) -> f64 {
    let mut d = ellipsoid(p, at(56.0, 16.0, -44.0), at(7.5, 18.0, 28.0));
    let temple = ellipsoid(p, at(58.0, 24.0, 10.0), at(9.0, 30.0, 34.0));
    let wing = ellipsoid(p, at(38.0, 16.0, -36.0), at(8.0, 14.0, 24.0));
    d = d.min(temple).min(wing);
    let lips = chain(p, &[at(0.0, 83.0, -50.0), at(22.0, 72.0, -50.0)], 6.0);
    let cheek = capsule(p, at(24.0, 72.0, -46.0), at(45.0, 40.0, -44.0), 2.4);
    let smile = capsule(p, at(44.0, 68.0, -14.0), at(24.0, 76.0, -46.0), 2.2);
    let face = capsule(p, at(0.0, 74.0, -78.0), at(22.0, 66.0, -76.0), 6.0);
    let around_eye = (sphere(p, at(33.0, 70.0, 7.0), 23.0).abs() - 1.2).max(72.0 - p.y);
    d = d.min(lips).min(cheek).min(smile).min(face).min(around_eye);
    if p.z > 0.0 {
        return d;
    }
    let floor = ellipsoid(p, at(10.0, 44.0, -76.0), at(13.0, 26.0, 5.5));
    d = d.min(floor);
    let turner = cone(p, at(56.0, -26.0, -24.0), at(26.0, 4.0, -140.0), 9.0, 14.0);
    let strap = cone(p, at(7.0, 24.0, -92.0), at(10.0, 18.0, -150.0), 4.0, 5.5);
    let nape_outer = cone(
        p,
        at(26.0, -64.0, -24.0),
        at(34.0, -74.0, -150.0),
        16.0,
        17.0,
    );
    let nape_inner = cone(
        p,
        at(14.0, -55.0, -22.0),
        at(13.0, -66.0, -150.0),
        13.5,
        13.5,
    );
    let beside = cone(
        p,
        at(32.0, -40.0, -36.0),
        at(40.0, -36.0, -150.0),
        11.0,
        16.0,
    );
    let before = capsule(
        p,
        at(9.0, body_y(-60.0) + 12.0, -30.0),
        at(9.0, body_y(-120.0) + 13.0, -150.0),
        6.0,
    );
    let throat = chain(
        p,
        &[
            at(0.0, 4.0, -18.0),
            at(0.0, 7.0, -52.0),
            at(0.0, 8.0, -96.0),
        ],
        10.5,
    );
    d = d.min(turner).min(strap).min(nape_outer).min(nape_inner);
    d.min(beside).min(before).min(throat)
}

fn glands(p: DVec3) -> f64 {
    let ear_gland = ellipsoid(p, at(59.0, -4.0, -34.0), at(9.0, 13.0, 20.0));
    let jaw_gland = ellipsoid(p, at(32.0, 24.0, -80.0), at(8.0, 14.0, 10.0));
    ear_gland.min(jaw_gland)
}

fn tongue(p: DVec3) -> f64 {
    let body = ellipsoid(p, at(0.0, 42.0, -56.0), at(21.0, 28.0, 13.5));
    let root = ellipsoid(p, at(0.0, 27.0, -66.0), at(18.0, 15.0, 20.0));
    join(body, root, 8.0)
}

fn vessels(p: DVec3) -> f64 {
    let artery = chain(
        p,
        &[
            at(26.0, -4.0, -20.0),
            at(25.0, 0.0, -70.0),
            at(22.0, 0.0, -150.0),
        ],
        3.8,
    );
    let vein = chain(
        p,
        &[
            at(32.0, -10.0, -20.0),
            at(31.0, -3.0, -70.0),
            at(31.0, -2.0, -150.0),
        ],
        5.6,
    );
    artery.min(vein)
}

/// The small bone under the tongue.
fn tongue_bone(p: DVec3) -> f64 {
    chain(
        p,
        &[
            at(0.0, 30.0, -88.0),
            at(11.0, 26.0, -88.0),
            at(20.0, 8.0, -84.0),
        ],
        2.3,
    )
}

fn paint_eye(painting: &mut Painting, p: DVec3, skin: f64) {
    let orbit = orbit(p);
    if orbit > 3.0 {
        return;
    }
    painting.over(orbit.max(skin + 2.0), FAT);
    let apex = at(15.0, 32.0, 9.0);
    let straps = [
        at(45.0, 66.0, 8.0),
        at(20.0, 66.0, 8.0),
        at(32.0, 64.0, 20.0),
        at(32.0, 64.0, -4.0),
    ];
    let straps = straps.map(|end| capsule(p, apex, end, 1.9));
    painting.over(straps.into_iter().fold(f64::INFINITY, f64::min), 50.0);
    painting.over(
        chain(p, &[apex, at(24.0, 46.0, 8.0), at(31.0, 58.0, 7.0)], 2.2),
        36.0,
    );
    let center = at(32.0, 68.0, 7.0);
    let globe = sphere(p, center, 12.3);
    painting.over(globe, 48.0);
    painting.over(globe + 1.4, 12.0);
    painting.over(ellipsoid(p, at(32.4, 75.3, 7.0), at(4.6, 2.3, 4.6)), 88.0);
}
