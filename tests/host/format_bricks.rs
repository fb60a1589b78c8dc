//! Files of bricks: what is written is read, level by level, and what is damaged is refused.
#![cfg(feature = "files")]

use crate::files;

use files::{Folder, message, numbers};
use glam::{DAffine3, DMat3, dvec3};
use std::io::Cursor;
use std::path::Path;
use stratavox::format;
use stratavox::format::write::{
    NumberType, Selection, VolumeFormat, WriteVolumeOptions, write_volume,
};
use stratavox::volume::{
    Format, Header, Limits, Piece, ReadError, Rescale, Source, TimeComponent, VolumeSelection,
    VoxelBox, VoxelType, Voxels,
};

/// Numbers of a formula, of any type; two times and three components.
struct Made {
    header: Header,
    hole: Option<[u32; 3]>,
}

const DIMS: [u32; 3] = [131, 125, 7];

impl Made {
    fn of(stored: VoxelType) -> Self {
        let m = DMat3::from_cols(
            dvec3(0.5, 0.1, 0.0),
            dvec3(0.0, 0.75, 0.2),
            dvec3(0.3, 0.0, -2.0),
        );
        let affine = DAffine3::from_mat3_translation(m, dvec3(7.0, -1.0 / 3.0, 1e3));
        let mut header = Header::new(Format::Raw, DIMS, stored, affine);
        header.times = 2;
        header.components = 3;
        header.rescale = Rescale {
            slope: -0.25,
            intercept: 12.5,
        };
        header.unit = Some("K".to_owned());
        header.hounsfield = true;
        Self { header, hole: None }
    }

    fn number(&self, pick: TimeComponent, [x, y, z]: [u32; 3]) -> f32 {
        match self.hole == Some([x, y, z]) {
            true => 101.0,
            // A flat part too: bricks of one number.
            false if pick.component == 2 => 5.0,
            false => ((x * 3 + y * 7 + z * 31 + 11 * pick.time + 5 * pick.component) % 100) as f32,
        }
    }
}

impl Source for Made {
    fn path(&self) -> &Path {
        Path::new("made")
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let [low, high] = [region.min, region.max];
        let mut all = Vec::new();
        for z in low[2]..high[2] {
            for y in low[1]..high[1] {
                all.extend((low[0]..high[0]).map(|x| self.number(pick, [x, y, z])));
            }
        }
        Ok(match self.header.stored {
            VoxelType::U8 => Voxels::U8(all.iter().map(|&n| n as u8).collect()),
            VoxelType::I8 => Voxels::I8(all.iter().map(|&n| n as i8).collect()),
            VoxelType::U16 => Voxels::U16(all.iter().map(|&n| n as u16).collect()),
            VoxelType::I16 => Voxels::I16(all.iter().map(|&n| n as i16).collect()),
            VoxelType::F16 => Voxels::F16(all.iter().map(|&n| half::f16::from_f32(n)).collect()),
            _ => Voxels::F32(all),
        }
        .into())
    }
}

fn written(source: &dyn Source, selection: &Selection) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let options = WriteVolumeOptions {
        format: VolumeFormat::Bricks,
        numbers: NumberType::Stored,
        compress: true,
    };
    let mut last = (0, 0);
    write_volume(source, selection, &options, &mut file, &mut |done, of| {
        assert_eq!(done, last.0 + 1);
        last = (done, of);
    })
    .expect("written");
    assert_eq!(last.0, last.1, "all bricks are told");
    file.into_inner()
}

fn open(folder: &Folder, bytes: &[u8], level: Option<u32>) -> Result<Box<dyn Source>, ReadError> {
    let path = folder.write("a.svb", bytes);
    let wanted = VolumeSelection {
        level,
        ..VolumeSelection::default()
    };
    format::open(&path, &wanted, &Limits::default())
}

#[test]
fn numbers_and_all_that_is_known_of_them_come_back() {
    let folder = Folder::new();
    for stored in [
        VoxelType::U8,
        VoxelType::I8,
        VoxelType::U16,
        VoxelType::I16,
        VoxelType::F16,
        VoxelType::F32,
    ] {
        let made = Made::of(stored);
        let bytes = written(&made, &Selection::all(&made.header));
        let source = open(&folder, &bytes, None).expect("readable");
        let found = source.header();
        let wanted = Header {
            format: Format::Bricks,
            levels: 2,
            ..made.header.clone()
        };
        assert_eq!(*found, wanted);
        for (time, component) in [(0, 0), (0, 2), (1, 1)] {
            let pick = TimeComponent { time, component };
            // All, and boxes within a brick, over borders of bricks, and in a corner.
            for region in [
                found.whole(),
                VoxelBox {
                    min: [3, 4, 1],
                    max: [20, 9, 6],
                },
                VoxelBox {
                    min: [110, 90, 0],
                    max: [131, 124, 7],
                },
                VoxelBox {
                    min: [117, 117, 2],
                    max: [123, 123, 5],
                },
            ] {
                let piece = source.read(pick, region).expect("readable");
                assert_eq!(piece, made.read(pick, region).expect("made"), "{stored:?}");
            }
        }
    }
}

#[test]
fn a_part_lies_where_it_lay() {
    let made = Made::of(VoxelType::U16);
    let selection = Selection {
        region: VoxelBox {
            min: [2, 3, 1],
            max: [130, 101, 5],
        },
        times: 1..2,
        components: 1..2,
    };
    let bytes = written(&made, &selection);
    let source = open(&Folder::new(), &bytes, None).expect("readable");
    let header = source.header();
    assert_eq!(header.dims, [128, 98, 4]);
    assert_eq!((header.times, header.components), (1, 1));
    let there = made
        .header
        .world_from_voxel
        .transform_point3(dvec3(2.0, 3.0, 1.0));
    assert_eq!(header.world_from_voxel.translation, there);
    let piece = source
        .read(TimeComponent::default(), header.whole())
        .expect("readable");
    let pick = TimeComponent {
        time: 1,
        component: 1,
    };
    assert_eq!(piece, made.read(pick, selection.region).expect("made"));
}

#[test]
fn coarser_levels_are_means_and_say_how_far_off_they_are() {
    let folder = Folder::new();
    let mut made = Made::of(VoxelType::F32);
    made.header.fill = Some(101.0);
    made.hole = Some([4, 5, 2]);
    let bytes = written(&made, &Selection::all(&made.header));
    let source = open(&folder, &bytes, Some(1)).expect("readable");
    let header = source.header();
    assert_eq!(header.dims, [66, 63, 4]);
    let corner = dvec3(1.0, 1.0, 1.0);
    assert_eq!(
        header.world_from_voxel.transform_point3(corner),
        made.header.world_from_voxel.transform_point3(2.0 * corner)
    );
    let pick = TimeComponent::default();
    let found = numbers(&source.read(pick, header.whole()).expect("readable").voxels);
    let (mut largest, mut squares, mut count) = (0.0f64, 0.0, 0.0);
    for (i, &coarse) in found.iter().enumerate() {
        let [x, y, z] = [i % 66, i / 66 % 63, i / 66 / 63].map(|n| 2 * n as u32);
        let fine: Vec<f64> = (0..8)
            .map(|k| [x + k % 2, y + k / 2 % 2, z + k / 4])
            .filter(|at| (0..3).all(|k| at[k] < DIMS[k]) && made.hole != Some(*at))
            .map(|at| made.number(pick, at).into())
            .collect();
        let mean = fine.iter().sum::<f64>() / fine.len() as f64;
        assert!((mean - f64::from(coarse)).abs() < 1e-5, "{mean} {coarse}");
        for number in fine {
            largest = largest.max((number - f64::from(coarse)).abs());
            squares += (number - f64::from(coarse)).powi(2);
            count += 1.0;
        }
    }
    let note = header
        .notes
        .iter()
        .find(|note| note.contains("level 1 of 1"));
    let note = note.expect("what the level costs");
    let words = note.split([' ', ',']).filter_map(|word| word.parse().ok());
    let said: Vec<f64> = words.filter(|n: &f64| n.fract() != 0.0).collect();
    // Of all times and components together; values are a quarter of the numbers.
    let [said_largest, said_rms] = said[..] else {
        panic!("{note}");
    };
    assert!(
        said_largest >= 0.25 * largest - 1e-4 && said_largest <= 0.26 * largest,
        "{note}"
    );
    let rms = 0.25 * f64::sqrt(squares / count);
    assert!((0.6..1.1).contains(&(said_rms / rms)), "{note}, not {rms}");
    let refused = open(&folder, &bytes, Some(2)).err().expect("no such level");
    let words = message(&refused);
    assert!(
        words.contains("level") && words.contains("0 to 1"),
        "{words}"
    );
}

#[test]
fn what_is_damaged_is_refused_by_name() {
    let folder = Folder::new();
    let made = Made::of(VoxelType::U16);
    let bytes = written(&made, &Selection::all(&made.header));
    let whole = |bytes: &[u8]| -> Result<Piece, ReadError> {
        let source = open(&folder, bytes, None)?;
        source.read(TimeComponent::default(), source.header().whole())
    };
    assert!(whole(&bytes).is_ok());
    let refused = |bytes: &[u8], word: &str| {
        let error = whole(bytes).map(|_| "numbers").expect_err(word);
        let words = message(&error);
        assert!(words.contains(word), "{words}: no {word}");
    };
    refused(&bytes[..bytes.len() - 1], "promises");
    refused(&[&bytes[..], b"x"].concat(), "promises");
    let with = |from: &str, to: &str| {
        let at = bytes
            .windows(from.len())
            .rposition(|part| part == from.as_bytes());
        let at = at.expect("in the header");
        let mut changed = bytes.clone();
        changed[at..at + to.len()].copy_from_slice(to.as_bytes());
        changed
    };
    refused(&with("version: 1", "version: 9"), "version 9");
    refused(&with("dims: 131", "dims: 931"), "level");
    refused(&with("type: u16", "type: x16"), "type");
    refused(&with("side: 120", "side: 0.1"), "side");
    refused(&with("halo: 3", "halo: 0"), "halo");
    refused(&with("hounsfield: yes", "hounsfield: may"), "hounsfield");
    refused(&with("version: 1", "ver ion: 1"), "version");
    // The first brick.
    let mut damaged = bytes.clone();
    damaged[40..60].fill(0xff);
    refused(&damaged, "damaged");
}
