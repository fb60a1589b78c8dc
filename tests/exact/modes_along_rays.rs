//! LMIP, attenuated MIP, MIDA and depth cues: closed forms, orders between modes, and the device against its CPU reference.

use crate::shared::{
    PictureCase, compare, device, oblique_shots, ramps, sheared_affine, straight_shots, volume_of,
    waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::Scene;
use stratavox::shaders::Frame;
use stratavox::technique::composite::Composite;
use stratavox::technique::mida::Mida;
use stratavox::technique::projection::reference::{Projected, project};
use stratavox::technique::{Filter, Lattice, Mode, Settings, Shading, Technique};
use stratavox::volume::{Grid, Volume};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const CUBE: Grid = Grid {
    dims: [16, 16, 32],
    world_from_voxel: DAffine3::IDENTITY,
};

/// Both projections on the lattice of rays, with numbers under which each mode differs from its neighbours.
fn shots(grid: Grid, mode: Mode) -> Vec<PictureCase> {
    let on_rays = oblique_shots(grid, mode).into_iter().filter(|shot| {
        shot.settings.technique == Technique::Raycast && shot.settings.lattice == Lattice::Ray
    });
    on_rays.map(|shot| shot.with(set_numbers)).collect()
}

fn set_numbers(settings: &mut Settings) {
    settings.per_mode.lmip_threshold = 0.6;
    settings.per_mode.unit_values = [0.1, 0.9];
    settings.per_mode.attenuation = 4.0;
    settings.per_mode.mida_gamma = -0.25;
}

fn layer(picture: &Picture, kind: LayerKind) -> Vec<f32> {
    let layer = picture.layers.iter().find(|layer| layer.kind == kind);
    layer.expect("the layer").values.clone()
}

fn drawn(volume: &Volume, shot: &PictureCase, layers: &[LayerKind]) -> Picture {
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let scene = shot.scene(volume, Some(&transfer));
    renderer.render(&scene, layers).unwrap().picture
}

/// One straight ray through the middle of `CUBE`, of the f64 CPU reference on a formula over z.
fn along_z(
    mode: Mode,
    samples_per_voxel: f64,
    value: impl Fn(f64) -> f64,
    change: impl Fn(&mut Settings),
) -> Projected<f64> {
    let shot = &straight_shots(CUBE, mode)[0];
    let shot = shot.with(|settings| {
        settings.samples_per_voxel = samples_per_voxel;
        change(settings);
    });
    let (frame, _) = shot.parameters();
    project(&frame, Lattice::Ray, mode, [8.5, 8.5], |[_, _, z]| {
        Some(value(z))
    })
    .0
}

/// Two bumps along z, the second one the higher. The eye is 32 before the box.
fn bumps(z: f64) -> f64 {
    let bump = |height: f64, at: f64| height * (-(z - at).powi(2) / 8.0).exp();
    bump(0.7, 9.0) + bump(1.0, 22.0)
}

#[test]
fn lmip_is_the_first_bump_over_the_threshold_and_not_the_highest() {
    for (threshold, height, at) in [
        (0.5, 0.7, 9.0),
        (0.8, 1.0, 22.0),
        (f64::INFINITY, 1.0, 22.0),
    ] {
        let found = along_z(Mode::Lmip, 8.0, bumps, |s| {
            s.per_mode.lmip_threshold = threshold
        });
        // Half a step from the top of a Gaussian of variance 4.
        let low = height * (-(1.0_f64 / 16.0).powi(2) / 8.0).exp();
        assert!(
            (low - 1e-9..=height + 1e-6).contains(&found.value),
            "over {threshold}: {found:?}"
        );
        let depth = found.depth.expect("a depth");
        assert!(
            (depth - (16.0 + at)).abs() <= 0.5 / 8.0 + 1e-6,
            "over {threshold}: {found:?}"
        );
    }
    // A ray that still rises at its end has its maximum there.
    let found = along_z(Mode::Lmip, 1.0, |z| z, |s| s.per_mode.lmip_threshold = 3.0);
    assert_eq!((found.value, found.weight), (31.5, 1.0));
}

#[test]
fn a_threshold_over_all_values_makes_lmip_a_mip() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let layers = [LayerKind::Value, LayerKind::Depth, LayerKind::Samples];
    for (lmip, mip) in shots(GRID(), Mode::Lmip)
        .iter()
        .zip(shots(GRID(), Mode::Mip))
    {
        let lmip = lmip.with(|s| s.per_mode.lmip_threshold = 2.0);
        // All samples are counted.
        let both = [&lmip, &mip].map(|shot| shot.with(|s| s.skip = false));
        let [found, wanted] = both.map(|shot| drawn(&volume, &shot, &layers));
        let same = |kind| {
            layer(&found, kind)
                .iter()
                .zip(layer(&wanted, kind))
                .all(|(a, b)| a.to_bits() == b.to_bits())
        };
        assert!(
            layers.into_iter().all(same) && found.pixels == wanted.pixels,
            "{}",
            lmip.what()
        );
    }
}

#[test]
fn minimum_local_maximum_and_maximum_stand_in_order_and_fading_only_takes() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let layers = [LayerKind::Value, LayerKind::Depth];
    let modes = [Mode::Minip, Mode::Lmip, Mode::Mip, Mode::AttenuatedMip];
    let first = |mode| shots(GRID(), mode).remove(0);
    let [minip, lmip, mip, faded] = modes.map(|mode| drawn(&volume, &first(mode), &layers));
    let [low, local, high, faded] =
        [minip, lmip.clone(), mip.clone(), faded].map(|p| layer(&p, LayerKind::Value));
    let [near, far] = [lmip, mip].map(|p| layer(&p, LayerKind::Depth));
    let mut differ = [0; 2];
    for i in 0..low.len() {
        if low[i].is_nan() {
            continue;
        }
        assert!(
            low[i] <= local[i] && local[i] <= high[i] && near[i] <= far[i],
            "pixel {i}"
        );
        assert!(
            faded[i] <= high[i].clamp(0.1, 0.9) + 1e-6,
            "pixel {i}: {} of {}",
            faded[i],
            high[i]
        );
        differ[0] += usize::from(local[i] < high[i]);
        differ[1] += usize::from(faded[i] < high[i] - 0.01);
    }
    assert!(
        differ.iter().all(|&n| n > 50),
        "the modes are the same: {differ:?}"
    );
}

/// Half of matter of value 1/2 before matter of value 1: what is behind has faded by a share known in advance.
#[test]
fn what_lies_behind_fades_by_the_matter_before_it_whatever_the_step() {
    let slabs = |z: f64| if z < 16.0 { 0.5 } else { 1.0 };
    let diagonal = f64::sqrt(16.0 * 16.0 * 2.0 + 32.0 * 32.0);
    // The second slab shows as exp(-a 8 / diagonal), the first as 1/2.
    for (share, wanted) in [(0.8_f64, 0.8), (0.6, 0.6), (0.4, 0.5)] {
        for samples_per_voxel in [1.0, 2.0, 4.0] {
            let found = along_z(Mode::AttenuatedMip, samples_per_voxel, slabs, |s| {
                s.per_mode.attenuation = -share.ln() * diagonal / 8.0;
            });
            assert!(
                (found.value - wanted).abs() < 1e-6,
                "{share}, {samples_per_voxel}: {found:?}"
            );
        }
    }
}

#[test]
fn mida_of_gamma_minus_one_is_compositing_to_the_last_bit() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let layers = [
        LayerKind::Depth,
        LayerKind::Samples,
        LayerKind::Transmittance,
    ];
    for (mida, composite) in shots(GRID(), Mode::Mida)
        .iter()
        .zip(shots(GRID(), Mode::Composite))
    {
        for termination in [0.0, 0.05] {
            let both = [mida, &composite].map(|shot| {
                shot.with(|s| {
                    s.per_mode.mida_gamma = -1.0;
                    s.termination = termination;
                    s.conformance = false;
                    s.skip = false;
                })
            });
            let [found, wanted] = both.map(|shot| drawn(&volume, &shot, &layers));
            let difference = found.pixels.iter().zip(&wanted.pixels);
            let worst = difference
                .flat_map(|(a, b)| (0..4).map(|c| (a[c] - b[c]).abs()))
                .fold(0.0, f32::max);
            assert!(worst <= 1e-6, "{}: off by {worst}", mida.what());
            assert_eq!(
                layer(&found, LayerKind::Samples),
                layer(&wanted, LayerKind::Samples)
            );
        }
    }
}

#[test]
fn two_samples_of_mida_are_what_the_formula_says() {
    let (frame, _) = shots(GRID(), Mode::Mida)[0]
        .with(|s| {
            s.per_mode.unit_values = [0.0, 2.0];
            s.per_mode.mida_gamma = -0.25;
        })
        .parameters();
    // Of opacity 1 - exp(-1 * 0.5) each, values 0.4 and 1.6: 0.2 and 0.8 without their unit.
    let mut found = Mida::<f64>::default();
    found.add(&frame, 0.4, [1.0, 0.0, 0.0, 1.0], 0.5, 1.0);
    found.add(&frame, 1.6, [0.0, 1.0, 0.0, 1.0], 0.5, 1.5);
    let alpha = 1.0 - (-0.5_f64).exp();
    // The first finds nothing before it; the second rises by 0.6.
    let beta = 1.0 - 0.6 * 0.75;
    let red = beta * alpha;
    let green = (1.0 - beta * alpha) * alpha;
    let opacity = beta * alpha + green;
    let Composite {
        color,
        transmittance,
        depth,
    } = found.gathered;
    for (found, wanted) in [
        (color[0], red),
        (color[1], green),
        (1.0 - transmittance, opacity),
    ] {
        assert!((found - wanted).abs() < 1e-6, "{found}, not {wanted}");
    }
    assert_eq!(depth, Some(1.5), "opacity {opacity}");
    assert!((found.largest - 0.8).abs() < 1e-6);
}

#[test]
fn mida_of_gamma_one_is_the_mip_and_half_the_way_is_the_mean_of_both() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for (mida, mip) in shots(GRID(), Mode::Mida)
        .iter()
        .zip(shots(GRID(), Mode::Mip))
    {
        for (conformance, allowed) in [(true, 2e-6), (false, 1.0 / 4096.0 + 1e-5)] {
            let of = |gamma: f64| {
                mida.with(|s| {
                    s.per_mode.mida_gamma = gamma;
                    s.conformance = conformance;
                })
            };
            let mip = mip.with(|s| s.conformance = conformance);
            let mut picture = |shot: &PictureCase| {
                let scene = shot.scene(&volume, Some(&transfer));
                let found = renderer.render(&scene, &[]).unwrap().picture;
                let reference = reference::render::<f32>(&scene).unwrap();
                [found.pixels, reference.pixels]
            };
            let [start, half, end] = [0.0, 0.5, 1.0].map(|gamma| picture(&of(gamma)));
            let wanted = picture(&mip);
            let (mut worst, mut apart, mut drawn) = (0.0_f32, 0.0_f32, 0);
            for way in 0..2 {
                for i in 0..wanted[way].len() {
                    let [a, b, c, d] = [&start, &half, &end, &wanted].map(|p| p[way][i]);
                    drawn += usize::from(d[3] > 0.1);
                    for k in 0..4 {
                        worst = worst.max((c[k] - d[k]).abs());
                        worst = worst.max((b[k] - 0.5 * (a[k] + c[k])).abs());
                        apart = apart.max((a[k] - d[k]).abs());
                    }
                }
            }
            assert!(worst <= allowed, "{}: off by {worst}", mida.what());
            assert!(apart > 0.05 && drawn > 200, "{apart}, {drawn} pixels");
        }
    }
}

/// An early end must not hide a maximum that would have cleared what hides it.
#[test]
fn a_maximum_behind_opaque_matter_is_seen_in_mida_though_rays_end_early() {
    let volume = volume_of(CUBE.dims, DAffine3::IDENTITY, |p: DVec3| {
        if p.z < 20.0 { 0.75 } else { 1.0 }
    });
    let shot = straight_shots(CUBE, Mode::Mida).remove(0);
    let shot = |termination| {
        shot.with(|s| {
            s.termination = termination;
            s.per_mode.mida_gamma = 0.0;
            s.conformance = false;
        })
    };
    let [whole, early] =
        [0.0, 0.01].map(|termination| drawn(&volume, &shot(termination), &[LayerKind::Samples]));
    let middle = 8 * 16 + 8;
    let differ = (0..3).map(|c| (whole.pixels[middle][c] - early.pixels[middle][c]).abs());
    assert!(
        differ.fold(0.0, f32::max) <= 0.01,
        "{:?}, {:?}",
        whole.pixels[middle],
        early.pixels[middle]
    );
    let [whole, early] = [whole, early].map(|p| layer(&p, LayerKind::Samples)[middle]);
    // Behind the largest value of all nothing is waited for.
    assert!(early > 20.0 && early < whole, "{early} samples of {whole}");
}

#[test]
fn the_far_end_is_darker_by_the_cue_and_alpha_stays() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    for mode in [Mode::Mip, Mode::Minip, Mode::Lmip, Mode::AttenuatedMip] {
        for shot in shots(GRID(), mode) {
            let cued = shot.with(|s| s.per_mode.depth_cue = 0.8);
            let plain = drawn(&volume, &shot, &[LayerKind::Depth]);
            let found = drawn(&volume, &cued, &[]);
            let distance = shot.camera.eye.distance(shot.grid.center());
            let half = 0.5 * longest_diagonal(&shot.grid);
            let mut seen = [f32::INFINITY, 0.0];
            for (i, depth) in layer(&plain, LayerKind::Depth).into_iter().enumerate() {
                let (wanted, found) = (plain.pixels[i], found.pixels[i]);
                assert_eq!(wanted[3], found[3], "alpha");
                if depth.is_nan() {
                    continue;
                }
                let far = ((f64::from(depth) - (distance - half)) / (2.0 * half)).clamp(0.0, 1.0);
                let light = (1.0 - 0.8 * far) as f32;
                seen = [seen[0].min(light), seen[1].max(light)];
                for c in 0..3 {
                    assert!(
                        (found[c] - light * wanted[c]).abs() < 2e-6,
                        "{} {i}",
                        shot.what()
                    );
                }
            }
            assert!(seen[1] - seen[0] > 0.1, "the cue says nothing: {seen:?}");
        }
    }
}

fn longest_diagonal(grid: &Grid) -> f64 {
    let far = grid.far_corner();
    let signs = [
        dvec3(1., 1., 1.),
        dvec3(1., 1., -1.),
        dvec3(1., -1., 1.),
        dvec3(-1., 1., 1.),
    ];
    let length = |sign: DVec3| grid.world_from_voxel.transform_vector3(sign * far).length();
    signs.map(length).into_iter().fold(0.0, f64::max)
}

/// The place of a maximum is the place of the one bump there is.
#[test]
fn the_position_of_a_maximum_is_where_the_maximum_lies_in_the_world() {
    let top = dvec3(9.3, 8.6, 7.2);
    let volume = volume_of(GRID().dims, sheared_affine(), |p| {
        (-p.distance_squared(top) / 18.0).exp()
    });
    let wanted = sheared_affine().transform_point3(top);
    for shot in shots(GRID(), Mode::Mip) {
        let picture = drawn(
            &volume,
            &shot,
            &[LayerKind::Value, LayerKind::Position, LayerKind::Depth],
        );
        let values = layer(&picture, LayerKind::Value);
        let best = (0..values.len()).filter(|&i| !values[i].is_nan());
        let best = best
            .max_by(|&a, &b| values[a].total_cmp(&values[b]))
            .expect("a maximum");
        let positions = layer(&picture, LayerKind::Position);
        let found = dvec3(
            positions[3 * best].into(),
            positions[3 * best + 1].into(),
            positions[3 * best + 2].into(),
        );
        // Half a pixel aside, half a step along, and what trilinear interpolation moves the top of a bump by.
        assert!(
            found.distance(wanted) < 1.5,
            "{}: {found}, not {wanted}",
            shot.what()
        );
        let depth = f64::from(layer(&picture, LayerKind::Depth)[best]);
        let rays = shot.camera.rays(shot.extent);
        let [x, y] = [best % 40, best / 40].map(|n| n as f64 + 0.5);
        let (origin, direction) = rays.at(x, y);
        assert!((origin + depth * direction).distance(found) < 1e-3);
        let misses = values
            .iter()
            .zip(positions.chunks(3))
            .filter(|(v, _)| v.is_nan());
        assert!(
            misses.clone().count() > 0 && misses.clone().all(|(_, p)| p.iter().all(|n| n.is_nan()))
        );
    }
}

#[test]
fn each_of_these_modes_is_drawn_as_its_reference_computes_it() {
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    for with_holes in [false, true] {
        if with_holes {
            let mask = (0..17 * 21 * 13).map(|i: u32| u8::from(!i.is_multiple_of(97)));
            volume.validity = Some(mask.collect());
        }
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        for mode in [Mode::Lmip, Mode::AttenuatedMip, Mode::Mida] {
            for (nth, shot) in shots(GRID(), mode).into_iter().enumerate() {
                let shot = shot.with(|settings| {
                    // All samples are counted; tests/relations/skipping_beside.rs compares with pictures that leave some out.
                    settings.skip = false;
                    settings.filter =
                        [Filter::Linear, Filter::Nearest][usize::from(with_holes != (nth == 0))];
                    let is_lit = mode == Mode::Mida && nth == 0;
                    settings.shading = is_lit.then(Shading::default);
                    if mode != Mode::Mida {
                        settings.per_mode.depth_cue = 0.5;
                    }
                });
                check(&mut renderer, &shot.scene(&volume, Some(&transfer)), &shot);
            }
        }
    }
}

fn check(renderer: &mut Renderer, scene: &Scene, shot: &PictureCase) {
    let mode = shot.settings.mode;
    let mut kinds = vec![LayerKind::Depth, LayerKind::Samples, LayerKind::Position];
    kinds.push(if mode.has_value() {
        LayerKind::Value
    } else {
        LayerKind::Transmittance
    });
    let found = renderer.render(scene, &kinds).unwrap().picture;
    let double = reference::render::<f64>(scene).unwrap();
    let single = reference::render::<f32>(scene).unwrap();
    let all = [&double, &single, &found];
    let what = format!("{:?} {:?}", shot.settings.filter, shot.what());
    compare(
        &what,
        4 * found.width,
        all.map(|p| p.pixels.as_flattened()),
        1.0,
    );
    for kind in kinds {
        let lists = all.map(|picture| layer(picture, kind));
        let scale = lists[0]
            .iter()
            .copied()
            .filter(|v| !v.is_nan())
            .fold(1.0, |a, b| f32::max(a, b.abs()));
        let width = found.width * kind.numbers() as u32;
        compare(
            &format!("{kind:?} of {what}"),
            width,
            [&lists[0], &lists[1], &lists[2]],
            scale,
        );
    }
}

#[test]
fn what_these_modes_lack_is_refused_by_name() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let refused = |shot: &PictureCase| {
        let error = reference::render::<f32>(&shot.scene(&volume, Some(&transfer)));
        error.expect_err("refused").to_string()
    };
    for mode in [Mode::Lmip, Mode::AttenuatedMip, Mode::Mida, Mode::Iso] {
        let shot = shots(GRID(), mode).remove(0);
        let slices = shot.with(|s| s.technique = Technique::Slices3d);
        let text = refused(&slices);
        assert!(
            text.contains("slices-3d") && text.contains(&mode.to_string()),
            "{text}"
        );
        let planes = shot.with(|s| s.lattice = Lattice::Planes);
        assert!(
            refused(&planes).contains("along rays"),
            "{}",
            refused(&planes)
        );
    }
    let cue = |mode| {
        shots(GRID(), mode)
            .remove(0)
            .with(|s| s.per_mode.depth_cue = 0.5)
    };
    assert!(refused(&cue(Mode::Average)).contains("no one depth"));
    let sliced = cue(Mode::Mip).with(|s| s.technique = Technique::Slices2d);
    assert!(refused(&sliced).contains("no one depth"));
    for (change, wanted) in [
        (
            (|s: &mut Settings| s.per_mode.mida_gamma = 1.5) as fn(&mut Settings),
            "gamma of MIDA is 1.5",
        ),
        (|s| s.per_mode.mida_gamma = f64::NAN, "gamma of MIDA is NaN"),
        (|s| s.per_mode.unit_values = [1.0, 1.0], "unit values is 1"),
    ] {
        let text = refused(&shots(GRID(), Mode::Mida).remove(0).with(change));
        assert!(text.contains(wanted), "{text}");
    }
}

#[test]
fn no_number_of_a_mode_reaches_the_device_infinite() {
    let shot = shots(GRID(), Mode::Lmip).remove(0);
    let (frame, _): (Frame, u32) = shot
        .with(|s| s.per_mode.lmip_threshold = f64::INFINITY)
        .parameters();
    assert_eq!(frame.lmip_threshold, f32::MAX);
}
