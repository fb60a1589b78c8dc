//! Which voxels are full: before filtering by their own value, after filtering by what filters can make.

use crate::voxel_sets::{Random, voxels};
use glam::DAffine3;
use stratavox::{
    resident::Halo,
    technique::full_voxels::{full_after_filtering, full_before_filtering},
    technique::{Filter, Settings},
    transfer::{Interpolation, OpacityPoint, TransferFunction, VisibleRanges},
    volume::{Rescale, Volume, Voxels, sample},
};

const DIMS: [u32; 3] = [9, 7, 5];
const COUNT: usize = 9 * 7 * 5;

fn function(points: &[[f64; 2]]) -> TransferFunction {
    let point = |&[value, opacity]: &[f64; 2]| OpacityPoint { value, opacity };
    TransferFunction {
        color: Vec::new(),
        opacity: points.iter().map(point).collect(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

fn volume(voxels: Voxels, rescale: Rescale, fill: Option<f64>) -> Volume {
    Volume::from_voxels(DIMS, DAffine3::IDENTITY, voxels, rescale, fill).expect("a volume")
}

/// Noise of each type of number, some of it rescaled.
fn volumes() -> Vec<Volume> {
    let mut random = Random::new(5);
    let mut codes = |count: f64, first: f64| -> Vec<f64> {
        (0..COUNT)
            .map(|_| (random.unit() * count + first).floor())
            .collect()
    };
    let plain = Rescale::default();
    let turned = Rescale {
        slope: -0.5,
        intercept: 70.0,
    };
    let (bytes, signed) = (codes(256.0, 0.0), codes(256.0, -128.0));
    let (wide, deep) = (codes(300.0, 0.0), codes(300.0, -150.0));
    let whole = |codes: &[f64]| codes.iter().map(|&n| n as f32).collect::<Vec<_>>();
    vec![
        volume(
            Voxels::U8(bytes.iter().map(|&n| n as u8).collect()),
            plain,
            None,
        ),
        volume(
            Voxels::I8(signed.iter().map(|&n| n as i8).collect()),
            turned,
            None,
        ),
        volume(
            Voxels::U16(wide.iter().map(|&n| n as u16).collect()),
            plain,
            None,
        ),
        volume(
            Voxels::I16(deep.iter().map(|&n| n as i16).collect()),
            turned,
            None,
        ),
        volume(
            Voxels::F16(wide.iter().map(|&n| half::f16::from_f64(n)).collect()),
            plain,
            None,
        ),
        volume(Voxels::F32(whole(&deep)), plain, None),
    ]
}

fn functions() -> Vec<TransferFunction> {
    vec![
        function(&[]),
        function(&[[0.0, 0.5]]),
        function(&[[100.0, 0.0], [120.0, 0.4]]),
        // A thin hill, between two codes too.
        function(&[[40.2, 0.0], [40.5, 0.9], [40.8, 0.0]]),
        function(&[
            [-20.0, 0.3],
            [10.0, 0.0],
            [90.0, 0.0],
            [91.0, 0.1],
            [95.0, 0.0],
        ]),
    ]
}

fn value_of(volume: &Volume, [x, y, z]: [u32; 3]) -> f64 {
    let n = (x + DIMS[0] * (y + DIMS[1] * z)) as usize;
    f64::from(volume.voxels.stored(n)) * volume.rescale.slope + volume.rescale.intercept
}

#[test]
fn before_filtering_a_voxel_is_full_whose_own_value_has_opacity() {
    let mut full = 0;
    for volume in volumes() {
        for function in functions() {
            let set = full_before_filtering(&volume, &function);
            for voxel in voxels(DIMS) {
                let wanted = function.opacity(value_of(&volume, voxel)) > 0.0;
                assert_eq!(set.contains(voxel), wanted, "{voxel:?} of {function:?}");
            }
            full += set.full_count();
        }
    }
    assert!(full > COUNT as u64, "{full}");
}

#[test]
fn before_filtering_a_voxel_without_data_is_not_full() {
    let codes: Vec<u8> = (0..COUNT).map(|n| (n % 3) as u8).collect();
    let volume = volume(Voxels::U8(codes), Rescale::default(), Some(2.0));
    let set = full_before_filtering(&volume, &function(&[[0.0, 0.5]]));
    for (n, voxel) in voxels(DIMS).enumerate() {
        assert_eq!(set.contains(voxel), n % 3 != 2, "{voxel:?}");
    }
}

/// What is sampled inside a voxel that is not full has no opacity.
#[test]
fn after_filtering_every_voxel_is_full_in_which_a_sample_is_seen() {
    let halo = Settings::default().halo();
    assert_eq!(Settings::default().filter, Filter::Linear);
    let mut random = Random::new(23);
    let (mut seen, mut empty) = (0, 0);
    // Of those, in voxels that are not full by their own value: without what lies around them they were left out.
    let mut beside = 0;
    for volume in volumes() {
        for function in functions() {
            let set = full_after_filtering(&volume, &function, halo);
            let alone = Halo { voxels: 0, ..halo };
            let alone = full_after_filtering(&volume, &function, alone);
            empty += set.voxel_count() - set.full_count();
            for voxel in voxels(DIMS) {
                for _ in 0..20 {
                    let point = voxel.map(|n| f64::from(n) + random.unit());
                    let value = sample::linear(&volume, point).expect("data");
                    if function.opacity(value) > 0.0 {
                        assert!(set.contains(voxel), "{point:?}, {value} by {function:?}");
                        seen += 1;
                        beside += u32::from(!alone.contains(voxel));
                    }
                }
            }
            // What is full before filtering is so afterwards.
            let before = full_before_filtering(&volume, &function);
            assert!(voxels(DIMS).all(|voxel| !before.contains(voxel) || set.contains(voxel)));
        }
    }
    assert!(
        seen > 10_000 && empty > 1000,
        "{seen} samples seen, {empty} voxels empty"
    );
    assert!(
        beside > 1000,
        "of {seen} samples seen {beside} by what is beside"
    );
}

#[test]
fn after_filtering_what_counts_is_the_range_of_the_voxel_and_its_halo() {
    // One voxel alone is seen: so are those that look at it, as far as the filter looks.
    let middle = [4, 3, 2];
    let codes = voxels(DIMS).map(|voxel| if voxel == middle { 200 } else { 0 });
    let volume = volume(Voxels::U8(codes.collect()), Rescale::default(), None);
    let seen = function(&[[150.0, 0.0], [160.0, 0.5]]);
    for filter in [
        Filter::Nearest,
        Filter::Linear,
        Filter::CubicSmooth,
        Filter::CatmullRom,
    ] {
        let halo = Settings {
            filter,
            ..Settings::default()
        }
        .halo();
        let set = full_after_filtering(&volume, &seen, halo);
        for voxel in voxels(DIMS) {
            let is_near = (0..3).all(|k| voxel[k].abs_diff(middle[k]) <= halo.voxels);
            assert_eq!(set.contains(voxel), is_near, "{voxel:?} by {filter}");
        }
    }
    // Filters with negative weights reach beyond the values of the voxels.
    let beyond = function(&[[210.0, 0.0], [211.0, 0.5]]);
    assert!(VisibleRanges::new(&beyond).shows([0.0, 250.0]));
    let full = |overshoot: f32| {
        let halo = Halo {
            voxels: 1,
            overshoot,
            is_mixed: true,
        };
        full_after_filtering(&volume, &beyond, halo).full_count()
    };
    assert_eq!([full(0.0), full(0.5)], [0, 27]);
}
