//! Volumes that lie on grids of their own.

use super::*;
use glam::{DMat3, dvec3};
use stratavox::technique::{Settings, splat::Splat};

/// Turned against the grid of the volume, with finer voxels, and in a part of its box.
fn turned() -> (DAffine3, [u32; 3]) {
    let center = GRID().center();
    let matrix = DMat3::from_rotation_y(0.3)
        * DMat3::from_rotation_x(0.5)
        * DMat3::from_diagonal(dvec3(0.7, 0.5, 0.9));
    let dims = [15, 23, 11];
    let middle = matrix * (0.5 * DVec3::from_array(dims.map(f64::from)));
    let affine = DAffine3::from_mat3_translation(matrix, center - middle + dvec3(1.3, -0.4, 0.2));
    (affine, dims)
}

/// Codes of 16 bits.
fn ripples_on(affine: DAffine3, dims: [u32; 3]) -> Volume {
    let values = volume_of(dims, affine, |p| 0.5 + 0.4 * (0.7 * p.y + 0.3 * p.x).sin()).voxels;
    let codes = (0..values.len()).map(|i| (values.stored(i) * 60000.0) as u16);
    let rescale = Rescale {
        slope: 1.0 / 60000.0,
        intercept: 0.0,
    };
    Volume::from_voxels(dims, affine, Voxels::U16(codes.collect()), rescale, None).unwrap()
}

fn labels_on(affine: DAffine3, dims: [u32; 3]) -> Volume {
    let count = dims.iter().product::<u32>();
    let voxels = Voxels::U8((0..count).map(|i| (i / 7 % 4) as u8).collect());
    Volume::from_voxels(dims, affine, voxels, Rescale::default(), None).unwrap()
}

/// Without 2D stacks, which have no places between their slices.
fn shots(mode: Mode) -> impl Iterator<Item = PictureCase> {
    let all = small_shots(GRID(), mode).into_iter();
    let has_places = |shot: &PictureCase| shot.settings.technique != Technique::Slices2d;
    let by_rays = |shot: &PictureCase| {
        let Settings {
            technique, lattice, ..
        } = shot.settings;
        technique == Technique::Raycast && lattice == Lattice::Ray
    };
    let warped = all
        .clone()
        .filter(by_rays)
        .map(|shot| shot.with(|settings| settings.technique = Technique::ShearWarp));
    all.filter(has_places).chain(warped)
}

/// The last picture that the device draws.
fn check(
    volume: &Volume,
    transfer: &TransferFunction,
    channels: &[Channel],
    mode: Mode,
    what: &str,
) -> Vec<[f32; 4]> {
    let others = channels.iter().map(|channel| channel.volume);
    let volumes: Vec<_> = [volume].into_iter().chain(others).collect();
    let mut renderer = renderer(&volumes);
    let mut last = Vec::new();
    for filter in [Filter::Nearest, Filter::Linear] {
        for shot in of_filter(filter, shots(mode).collect()) {
            let shot = shot.with(|settings| settings.filter = filter);
            let scene = scene(&shot, volume, transfer, Beside::Channels(channels));
            let all = pictures(&mut renderer, &scene);
            let what = format!("{what}, {filter:?}, {}", shot.what());
            let drawn = all[1].pixels.iter().filter(|p| p[3] > 0.01).count();
            assert!(drawn > 50, "{what}: only {drawn} pixels are drawn");
            let lists = all.each_ref().map(|p| p.pixels.as_flattened());
            compare(&what, 4 * all[0].width, lists, 1.0);
            last.clone_from(&all[2].pixels);
        }
    }
    last
}

#[test]
fn volumes_on_grids_of_their_own_are_mixed_as_the_reference_mixes_them() {
    let first = volume_of(GRID().dims, sheared_affine(), waves);
    let (affine, dims) = turned();
    let second = ripples_on(affine, dims);
    let holed = with_holes(ripples_on(affine, dims), 5);
    let coarse =
        DAffine3::from_translation(DVec3::splat(-2.0)) * DAffine3::from_scale(DVec3::splat(4.0));
    let mut labels = with_holes(labels_on(sheared_affine() * coarse, [6, 7, 5]), 11);
    dim(&mut labels, |label| label == 2);
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let names = label_colors();
    let one = channel(&second, &functions[1], Role::Numbers);
    let with_holes = channel(&holed, &functions[1], Role::Numbers);
    let map = channel(&labels, &names, Role::Labels);
    let opacity = channel(&second, &functions[0], Role::Opacity);
    let all = [
        (&[one][..], "one"),
        (&[with_holes], "with holes"),
        (&[one, map], "with labels"),
        (&[opacity], "opacity"),
    ];
    let drawn =
        all.map(|(channels, what)| check(&first, &functions[0], channels, Mode::Composite, what));
    for (i, picture) in drawn.iter().enumerate() {
        assert!(
            !drawn[..i].contains(picture),
            "{}: as another one",
            all[i].1
        );
    }
    for mode in [Mode::Mip, Mode::Average] {
        check(&first, &functions[0], &[one], mode, "projected");
    }
}

/// Voxels repeated beyond the box: filters clamp to the same values, so a larger grid is the same field in the box.
#[test]
fn a_channel_with_a_border_of_its_own_is_that_without() {
    let dims = GRID().dims;
    let first = volume_of(dims, sheared_affine(), waves);
    let second = ripples();
    let codes: Vec<u16> = {
        let clamped = |n: u32, k: usize| n.saturating_sub(2).min(dims[k] - 1);
        let [nx, ny, nz] = dims.map(|n| n + 4);
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        let index = |[x, y, z]: [u32; 3]| {
            let [x, y, z] = [clamped(x, 0), clamped(y, 1), clamped(z, 2)];
            (x + dims[0] * (y + dims[1] * z)) as usize
        };
        let Voxels::U16(own) = &second.voxels else {
            unreachable!("codes of 16 bits")
        };
        all.map(|p| own[index(p)]).collect()
    };
    let affine = sheared_affine() * DAffine3::from_translation(DVec3::splat(-2.0));
    let rescale = Rescale {
        slope: 1.0 / 60000.0,
        intercept: 0.0,
    };
    let bordered = Volume::from_voxels(
        dims.map(|n| n + 4),
        affine,
        Voxels::U16(codes),
        rescale,
        None,
    )
    .unwrap();
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let [same, other] =
        [&second, &bordered].map(|volume| [channel(volume, &functions[1], Role::Numbers)]);
    let mut renderers = [renderer(&[&first, &second]), renderer(&[&first, &bordered])];
    for shot in shots(Mode::Composite) {
        let shot = shot.with(|settings| {
            settings.filter = Filter::Linear;
            settings.conformance = true;
        });
        let [wanted, found] = [(0, &same), (1, &other)].map(|(i, channels)| {
            let scene = scene(&shot, &first, &functions[0], Beside::Channels(channels));
            renderers[i].render(&scene, &[]).unwrap().picture
        });
        let mut worst = Worst::new(format!("with a border, {}", shot.what()));
        for (pixel, (wanted, found)) in shot.pixels().zip(wanted.pixels.iter().zip(&found.pixels)) {
            for c in 0..4 {
                // Places of some twenty voxels are rounded once more, by 2^-20 of a voxel: steps of values, times opacities, of a
                // hundred samples.
                worst.take(pixel, f64::from(wanted[c]) - f64::from(found[c]), 1e-5);
            }
        }
        worst.assert_holds();
    }
}

#[test]
fn skipping_what_no_channel_shows_changes_no_bit() {
    let first = volume_of([40, 40, 40], DAffine3::IDENTITY, |p| {
        f64::from(u8::from(p.x > 30.0))
    });
    let affine = DAffine3::from_translation(dvec3(5.0, 8.0, 9.0))
        * DAffine3::from_scale(DVec3::splat(0.6))
        * DAffine3::from_rotation_z(0.4);
    let ball = |p: DVec3| f64::from(u8::from((p - dvec3(15.0, 14.0, 13.0)).length() < 11.0));
    let second = volume_of([30, 28, 26], affine, ball);
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9])];
    let channels = [channel(&second, &functions[1], Role::Numbers)];
    let mut renderer = renderer(&[&first, &second]);
    let mut seen = 0;
    for shot in oblique_shots(first.grid(), Mode::Composite) {
        if shot.settings.technique != Technique::Raycast {
            continue;
        }
        let layers = [LayerKind::Samples];
        let [all, skipped] = [false, true].map(|skip| {
            let shot = shot.with(|settings| settings.skip = skip);
            let scene = scene(&shot, &first, &functions[0], Beside::Channels(&channels));
            renderer.render(&scene, &layers).unwrap().picture
        });
        assert!(all.pixels == skipped.pixels, "{}", shot.what());
        let taken = |picture: &Picture| {
            picture.layers[0]
                .values
                .iter()
                .map(|&n| f64::from(n))
                .sum::<f64>()
        };
        assert!(
            taken(&skipped) < 0.7 * taken(&all),
            "{} of {}",
            taken(&skipped),
            taken(&all)
        );
        // What the second volume alone shows.
        seen += all.pixels.iter().filter(|p| p[0] > p[1] + 1e-3).count();
    }
    assert!(seen > 100, "{seen} pixels show the ball");
}

#[test]
fn techniques_without_places_between_slices_refuse_them_by_name() {
    let first = volume_of(GRID().dims, sheared_affine(), waves);
    let (affine, dims) = turned();
    let second = ripples_on(affine, dims);
    let functions = [ramps(), ramps()];
    let channels = [channel(&second, &functions[1], Role::Numbers)];
    let shot = shots(Mode::Composite).next().unwrap();
    for technique in [Technique::Slices2d, Technique::Splat] {
        let shot = shot.with(|settings| {
            settings.technique = technique;
            settings.lattice = Lattice::Ray;
            settings.splat = Splat::default();
        });
        let scene = scene(&shot, &first, &functions[0], Beside::Channels(&channels));
        let error = scene.check().unwrap_err().to_string();
        assert!(error.contains(&technique.to_string()), "{error}");
    }
    let caps = Caps {
        max_image_dimension_3d: 16,
        ..Caps::UNLIMITED
    };
    let scene = scene(&shot, &first, &functions[0], Beside::Channels(&channels));
    let mut bricked = Renderer::several(device_with(caps), vec![&first, &second]).unwrap();
    let error = bricked.render(&scene, &[]).unwrap_err().to_string();
    assert!(error.contains("too large for one texture"), "{error}");
}
