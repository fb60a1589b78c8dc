//! Light of any strength to what a screen shows, before it is coded (`sampling.md` 8).
//!
//! ```text
//! C' = A curve(2^exposure C / A)
//! ```
//!
//! The curves are of linear light: Khronos' PBR neutral tone mapper (2024), which keeps colours under .76 but for a foot of
//! .04, and Hable's filmic one ("Uncharted 2: HDR Lighting", GDC 2010), which takes 5.6 to white.

use super::{ColorSpace, Picture};

/// What a picture is sent through on its way to a screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// In stops: light is multiplied by 2 to this power.
    pub exposure: f64,
    /// What is done with light near white and over it.
    pub curve: ToneCurve,
}

/// A tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// Light over 1 is cut off.
    #[default]
    None,
    /// Colours stay, and bright ones fade to white.
    Neutral,
    /// Soft in the dark and in the light.
    Filmic,
}

impl Picture {
    /// The picture through `tone`; only pictures in linear light have one.
    ///
    /// Layers stay.
    pub fn apply_tone(&mut self, tone: Tone) {
        if tone == Tone::default() || self.color_space != ColorSpace::Linear {
            return;
        }
        let gain = tone.exposure.exp2();
        for [r, g, b, alpha] in &mut self.pixels {
            let a = f64::from(*alpha);
            if a == 0.0 {
                continue;
            }
            let light = [*r, *g, *b].map(|c| gain * f64::from(c) / a);
            let seen = match tone.curve {
                ToneCurve::None => light,
                ToneCurve::Neutral => neutral(light),
                ToneCurve::Filmic => light.map(filmic),
            };
            [*r, *g, *b] = seen.map(|c| (a * c) as f32);
        }
    }
}

/// Peaks over this are compressed.
const START: f64 = 0.8 - 0.04;
/// How fast compressed colours fade to white.
const DESATURATION: f64 = 0.15;

fn neutral(light: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = light;
    let least = r.min(g).min(b);
    let foot = match least < 0.08 {
        true => least - 6.25 * least * least,
        false => 0.04,
    };
    let color = light.map(|c| c - foot);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let white = 1.0 - room * room / (peak + room - START);
    let fade = 1.0 - 1.0 / (DESATURATION * (peak - white) + 1.0);
    color.map(|c| {
        let compressed = c * white / peak;
        compressed + fade * (white - compressed)
    })
}

/// Hable's own exposure, and what he takes for white.
const GAIN: f64 = 2.0;
const WHITE: f64 = 11.2;

fn filmic(light: f64) -> f64 {
    let [a, b, c, d, e, f] = [0.15, 0.5, 0.1, 0.2, 0.02, 0.3];
    let curve = |x: f64| (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
    curve(GAIN * light) / curve(WHITE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(pixel: [f32; 4]) -> Picture {
        Picture {
            width: 1,
            height: 1,
            pixels: vec![pixel],
            color_space: ColorSpace::Linear,
            layers: Vec::new(),
        }
    }

    fn toned(pixel: [f32; 4], exposure: f64, curve: ToneCurve) -> [f32; 4] {
        let mut picture = picture(pixel);
        picture.apply_tone(Tone { exposure, curve });
        picture.pixels[0]
    }

    #[test]
    fn a_stop_doubles_light_and_leaves_alpha() {
        let found = toned([0.1, 0.2, 0.3, 0.5], 1.0, ToneCurve::None);
        assert_eq!(found, [0.2, 0.4, 0.6, 0.5]);
    }

    /// A curve bends the colour, not the colour times its opacity.
    #[test]
    fn alpha_does_not_bend_a_curve() {
        for curve in [ToneCurve::Neutral, ToneCurve::Filmic] {
            let whole = toned([0.5, 1.0, 3.0, 1.0], 0.5, curve);
            let half = toned([0.25, 0.5, 1.5, 0.5], 0.5, curve);
            for c in 0..3 {
                assert!(
                    (half[c] - 0.5 * whole[c]).abs() < 1e-7,
                    "{half:?} {whole:?}"
                );
            }
        }
    }

    #[test]
    fn neutral_keeps_colours_but_for_its_foot_and_never_exceeds_white() {
        let near = |found: [f64; 3], wanted: [f64; 3]| {
            let off = (0..3)
                .map(|c| (found[c] - wanted[c]).abs())
                .fold(0.0, f64::max);
            assert!(off < 1e-12, "{found:?} {wanted:?}");
        };
        near(neutral([0.5, 0.3, 0.1]), [0.46, 0.26, 0.06]);
        near(neutral([0.4, 0.2, 0.04]), [0.37, 0.17, 0.01]);
        // A peak of 1 after the foot: 1 - .24^2 / .48.
        let grey = neutral([1.04; 3]);
        near(grey, [0.88; 3]);
        for light in [[1e6, 1.0, 0.0], [3.0, 40.0, 2.0]] {
            assert!(neutral(light).iter().all(|c| (0.0..=1.0).contains(c)));
        }
    }

    #[test]
    fn filmic_begins_at_black_and_takes_its_white_to_one() {
        assert!(filmic(0.0).abs() < 1e-12);
        assert!((filmic(WHITE / GAIN) - 1.0).abs() < 1e-12);
    }
}
