//! Kernels and prefilters: what they reproduce, what they go through, and where no data reaches.

use glam::{DAffine3, DVec3};
use stratavox::volume::field::{Field, MarschnerLobb};
use stratavox::volume::kernel::{Kernel, convolved, convolved_in_slice};
use stratavox::volume::sample::{linear, nearest};
use stratavox::volume::{Coefficients, Rescale, Spline, Volume, Voxels};

const KERNELS: [Kernel; 3] = [Kernel::Quadratic, Kernel::Cubic, Kernel::CatmullRom];
const SPLINES: [Spline; 2] = [Spline::Quadratic, Spline::Cubic];
const ALL_AXES: [bool; 3] = [true; 3];

fn volume_of(dims: [u32; 3], value: impl Fn([u32; 3]) -> f32) -> Volume {
    let [nx, ny, nz] = dims;
    let voxels = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let numbers = Voxels::F32(voxels.map(value).collect());
    Volume::from_voxels(dims, DAffine3::IDENTITY, numbers, Rescale::default(), None).unwrap()
}

/// Numbers from 0 to 1 that look like chance (Numerical Recipes' generator).
struct Chance(u32);

impl Chance {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 8) / f64::from(1 << 24)
    }
}

fn noise(dims: [u32; 3]) -> Volume {
    let mut chance = Chance(7);
    let count = dims.iter().product::<u32>();
    let numbers: Vec<f32> = (0..count).map(|_| chance.number() as f32).collect();
    volume_of(dims, |[x, y, z]| {
        numbers[((z * dims[1] + y) * dims[0] + x) as usize]
    })
}

fn centers(dims: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let [nx, ny, nz] = dims;
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

/// How far `filter` is from the voxels at their centres moved by `offset`, at the worst.
fn worst_at_centers(volume: &Volume, offset: f64, filter: impl Fn([f64; 3]) -> Option<f64>) -> f64 {
    let error = |index: [u32; 3]| {
        let p = index.map(|i| f64::from(i) + 0.5);
        let wanted = nearest(volume, p).unwrap();
        (filter(p.map(|x| x + offset)).unwrap() - wanted).abs()
    };
    centers(volume.dims).map(error).fold(0.0, f64::max)
}

#[test]
fn weights_add_up_to_1_and_those_of_b_splines_are_never_negative() {
    for kernel in KERNELS {
        for step in 0..=1000 {
            let f = f64::from(step) / 1000.0;
            let weights = kernel.weights(f);
            let sum: f64 = weights.iter().sum();
            assert!(
                (sum - 1.0).abs() < 4.0 * f64::EPSILON,
                "{kernel:?} at {f}: {sum}"
            );
            let least = weights.into_iter().fold(0.0, f64::min);
            match kernel {
                // The least of -f g^2 / 2 is at f = 1/3; two of them are negative at once.
                Kernel::CatmullRom => assert!(least >= -2.0 / 27.0 - f64::EPSILON),
                _ => assert!(least >= 0.0, "{kernel:?} at {f}: {weights:?}"),
            }
        }
    }
    let negative = Kernel::CatmullRom.weights(0.5);
    assert!(negative[0] < 0.0 && negative[3] < 0.0, "{negative:?}");
}

/// The weights as the centred kernels of the literature, which know of no cells.
fn kernel_at(kernel: Kernel, x: f64) -> f64 {
    let x = x.abs();
    match kernel {
        Kernel::Quadratic if x <= 0.5 => 0.75 - x * x,
        Kernel::Quadratic if x < 1.5 => 0.5 * (1.5 - x).powi(2),
        Kernel::Cubic if x <= 1.0 => (4.0 - 6.0 * x * x + 3.0 * x.powi(3)) / 6.0,
        Kernel::Cubic if x < 2.0 => (2.0 - x).powi(3) / 6.0,
        Kernel::CatmullRom if x <= 1.0 => 1.0 - 2.5 * x * x + 1.5 * x.powi(3),
        Kernel::CatmullRom if x < 2.0 => 2.0 - 4.0 * x + 2.5 * x * x - 0.5 * x.powi(3),
        _ => 0.0,
    }
}

#[test]
fn taps_are_those_of_the_centred_kernels() {
    for kernel in KERNELS {
        for step in 0..=400 {
            let p = 10.0 + 0.01 * f64::from(step);
            let taps = kernel.taps(p, 64);
            for (tap, weight) in taps.weights.into_iter().enumerate() {
                let center = f64::from(taps.first + tap as i32) + 0.5;
                let wanted = kernel_at(kernel, p - center);
                assert!(
                    (weight - wanted).abs() < 1e-14,
                    "{kernel:?} at {p}: {weight}, {wanted}"
                );
            }
        }
    }
}

#[test]
fn linear_functions_are_reproduced_away_from_the_edges() {
    let dims = [40, 38, 36];
    let slope = DVec3::new(0.25, -0.5, 0.125);
    let volume = volume_of(dims, |i| {
        slope.dot(DVec3::from_array(i.map(f64::from)) + 0.5) as f32
    });
    let mut chance = Chance(3);
    // The edge bends the line, and the prefilter carries that inside by |z| a voxel.
    let depth = 14.0;
    let away = (2.0 - 3.0_f64.sqrt()).powf(depth - 2.0) * 40.0;
    let rounding = 20.0 * f64::from(f32::EPSILON) * 3.0;
    for _ in 0..2000 {
        let p = dims.map(|n| depth + chance.number() * (f64::from(n) - 2.0 * depth));
        let wanted = slope.dot(DVec3::from_array(p));
        for kernel in KERNELS {
            let error = (convolved(&volume, kernel, p).unwrap() - wanted).abs();
            assert!(error < 1e-13, "{kernel:?} at {p:?}: {error:e}");
        }
    }
    for spline in SPLINES {
        let coefficients = Coefficients::new(&volume, spline, ALL_AXES);
        for _ in 0..2000 {
            let p = dims.map(|n| depth + chance.number() * (f64::from(n) - 2.0 * depth));
            let found = convolved(coefficients.volume(), spline.kernel(), p).unwrap();
            let error = (found - slope.dot(DVec3::from_array(p))).abs();
            assert!(error < away + rounding, "{spline:?} at {p:?}: {error:e}");
        }
    }
}

#[test]
fn interpolating_filters_go_through_every_voxel_at_the_borders_too() {
    for dims in [
        [1, 1, 1],
        [2, 3, 1],
        [1, 5, 4],
        [9, 8, 13],
        [70, 3, 2],
        [33, 66, 5],
    ] {
        let volume = noise(dims);
        for spline in SPLINES {
            let coefficients = Coefficients::new(&volume, spline, ALL_AXES);
            let filter = |p| convolved(coefficients.volume(), spline.kernel(), p);
            let worst = worst_at_centers(&volume, 0.0, filter);
            assert!(worst <= 1e-6, "{spline:?} of {dims:?}: off by {worst:e}");
        }
        let worst = worst_at_centers(&volume, 0.0, |p| convolved(&volume, Kernel::CatmullRom, p));
        assert_eq!(worst, 0.0, "Catmull-Rom of {dims:?}");
    }
}

#[test]
fn a_missing_prefilter_half_a_voxel_and_another_pole_are_caught() {
    let volume = noise([9, 8, 13]);
    for spline in SPLINES {
        let kernel = spline.kernel();
        let coefficients = Coefficients::new(&volume, spline, ALL_AXES);
        let [read, other] = [spline, SPLINES[usize::from(spline == SPLINES[0])]]
            .map(|spline| Coefficients::new(&volume, spline, ALL_AXES));
        let right = |p| convolved(coefficients.volume(), kernel, p);
        let wrong: [(&str, f64); 4] = [
            (
                "no prefilter",
                worst_at_centers(&volume, 0.0, |p| convolved(&volume, kernel, p)),
            ),
            ("half a voxel", worst_at_centers(&volume, 0.5, right)),
            (
                "the other spline",
                worst_at_centers(&volume, 0.0, |p| convolved(other.volume(), kernel, p)),
            ),
            ("one axis left out", {
                let part = Coefficients::new(&volume, spline, [true, true, false]);
                worst_at_centers(&volume, 0.0, |p| convolved(part.volume(), kernel, p))
            }),
        ];
        assert!(worst_at_centers(&volume, 0.0, |p| convolved(read.volume(), kernel, p)) <= 1e-6);
        for (what, worst) in wrong {
            assert!(worst > 0.02, "{spline:?}, {what}: {worst} is not seen");
        }
    }
}

#[test]
fn outside_the_outermost_centers_the_value_is_that_of_the_edge() {
    let dims = [4, 5, 3];
    let volume = noise(dims);
    let mut chance = Chance(5);
    let coefficients = SPLINES.map(|spline| Coefficients::new(&volume, spline, ALL_AXES));
    for _ in 0..500 {
        let p = dims.map(|n| chance.number() * (f64::from(n) + 4.0) - 2.0);
        let inside = std::array::from_fn(|k| p[k].clamp(0.5, f64::from(dims[k]) - 0.5));
        for kernel in KERNELS {
            assert_eq!(
                convolved(&volume, kernel, p),
                convolved(&volume, kernel, inside)
            );
        }
        let corner = [0, 1, 2].map(|k| {
            if p[k] < 1.0 {
                -0.3
            } else {
                f64::from(dims[k]) + 0.3
            }
        });
        let wanted = nearest(&volume, corner).unwrap();
        for coefficients in &coefficients {
            let found = convolved(
                coefficients.volume(),
                coefficients.spline().kernel(),
                corner,
            );
            assert!((found.unwrap() - wanted).abs() < 1e-6, "{corner:?}");
        }
        assert_eq!(convolved(&volume, Kernel::CatmullRom, corner), Some(wanted));
    }
}

/// Eight linear fetches, as `shaders/lib/kernel_pairs.wgsl` places them.
fn by_pairs(volume: &Volume, kernel: Kernel, p: [f64; 3]) -> f64 {
    let axes: [_; 3] = std::array::from_fn(|k| {
        let taps = kernel.taps(p[k], volume.dims[k]);
        let [w0, w1, w2, w3] = taps.weights;
        let first = f64::from(taps.first) + 0.5;
        let weight = w2 + w3;
        let second = first + 2.0 + w3 / weight.max(1e-20);
        [(first + w1 / (w0 + w1), w0 + w1), (second, weight)]
    });
    let mut sum = 0.0;
    for x in axes[0] {
        for y in axes[1] {
            for z in axes[2] {
                sum += x.1 * y.1 * z.1 * linear(volume, [x.0, y.0, z.0]).unwrap();
            }
        }
    }
    sum
}

#[test]
fn eight_linear_fetches_are_the_64_of_a_b_spline() {
    let volume = noise([7, 6, 9]);
    let mut chance = Chance(11);
    for kernel in [Kernel::Quadratic, Kernel::Cubic] {
        for _ in 0..3000 {
            let p = volume
                .dims
                .map(|n| chance.number() * (f64::from(n) + 1.0) - 0.5);
            // Voxel borders, where one weight of the quadratic is 0, are among them.
            for p in [p, p.map(f64::round)] {
                let wanted = convolved(&volume, kernel, p).unwrap();
                let error = (by_pairs(&volume, kernel, p) - wanted).abs();
                assert!(error <= 1e-14, "{kernel:?} at {p:?}: {error:e}");
            }
        }
    }
    // Weights that change sign cannot be met by an interpolation.
    let p = [3.3, 2.8, 4.4];
    let wanted = convolved(&volume, Kernel::CatmullRom, p).unwrap();
    assert!((by_pairs(&volume, Kernel::CatmullRom, p) - wanted).abs() > 1e-3);
}

#[test]
fn a_sample_is_no_data_exactly_where_the_hole_has_a_weight() {
    let dims = [5, 4, 6];
    for hole in [[2, 1, 3], [0, 0, 0], [4, 3, 5], [0, 2, 5]] {
        let volume = volume_of(dims, |i| if i == hole { f32::NAN } else { 1.0 });
        for kernel in KERNELS {
            let has_weight = |p: f64, k: usize| {
                let p = p.clamp(0.5, f64::from(dims[k]) - 0.5);
                (-4..12).any(|tap: i32| {
                    let voxel = tap.clamp(0, dims[k] as i32 - 1);
                    voxel == hole[k] as i32 && kernel_at(kernel, p - 0.5 - f64::from(tap)) != 0.0
                })
            };
            let (mut missing, mut all) = (0, 0);
            let steps = dims.map(|n| -2..=4 * n as i32 + 2);
            for x in steps[0].clone() {
                for y in steps[1].clone() {
                    for z in steps[2].clone() {
                        // Quarters of a voxel have exact weights.
                        let p = [x, y, z].map(|i| 0.25 * f64::from(i));
                        let wanted = (0..3).all(|k| has_weight(p[k], k));
                        let found = convolved(&volume, kernel, p).is_none();
                        assert_eq!(found, wanted, "{kernel:?}, hole {hole:?}, at {p:?}");
                        let single = p.map(|x| x as f32);
                        assert_eq!(convolved(&volume, kernel, single).is_none(), wanted);
                        (missing, all) = (missing + usize::from(wanted), all + 1);
                    }
                }
            }
            assert!(
                missing > 0 && missing < all,
                "{kernel:?}: {missing} of {all}"
            );
        }
    }
}

#[test]
fn a_stack_is_the_volumes_spline_on_its_slices() {
    // At a slice's centre the spline through the voxels is the one through that slice's voxels: so stacks need
    // coefficients along two axes only.
    let volume = noise([8, 7, 6]);
    let mut chance = Chance(13);
    for spline in SPLINES {
        let whole = Coefficients::new(&volume, spline, ALL_AXES);
        for axis in 0..3 {
            let axes = std::array::from_fn(|k| k != axis);
            let stack = Coefficients::new(&volume, spline, axes);
            for _ in 0..200 {
                let mut p = volume.dims.map(|n| chance.number() * f64::from(n));
                let slice = (p[axis] as u32).min(volume.dims[axis] - 1);
                p[axis] = f64::from(slice) + 0.5;
                let kernel = spline.kernel();
                let wanted = convolved(whole.volume(), kernel, p).unwrap();
                let found = convolved_in_slice(stack.volume(), kernel, axis, slice, p).unwrap();
                assert!(
                    (found - wanted).abs() < 2e-6,
                    "{spline:?}, axis {axis}, {p:?}"
                );
            }
        }
    }
}

#[test]
fn coefficients_keep_what_the_volume_says() {
    let rescale = Rescale {
        slope: 0.5,
        intercept: -3.0,
    };
    let codes = Voxels::I16(
        (0..5 * 6 * 7)
            .map(|i| (i * 37 % 211) as i16 - 100)
            .collect(),
    );
    let affine = DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0));
    let volume = Volume::from_voxels([5, 6, 7], affine, codes, rescale, Some(-63.0)).unwrap();
    assert!(volume.no_data_count() > 0);
    let made = Coefficients::new(&volume, Spline::Cubic, ALL_AXES);
    let kept = made.volume();
    assert_eq!(kept.grid(), volume.grid());
    assert_eq!(kept.rescale, rescale);
    assert_eq!(kept.validity, volume.validity);
    assert_eq!(kept.value_range, volume.value_range);
    // Through the numbers that holes are filled with, and in values, not codes.
    let mut filled = volume.clone();
    filled.validity = None;
    let mut read = kept.clone();
    read.validity = None;
    let worst = worst_at_centers(&filled, 0.0, |p| convolved(&read, Kernel::Cubic, p));
    assert!(worst <= 1e-6 * 110.0, "off by {worst:e}");
}

/// RMS error on the signal of Marschner and Lobb at 40 voxels an axis, from centre to centre of the outermost over
/// [-1, 1], at points of [-0.8, 0.8].
fn marschner_lobb_rms(filter: impl Fn([f64; 3]) -> Option<f64>) -> f64 {
    let field = MarschnerLobb::default();
    let mut chance = Chance(31);
    let count = 20_000;
    let squares = (0..count).map(|_| {
        let world = DVec3::from_array([(); 3].map(|()| 1.6 * chance.number() - 0.8));
        let p = ((world + 1.0) * 19.5 + 0.5).to_array();
        (filter(p).unwrap() - field.value(world)).powi(2)
    });
    (squares.sum::<f64>() / f64::from(count)).sqrt()
}

#[test]
fn errors_on_the_signal_of_marschner_and_lobb_are_the_known_ones() {
    let field = MarschnerLobb::default();
    let volume = volume_of([40; 3], |i| {
        field.value(DVec3::from_array(i.map(f64::from)) / 19.5 - 1.0) as f32
    });
    let [quadratic, cubic] = SPLINES.map(|spline| Coefficients::new(&volume, spline, ALL_AXES));
    let raw = |kernel| marschner_lobb_rms(|p| convolved(&volume, kernel, p));
    let through = |made: &Coefficients| {
        marschner_lobb_rms(|p| convolved(made.volume(), made.spline().kernel(), p))
    };
    for (what, found, wanted) in [
        (
            "nearest",
            marschner_lobb_rms(|p| nearest(&volume, p)),
            0.0474,
        ),
        ("linear", marschner_lobb_rms(|p| linear(&volume, p)), 0.0328),
        ("quadratic", through(&quadratic), 0.0185),
        ("cubic", through(&cubic), 0.0147),
        ("quadratic-smooth", raw(Kernel::Quadratic), 0.0391),
        ("cubic-smooth", raw(Kernel::Cubic), 0.0452),
        ("catmull-rom", raw(Kernel::CatmullRom), 0.0233),
    ] {
        println!("{what}: {found:.4}, known {wanted}");
        assert!(
            (found / wanted - 1.0).abs() < 0.03,
            "{what}: {found}, wanted {wanted}"
        );
    }
}
