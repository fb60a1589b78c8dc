//! A volume in memory: what is read, what is refused, how holes are filled.

use glam::{DAffine3, DMat3, DVec3};
use std::path::Path;
use stratavox::volume::{
    Format, Header, Limits, Piece, Problem, ReadError, Rescale, Source, TimeComponent, Volume,
    VoxelBox, VoxelType, Voxels, phantom,
};

/// Two times of one number each, or a trap for who reads what should have been refused.
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

fn header(dims: [u32; 3], stored: VoxelType) -> Header {
    Header::new(Format::Raw, dims, stored, DAffine3::IDENTITY)
}

fn in_memory(dims: [u32; 3], voxels: Voxels, fill: Option<f64>) -> Volume {
    Volume::from_voxels(dims, DAffine3::IDENTITY, voxels, Rescale::default(), fill).unwrap()
}

/// Numbers that look random, the same on each run.
fn scattered(seed: u64) -> impl FnMut() -> u32 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as u32
    }
}

#[test]
fn a_hole_holds_the_number_of_one_of_its_nearest_valid_voxels() {
    for (dims, holes_percent) in [
        ([13, 11, 7], 30),
        ([9, 16, 12], 97),
        ([1, 20, 1], 80),
        ([6, 1, 14], 99),
    ] {
        let [nx, ny, nz] = dims.map(|n: u32| n as usize);
        let mut next = scattered(u64::from(dims[0]) + holes_percent);
        let is_hole: Vec<bool> = (0..nx * ny * nz)
            .map(|i| i != 3 && u64::from(next() % 100) < holes_percent)
            .collect();
        // Each number is the index of its voxel, so that it tells where it came from.
        let numbers = (0..nx * ny * nz).map(|i| if is_hole[i] { f32::NAN } else { i as f32 });
        let volume = in_memory(dims, Voxels::F32(numbers.collect()), None);
        let place = |i: usize| [i % nx, i / nx % ny, i / nx / ny];
        let squared = |a: usize, b: usize| -> usize {
            let (a, b) = (place(a), place(b));
            (0..3).map(|k| a[k].abs_diff(b[k]).pow(2)).sum()
        };
        let validity = volume.validity.as_ref().unwrap();
        for i in 0..nx * ny * nz {
            let source = volume.voxels.stored(i) as usize;
            let nearest = (0..nx * ny * nz)
                .filter(|&j| !is_hole[j])
                .map(|j| squared(i, j))
                .min();
            assert!(
                !is_hole[source],
                "voxel {i} of {dims:?} holds the number of the hole {source}"
            );
            assert_eq!(
                Some(squared(i, source)),
                nearest,
                "voxel {i} of {dims:?} took from {source}"
            );
            assert_eq!(validity[i] == 0, is_hole[i], "validity of voxel {i}");
        }
        let holes = is_hole.iter().filter(|&&hole| hole).count() as u64;
        assert_eq!(volume.no_data_count(), holes);
    }
}

#[test]
fn no_data_is_what_is_not_finite_or_equals_the_fill_in_its_own_type() {
    let bytes = |fill| in_memory([4, 1, 1], Voxels::U8(vec![3, 9, 44, 255]), fill);
    assert_eq!(bytes(None).validity, None);
    assert_eq!(bytes(Some(44.0)).validity, Some(vec![1, 1, 0, 1]));
    assert_eq!(
        bytes(Some(300.0)).validity,
        None,
        "300 is no u8, not 44 either"
    );
    assert_eq!(bytes(Some(9.5)).validity, None);
    assert_eq!(bytes(Some(f64::NAN)).validity, None);
    // The f32 next to 1e20 is not 1e20: the fill is rounded as the voxels were.
    let floats = vec![f32::NAN, f32::NEG_INFINITY, 1e20, 0.0, -7.5];
    let volume = in_memory([5, 1, 1], Voxels::F32(floats), Some(1e20));
    assert_eq!(volume.validity, Some(vec![0, 0, 0, 1, 1]));
    assert_eq!(volume.voxels, Voxels::F32(vec![0.0, 0.0, 0.0, 0.0, -7.5]));
    assert_eq!(volume.value_range, [-7.5, 0.0]);
}

#[test]
fn a_volume_without_any_data_is_all_zero_with_an_empty_range() {
    let volume = in_memory([2, 2, 1], Voxels::F32(vec![f32::NAN; 4]), None);
    assert_eq!(volume.voxels, Voxels::F32(vec![0.0; 4]));
    assert_eq!(volume.validity, Some(vec![0; 4]));
    assert_eq!(volume.value_range, [0.0, 0.0]);
}

#[test]
fn a_falling_rescale_still_gives_an_ascending_range() {
    let rescale = Rescale {
        slope: -2.0,
        intercept: 1.0,
    };
    let voxels = Voxels::I16(vec![-3, 5]);
    let volume = Volume::from_voxels([2, 1, 1], DAffine3::IDENTITY, voxels, rescale, None).unwrap();
    assert_eq!(volume.value_range, [-9.0, 7.0]);
}

#[test]
fn a_box_of_a_volume_lies_where_it_lay_in_the_whole() {
    let source = phantom::open("phantom:head,n=20", &Limits::default()).unwrap();
    let read = |region| {
        Volume::read(
            &*source,
            TimeComponent::default(),
            region,
            &Limits::default(),
        )
        .unwrap()
    };
    let whole = read(source.header().whole());
    let part = read(VoxelBox {
        min: [3, 5, 2],
        max: [17, 6, 20],
    });
    assert_eq!(part.dims, [14, 1, 18]);
    for z in 0..18 {
        for x in 0..14 {
            let wanted = whole.voxels.stored(((z + 2) * 20 + 5) * 20 + x + 3);
            assert_eq!(part.voxels.stored(z * 14 + x), wanted, "voxel {x} 0 {z}");
        }
    }
    let corner = part.world_from_voxel.transform_point3(DVec3::ZERO);
    let wanted = whole
        .world_from_voxel
        .transform_point3(DVec3::new(3.0, 5.0, 2.0));
    assert!(
        (corner - wanted).length() < 1e-9,
        "corner at {corner}, not {wanted}"
    );
}

#[test]
fn what_does_not_fit_the_limits_is_refused_before_it_is_read() {
    // There are no voxels to read: reading would panic.
    for (dims, stored, wanted) in [
        ([100, 100, 101], VoxelType::U8, 1_010_000),
        ([500, 500, 1], VoxelType::F64, 1_000_000),
        ([u32::MAX; 3], VoxelType::I16, u64::MAX),
    ] {
        let source = Given {
            header: header(dims, stored),
            times: Vec::new(),
        };
        let limits = Limits {
            max_bytes: 999_999,
            ..Limits::default()
        };
        let found = Volume::read(
            &source,
            TimeComponent::default(),
            source.header.whole(),
            &limits,
        );
        let error = found.expect_err("a volume over the limit");
        match error.problem {
            Problem::Limit {
                wanted_bytes,
                limit_bytes: 999_999,
                ..
            } => assert_eq!(wanted_bytes, wanted),
            other => panic!("{other} for {dims:?}"),
        }
    }
}

#[test]
fn the_memory_to_fill_holes_counts_too() {
    let voxels = Voxels::F32(vec![1.0, f32::NAN]);
    let source = Given {
        header: header([2, 1, 1], VoxelType::F32),
        times: vec![voxels],
    };
    let read = |max_bytes| {
        let limits = Limits {
            max_bytes,
            ..Limits::default()
        };
        Volume::read(
            &source,
            TimeComponent::default(),
            source.header.whole(),
            &limits,
        )
    };
    // Four bytes of number, one of mask, four of distance for each.
    assert!(read(18).is_ok());
    let error = read(17).expect_err("17 bytes are too few");
    assert!(
        matches!(
            error.problem,
            Problem::Limit {
                wanted_bytes: 18,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn a_pick_or_box_outside_of_the_source_is_an_error_that_says_what_there_is() {
    let source = phantom::open("storm,n=8,times=3", &Limits::default()).unwrap();
    let whole = source.header().whole();
    let read = |pick, region| {
        let error = Volume::read(&*source, pick, region, &Limits::default()).expect_err("outside");
        error.to_string()
    };
    let pick = |time, component| TimeComponent { time, component };
    assert_eq!(
        read(pick(3, 0), whole),
        "cannot read storm,n=8,times=3: phantom field `time`: wanted 0 to 2, found 3"
    );
    assert!(read(pick(0, 1), whole).contains("`component`: wanted 0 to 0, found 1"));
    let too_far = VoxelBox {
        min: [0; 3],
        max: [8, 8, 4],
    };
    assert!(read(pick(0, 0), too_far).contains("a box inside [8, 8, 3]"));
    let empty = VoxelBox {
        min: [2, 0, 0],
        max: [2, 8, 3],
    };
    assert!(read(pick(0, 0), empty).contains("region"));
}

#[test]
fn voxels_that_do_not_make_a_volume_are_refused() {
    let make = |dims, matrix: DMat3, slope| {
        let affine = DAffine3 {
            matrix3: matrix,
            translation: DVec3::ZERO,
        };
        let rescale = Rescale {
            slope,
            intercept: 0.0,
        };
        Volume::from_voxels(dims, affine, Voxels::U8(vec![0; 6]), rescale, None)
    };
    assert!(make([3, 2, 1], DMat3::IDENTITY, 1.0).is_ok());
    assert!(
        make([3, 2, 2], DMat3::IDENTITY, 1.0).is_err(),
        "twelve voxels of six"
    );
    assert!(
        make([3, 0, 2], DMat3::IDENTITY, 1.0).is_err(),
        "an axis of none"
    );
    assert!(
        make(
            [3, 2, 1],
            DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)),
            1.0
        )
        .is_err(),
        "flat"
    );
    assert!(
        make([3, 2, 1], DMat3::from_diagonal(DVec3::splat(f64::NAN)), 1.0).is_err(),
        "NaN"
    );
    assert!(make([3, 2, 1], DMat3::IDENTITY, 0.0).is_err(), "slope 0");
}

#[test]
fn a_source_that_breaks_its_promise_is_an_error() {
    let source = Given {
        header: header([2, 2, 2], VoxelType::U8),
        times: vec![Voxels::U8(vec![0; 7])],
    };
    let found = Volume::read(
        &source,
        TimeComponent::default(),
        source.header.whole(),
        &Limits::default(),
    );
    let error = found.expect_err("seven voxels of eight");
    assert!(
        matches!(
            error.problem,
            Problem::Size {
                wanted_bytes: 8,
                found_bytes: 7,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn ends_are_found_wherever_they_stand() {
    for length in [1, 63, 64, 65, 200] {
        for at in 0..length {
            let mut numbers = vec![5_i16; length];
            numbers[at] = -300;
            numbers[(at + length / 2) % length] += 400;
            let wanted = [numbers.iter().min(), numbers.iter().max()];
            let wanted = wanted.map(|end| f64::from(*end.expect("some")));
            let dims = [length as u32, 1, 1];
            let rescale = Rescale::default();
            let of = |voxels| Volume::from_voxels(dims, DAffine3::IDENTITY, voxels, rescale, None);
            let floats = numbers.iter().map(|&x| f32::from(x)).collect();
            for voxels in [Voxels::I16(numbers.clone()), Voxels::F32(floats)] {
                let volume = of(voxels).expect("a volume");
                assert_eq!(volume.value_range, wanted, "{length} {at}");
            }
        }
    }
}

#[test]
fn one_hole_is_found_wherever_it_stands() {
    const LENGTH: usize = 10_000;
    for at in [0, 1, 4095, 4096, LENGTH - 1] {
        let mut numbers = vec![1.0_f32; LENGTH];
        numbers[at] = f32::NAN;
        let dims = [LENGTH as u32, 1, 1];
        let voxels = Voxels::F32(numbers);
        let volume =
            Volume::from_voxels(dims, DAffine3::IDENTITY, voxels, Rescale::default(), None);
        assert_eq!(volume.expect("a volume").no_data_count(), 1, "{at}");
    }
}
