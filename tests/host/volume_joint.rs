//! Histograms of volumes: every valid voxel counted once, gradients in world units.

use glam::{DAffine3, DMat3, DVec3};
use stratavox::volume::{Histogram, JointHistogram, Rescale, Volume, Voxels};

fn volume(dims: [u32; 3], world_from_voxel: DAffine3, value: impl Fn([u32; 3]) -> f32) -> Volume {
    let [x, y, z] = dims;
    let places = (0..z).flat_map(|k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])));
    let voxels = Voxels::F32(places.map(value).collect());
    Volume::from_voxels(dims, world_from_voxel, voxels, Rescale::default(), None).expect("a volume")
}

fn sum(counts: &[u64]) -> u64 {
    counts.iter().sum()
}

#[test]
fn every_valid_voxel_is_counted_once_whatever_the_bins() {
    let mut noise = 1_u32;
    let numbers: Vec<i16> = (0..7 * 5 * 3)
        .map(|_| {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (noise >> 16) as i16
        })
        .collect();
    let fill = f64::from(numbers[17]);
    let fills = numbers.iter().filter(|&&n| f64::from(n) == fill).count() as u64;
    let rescale = Rescale {
        slope: -0.5,
        intercept: 3.0,
    };
    let voxels = Voxels::I16(numbers);
    let volume = Volume::from_voxels([7, 5, 3], DAffine3::IDENTITY, voxels, rescale, Some(fill))
        .expect("a volume");
    for bins in [1, 2, 10, 256, 4096] {
        let histogram = Histogram::of(&volume, bins);
        assert_eq!(sum(&histogram.counts), 105 - fills, "{bins} bins");
        assert!(histogram.counts.len() <= bins);
        let joint = JointHistogram::of(&volume, bins, 9);
        assert_eq!(sum(&joint.counts), 105 - fills, "{bins} columns");
        // Columns of the joint histogram are the bins of the other, also where the slope turns values round.
        let columns: Vec<u64> = (0..joint.columns)
            .map(|c| joint.counts.chunks(joint.columns).map(|row| row[c]).sum())
            .collect();
        assert_eq!(columns, histogram.counts, "{bins} columns");
        assert_eq!(joint.value_edges(), histogram.edges());
    }
}

#[test]
fn whole_numbers_have_bins_of_a_whole_number_of_codes_and_edges_between_them() {
    let volume = volume([4, 1, 1], DAffine3::IDENTITY, |[i, ..]| {
        [0.0, 1.0, 1.0, 9.0][i as usize]
    });
    let histogram = Histogram::of(&volume, 256);
    assert_eq!(histogram.counts, [1, 2, 0, 0, 0, 0, 0, 0, 0, 1]);
    assert_eq!(histogram.edges()[..3], [-0.5, 0.5, 1.5]);
    let coarse = Histogram::of(&volume, 4);
    // Three codes a bin.
    assert_eq!(
        (coarse.counts, coarse.value_range),
        (vec![3, 0, 0, 1], [-0.5, 11.5])
    );
}

/// One row of the joint histogram, at the slope; others are empty.
#[track_caller]
fn assert_one_line(volume: &Volume, slope: f64) {
    let joint = JointHistogram::of(volume, 64, 50);
    let top = joint.gradient_range[1];
    assert!((top - slope).abs() < 1e-9 * slope, "{top}, not {slope}");
    let rows: Vec<u64> = joint.counts.chunks(joint.columns).map(sum).collect();
    let all = u64::from(volume.dims.iter().product::<u32>());
    assert_eq!((rows[49], sum(&rows[..49])), (all, 0), "{rows:?}");
}

#[test]
fn a_linear_ramp_is_one_line_at_its_slope() {
    // 2 i - 3 j + 6 k: 7 per voxel, at the borders too.
    let ramp = |[i, j, k]: [u32; 3]| 2.0 * i as f32 - 3.0 * j as f32 + 6.0 * k as f32;
    assert_one_line(&volume([6, 5, 4], DAffine3::IDENTITY, ramp), 7.0);
}

#[test]
fn the_slope_is_that_of_the_world_on_unequal_turned_and_sheared_grids() {
    let ramp = |[i, j, k]: [u32; 3]| 2.0 * i as f32 - 3.0 * j as f32 + 6.0 * k as f32;
    // Voxels of 0.5 x 1 x 4: (4, -3, 1.5) per world length.
    let unequal = DAffine3::from_scale(DVec3::new(0.5, 1.0, 4.0));
    let slope = (16.0 + 9.0 + 2.25_f64).sqrt();
    assert_one_line(&volume([6, 5, 4], unequal, ramp), slope);
    let turned = DAffine3::from_rotation_z(0.7) * DAffine3::from_rotation_x(-1.1) * unequal;
    assert_one_line(&volume([6, 5, 4], turned, ramp), slope);
    // x = i + j / 2: the field 2 i - 3 j + 6 k is 2 x - 4 y + 6 z.
    let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::Z);
    let sheared = DAffine3::from_mat3(sheared);
    assert_one_line(&volume([6, 5, 4], sheared, ramp), 56.0_f64.sqrt());
}

#[test]
fn gradients_follow_the_rescale_and_do_not_reach_over_voxels_without_data() {
    let numbers = Voxels::F32(vec![0.0, 1.0, 2.0, f32::NAN, 104.0, 105.0, 106.0]);
    let rescale = Rescale {
        slope: -3.0,
        intercept: 0.0,
    };
    let volume = Volume::from_voxels([7, 1, 1], DAffine3::IDENTITY, numbers, rescale, None)
        .expect("a volume");
    let joint = JointHistogram::of(&volume, 10, 4);
    // The step from 2 to 104 lies in the hole: 3 per voxel everywhere else.
    assert_eq!(joint.gradient_range, [0.0, 3.0]);
    assert_eq!(sum(&joint.counts), 6);
}

#[test]
fn a_volume_without_change_or_without_data_has_a_histogram_too() {
    let flat = volume([3, 2, 1], DAffine3::IDENTITY, |_| 5.5);
    let joint = JointHistogram::of(&flat, 16, 4);
    assert_eq!((joint.columns, joint.gradient_range), (1, [0.0, 1.0]));
    assert_eq!(joint.counts, [6, 0, 0, 0]);
    assert_eq!(Histogram::of(&flat, 16).counts, [6]);
    let empty = volume([3, 2, 1], DAffine3::IDENTITY, |_| f32::NAN);
    assert!(Histogram::of(&empty, 16).edges().is_empty());
    let joint = JointHistogram::of(&empty, 16, 4);
    assert_eq!((joint.columns, joint.counts.len()), (0, 0));
    assert!(joint.value_edges().is_empty());
}
