//! Smooth noise without a table: the same on every machine.

use glam::{DVec3, IVec3};

/// Value noise in -1..1, one bump a unit length: random numbers on the whole points, the smoothstep
/// 3f^2 - 2f^3 between them.
pub(super) fn noise(p: DVec3) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let s = f * f * (DVec3::splat(3.0) - 2.0 * f);
    let cell = cell.as_ivec3();
    let at = |x, y, z| at_point(cell + IVec3::new(x, y, z));
    let row = |y, z| mix(at(0, y, z), at(1, y, z), s.x);
    let plane = |z| mix(row(0, z), row(1, z), s.y);
    mix(plane(0), plane(1), s.z)
}

/// Four octaves of [`noise`], each of half the size and half the height of the one before.
pub(super) fn turbulence(p: DVec3) -> f64 {
    let octaves = [1.0, 2.0, 4.0, 8.0];
    // Shifted, or the lattices of all octaves would meet in the origin.
    let octave = |scale: f64| noise(p * scale + DVec3::splat(17.3 * scale)) / scale;
    octaves.into_iter().map(octave).sum()
}

fn mix(a: f64, b: f64, f: f64) -> f64 {
    a + f * (b - a)
}

/// The finalizer of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014) over the three coordinates.
fn at_point(p: IVec3) -> f64 {
    // Sign extension changes all 64 bits, which is as good as any.
    let [x, y, z] = [p.x as u64, p.y as u64, p.z as u64];
    let mut h = x
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(y.wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
        .wrapping_add(z.wrapping_mul(0x1656_67b1_9e37_79f9));
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    h ^= h >> 31;
    (h >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}
