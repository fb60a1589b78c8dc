//! Air inside: nose, sinuses, ears, throat.

use super::shape::{at, capsule, chain, cone, cut, ellipsoid, join};
use super::skin;
use crate::volume::phantom::noise::noise;
use glam::DVec3;

/// Distance to air; `side` is -1 on the left and 1 on the right.
pub(super) fn distance(p: DVec3, side: f64) -> f64 {
    if p.z > 52.0 {
        return f64::INFINITY;
    }
    let mut d = f64::INFINITY;
    if p.y > 30.0 || p.z > -40.0 && p.x < 45.0 {
        d = d.min(nose(p, side)).min(sinuses(p, side));
    }
    if p.z < 0.0 && p.x < 30.0 {
        d = d.min(throat(p));
    }
    if p.x > 30.0 {
        d = d.min(ear(p));
    }
    d
}

fn nose(p: DVec3, side: f64) -> f64 {
    let low = ellipsoid(p, at(7.5, 42.0, -23.0), at(8.0, 34.0, 9.0));
    let high = ellipsoid(p, at(5.0, 46.0, -8.0), at(4.5, 28.0, 17.0));
    let room = join(low, high, 4.0);
    // The wall in the middle leans to one side; three scrolls of mucosa narrow each half.
    let wall = (p.x + side * 1.2 * (p.y * 0.08).sin()).abs() - 1.3;
    let scroll = |x, z, r| cone(p, at(x, 66.0, z - 1.0), at(x, 20.0, z), 0.8 * r, r);
    let scrolls = scroll(10.5, -24.0, 4.6)
        .min(scroll(8.0, -13.0, 3.4))
        .min(scroll(6.5, -3.0, 2.2));
    let room = cut(cut(room, wall, 1.5), scrolls, 1.5);
    room.min(skin::nostril(p))
}

fn sinuses(p: DVec3, side: f64) -> f64 {
    let cheek = ellipsoid(p, at(25.0, 44.0, -18.0), at(10.0, 16.0, 14.0));
    let cheek = join(
        cheek,
        ellipsoid(p, at(32.0, 48.0, -14.0), at(7.0, 8.5, 6.5)),
        6.0,
    );
    // The two over the brows are never alike.
    let brow = ellipsoid(
        p,
        at(9.0 + 2.0 * side, 77.5, 29.0 + 1.5 * side),
        at(8.0 + 2.0 * side, 3.0, 8.0 + 1.5 * side),
    );
    let behind = ellipsoid(p, at(7.5, 12.0, 1.0), at(6.3, 11.0, 7.5));
    // Small cells between the eyes.
    let cells = ellipsoid(p, at(7.5, 46.0, 9.0), at(5.0, 25.0, 9.0));
    let walls = 0.9 - 2.5 * (0.5 * ((p.y * 0.55).sin().abs() + (p.z * 0.6 + 1.0).sin().abs()));
    cheek.min(brow).min(behind).min(cells.max(walls))
}

fn throat(p: DVec3) -> f64 {
    let upper = ellipsoid(p, at(0.0, 6.0, -22.0), at(11.0, 8.0, 12.0));
    let middle = chain(
        p,
        &[
            at(0.0, 4.0, -28.0),
            at(0.0, 7.0, -52.0),
            at(0.0, 9.0, -78.0),
        ],
        6.5,
    );
    let lower = cone(p, at(0.0, 10.0, -84.0), at(0.0, 9.0, -102.0), 7.0, 4.0);
    let windpipe = capsule(p, at(0.0, 8.0, -108.0), at(0.0, 3.0, -150.0), 8.2);
    let mouth = ellipsoid(p, at(0.0, 44.0, -40.0), at(16.0, 24.0, 2.4));
    // The lid over the larynx.
    let lid = ellipsoid(p, at(0.0, 13.0, -80.0), at(9.0, 1.6, 11.0));
    cut(
        join(join(join(upper, middle, 5.0), lower, 4.0), windpipe, 6.0),
        lid,
        1.5,
    )
    .min(mouth)
}

/// Distance to the ring of cartilage around the windpipe and the voice box.
pub(super) fn cartilage(p: DVec3) -> f64 {
    let rings = (p.z * 0.9).sin() * 1.2;
    let windpipe = capsule(
        p,
        at(0.0, 8.0, -112.0),
        at(0.0, 3.0, -150.0),
        10.2 + 0.4 * rings,
    );
    let shield = ellipsoid(p, at(0.0, 10.0, -98.0), at(16.0, 17.0, 14.0)).abs() - 1.6;
    windpipe.max(p.z + 110.0).min(shield.max(-4.0 - p.y + 8.0))
}

fn ear(p: DVec3) -> f64 {
    let canal = chain(
        p,
        &[
            at(85.0, -8.0, -3.0),
            at(70.0, -11.0, -2.0),
            at(50.0, -11.0, -3.0),
        ],
        3.2,
    );
    let drum_room = ellipsoid(p, at(46.0, -10.0, -2.0), at(3.5, 5.0, 6.5));
    let mastoid = cone(p, at(54.0, -24.0, -7.0), at(51.0, -19.0, -28.0), 8.6, 3.5);
    let cells = if mastoid < 1.0 {
        mastoid.max(1.2 - 4.5 * noise(p * 0.42).abs())
    } else {
        mastoid
    };
    canal.min(drum_room).min(cells)
}
