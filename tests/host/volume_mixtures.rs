//! Lengths of vectors, colours multiplied with their alpha, label maps on other grids: the CPU's part.

use glam::{DAffine3, DVec3};
use std::path::Path;
use stratavox::volume::labels::{hide, labels_of, on_grid};
use stratavox::volume::{
    ComponentKind, Format, Grid, Header, Limits, Magnitude, Piece, ReadError, Rescale, Source,
    TimeComponent, Volume, VoxelBox, VoxelType, Voxels, luma, read_colors,
};

/// Numbers in memory, one list a component.
struct Memory {
    header: Header,
    components: Vec<Voxels>,
}

impl Memory {
    fn new(dims: [u32; 3], stored: VoxelType, components: Vec<Voxels>) -> Self {
        let header = Header {
            components: components.len() as u32,
            ..Header::new(Format::Raw, dims, stored, DAffine3::IDENTITY)
        };
        Self { header, components }
    }
}

impl Source for Memory {
    fn path(&self) -> &Path {
        Path::new("memory")
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let [nx, ny, _] = self.header.dims;
        let all = (region.min[2]..region.max[2]).flat_map(move |z| {
            (region.min[1]..region.max[1]).flat_map(move |y| {
                (region.min[0]..region.max[0]).map(move |x| (z * ny + y) * nx + x)
            })
        });
        let indices: Vec<usize> = all.map(|i| i as usize).collect();
        let from = &self.components[pick.component as usize];
        Ok(match from {
            Voxels::U8(v) => Voxels::U8(indices.iter().map(|&i| v[i]).collect()),
            _ => Voxels::F32(indices.iter().map(|&i| from.stored(i)).collect()),
        }
        .into())
    }
}

fn whole(source: &dyn Source) -> Volume {
    let region = source.header().whole();
    Volume::read(source, TimeComponent::default(), region, &Limits::default()).expect("a volume")
}

fn labels(dims: [u32; 3], affine: DAffine3, codes: Vec<u8>) -> Volume {
    let rescale = Rescale::default();
    Volume::from_voxels(dims, affine, Voxels::U8(codes), rescale, None).expect("a volume")
}

#[test]
fn the_length_of_a_vector_is_taken_after_rescale_and_holes_stay_holes() {
    let [x, y] = [vec![3.0, 0.0, -5.0, 9.0], vec![4.0, 0.5, 12.0, f32::NAN]];
    let mut source = Memory::new(
        [2, 2, 1],
        VoxelType::F32,
        vec![Voxels::F32(x), Voxels::F32(y)],
    );
    source.header.rescale = Rescale {
        slope: 2.0,
        intercept: 1.0,
    };
    source.header.fill = Some(0.5);
    let lengths = Magnitude::new(Box::new(source));
    assert_eq!(lengths.header().components, 1);
    assert_eq!(lengths.header().meaning, ComponentKind::Numbers);
    assert!(lengths.header().notes[0].contains("length"));
    let volume = whole(&lengths);
    assert_eq!(volume.validity, Some(vec![1, 0, 1, 0]));
    // (7, 9) and (-9, 25).
    assert_eq!(volume.voxels.stored(0), 130_f32.sqrt());
    assert_eq!(volume.voxels.stored(2), 706_f32.sqrt());
    assert_eq!(volume.rescale, Rescale::default());
}

#[test]
fn a_part_of_lengths_is_the_part_of_the_whole() {
    let component = |k: usize| Voxels::U8((0..60).map(|i| (i * (k + 2) % 251) as u8).collect());
    let source = Memory::new([5, 4, 3], VoxelType::U8, (0..3).map(component).collect());
    let lengths = Magnitude::new(Box::new(source));
    let all = whole(&lengths).voxels;
    let part = VoxelBox {
        min: [1, 2, 1],
        max: [4, 4, 3],
    };
    let found = lengths
        .read(TimeComponent::default(), part)
        .expect("a piece")
        .voxels;
    let mut next = 0;
    for z in 1..3 {
        for y in 2..4 {
            for x in 1..4 {
                assert_eq!(found.stored(next), all.stored((z * 4 + y) * 5 + x));
                next += 1;
            }
        }
    }
    assert_eq!(next, found.len());
}

#[test]
fn colours_of_bytes_are_multiplied_with_alpha_without_loss() {
    let bytes = |list: [u8; 4]| Voxels::U8(list.to_vec());
    let channels = vec![
        bytes([255, 10, 0, 7]),
        bytes([255, 20, 128, 7]),
        bytes([0, 30, 255, 7]),
        bytes([255, 255, 3, 0]),
    ];
    let mut source = Memory::new([4, 1, 1], VoxelType::U8, channels);
    source.header.meaning = ComponentKind::Rgba;
    let found = read_colors(&source, 0, &Limits::default()).expect("colours");
    let [red, _, blue, alpha] = &found[..] else {
        panic!("{} volumes", found.len());
    };
    assert_eq!(red.voxels, Voxels::U16(vec![65025, 2550, 0, 0]));
    assert_eq!(blue.voxels, Voxels::U16(vec![0, 7650, 765, 0]));
    let value = |volume: &Volume, i: usize| {
        f64::from(volume.voxels.stored(i)) * volume.rescale.slope + volume.rescale.intercept
    };
    assert_eq!(value(red, 0), 1.0);
    assert!((value(alpha, 2) - 3.0 / 255.0).abs() < 1e-15);
    source.components.truncate(3);
    source.header.components = 3;
    let straight = read_colors(&source, 0, &Limits::default()).expect("colours");
    assert_eq!(straight[1].voxels, bytes([255, 20, 128, 7]));
    let wanted = (0.2126 * 10.0 + 0.7152 * 20.0 + 0.0722 * 30.0) / 255.0;
    assert!((luma(&straight, 1).expect("valid") - wanted).abs() < 1e-12);
}

#[test]
fn colours_are_checked_together_against_the_memory() {
    let channels = vec![Voxels::U8(vec![0; 64]); 4];
    let source = Memory::new([4, 4, 4], VoxelType::U8, channels);
    let limits = Limits {
        max_bytes: 255,
        ..Limits::default()
    };
    let refused = read_colors(&source, 0, &limits).expect_err("too large");
    assert!(refused.to_string().contains("bytes"), "{refused}");
    let fits = Limits {
        max_bytes: 256,
        ..limits
    };
    read_colors(&source, 0, &fits).expect("four times 64 bytes");
}

#[test]
fn every_voxel_takes_the_label_that_its_centre_lies_in() {
    // Turned by a right angle and moved: voxel (x, y) of the grid lies in voxel (y, 3 - x) of the map.
    let turned = DAffine3::from_translation(DVec3::new(10.0, 4.0, 0.0))
        * DAffine3::from_rotation_z(-std::f64::consts::FRAC_PI_2);
    let map = labels([4, 3, 1], turned, (1..=12).collect());
    let grid = Grid {
        dims: [3, 4, 1],
        world_from_voxel: DAffine3::from_translation(DVec3::new(10.0, 0.0, 0.0)),
    };
    let (moved, share) = on_grid(&map, &grid);
    assert_eq!(share, 1.0);
    for y in 0..4_u32 {
        for x in 0..3_u32 {
            let world = grid.world_from_voxel.transform_point3(DVec3::new(
                f64::from(x) + 0.5,
                f64::from(y) + 0.5,
                0.5,
            ));
            let there = turned.inverse().transform_point3(world).floor();
            let wanted = 1.0 + there.y * 4.0 + there.x;
            let found = f64::from(moved.voxels.stored((y * 3 + x) as usize));
            assert_eq!(found, wanted, "({x}, {y})");
        }
    }
    assert_eq!(moved.grid(), grid);
}

#[test]
fn outside_of_the_map_there_is_no_label_and_the_share_says_so() {
    let map = labels([2, 2, 1], DAffine3::IDENTITY, vec![5, 6, 7, 8]);
    let grid = |x| Grid {
        dims: [4, 2, 1],
        world_from_voxel: DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)),
    };
    let (moved, share) = on_grid(&map, &grid(-2.0));
    assert_eq!(moved.voxels, Voxels::U8(vec![0, 0, 5, 6, 0, 0, 7, 8]));
    assert_eq!(share, 0.5);
    assert_eq!(on_grid(&map, &grid(50.0)).1, 0.0);
}

#[test]
fn labels_are_counted_and_hidden_ones_are_no_data() {
    let mut map = labels([3, 2, 1], DAffine3::IDENTITY, vec![0, 2, 2, 9, 0, 0]);
    let counted: Vec<_> = labels_of(&map).expect("labels").into_iter().collect();
    assert_eq!(counted, [(0, 3), (2, 2), (9, 1)]);
    hide(&mut map, |label| label != 2);
    assert_eq!(map.validity, Some(vec![1, 0, 0, 1, 1, 1]));
    hide(&mut map, |_| true);
    assert_eq!(map.validity, None);
    let fractions = Voxels::F32(vec![0.5, 1.0]);
    let rescale = Rescale::default();
    let no_labels =
        Volume::from_voxels([2, 1, 1], DAffine3::IDENTITY, fractions, rescale, None).unwrap();
    assert_eq!(labels_of(&no_labels), None);
}
