//! Whether a device computes what its CPU reference computes.
//!
//! How well a pixel is defined in f32 at all, the CPU reference says itself: in f32 and in f64 it differs by what
//! rounding does to this picture. Where that is a jump (a voxel border, a plane at the end of a chord) the
//! pixel is left out; elsewhere the device may differ from the f32 CPU reference by a few times the worst of it, and by
//! 2e-6 for its own exp, log and pow.

use super::Worst;

/// Numbers of one kind from the three: f64 CPU reference, f32 CPU reference, device. Of size `scale`.
pub fn compare(what: &str, width: u32, lists: [&[f32]; 3], scale: f32) {
    let [double, single, found] = lists;
    assert!(double.len() == single.len() && single.len() == found.len());
    let apart = |a: f32, b: f32| {
        if a == b || (a.is_nan() && b.is_nan()) {
            0.0
        } else if a.is_nan() || b.is_nan() {
            f32::INFINITY
        } else {
            (a - b).abs() / scale
        }
    };
    const JUMP: f32 = 2e-5;
    let smooth = |i: &usize| apart(double[*i], single[*i]) < JUMP;
    let rounding = (0..found.len())
        .filter(smooth)
        .map(|i| apart(double[i], single[i]))
        .fold(0.0, f32::max);
    let mut worst = Worst::new(what);
    for i in 0..found.len() {
        let pixel = [i as u32 % width, i as u32 / width];
        if smooth(&i) {
            let allowed = 2e-6 + 4.0 * rounding;
            worst.take(pixel, apart(single[i], found[i]).into(), allowed.into());
        } else {
            worst.leave_out();
        }
    }
    worst.assert_holds();
}
