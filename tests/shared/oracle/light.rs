//! Media of one extinction, and media of one colour.

use super::super::{Chord, Matter, PictureCase, Way, Worst, waves};
use super::what;
use stratavox::technique::{Lattice, Technique};

/// A1: a homogeneous medium.
///
/// ```text
/// alpha = 1 - exp(-sigma L),  C = c alpha         L the chord, on planes their number times their distance
/// ```
pub fn homogeneous(way: &dyn Way, shot: &PictureCase) -> Worst {
    const SIGMA: f64 = 0.11;
    const COLOR: [f64; 3] = [0.8, 0.5, 0.1];
    let matter = Matter {
        value: &|_| 1.0,
        color: &|_| COLOR,
        extinction: &|_| SIGMA,
        range: [0.0, 2.0],
    };
    let mut worst = Worst::new(what("A1", way, shot));
    let found = way.picture(shot, &matter);
    for (pixel, found) in shot.pixels().zip(found) {
        let chord = Chord::of(shot, pixel);
        if chord.as_ref().is_some_and(|chord| chord.hangs) {
            worst.leave_out();
            continue;
        }
        let length = chord.as_ref().map_or(0.0, |chord| chord.length());
        let opacity = -(-SIGMA * length).exp_m1();
        let allowed = 5e-6 + moved_ends(shot, chord.as_ref(), SIGMA) * (1.0 - opacity);
        let [r, g, b] = COLOR.map(|c| c * opacity);
        for (wanted, found) in [r, g, b, opacity].into_iter().zip(found) {
            worst.take(pixel, found - wanted, allowed);
        }
    }
    worst
}

/// Optical depth that may come and go with the ends of a chord in f32: on planes none, they are counted.
fn moved_ends(shot: &PictureCase, chord: Option<&Chord>, sigma: f64) -> f64 {
    let is_counted =
        shot.settings.technique != Technique::Raycast || shot.settings.lattice != Lattice::Ray;
    if is_counted {
        return 0.0;
    }
    chord.map_or(0.0, |chord| 2.0 * chord.blur * sigma)
}

/// A5: one colour, any density, any step: C = c alpha everywhere.
pub fn constant_color(way: &dyn Way, shot: &PictureCase) -> Worst {
    const COLOR: [f64; 3] = [0.9, 0.6, 0.3];
    let matter = Matter {
        value: &waves,
        color: &|_| COLOR,
        extinction: &|v| 0.02 + 0.3 * v,
        range: [-0.1, 1.1],
    };
    let mut worst = Worst::new(what("A5", way, shot));
    for (pixel, found) in shot.pixels().zip(way.picture(shot, &matter)) {
        if found[3] > 0.01 {
            for c in 0..3 {
                worst.take(pixel, found[c] - COLOR[c] * found[3], 2e-6);
            }
        }
    }
    worst
}
