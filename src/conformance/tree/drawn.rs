//! A picture against the answer of each of its rays, which is allowed what the arithmetic of the picture itself may be
//! off by.

use crate::conformance::case::Stop;
use crate::conformance::judge::WIDE_ALLOWANCE;
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::{Chord, PictureCase, Seen, Tracked};
use crate::conformance::test_bed::TestBed;
use crate::offscreen::reference;
use crate::picture::{LayerKind, Picture};
use crate::scene::Scene;
use crate::technique::{self, Settings};

/// What a model leaves over, of f64 and of nothing else.
const OF_F64: f64 = 1e-9;

/// Of a channel that may be off by so much of all light nothing is known.
pub const WIDEST: f32 = 0.1;

/// How the bounds of running errors are made.
pub const DERIVATION: &str = "Running error analysis: the reference of the shaders runs once over this scene with numbers that carry how far any \
device may be from them (oracle/tracked.rs). Each operation may round either way, 2^-23 of its result; division 5/2, square roots 5 of \
these, exp 3 + 2 |x|, log 2^-21 near 1, pow exp2(y log2 x), mix x (1 - a) + y a (Vulkan specification, precision of SPIR-V \
instructions). Errors of operands go through each operation at their worst, none against another. What comes as f32 is within 2^-24 \
of what it stands for. allowed = that error of this channel of this pixel, a worst case. Where a comparison or a floor could turn \
out otherwise the pixel depends on rounding, and where the bound of a channel is a tenth of all light it says nothing: both are left out.";

/// The same where slices are blended in 16-bit floats.
pub const DERIVATION_F16: &str = "Slices are blended in 16-bit floats, by batches of 64, which are merged in 32 bits: source, factor, \
product and sum of each blend are numbers of 11 significant bits, each off by 2^-10 of itself because it may be cut off (Vulkan \
specification, Blending: a precision no lower than that of the target), and by all of itself under 2^-14. An error goes on through \
each blend as any other, so it grows with the number of slices as the operator lets it. ";

/// How far any device may be from the true picture of a scene: errors in place of numbers, infinite where the answer
/// depends on rounding. `ROUNDED` as in [`Tracked`].
pub fn errors<const ROUNDED: bool>(bed: &mut TestBed, scene: &Scene) -> Result<Picture, Stop> {
    let wrong = |error: technique::Error| Stop::Suite(error.to_string());
    let errors = match bed.is_merged(scene.settings)? {
        true => reference::render::<Tracked<ROUNDED, true>>(scene),
        false => reference::render::<Tracked<ROUNDED, false>>(scene),
    };
    errors.map_err(wrong)
}

/// What [`errors`] are derived from.
pub fn derivation(bed: &mut TestBed, settings: &Settings) -> Result<String, Stop> {
    let of_blending = match bed.is_merged(settings)? {
        true => DERIVATION_F16,
        false => "",
    };
    Ok(format!("{of_blending}{DERIVATION}"))
}

/// What `picture` has of a layer.
pub fn layer(picture: &Picture, kind: LayerKind) -> Option<&[f32]> {
    let found = picture.layers.iter().find(|layer| layer.kind == kind);
    found.map(|layer| layer.values.as_slice())
}

/// Draws the scene of a shot and compares each ray with what it should see.
pub fn measure(
    bed: &mut TestBed,
    shot: &PictureCase,
    scene: &Scene,
    layers: &[LayerKind],
    of: impl Fn(&Chord) -> Seen,
) -> Result<Measurement, Stop> {
    let allowed = errors::<true>(bed, scene)?;
    let bound = Bound::new("running-error", derivation(bed, scene.settings)?);
    compare(bed, shot, scene, layers, (bound, Some(&allowed)), of)
}

/// The same where each answer says itself what it is allowed.
pub fn measure_within(
    bed: &mut TestBed,
    shot: &PictureCase,
    scene: &Scene,
    layers: &[LayerKind],
    bound: Bound,
    of: impl Fn(&Chord) -> Seen,
) -> Result<Measurement, Stop> {
    compare(bed, shot, scene, layers, (bound, None), of)
}

fn compare(
    bed: &mut TestBed,
    shot: &PictureCase,
    scene: &Scene,
    layers: &[LayerKind],
    (bound, allowed): (Bound, Option<&Picture>),
    of: impl Fn(&Chord) -> Seen,
) -> Result<Measurement, Stop> {
    let found = bed.render(scene, layers)?;
    let mut measurement = Measurement::new(bound, 1000);
    let mut expected = Vec::with_capacity(found.pixels.len());
    let mut widest = 0.0f64;
    // Channels of pixels that a ray reaches, and those of them whose allowance is wide.
    let (mut reached, mut wide) = (0, 0);
    for (i, pixel) in shot.pixels().enumerate() {
        let chord = shot.chord(pixel);
        let hangs = chord.as_ref().is_some_and(|chord| chord.hangs);
        let errors = allowed.map_or([0.0; 4], |allowed| allowed.pixels[i]);
        let is_sure = errors.iter().all(|&error| error < WIDEST);
        if hangs || !is_sure {
            measurement.leave_out(4 + layers.len());
            expected.push(found.pixels[i]);
            continue;
        }
        let is_reached = chord.is_some();
        let wanted = chord.map_or(Seen::NOTHING, |chord| of(&chord));
        expected.push(wanted.pixel.map(|n| n as f32));
        for c in 0..4 {
            let channel = ["red", "green", "blue", "alpha"][c];
            let error = f64::from(errors[c]) + OF_F64 + wanted.slack;
            let at = || format!("{channel} of pixel {pixel:?}");
            measurement.take(at, wanted.pixel[c], found.pixels[i][c].into(), error);
            widest = widest.max(error);
            reached += usize::from(is_reached);
            wide += usize::from(is_reached && error > WIDE_ALLOWANCE);
        }
        for &kind in layers {
            let number = match kind {
                LayerKind::Depth => wanted.depth,
                _ => wanted.value,
            };
            let missing = || Stop::Suite(format!("no layer {}", kind.name()));
            let found = layer(&found, kind).ok_or_else(missing)?;
            let error = match allowed.and_then(|allowed| layer(allowed, kind)) {
                // Nothing is there, whatever rounds.
                Some(_) if number.is_nan() => 0.0,
                Some(errors) => f64::from(errors[i]) + OF_F64 * number.abs().max(1.0),
                None => wanted.slack,
            };
            if error.is_infinite() {
                measurement.leave_out(1);
                continue;
            }
            let at = || format!("{} of pixel {pixel:?}", kind.name());
            measurement.take(at, number, found[i].into(), error);
        }
    }
    // What a channel of the picture may be off by at most, and how many of them by more than proves anything.
    let inputs = &mut measurement.bound.inputs;
    inputs.insert("widest".into(), widest);
    inputs.insert("wide_share".into(), wide as f64 / reached.max(1) as f64);
    let drawn = found.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
    measurement.hold(|| "pixels that are drawn".into(), drawn > 40);
    measurement.pictures = Some(Pictures {
        width: shot.extent[0],
        expected,
        found: found.pixels,
    });
    Ok(measurement)
}
