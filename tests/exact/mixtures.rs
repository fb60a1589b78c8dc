//! Several volumes on one grid: each shader computes what its CPU reference computes, bricks change nothing, and a mixture
//! is what independent emitters and absorbers in one place are.

mod hindered;
mod labels_over;
mod opacity;
mod own_grids;
mod preclassified;

use crate::shared::{
    Chord, PictureCase, Worst, compare, device, device_with, oblique_shots, ramps, sheared_affine,
    sweep, volume_of, waves,
};
use glam::{DAffine3, DVec3};
use stratavox::color::decode_srgb;
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::{Error, Filter, Lattice, Mode, Role, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Grid, Rescale, Volume, Voxels, labels::dim};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

/// One colour, and the opacity per world length 1 of an extinction.
fn fog(srgb: [f64; 3], extinction: f64) -> TransferFunction {
    TransferFunction {
        color: vec![ColorPoint { value: 0.0, srgb }],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: -(-extinction).exp_m1(),
        }],
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

fn tinted(srgb: [f64; 3]) -> TransferFunction {
    let mut function = ramps();
    function.color[2].srgb = srgb;
    function
}

fn with_holes(mut volume: Volume, step: usize) -> Volume {
    let count = volume.voxels.len();
    let mask = (0..count).map(|i| u8::from(!i.is_multiple_of(step)));
    volume.validity = Some(mask.collect());
    volume
}

/// Waves that run otherwise, as codes of 16 bits.
fn ripples() -> Volume {
    let field = |p: DVec3| 0.5 + 0.4 * (0.7 * p.y + 0.3 * p.x).sin();
    let values = volume_of(GRID().dims, sheared_affine(), field).voxels;
    let codes = (0..values.len()).map(|i| (values.stored(i) * 60000.0) as u16);
    let rescale = Rescale {
        slope: 1.0 / 60000.0,
        intercept: 0.0,
    };
    let voxels = Voxels::U16(codes.collect());
    Volume::from_voxels(GRID().dims, sheared_affine(), voxels, rescale, None).unwrap()
}

/// Labels 0 to 3 in blocks.
fn blocks() -> Volume {
    let [nx, ny, nz] = GRID().dims;
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let label = |[x, y, z]: [u32; 3]| ((x / 5 + y / 6 + z / 4) % 4) as u8;
    let voxels = Voxels::U8(all.map(label).collect());
    let rescale = Rescale::default();
    Volume::from_voxels(GRID().dims, sheared_affine(), voxels, rescale, None).unwrap()
}

fn label_colors() -> TransferFunction {
    let colors = [[0.0; 3], [1.0, 0.1, 0.1], [0.1, 1.0, 0.2], [0.2, 0.3, 1.0]];
    let value = |i: usize| i as f64 - 0.5;
    let colors = colors.into_iter().enumerate();
    let color = colors.map(|(i, srgb)| ColorPoint {
        value: value(i),
        srgb,
    });
    let opacities = [0.0, 0.1, 0.05, 0.2].into_iter().enumerate();
    let opacity = opacities.map(|(i, opacity)| OpacityPoint {
        value: value(i),
        opacity,
    });
    TransferFunction {
        color: color.collect(),
        opacity: opacity.collect(),
        reference_length: None,
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    }
}

fn channel<'a>(volume: &'a Volume, transfer: &'a TransferFunction, role: Role) -> Channel<'a> {
    Channel {
        volume,
        transfer: Some(transfer),
        role,
    }
}

fn scene<'a>(
    shot: &'a PictureCase,
    volume: &'a Volume,
    transfer: &'a TransferFunction,
    beside: Beside<'a>,
) -> Scene<'a> {
    Scene {
        beside,
        ..shot.scene(volume, Some(transfer))
    }
}

/// Opening a device takes far longer than a picture: one for all pictures of the same volumes.
fn renderer<'a>(volumes: &[&'a Volume]) -> Renderer<'a> {
    Renderer::several(device(), volumes.to_vec()).unwrap()
}

/// Small pictures, those of one pipeline next to each other.
fn small_shots(grid: Grid, mode: Mode) -> Vec<PictureCase> {
    let all = oblique_shots(grid, mode);
    let (first, second) = all.split_at(all.len() / 2);
    let pairs = first.iter().zip(second);
    let shots = pairs.flat_map(|(a, b)| [a.clone(), b.clone()]);
    let extent = [28, 24];
    shots.map(|shot| PictureCase { extent, ..shot }).collect()
}

/// Each pipeline with one of both filters, by turns; with both in long sweeps.
fn of_filter(filter: Filter, shots: Vec<PictureCase>) -> impl Iterator<Item = PictureCase> {
    let is_drawn = move |pair| sweep::is_long() || (pair % 2 == 0) == (filter == Filter::Linear);
    let numbered = shots.into_iter().enumerate();
    numbered.filter_map(move |(n, shot)| is_drawn(n / 2).then_some(shot))
}

fn pictures(renderer: &mut Renderer, scene: &Scene) -> [Picture; 3] {
    [
        reference::render::<f64>(scene).unwrap(),
        reference::render::<f32>(scene).unwrap(),
        renderer.render(scene, &[]).unwrap().picture,
    ]
}

/// Every placement of samples, and both filters.
fn check_against_references(
    volume: &Volume,
    transfer: &TransferFunction,
    beside: Beside,
    mode: Mode,
    what: &str,
) {
    let volumes = match beside {
        Beside::Nothing | Beside::Preclassified | Beside::Points(_) => vec![volume],
        Beside::Channels(all) => {
            let others = all.iter().map(|channel| channel.volume);
            [volume].into_iter().chain(others).collect()
        }
        Beside::Colors(all) | Beside::Classified(all) => [&[volume], all].concat(),
    };
    let mut renderer = renderer(&volumes);
    for filter in [Filter::Nearest, Filter::Linear] {
        for shot in of_filter(filter, small_shots(GRID(), mode)) {
            let shot = shot.with(|settings| settings.filter = filter);
            let scene = scene(&shot, volume, transfer, beside);
            let all = pictures(&mut renderer, &scene);
            let what = format!("{what}, {filter:?}, {}", shot.what());
            let drawn = all[1].pixels.iter().filter(|p| p[3] > 0.01).count();
            assert!(drawn > 100, "{what}: only {drawn} pixels are drawn");
            let lists = all.each_ref().map(|p| p.pixels.as_flattened());
            compare(&what, 4 * all[0].width, lists, 1.0);
        }
    }
}

#[test]
fn channels_with_holes_and_types_of_their_own_are_mixed_as_the_reference_mixes_them() {
    let first = with_holes(volume_of(GRID().dims, sheared_affine(), waves), 7);
    let (second, mut labels) = (ripples(), with_holes(blocks(), 11));
    dim(&mut labels, |label| label == 2);
    let third = with_holes(ripples(), 5);
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9]), ramps()];
    let names = label_colors();
    let channels = [
        channel(&second, &functions[1], Role::Numbers),
        channel(&third, &functions[2], Role::Numbers),
        channel(&labels, &names, Role::Labels),
    ];
    for count in 1..=channels.len() {
        let beside = Beside::Channels(&channels[..count]);
        let what = format!("{count} beside");
        check_against_references(&first, &functions[0], beside, Mode::Composite, &what);
    }
    let whole = ripples();
    let channels = [channel(&second, &functions[1], Role::Numbers)];
    let beside = Beside::Channels(&channels);
    check_against_references(&whole, &functions[0], beside, Mode::Composite, "no holes");
}

#[test]
fn projections_of_channels_are_added_as_the_reference_adds_them() {
    let first = with_holes(volume_of(GRID().dims, sheared_affine(), waves), 7);
    let second = ripples();
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let channels = [channel(&second, &functions[1], Role::Numbers)];
    for mode in [Mode::Mip, Mode::Minip, Mode::Average] {
        let beside = Beside::Channels(&channels);
        check_against_references(&first, &functions[0], beside, mode, "projected");
    }
}

#[test]
fn colours_are_drawn_as_the_reference_draws_them() {
    let red = volume_of(GRID().dims, sheared_affine(), waves);
    let green = with_holes(ripples(), 13);
    let blue = volume_of(GRID().dims, sheared_affine(), |p| 1.0 - waves(p));
    let alpha = volume_of(GRID().dims, sheared_affine(), |p| 0.3 + 0.7 * waves(p));
    let transfer = ramps();
    for volumes in [&[&green, &blue][..], &[&green, &blue, &alpha]] {
        let what = format!("{} colours", 1 + volumes.len());
        let beside = Beside::Colors(volumes);
        check_against_references(&red, &transfer, beside, Mode::Composite, &what);
    }
}

#[test]
fn two_fogs_in_one_place_are_one_of_their_mean_colour_and_added_extinction() {
    let volume = volume_of(GRID().dims, sheared_affine(), |_| 1.0);
    let (colors, extinctions) = ([[1.0, 0.2, 0.0], [0.1, 0.4, 0.9]], [0.02, 0.07]);
    let functions = [0, 1].map(|i| fog(colors[i], extinctions[i]));
    let channels = [channel(&volume, &functions[1], Role::Numbers)];
    let sum: f64 = extinctions.iter().sum();
    let mut renderer = renderer(&[&volume, &volume]);
    for shot in small_shots(GRID(), Mode::Composite) {
        let shot = shot.with(|settings| settings.color_space = ColorSpace::Display);
        let scene = scene(&shot, &volume, &functions[0], Beside::Channels(&channels));
        let all = pictures(&mut renderer, &scene);
        for (way, picture) in ["f64", "f32", "device"].into_iter().zip(&all) {
            let mut worst = Worst::new(format!("two fogs, {way}, {}", shot.what()));
            for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                let chord = Chord::of(&shot, pixel);
                if chord.as_ref().is_some_and(|chord| chord.hangs) {
                    worst.leave_out();
                    continue;
                }
                let length = chord.as_ref().map_or(0.0, |chord| chord.length());
                let blur = chord.as_ref().map_or(0.0, |chord| chord.blur);
                let alpha = -(-sum * length).exp_m1();
                // What f32 does to the ends of the chord, and to a hundred blended segments.
                let allowed = 2.0 * sum * blur + 1e-5;
                for c in 0..3 {
                    let light = extinctions[0] * colors[0][c] + extinctions[1] * colors[1][c];
                    worst.take(pixel, f64::from(found[c]) - alpha * light / sum, allowed);
                }
                worst.take(pixel, f64::from(found[3]) - alpha, allowed);
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn a_transparent_channel_leaves_the_picture_of_the_other() {
    let (volume, other) = (
        volume_of(GRID().dims, sheared_affine(), waves),
        with_holes(ripples(), 5),
    );
    let (shown, nothing) = (ramps(), fog([1.0, 0.0, 1.0], 0.0));
    let channels = [channel(&other, &nothing, Role::Numbers)];
    let (mut one, mut both) = (renderer(&[&volume]), renderer(&[&volume, &other]));
    for shot in small_shots(GRID(), Mode::Composite) {
        let alone = scene(&shot, &volume, &shown, Beside::Nothing);
        let mixed = scene(&shot, &volume, &shown, Beside::Channels(&channels));
        let wanted = pictures(&mut one, &alone);
        let found = pictures(&mut both, &mixed);
        for (wanted, found) in wanted.iter().zip(&found) {
            let what = format!("transparent beside, {}", shot.what());
            // sigma c / sigma is c to one rounding a sample.
            Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 2e-6).assert_holds();
        }
    }
}

#[test]
fn channels_in_another_order_are_the_same_picture() {
    let volumes = [
        volume_of(GRID().dims, sheared_affine(), waves),
        ripples(),
        with_holes(ripples(), 7),
    ];
    let functions = [tinted([0.0, 1.0, 1.0]), tinted([1.0, 0.0, 1.0]), ramps()];
    let orders = [[0, 1, 2], [1, 0, 2], [2, 1, 0]];
    let mut renderers = orders.map(|order| renderer(&order.map(|i| &volumes[i])));
    for mode in [Mode::Composite, Mode::Mip] {
        for shot in small_shots(GRID(), mode) {
            let mut in_order = |nth: usize| {
                let order: [usize; 3] = orders[nth];
                let [first, ..] = order;
                let channels = order.map(|i| channel(&volumes[i], &functions[i], Role::Numbers));
                let beside = Beside::Channels(&channels[1..]);
                let scene = scene(&shot, &volumes[first], &functions[first], beside);
                renderers[nth].render(&scene, &[]).unwrap().picture
            };
            let wanted = in_order(0);
            for nth in [1, 2] {
                let what = format!("order {:?}, {}", orders[nth], shot.what());
                let found = in_order(nth);
                Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 4e-6)
                    .assert_holds();
            }
        }
    }
}

#[test]
fn a_volume_of_one_colour_is_that_colour() {
    let srgb = [0.9, 0.5, 0.2];
    let constant = |x: f64| volume_of(GRID().dims, sheared_affine(), move |_| x);
    let alpha = volume_of(GRID().dims, sheared_affine(), waves);
    let straight = srgb.map(constant);
    let multiplied = srgb.map(|c| volume_of(GRID().dims, sheared_affine(), move |p| c * waves(p)));
    let transfer = fog([0.0; 3], 0.1);
    let rgb = [&straight[1], &straight[2]];
    let rgba = [&multiplied[1], &multiplied[2], &alpha];
    for (first, beside) in [(&straight[0], &rgb[..]), (&multiplied[0], &rgba)] {
        let mut renderer = renderer(&[&[first], beside].concat());
        for color_space in [ColorSpace::Linear, ColorSpace::Display] {
            for shot in small_shots(GRID(), Mode::Composite) {
                let shot = shot.with(|settings| settings.color_space = color_space);
                let scene = scene(&shot, first, &transfer, Beside::Colors(beside));
                let wanted = match color_space {
                    ColorSpace::Linear => srgb.map(decode_srgb),
                    ColorSpace::Display => srgb,
                };
                for picture in pictures(&mut renderer, &scene) {
                    let what = format!("{} colours, {}", 1 + beside.len(), shot.what());
                    let mut worst = Worst::new(what);
                    for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                        for c in 0..3 {
                            let wanted = wanted[c] * f64::from(found[3]);
                            worst.take(pixel, f64::from(found[c]) - wanted, 5e-6);
                        }
                    }
                    worst.assert_holds();
                    let drawn = picture.pixels.iter().filter(|p| p[3] > 0.1).count();
                    assert!(drawn > 100, "only {drawn} pixels are drawn");
                }
            }
        }
    }
}

#[test]
fn projected_channels_are_the_sum_of_their_pictures_up_to_one() {
    let volumes = [volume_of(GRID().dims, sheared_affine(), waves), ripples()];
    let dense = |srgb| {
        let mut function = tinted(srgb);
        function.opacity[2].opacity = 0.9;
        function
    };
    let functions = [dense([0.0, 1.0, 1.0]), dense([1.0, 0.9, 0.0])];
    let channels = [channel(&volumes[1], &functions[1], Role::Numbers)];
    let mut alone = [renderer(&[&volumes[0]]), renderer(&[&volumes[1]])];
    let mut renderer = renderer(&[&volumes[0], &volumes[1]]);
    let mut clamped = 0;
    for shot in small_shots(GRID(), Mode::Mip) {
        let beside = Beside::Channels(&channels);
        let together = scene(&shot, &volumes[0], &functions[0], beside);
        let found = renderer.render(&together, &[LayerKind::Samples]).unwrap();
        let mut one = |i: usize| {
            let scene = scene(&shot, &volumes[i], &functions[i], Beside::Nothing);
            alone[i].render(&scene, &[]).unwrap().picture.pixels
        };
        let (a, b) = (one(0), one(1));
        let wanted: Vec<[f32; 4]> = a
            .iter()
            .zip(&b)
            .map(|(a, b)| std::array::from_fn(|c| (a[c] + b[c]).min(1.0)))
            .collect();
        let pairs = a.iter().zip(&b);
        clamped += pairs
            .filter(|(a, b)| (0..4).any(|c| a[c] + b[c] > 1.0))
            .count();
        assert_eq!(wanted, found.picture.pixels, "{}", shot.what());
        assert_eq!(found.picture.layers.len(), 1, "samples");
    }
    assert!(clamped > 0, "no sum is over 1");
}

#[test]
fn hidden_labels_cut_away_what_a_crop_box_cuts_away() {
    // World is voxel space, so that both cut at the same numbers.
    let affine = DAffine3::IDENTITY;
    let dims = [16, 18, 20];
    let volume = volume_of(dims, affine, waves);
    let mut labels = volume_of(dims, affine, |_| 1.0);
    let is_shown = |i: usize| i % 16 >= 6;
    labels.validity = Some(
        (0..labels.voxels.len())
            .map(|i| is_shown(i).into())
            .collect(),
    );
    let grid = volume.grid();
    let (shown, nothing) = (ramps(), fog([0.0; 3], 0.0));
    let channels = [channel(&labels, &nothing, Role::Labels)];
    // Samples that do not depend on where the ray enters.
    let on_planes = |shot: &PictureCase| {
        shot.settings.technique != Technique::Raycast || shot.settings.lattice == Lattice::Planes
    };
    let (mut with_crop, mut with_labels) = (renderer(&[&volume]), renderer(&[&volume, &labels]));
    let shots = small_shots(grid, Mode::Composite).into_iter();
    for shot in shots.filter(on_planes) {
        let shot = shot.with(|settings| settings.filter = Filter::Linear);
        let hidden = scene(&shot, &volume, &shown, Beside::Channels(&channels));
        let cropped_shot = shot.with(|settings| {
            settings.crop = Some([DVec3::new(6.0, 0.0, 0.0), grid.far_corner()]);
        });
        let cropped = scene(&cropped_shot, &volume, &shown, Beside::Nothing);
        let wanted = with_crop.render(&cropped, &[]).unwrap().picture;
        let found = with_labels.render(&hidden, &[]).unwrap().picture;
        let mut worst = Worst::new(format!("hidden by labels, {}", shot.what()));
        for (pixel, (wanted, found)) in shot.pixels().zip(wanted.pixels.iter().zip(&found.pixels)) {
            if Chord::of(&cropped_shot, pixel).is_some_and(|chord| chord.hangs) {
                worst.leave_out();
                continue;
            }
            for c in 0..4 {
                worst.take(pixel, f64::from(wanted[c]) - f64::from(found[c]), 2e-6);
            }
        }
        worst.assert_holds();
    }
}

#[test]
fn bricks_leave_a_mixture_bit_identical() {
    let caps = Caps {
        // Few bricks: software drivers compile slices anew for each.
        max_image_dimension_3d: 11,
        max_image_array_layers: 6,
        ..Caps::UNLIMITED
    };
    let first = with_holes(volume_of(GRID().dims, sheared_affine(), waves), 7);
    let (second, mut labels) = (ripples(), with_holes(blocks(), 11));
    dim(&mut labels, |label| label == 2);
    let (functions, names) = ([ramps(), tinted([1.0, 0.0, 1.0])], label_colors());
    let channels = [
        channel(&second, &functions[1], Role::Numbers),
        channel(&labels, &names, Role::Labels),
    ];
    let colors = [&second, &first];
    let cases = [
        (Beside::Channels(&channels), vec![&first, &second, &labels]),
        (Beside::Colors(&colors), vec![&first, &second, &first]),
    ];
    for (turn, (beside, volumes)) in cases.into_iter().enumerate() {
        let mut whole = renderer(&volumes);
        let mut bricked = Renderer::several(device_with(caps), volumes).unwrap();
        // Pipelines by turns: a shot and its neighbour have one.
        let shots = small_shots(GRID(), Mode::Composite).into_iter().enumerate();
        let is_drawn = |i: usize| sweep::is_long() || i / 2 % 2 == turn;
        for (_, shot) in shots.filter(|(i, _)| is_drawn(*i)) {
            let shot = shot.with(|settings| settings.termination = 0.01);
            let scene = scene(&shot, &first, &functions[0], beside);
            let layers = [LayerKind::Samples];
            let wanted = whole.render(&scene, &layers).unwrap().picture;
            let found = bricked.render(&scene, &layers).unwrap().picture;
            assert!(wanted.pixels.iter().filter(|p| p[3] > 0.0).count() > 100);
            assert!(wanted.pixels == found.pixels, "{}", shot.what());
            assert_eq!(wanted.layers, found.layers, "{}", shot.what());
        }
    }
}

#[test]
fn what_cannot_be_mixed_is_refused() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let moved = volume_of(GRID().dims, DAffine3::IDENTITY, waves);
    let transfer = ramps();
    let refused = |mode: Mode, beside: Beside| {
        let shot = oblique_shots(GRID(), mode).swap_remove(0);
        let scene = scene(&shot, &volume, &transfer, beside);
        let on_cpu = reference::render::<f32>(&scene).unwrap_err();
        let on_device = renderer(&scene.volumes()).render(&scene, &[]).unwrap_err();
        assert_eq!(on_cpu.to_string(), on_device.to_string());
        on_cpu
    };
    let channels = |volume, role, count| vec![channel(volume, &transfer, role); count];
    let found = refused(Mode::Composite, Beside::Colors(&[&volume, &moved]));
    assert_eq!(found, Error::OtherGrid);
    let many = channels(&volume, Role::Numbers, 4);
    let found = refused(Mode::Composite, Beside::Channels(&many));
    let (wanted, limit) = (5, 4);
    assert_eq!(found, Error::TooManyChannels { wanted, limit });
    let found = refused(Mode::Composite, Beside::Colors(&[&volume]));
    assert_eq!(found, Error::NoColor { found: 2 });
    let mode = Mode::Mip;
    let found = refused(mode, Beside::Colors(&[&volume, &volume]));
    assert_eq!(found, Error::NotMixed { mode });
    let opacity = channels(&volume, Role::Opacity, 1);
    let found = refused(mode, Beside::Channels(&opacity));
    assert_eq!(found, Error::NotMixed { mode });
}
