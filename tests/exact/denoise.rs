//! Noise filters: what they leave of white noise, what they leave alone, and the device against its CPU reference.

use crate::shared::{device, device_with, sheared_affine, volume_of, waves};
use glam::{DAffine3, DVec3};
use stratavox::gpu::Caps;
use stratavox::offscreen;
use stratavox::volume::{Denoise, Rescale, Volume, Voxels, noise_of};

const GAUSSIAN: Denoise = Denoise::Gaussian { sigma_voxels: 1.2 };
const BILATERAL: Denoise = Denoise::Bilateral {
    sigma_voxels: 1.0,
    sigma_value: None,
};

const NLM: Denoise = Denoise::NonLocalMeans { sigma_value: None };

/// Independent numbers of mean 0 and deviation 1: twelve uniform ones less six, from a 64-bit counter mixed as
/// SplitMix64 does it (Steele, Lea and Flood 2014).
fn noise(count: usize) -> impl Iterator<Item = f64> {
    let uniform = |i: u64| {
        let mut z = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count as u64).map(move |i| (1..=12).map(|k| uniform(12 * i + k)).sum::<f64>() - 6.0)
}

fn volume(side: u32, value: impl Fn(DVec3) -> f64, deviation: f64) -> Volume {
    let clean = volume_of([side; 3], DAffine3::IDENTITY, value);
    let count = clean.voxels.len();
    let noisy = noise(count)
        .enumerate()
        .map(|(i, n)| clean.voxels.stored(i) + (deviation * n) as f32);
    let voxels = Voxels::F32(noisy.collect());
    Volume::from_voxels(
        clean.dims,
        DAffine3::IDENTITY,
        voxels,
        Rescale::default(),
        None,
    )
    .expect("a volume")
}

/// Numbers at least `margin` voxels inside, with their places.
fn inner(volume: &Volume, margin: usize) -> Vec<([usize; 3], f64)> {
    let [nx, ny, nz] = volume.dims.map(|n| n as usize);
    let mut found = Vec::new();
    for z in margin..nz - margin {
        for y in margin..ny - margin {
            for x in margin..nx - margin {
                let number = volume.voxels.stored(x + nx * (y + ny * z));
                found.push(([x, y, z], number.into()));
            }
        }
    }
    found
}

fn deviation(numbers: &[([usize; 3], f64)]) -> f64 {
    let count = numbers.len() as f64;
    let mean = numbers.iter().map(|n| n.1).sum::<f64>() / count;
    (numbers.iter().map(|n| (n.1 - mean).powi(2)).sum::<f64>() / count).sqrt()
}

#[test]
fn a_gaussian_leaves_of_white_noise_what_the_law_says() {
    let noisy = volume(48, |_| 0.0, 1.0);
    let filtered = GAUSSIAN.denoised(&noisy);
    let found = deviation(&inner(&filtered, 5)) / deviation(&inner(&noisy, 5));
    // (2 s sqrt pi)^(-3/2), for s = 1.2. Some (38 / 4.3)^3 of the filtered numbers are independent, so that their
    // deviation is known to one part in sqrt(2 * 690), 2.7 %: three times that are allowed.
    let wanted = (2.0 * 1.2 * std::f64::consts::PI.sqrt()).powf(-1.5);
    assert!((wanted - 0.114).abs() < 5e-4, "{wanted}");
    assert!((found / wanted - 1.0).abs() < 0.08, "{found}, not {wanted}");
}

#[test]
fn noise_lifts_a_maximum_less_once_it_is_taken_out() {
    let noisy = volume(64, |_| 0.0, 1.0);
    let mean_of_maxima = |volume: &Volume| {
        let mut maxima = [[f64::NEG_INFINITY; 64]; 64];
        for ([x, y, _], number) in inner(volume, 0) {
            maxima[y][x] = maxima[y][x].max(number);
        }
        maxima.iter().flatten().sum::<f64>() / 4096.0
    };
    // 2.35 deviations for the maximum of 64 (by sampling a normal distribution; twelve
    // uniform numbers reach a little less far).
    let before = mean_of_maxima(&noisy);
    assert!((2.25..2.40).contains(&before), "{before}");
    for (filter, at_most) in [(GAUSSIAN, 0.3), (Denoise::Median, 0.8), (BILATERAL, 0.8)] {
        let after = mean_of_maxima(&filter.denoised(&noisy));
        assert!(after < at_most * before, "{filter:?}: {after}");
    }
}

#[test]
fn the_noise_of_a_volume_is_found() {
    for sigma in [0.01, 1.0, 30.0] {
        let found = noise_of(&volume(40, |p| 0.1 * sigma * p.x, sigma));
        // A slope of a tenth widens |d| by (0.1 / sqrt 2)^2 / 2; the median of 62 400 is known to 0.6 %.
        assert!((found / sigma - 1.0).abs() < 0.02, "{found}, not {sigma}");
    }
    assert_eq!(noise_of(&volume(8, |_| 3.0, 0.0)), 0.0);
}

#[test]
fn what_is_even_or_a_ramp_stays_as_it_is() {
    let fixed = Denoise::Bilateral {
        sigma_voxels: 1.0,
        sigma_value: Some(2.0),
    };
    let even = volume(12, |_| 0.3, 0.0);
    let ramp = volume(20, |p| p.x - 0.5 * p.y + 0.25 * p.z, 0.0);
    for filter in [GAUSSIAN, Denoise::Median, BILATERAL, NLM, fixed] {
        for (_, number) in inner(&filter.denoised(&even), 0) {
            assert!((number - 0.3).abs() < 1e-7, "{filter:?}: {number}");
        }
        let filtered = filter.denoised(&ramp);
        for (place, number) in inner(&filtered, 5) {
            let [x, y, z] = place.map(|n| n as f64 + 0.5);
            let wanted = x - 0.5 * y + 0.25 * z;
            assert!(
                (number - wanted).abs() < 1e-5,
                "{filter:?} {place:?}: {number}"
            );
        }
    }
    // Without noise there is nothing that is twice the noise: not a bit changes.
    assert_eq!(BILATERAL.denoised(&even).voxels, even.voxels);
    assert_eq!(NLM.denoised(&even).voxels, even.voxels);
}

#[test]
fn edges_stay_where_a_gaussian_blurs_them() {
    let step = |p: DVec3| if p.x < 10.0 { 0.0 } else { 100.0 };
    let noisy = volume(20, step, 1.0);
    let worst_beside_the_edge = |filter: Denoise| {
        let filtered = filter.denoised(&noisy);
        let beside = inner(&filtered, 5);
        let beside = beside.iter().filter(|([x, ..], _)| (9..=10).contains(x));
        let off = beside.map(|([x, ..], n)| (n - if *x < 10 { 0.0 } else { 100.0 }).abs());
        off.fold(0.0, f64::max)
    };
    assert!(worst_beside_the_edge(GAUSSIAN) > 30.0);
    // Noise of deviation 1 on 2000 numbers reaches 4; the median of 27 and the mean of some 30 less than half of it.
    assert!(worst_beside_the_edge(Denoise::Median) < 2.0);
    assert!(worst_beside_the_edge(BILATERAL) < 2.5);
}

/// An own oracle of 28^3 numbers (the same equation in another language and in double precision) leaves 0.070 of white
/// noise, from 0.063 to 0.077 by the seed; weights that are all equal leave 343^(-1/2).
#[test]
fn alike_places_are_averaged_and_edges_stay_sharper_than_after_a_gaussian_of_the_same_strength() {
    let noisy = volume(28, |_| 0.0, 1.0);
    let left = |filter: Denoise| {
        deviation(&inner(&filter.denoised(&noisy), 4)) / deviation(&inner(&noisy, 4))
    };
    let known = Denoise::NonLocalMeans {
        sigma_value: Some(1.0),
    };
    let found = left(known);
    assert!((0.056..0.084).contains(&found), "{found}");
    let mean = Denoise::NonLocalMeans {
        sigma_value: Some(1e4),
    };
    // Some (20 / 7)^3 of the means are independent: known to one part in sqrt(2 * 23), 15 %, three times that allowed.
    let of_mean = left(mean) * 343_f64.sqrt();
    assert!((of_mean - 1.0).abs() < 0.45, "{of_mean}");
    // What a Gaussian must be to leave as much, and what both leave of a step of 6 deviations.
    let sigma_voxels = found.powf(-2.0 / 3.0) / (2.0 * std::f64::consts::PI.sqrt());
    let step = volume(28, |p| if p.x < 14.0 { 0.0 } else { 6.0 }, 1.0);
    let beside_the_edge = |filter: Denoise| {
        let numbers = inner(&filter.denoised(&step), 5);
        let beside = numbers.iter().filter(|([x, ..], _)| *x == 13);
        let (count, sum) = beside.fold((0.0, 0.0), |(n, sum), (_, v)| (n + 1.0, sum + v));
        sum / count
    };
    let blurred = beside_the_edge(Denoise::Gaussian { sigma_voxels });
    let kept = beside_the_edge(known);
    assert!(blurred > 2.0 && kept.abs() < 0.3, "{blurred}, {kept}");
}

#[test]
fn a_lone_outlier_is_gone_after_a_median() {
    let mut lone = volume(9, |p| p.z, 0.0);
    if let Voxels::F32(numbers) = &mut lone.voxels {
        numbers[4 + 9 * (4 + 9 * 4)] = 1e6;
    }
    for (place, number) in inner(&Denoise::Median.denoised(&lone), 1) {
        assert_eq!(number, place[2] as f64 + 0.5, "{place:?}");
    }
}

#[test]
fn all_but_the_numbers_stays() {
    let mut before = volume_of([6, 7, 8], sheared_affine(), waves);
    before.validity = Some((0..6 * 7 * 8).map(|i| u8::from(i % 5 != 0)).collect());
    before.rescale = Rescale {
        slope: -2.0,
        intercept: 5.0,
    };
    before.unit = Some("K".to_owned());
    let after = GAUSSIAN.denoised(&before);
    assert_eq!(after.validity, before.validity);
    assert_eq!(
        (after.unit.as_deref(), after.rescale),
        (Some("K"), before.rescale)
    );
    assert_eq!(after.grid(), before.grid());
    let value = |i: usize| 5.0 - 2.0 * f64::from(after.voxels.stored(i));
    let valid = (0..6 * 7 * 8).filter(|i| i % 5 != 0).map(value);
    let range = valid.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    });
    assert_eq!(after.value_range, range);
}

#[test]
fn the_device_filters_as_its_reference_does_in_slabs_of_any_height() {
    let codes =
        |p: DVec3| (1000.0 * waves(p) + 37.0 * (11.3 * p.x + 5.1 * p.y * p.z).sin()).round();
    let noisy = volume_of([33, 18, 29], sheared_affine(), codes);
    let fixed = Denoise::Bilateral {
        sigma_voxels: 0.8,
        sigma_value: Some(40.0),
    };
    // Room for all slices, and for 11: the Gaussian has 5 beside each of its own.
    let few = Caps {
        max_storage_buffer_range: 11 * 33 * 18 * 4,
        ..Caps::UNLIMITED
    };
    for mut device in [device(), device_with(few)] {
        let weak = Denoise::NonLocalMeans {
            sigma_value: Some(60.0),
        };
        for filter in [GAUSSIAN, Denoise::Median, BILATERAL, fixed, weak] {
            let found = offscreen::denoised(&mut device, &noisy, &filter).expect("filtered");
            let wanted = filter.denoised(&noisy);
            let mut worst = 0.0_f32;
            for i in 0..wanted.voxels.len() {
                worst = worst.max((found.voxels.stored(i) - wanted.voxels.stored(i)).abs());
            }
            // The median is one of the numbers. A sum of 13 weighted numbers under 1050 that may be fused differs by
            // 13 half ulps of 1050 at most, three times over; exp is right to 3 + 2 |x| ulps, and what it weighs is
            // under 8 deviations of 40 where it counts.
            let allowed = if filter == Denoise::Median {
                0.0
            } else {
                2.5e-3
            };
            assert!(worst <= allowed, "{filter:?}: {worst}");
            assert_ne!(wanted.voxels, noisy.voxels);
        }
    }
}
