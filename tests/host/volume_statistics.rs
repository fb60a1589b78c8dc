//! `Statistics`: over all times, without what is no data, after rescale.

use glam::DAffine3;
use half::f16;
use std::path::Path;
use stratavox::volume::{
    Format, Header, Histogram, Limits, Piece, ReadError, Rescale, Source, Statistics,
    TimeComponent, VoxelBox, VoxelType, Voxels,
};

struct Given {
    header: Header,
    times: Vec<Voxels>,
}

impl Source for Given {
    fn path(&self) -> &Path {
        Path::new("given")
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, _region: VoxelBox) -> Result<Piece, ReadError> {
        Ok(self.times[pick.time as usize].clone().into())
    }
}

fn given(times: Vec<Voxels>, rescale: Rescale, fill: Option<f64>) -> Given {
    let header = Header {
        times: times.len() as u32,
        rescale,
        fill,
        ..Header::new(
            Format::Raw,
            [times[0].len() as u32, 1, 1],
            times[0].voxel_type(),
            DAffine3::IDENTITY,
        )
    };
    Given { header, times }
}

fn statistics(source: &Given) -> Statistics {
    Statistics::of(source, 0..1, &Limits::default()).unwrap()
}

#[test]
fn they_span_all_times_and_leave_out_what_is_no_data() {
    let times = vec![
        Voxels::F32(vec![1.0, f32::NAN, -4.0, 99.0]),
        Voxels::F32(vec![f32::INFINITY, 99.0, 2.5, 8.0]),
    ];
    let rescale = Rescale {
        slope: 2.0,
        intercept: 10.0,
    };
    let found = statistics(&given(times, rescale, Some(99.0)));
    // Stored 1, -4, 2.5 and 8 count.
    assert_eq!(
        [found.min, found.max, found.mean],
        [2.0, 26.0, 2.0 * 7.5 / 4.0 + 10.0]
    );
    assert_eq!(
        [found.valid_count, found.non_finite_count, found.fill_count],
        [4, 2, 2]
    );
    assert_eq!(found.histogram.value_range, [2.0, 26.0]);
    let counts = &found.histogram.counts;
    assert_eq!(counts.len(), Histogram::MAX_BINS);
    assert_eq!([counts[0], counts[1023], counts.iter().sum()], [1, 1, 4]);
    // 1 lies 5/12 of the way.
    assert_eq!(counts[5 * 1024 / 12], 1);
}

#[test]
fn a_bin_of_integers_holds_a_whole_number_of_codes() {
    // All codes from -1000 to 999 once: two to a bin.
    let codes: Vec<i16> = (-1000..1000).collect();
    let found = statistics(&given(vec![Voxels::I16(codes)], Rescale::default(), None)).histogram;
    assert_eq!(found.counts, vec![2; 1000]);
    assert_eq!(found.value_range, [-1000.5, 999.5]);
}

#[test]
fn a_falling_rescale_turns_the_histogram_round() {
    let rescale = Rescale {
        slope: -1.0,
        intercept: 0.0,
    };
    let found = statistics(&given(vec![Voxels::U8(vec![0, 0, 0, 1, 3])], rescale, None));
    assert_eq!([found.min, found.max, found.mean], [-3.0, 0.0, -0.8]);
    assert_eq!(found.histogram.counts, [1, 0, 1, 3]);
    assert_eq!(found.histogram.value_range, [-3.5, 0.5]);
}

#[test]
fn one_value_alone_has_a_bin_around_it() {
    for voxels in [
        Voxels::F32(vec![7.0; 3]),
        Voxels::U16(vec![7; 3]),
        Voxels::F16(vec![f16::from_f32(7.0); 3]),
    ] {
        let found = statistics(&given(vec![voxels], Rescale::default(), None));
        assert_eq!([found.min, found.max, found.mean], [7.0; 3]);
        assert_eq!(
            found.histogram,
            Histogram {
                value_range: [6.5, 7.5],
                counts: vec![3]
            }
        );
    }
}

#[test]
fn without_any_data_they_say_so() {
    let found = statistics(&given(
        vec![Voxels::F32(vec![f32::NAN; 5])],
        Rescale::default(),
        None,
    ));
    assert!(found.min.is_nan() && found.max.is_nan() && found.mean.is_nan());
    assert_eq!([found.valid_count, found.non_finite_count], [0, 5]);
    assert!(found.histogram.counts.is_empty());
}

#[test]
fn the_largest_floats_do_not_break_them() {
    let voxels = Voxels::F32(vec![f32::MAX, f32::MIN, 0.0]);
    let found = statistics(&given(vec![voxels], Rescale::default(), None));
    assert_eq!(found.mean, 0.0);
    assert_eq!(found.histogram.counts.iter().sum::<u64>(), 3);
}

#[test]
fn what_does_not_fit_the_limits_is_refused() {
    let mut source = given(vec![Voxels::U8(vec![0; 4])], Rescale::default(), None);
    source.header.stored = VoxelType::I32;
    let limits = Limits {
        max_bytes: 15,
        ..Limits::default()
    };
    let error = Statistics::of(&source, 0..1, &limits).expect_err("16 bytes of f32");
    assert!(
        error
            .to_string()
            .contains("needs 16 bytes, the limit is 15"),
        "{error}"
    );
}
