//! The device's own filter and the table, against fetches and control points: off by no more than the
//! device's sub-texel bits b and the table's 1/4096 explain.
//!
//! ```text
//! value      dv     = (|Dx f| + |Dy f| + |Dz f|) 2^-(b+1)     D: largest step between neighbours, of the
//!                                                             coefficients where the filter reads those
//! opacity    da     = 1/4096 + a' dv                          per reference length d0
//! extinction ds     = da / ((1 - a) d0)
//! picture    dC, dA = L ds + 1/4096 c' + c' k' dv             L the chord: each segment's slip is seen by
//!                                                             at most all of the light
//! ```

use crate::shared::{
    Chord, PictureCase, Worst, device, oblique_shots, ramps, sheared_affine, volume_of, waves,
};
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::technique::{Filter, Mode};
use stratavox::transfer::TransferFunction;
use stratavox::volume::{Coefficients, Grid, Volume};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const TABLE: f64 = 1.0 / 4096.0;
/// The steepest of the sRGB curve: 2.4 / 1.055.
const DECODE_SLOPE: f64 = 2.275;

/// dv of a volume on a device of `bits`.
fn value_error(volume: &Volume, bits: u32) -> f64 {
    let [nx, ny, nz] = volume.dims.map(|n| n as usize);
    let at = |x: usize, y: usize, z: usize| f64::from(volume.voxels.stored((z * ny + y) * nx + x));
    let mut steps = [0.0f64; 3];
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let here = at(x, y, z);
                let next = [
                    at((x + 1).min(nx - 1), y, z),
                    at(x, (y + 1).min(ny - 1), z),
                    at(x, y, (z + 1).min(nz - 1)),
                ];
                for k in 0..3 {
                    steps[k] = steps[k].max((next[k] - here).abs());
                }
            }
        }
    }
    steps.iter().sum::<f64>() / 2f64.powi(bits as i32 + 1)
}

/// Largest opacity, its steepest rise and the steepest rise of an sRGB number.
fn slopes(transfer: &TransferFunction) -> [f64; 3] {
    let rise = |points: &mut dyn Iterator<Item = (f64, f64, f64, f64)>| {
        points
            .map(|(v0, y0, v1, y1)| ((y1 - y0) / (v1 - v0)).abs())
            .fold(0.0, f64::max)
    };
    let opacity = transfer.opacity.windows(2);
    let opacity = rise(&mut opacity.map(|p| (p[0].value, p[0].opacity, p[1].value, p[1].opacity)));
    let color = transfer.color.windows(2).flat_map(|p| {
        [0, 1, 2].map(|c: usize| (p[0].value, p[0].srgb[c], p[1].value, p[1].srgb[c]))
    });
    let largest = transfer
        .opacity
        .iter()
        .map(|p| p.opacity)
        .fold(0.0, f64::max);
    [largest, opacity, rise(&mut color.into_iter())]
}

#[test]
fn the_fast_path_is_off_by_what_filter_and_table_explain() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    check(&mut renderer, &volume, Filter::Linear, &volume);
}

/// Eight linear fetches with weights of sum 1 are off by no more than the worst of them.
#[test]
fn splines_by_the_sampler_are_off_by_what_it_and_the_table_explain() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for filter in [Filter::Cubic, Filter::QuadraticSmooth] {
        let coefficients = filter
            .spline()
            .map(|spline| Coefficients::new(&volume, spline, [true; 3]));
        let read = coefficients.as_ref().map_or(&volume, Coefficients::volume);
        check(&mut renderer, &volume, filter, read);
    }
}

/// `read`: what the device has of it.
fn check(renderer: &mut Renderer, volume: &Volume, filter: Filter, read: &Volume) {
    let transfer = ramps();
    let bits = renderer.device().gpu().limits().subtexel_bits;
    let dv = value_error(read, bits);
    let [largest, opacity_slope, color_slope] = slopes(&transfer);
    let reference_length = GRID().smallest_spacing();
    let da = TABLE + opacity_slope * dv;
    let ds = da / ((1.0 - largest) * reference_length);
    let dc = DECODE_SLOPE * (TABLE + color_slope * dv);
    println!(
        "{filter:?}, {bits} sub-texel bits: a value is off by {dv:.2e}, an extinction by {ds:.2e}"
    );
    for mode in [
        Mode::Composite,
        Mode::Mip,
        Mode::Minip,
        Mode::Average,
        Mode::Xray,
    ] {
        // What the sampler does to a value is known from the eye of one projection.
        let is_linear = filter == Filter::Linear;
        let shots = oblique_shots(GRID(), mode).into_iter();
        for shot in shots.take(if is_linear { usize::MAX } else { 6 }) {
            let shot = shot.with(|settings| settings.filter = filter);
            let layers: &[LayerKind] = if mode.is_projection() {
                &[LayerKind::Value]
            } else {
                &[]
            };
            let scene = shot.scene(volume, Some(&transfer));
            let exact = renderer.render(&scene, layers).unwrap().picture;
            let fast = shot.with(|settings| settings.conformance = false);
            let scene = fast.scene(volume, Some(&transfer));
            let found = renderer.render(&scene, layers).unwrap().picture;
            let mut worst = Worst::new(format!("fast, {}", fast.what()));
            for (i, pixel) in shot.pixels().enumerate() {
                let Some(chord) = Chord::of(&shot, pixel) else {
                    continue;
                };
                let length = chord.length();
                if mode == Mode::Composite {
                    for c in 0..4 {
                        let color = if c < 3 { dc } else { 0.0 };
                        let error = f64::from(found.pixels[i][c] - exact.pixels[i][c]);
                        worst.take(pixel, error, 5e-6 + length * ds + color);
                    }
                    continue;
                }
                let [wanted, found] = [&exact, &found].map(|p| f64::from(p.layers[0].values[i]));
                if !wanted.is_nan() {
                    let sum = if mode == Mode::Xray { length } else { 1.0 };
                    worst.take(pixel, found - wanted, (1e-6 + dv) * sum.max(1.0));
                }
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn a_fast_picture_of_a_projection_is_classified_by_the_points_themselves() {
    // Projecting modes classify once a pixel: no table, so a nearest MIP is the same picture to the bit.
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for shot in oblique_shots(GRID(), Mode::Mip) {
        let shot: PictureCase = shot.with(|s| s.filter = stratavox::technique::Filter::Nearest);
        let fast = shot.with(|settings| settings.conformance = false);
        let wanted = renderer
            .render(&shot.scene(&volume, Some(&transfer)), &[])
            .unwrap()
            .picture;
        let found = renderer
            .render(&fast.scene(&volume, Some(&transfer)), &[])
            .unwrap()
            .picture;
        assert_eq!(wanted.pixels, found.pixels, "{}", shot.what());
    }
}
