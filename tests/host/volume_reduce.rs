//! A reduced source: where its voxels lie, and what they are.

use glam::{DAffine3, DVec3};
use std::path::Path;
use stratavox::volume::{
    Format, Header, Piece, ReadError, Reduced, Source, TimeComponent, VoxelBox, VoxelType, Voxels,
};

/// Voxels in memory.
struct Given {
    header: Header,
    voxels: Vec<f32>,
}

impl Given {
    fn new(dims: [u32; 3], value: impl Fn([u32; 3]) -> f32) -> Self {
        let affine = DAffine3::from_scale_rotation_translation(
            DVec3::new(0.5, 2.0, 3.0),
            glam::DQuat::from_rotation_z(0.3),
            DVec3::new(7.0, -4.0, 1.0),
        );
        let mut voxels = Vec::new();
        for z in 0..dims[2] {
            for y in 0..dims[1] {
                voxels.extend((0..dims[0]).map(|x| value([x, y, z])));
            }
        }
        let header = Header::new(Format::Raw, dims, VoxelType::F32, affine);
        Self { header, voxels }
    }
}

impl Source for Given {
    fn path(&self) -> &Path {
        Path::new("given")
    }
    fn header(&self) -> &Header {
        &self.header
    }
    fn read(&self, _: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let [nx, ny, _] = self.header.dims;
        let mut voxels = Vec::new();
        for z in region.min[2]..region.max[2] {
            for y in region.min[1]..region.max[1] {
                let at = |x| self.voxels[(x + nx * (y + ny * z)) as usize];
                voxels.extend((region.min[0]..region.max[0]).map(at));
            }
        }
        Ok(Voxels::F32(voxels).into())
    }
}

fn numbers(source: &dyn Source, region: VoxelBox) -> Vec<f32> {
    match source
        .read(TimeComponent::default(), region)
        .expect("voxels")
        .voxels
    {
        Voxels::F32(numbers) => numbers,
        other => panic!("{:?}", other.voxel_type()),
    }
}

fn reduced(given: Given, factor: u32) -> Reduced {
    // One reduced slice at a time: the slabs have seams in every test.
    Reduced::new(Box::new(given), factor, 1)
}

#[test]
fn a_reduced_voxel_lies_in_the_middle_of_its_block_and_holds_what_a_linear_field_has_there() {
    let linear = |[x, y, z]: [u32; 3]| (x + 10 * y + 100 * z) as f32;
    let given = Given::new([6, 4, 8], linear);
    let from_world = given.header.world_from_voxel.inverse();
    let source = reduced(given, 2);
    assert_eq!(source.header().dims, [3, 2, 4]);
    let found = numbers(&source, source.header().whole());
    for (i, &value) in found.iter().enumerate() {
        let voxel = [i % 3, i / 3 % 2, i / 6].map(|n| n as f64 + 0.5);
        let world = source
            .header()
            .world_from_voxel
            .transform_point3(voxel.into());
        let index = from_world.transform_point3(world) - 0.5;
        let wanted = index.dot(DVec3::new(1.0, 10.0, 100.0));
        assert!(
            (f64::from(value) - wanted).abs() < 1e-9,
            "{i}: {value}, not {wanted}"
        );
    }
}

#[test]
fn a_part_is_that_part_of_the_whole_and_cut_blocks_are_means_of_what_they_have() {
    let field = |[x, y, z]: [u32; 3]| ((x * 7 + y * 13 + z * 29) % 31) as f32;
    let source = reduced(Given::new([7, 5, 10], field), 3);
    assert_eq!(source.header().dims, [3, 2, 4]);
    let whole = numbers(&source, source.header().whole());
    // The last block: x = 6, y = 3 and 4, z = 9.
    let wanted = (field([6, 3, 9]) + field([6, 4, 9])) / 2.0;
    assert_eq!(whole[23], wanted);
    let part = VoxelBox {
        min: [1, 0, 1],
        max: [3, 2, 3],
    };
    let found = numbers(&source, part);
    let wanted: Vec<f32> = (0..8)
        .map(|i| [1 + i % 2, i / 2 % 2, 1 + i / 4])
        .map(|[x, y, z]| whole[x + 3 * (y + 2 * z)])
        .collect();
    assert_eq!(found, wanted);
}

#[test]
fn voxels_without_data_take_no_part_in_a_mean_and_a_block_of_them_stays_without() {
    let mut given = Given::new([4, 2, 2], |[x, y, _]| match (x, y) {
        (0, 0) => f32::NAN,
        (1, 0) => -999.0,
        (0 | 1, _) => 5.0,
        _ => -999.0,
    });
    given.header.fill = Some(-999.0);
    let source = reduced(given, 2);
    let found = numbers(&source, source.header().whole());
    assert_eq!(found, [5.0, -999.0]);
}

#[test]
fn no_label_appears_that_was_not_there() {
    let mut given = Given::new([9, 9, 9], |[x, y, z]| {
        [3.0, 40.0, 500.0][((x + y + z) % 3) as usize]
    });
    given.header.is_labels = true;
    let source = reduced(given, 2);
    let found = numbers(&source, source.header().whole());
    assert_eq!(found.len(), 125);
    assert!(
        found.iter().all(|v| [3.0, 40.0, 500.0].contains(v)),
        "{found:?}"
    );
}
