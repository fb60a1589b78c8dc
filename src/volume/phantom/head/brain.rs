//! Inside the skull: folds, grey and white matter, ventricles, cerebellum, stem.

use super::Painting;
use super::shape::{at, capsule, chain, cone, ellipsoid, join, smoothstep, tilted_ellipsoid};
use crate::volume::phantom::noise::noise;
use glam::{DVec2, DVec3};

const FLUID: f64 = 8.0;
const GREY: f64 = 39.0;
const WHITE: f64 = 28.0;
const MEMBRANE: f64 = 58.0;

/// Paints the room of the brain; `room` is the distance to it, `side` is -1 on the left and 1 on the right.
pub(super) fn paint(painting: &mut Painting, p: DVec3, room: f64, side: f64) {
    painting.over(room, FLUID);
    if room > 0.0 {
        return;
    }
    let tent = tent_height(p);
    let below_tent = p.z - tent;
    let cerebrum = cerebrum(p, room, below_tent);
    // Most of the brain is deep inside the cerebrum.
    if cerebrum < 1.0 {
        paint_cerebrum(painting, p, cerebrum, side);
    }
    if below_tent < 4.0 && p.y < -8.0 {
        paint_cerebellum(painting, p, room, below_tent);
    }
    if p.x < 22.0 && p.z < 24.0 && p.y < 6.0 && p.y > -50.0 {
        painting.over(stem(p), 33.0);
        painting.over(ellipsoid(p, at(0.0, -39.0, -4.0), at(7.0, 4.5, 9.0)), FLUID);
    }
    // The sickle between the halves and the tent under them.
    let sickle = (p.x - 0.7).max(-room - 30.0 + 0.1 * p.y).max(-below_tent);
    if p.z > 12.0 {
        painting.over(sickle.max(room + 0.5), MEMBRANE);
    }
    if p.y < -22.0 {
        painting.over(
            (below_tent.abs() - 0.8).max(8.0 - p.x.hypot(p.y + 30.0)),
            MEMBRANE,
        );
    }
}

fn tent_height(p: DVec3) -> f64 {
    let back = (-p.y - 32.0).max(0.0);
    17.0 - 0.35 * p.x - 0.22 * back
}

fn cerebrum(p: DVec3, room: f64, below_tent: f64) -> f64 {
    let mut d = room + 2.2;
    if p.y < 0.0 {
        // In front of the stem there is no tent but the fluid around the stem.
        let floor = if p.y < -16.0 {
            -below_tent
        } else {
            9.0 - p.z - (p.y + 16.0) - 0.6 * (p.x - 18.0).max(0.0)
        };
        d = d.max(floor + 1.6);
    }
    // The gap between the halves reaches down to the bridge between them.
    let bridge = ellipsoid(p, at(0.0, 2.0, 34.0), at(30.0, 45.0, 20.0));
    d.max((1.6 - p.x).min(bridge))
}

fn paint_cerebrum(painting: &mut Painting, p: DVec3, surface: f64, side: f64) {
    let depth = -surface;
    // Grooves reach some way down; near the middle of the brain there are none.
    let groove = if depth < 21.0 {
        groove(p, side).max(depth - 14.0 + 4.0 * noise(p * 0.09))
    } else {
        f64::INFINITY
    };
    let to_fluid = groove.min(depth);
    painting.over(surface, WHITE);
    painting.over(surface.max(to_fluid - 3.2), GREY);
    painting.over(surface.max(groove), FLUID);
    if depth < 6.0 {
        return;
    }
    let thalamus = tilted_ellipsoid(
        p,
        at(11.5, -8.0, 31.0),
        at(8.5, 15.0, 9.0),
        DVec2::new(0.97, 0.24),
    );
    let lentil = ellipsoid(p, at(25.0, 9.0, 29.0), at(6.5, 17.0, 10.0));
    let tail = chain(
        p,
        &[
            at(14.0, 32.0, 38.0),
            at(15.0, 15.0, 47.0),
            at(19.0, -10.0, 50.0),
        ],
        4.6,
    );
    painting.over(thalamus.min(lentil).min(tail), GREY);
    painting.over(insula(p), FLUID);
    painting.over(ventricles(p), FLUID);
}

/// Distance to the sheets of fluid between folds: a warped gyroid's zero, |sin x cos y + ...| / |gradient|.
fn groove(p: DVec3, side: f64) -> f64 {
    // The two halves differ a little, as they do.
    let q = at(
        p.x * 0.235 + 0.6 * side,
        p.y * 0.205 + 0.4 * side,
        p.z * 0.215,
    );
    let q = q + 0.75
        * at(
            (q.y * 0.7 + 1.0).sin(),
            (q.z * 0.8).sin(),
            (q.x * 0.9 + 2.0).sin(),
        );
    let (sin, cos) = (q.map(f64::sin), q.map(f64::cos));
    let sheet = sin.x * cos.y + sin.y * cos.z + sin.z * cos.x;
    // The gradient of a gyroid on its zero is about 1.5, times 0.22 per millimetre.
    sheet.abs() * 3.0 - 0.75
}

/// The deep fold between the temporal lobe and the rest.
fn insula(p: DVec3) -> f64 {
    let sheet = tilted_ellipsoid(
        p,
        at(46.0, 4.0, 18.0),
        at(17.0, 30.0, 1.9),
        DVec2::new(0.93, -0.37),
    );
    let depth = ellipsoid(p, at(36.0, 6.0, 24.0), at(1.6, 17.0, 11.0));
    join(sheet, depth, 3.0)
}

fn ventricles(p: DVec3) -> f64 {
    let front = cone(p, at(9.0, 36.0, 36.0), at(6.5, 8.0, 47.0), 4.6, 4.2);
    let body = cone(p, at(6.5, 8.0, 47.0), at(20.0, -34.0, 42.0), 4.2, 6.2);
    let back = cone(p, at(21.0, -36.0, 38.0), at(20.0, -60.0, 33.0), 6.0, 2.5);
    let down = cone(p, at(23.0, -34.0, 37.0), at(31.0, -12.0, 12.0), 5.0, 2.6);
    let third = ellipsoid(p, at(0.0, -2.0, 28.0), at(2.4, 13.0, 11.0));
    join(join(join(front, body, 4.0), back, 4.0), down, 4.0).min(third)
}

fn paint_cerebellum(painting: &mut Painting, p: DVec3, room: f64, below_tent: f64) {
    let halves = ellipsoid(p, at(25.0, -58.0, -7.0), at(27.0, 26.0, 20.0));
    let worm = ellipsoid(p, at(0.0, -58.0, -3.0), at(12.0, 20.0, 18.0));
    let d = join(halves, worm, 6.0)
        .max(room + 2.2)
        .max(below_tent + 2.0);
    if d > 1.0 {
        return;
    }
    // Thin leaves, as shells around the stem.
    let from_stem = (p - at(0.0, -36.0, -6.0)).length();
    let leaves = (from_stem * 1.25 + 0.8 * (p.x * 0.22).sin()).sin();
    painting.over(d, GREY + 2.0);
    let fluid_in_leaves = smoothstep(0.62, 1.0, leaves) * smoothstep(-11.0, -2.0, d);
    painting.over(d.max(1.0 - 2.0 * fluid_in_leaves), 16.0);
    painting.over(
        join(
            d + 11.0,
            ellipsoid(p, at(16.0, -46.0, -8.0), at(14.0, 10.0, 7.0)),
            5.0,
        ),
        WHITE,
    );
}

fn stem(p: DVec3) -> f64 {
    let middle = cone(p, at(0.0, -10.0, 18.0), at(0.0, -20.0, 2.0), 13.0, 12.0);
    let bulge = ellipsoid(p, at(0.0, -16.0, -3.0), at(17.0, 12.5, 13.0));
    let end = cone(p, at(0.0, -24.0, -10.0), at(0.0, -32.5, -34.0), 9.5, 5.5);
    let arm = capsule(p, at(10.0, -26.0, -4.0), at(20.0, -42.0, -6.0), 6.0);
    join(join(join(middle, bulge, 5.0), end, 5.0), arm, 5.0)
}
