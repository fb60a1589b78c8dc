//! Runs that the device makes of codes are those that the host makes of classified voxels: to the byte.
//!
//! The device looks up what the host says of each code, and computes nothing but places: no number rounds.

use crate::shared::{device, device_with};
use crate::skipping_shared::Numbers;
use glam::DAffine3;
use half::f16;
use stratavox::color::ColorSpace;
use stratavox::gpu::{Caps, Headless};
use stratavox::resident::{ClassifiedRuns, PayloadFloats, RunBuilder, RunsSize};
use stratavox::technique::preclassified::{materials_of_codes, preclassified};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Rescale, Volume, Voxels};

const FLOATS: [PayloadFloats; 2] = [PayloadFloats::Half, PayloadFloats::Single];
pub const SPACES: [ColorSpace; 2] = [ColorSpace::Linear, ColorSpace::Display];

/// Values from 0 to 1; nothing below `first`, and everything where that is below 0.
pub fn function(first: f64, interpolation: Interpolation) -> TransferFunction {
    let opacity = [(first, 0.0), (first + 0.2, 0.3), (1.0, 0.9)];
    let color = [
        (0.0, [1.0, 0.2, 0.1]),
        (0.6, [0.3, 0.9, 0.5]),
        (1.0, [1.0; 3]),
    ];
    TransferFunction {
        color: color.map(|(value, srgb)| ColorPoint { value, srgb }).into(),
        opacity: opacity
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .into(),
        reference_length: Some(1.0),
        interpolation,
        gradient_transfer: None,
        medium: None,
    }
}

/// Numbers from 0 to 1 as each type of 8 and 16 bits stores them.
pub fn volumes(dims: [u32; 3], values: &[f64], validity: Option<&[u8]>) -> Vec<Volume> {
    let made = |voxels, slope: f64, intercept| {
        let rescale = Rescale { slope, intercept };
        let made = Volume::from_voxels(dims, DAffine3::IDENTITY, voxels, rescale, None);
        Volume {
            validity: validity.map(<[u8]>::to_vec),
            ..made.expect("a right volume")
        }
    };
    let (byte, word) = (1.0 / 255.0, 1.0 / 65_535.0);
    let scaled = |most: f64| values.iter().map(move |value| (value * most).round());
    vec![
        made(
            Voxels::U8(scaled(255.0).map(|n| n as u8).collect()),
            byte,
            0.0,
        ),
        made(
            Voxels::I8(scaled(255.0).map(|n| (n - 128.0) as i8).collect()),
            byte,
            128.0 * byte,
        ),
        made(
            Voxels::U16(scaled(65_535.0).map(|n| n as u16).collect()),
            word,
            0.0,
        ),
        made(
            Voxels::I16(scaled(65_535.0).map(|n| (n - 32_768.0) as i16).collect()),
            word,
            32_768.0 * word,
        ),
        made(
            Voxels::F16(values.iter().map(|&value| f16::from_f64(value)).collect()),
            1.0,
            0.0,
        ),
    ]
}

/// What both sides make of a volume.
fn check(
    device: &mut Headless,
    volume: &Volume,
    function: &TransferFunction,
    space: ColorSpace,
    floats: PayloadFloats,
) -> RunsSize {
    let length = 1.0;
    let dense = preclassified(volume, function, length, space).expect("four volumes");
    let host = ClassifiedRuns::new(device, dense.each_ref(), floats)
        .expect("room")
        .expect("plain floats");
    let builder = RunBuilder::new(device, volume).expect("room");
    let builder = builder.expect("codes");
    let materials = materials_of_codes(volume, function, length, space).expect("codes");
    let made = builder.build(device, &materials, floats).expect("room");
    let made = made.expect("numbers that such floats hold");
    let what = || {
        format!(
            "{:?} {:?} {floats:?}",
            volume.dims,
            volume.voxels.voxel_type()
        )
    };
    assert_eq!(made.size(), host.size(), "{}", what());
    let [wanted, found] = [&host, &made].map(|runs| runs.read(device).expect("bytes"));
    for (name, k) in [("words", 0), ("payload", 1)] {
        let differ = wanted[k].iter().zip(&found[k]).filter(|(a, b)| a != b);
        let count = differ.count();
        assert_eq!(count, 0, "{count} bytes of {name} differ, {}", what());
        assert_eq!(wanted[k].len(), found[k].len(), "{name} of {}", what());
    }
    made.size()
}

#[test]
fn the_device_makes_the_bytes_of_the_host() {
    let mut numbers = Numbers(17);
    let mut device = device();
    let mut seen = 0;
    for nx in 31..=65_u32 {
        let dims = [nx, 1 + nx % 5, 3];
        let count = dims.iter().product::<u32>() as usize;
        let values: Vec<f64> = (0..count).map(|_| numbers.next()).collect();
        let validity: Vec<u8> = (0..count).map(|_| u8::from(numbers.next() > 0.1)).collect();
        let first = [-1.0, 0.2, 0.5, 0.9][numbers.below(4)];
        let interpolation = [Interpolation::Linear, Interpolation::Step][numbers.below(2)];
        let validity = (nx % 2 == 0).then_some(&validity[..]);
        let function = function(first, interpolation);
        let kinds = volumes(dims, &values, validity);
        let volume = &kinds[nx as usize % kinds.len()];
        let [space, floats] = [numbers.below(2), numbers.below(2)];
        let size = check(
            &mut device,
            volume,
            &function,
            SPACES[space],
            FLOATS[floats],
        );
        seen += size.full;
        if first < 0.0 && validity.is_none() {
            assert_eq!(size.full, count as u64, "all are full");
        }
    }
    assert!(seen > 1000, "{seen} voxels are full");
}

/// More words than a workgroup has, and than all of one together: several blocks, several shares, several rows of texels.
#[test]
fn the_device_makes_the_bytes_of_the_host_of_many_words() {
    let mut numbers = Numbers(23);
    let mut device = device();
    let dims = [70, 128, 130];
    let count = dims.iter().product::<u32>() as usize;
    // Noise in layers, of which some are empty.
    let value = |n: usize, noise: f64| noise * f64::from(u8::from(!(n / 9000).is_multiple_of(3)));
    let values: Vec<f64> = (0..count).map(|n| value(n, numbers.next())).collect();
    let validity: Vec<u8> = (0..count)
        .map(|_| u8::from(numbers.next() > 0.01))
        .collect();
    for (n, volume) in volumes(dims, &values, Some(&validity)).iter().enumerate() {
        let function = function(0.3, Interpolation::Linear);
        let floats = FLOATS[n % 2];
        let size = check(&mut device, volume, &function, SPACES[n % 2], floats);
        assert!(size.full > 300_000 && size.runs > 100_000, "{size:?}");
    }
}

#[test]
fn nothing_and_everything_and_payloads_in_parts_are_made() {
    let mut device = device();
    let empty = function(2.0, Interpolation::Linear);
    let full = function(-1.0, Interpolation::Linear);
    // Of 16 bytes each: more than 64 MiB.
    let dims = [256, 128, 136];
    let count = dims.iter().product::<u32>() as usize;
    let values: Vec<f64> = (0..count).map(|n| (n % 251) as f64 / 251.0).collect();
    let volume = volumes(dims, &values, None).swap_remove(0);
    let (space, floats) = (SPACES[0], PayloadFloats::Single);
    let size = check(&mut device, &volume, &empty, space, floats);
    assert_eq!([size.full, size.runs], [0, 0]);
    let size = check(&mut device, &volume, &full, space, floats);
    assert_eq!([size.full, size.runs], [count as u64, 128 * 136]);
}

/// One volume, one function after another, and the first again.
#[test]
fn a_function_that_is_changed_back_makes_the_same_bytes() {
    let mut numbers = Numbers(3);
    let mut device = device();
    let dims = [45, 20, 11];
    let count = dims.iter().product::<u32>() as usize;
    let values: Vec<f64> = (0..count).map(|_| numbers.next()).collect();
    let volume = volumes(dims, &values, None).swap_remove(3);
    let builder = RunBuilder::new(&mut device, &volume).expect("room");
    let builder = builder.expect("codes");
    let made = [0.2, 0.6, 0.2].map(|first| {
        let function = function(first, Interpolation::Linear);
        let materials = materials_of_codes(&volume, &function, 1.0, SPACES[0]).expect("codes");
        let made = builder.build(&mut device, &materials, PayloadFloats::Half);
        let made = made.expect("room").expect("small numbers");
        made.read(&mut device).expect("bytes")
    });
    assert!(made[0] == made[2] && made[0] != made[1]);
}

#[test]
fn what_the_device_cannot_make_is_left_to_the_host() {
    let dims = [40, 8, 8];
    let values: Vec<f64> = (0..2560).map(|n| f64::from(n) / 2560.0).collect();
    let volume = volumes(dims, &values, None).swap_remove(2);
    let builder = |device: &mut Headless, volume| RunBuilder::new(device, volume).expect("room");
    let mut whole = device();
    let floats = Volume {
        voxels: Voxels::F32(values.iter().map(|&value| value as f32).collect()),
        ..volume.clone()
    };
    assert!(builder(&mut whole, &floats).is_none(), "too many codes");
    for caps in [
        Caps {
            max_storage_buffer_range: 5000,
            ..Caps::UNLIMITED
        },
        Caps {
            max_workgroup_count: [0, 1, 1],
            ..Caps::UNLIMITED
        },
    ] {
        assert!(builder(&mut device_with(caps), &volume).is_none());
    }
    // As many workgroups as there are blocks, of 64 words each: two of 128 words.
    let two_groups = Caps {
        max_workgroup_count: [2, 1, 1],
        ..Caps::UNLIMITED
    };
    let mut lean = device_with(two_groups);
    let there = builder(&mut lean, &volume).expect("two workgroups");
    let made = there.build(&mut lean, &vec![[0.5; 4]; 65_536], PayloadFloats::Half);
    let made = made.expect("two workgroups").expect("small numbers");
    assert_eq!(made.size().full, 2560);
    // Numbers that 16 bits do not hold, of a code that a voxel has and of one that none has.
    let there = builder(&mut whole, &volume).expect("codes");
    let mut materials = vec![[0.0; 4]; 65_536];
    let Voxels::U16(codes) = &volume.voxels else {
        unreachable!("made so")
    };
    let none = (0..=u16::MAX).find(|code| !codes.contains(code));
    let none = none.expect("more codes than voxels");
    let mut is_made = |materials: &[[f32; 4]], floats| {
        let made = there.build(&mut whole, materials, floats);
        made.expect("room").is_some()
    };
    materials[usize::from(none)] = [0.0, 0.0, 0.0, 70_000.0];
    assert!(is_made(&materials, PayloadFloats::Half));
    materials[usize::from(codes[7])] = [0.0, 0.0, 0.0, 70_000.0];
    assert!(!is_made(&materials, PayloadFloats::Half));
    assert!(is_made(&materials, PayloadFloats::Single));
}
