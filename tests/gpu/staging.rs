//! What uploads stage: texels of a region in the order of the texture, whatever the order of the voxels in memory.
//! The volume is wider than the blocks in which it is staged, along every axis.

use crate::shared::device;
use glam::DAffine3;
use stratavox::resident::{GpuVolume, TextureLayout};
use stratavox::volume::{Rescale, Volume, VoxelBox, Voxels};

const DIMS: [u32; 3] = [70, 66, 67];

fn count() -> usize {
    DIMS.iter().map(|&n| n as usize).product()
}

fn layouts() -> [TextureLayout; 4] {
    let stack = TextureLayout::Stack;
    [TextureLayout::Texture3d, stack(0), stack(1), stack(2)]
}

/// Indices of the voxels of a region: the axis across runs fastest, then that down, then that in depth.
fn indices(layout: TextureLayout, region: VoxelBox) -> Vec<usize> {
    let [across, down, deep] = match layout {
        TextureLayout::Texture3d => [0, 1, 2],
        TextureLayout::Stack(axis) => [(axis + 1) % 3, (axis + 2) % 3, axis],
    };
    let [nx, ny, _] = DIMS.map(|n| n as usize);
    let range = |axis: usize| region.min[axis] as usize..region.max[axis] as usize;
    let mut found = Vec::new();
    for w in range(deep) {
        for v in range(down) {
            for u in range(across) {
                let mut at = [0; 3];
                (at[across], at[down], at[deep]) = (u, v, w);
                found.push(at[0] + nx * (at[1] + ny * at[2]));
            }
        }
    }
    found
}

fn assert_staged(voxels: Voxels, fill: Option<f64>, texel: impl Fn(usize, usize) -> Vec<u8>) {
    let rescale = Rescale::default();
    let volume = Volume::from_voxels(DIMS, DAffine3::IDENTITY, voxels, rescale, fill);
    let volume = volume.expect("a volume");
    let device = device();
    for layout in layouts() {
        let made = GpuVolume::new(device.gpu(), &volume, layout).expect("room");
        let bytes = made.texel().bytes();
        let slabs = made.slabs(50_000 * bytes as u64);
        assert!(slabs.len() > 5, "{} slabs", slabs.len());
        for slab in slabs {
            let indices = indices(layout, slab.region);
            let mut wanted: Vec<u8> = indices.iter().flat_map(|&i| texel(i, bytes)).collect();
            if let Some(mask) = &volume.validity {
                wanted.resize(wanted.len().next_multiple_of(4), 0);
                wanted.extend(indices.iter().map(|&i| mask[i]));
            }
            let found = made.staged(&volume, slab.region);
            assert_eq!(found.len() as u64, made.staging_bytes(slab.region));
            assert!(found.starts_with(&wanted), "{layout:?} {slab:?}");
            assert!(found.len() - wanted.len() < 4, "{layout:?} {slab:?}");
        }
    }
}

#[test]
fn bytes_are_staged_in_the_order_of_every_texture() {
    let number = |i: usize| (i * 7 % 251) as u8;
    let texel = |i: usize, bytes: usize| match bytes {
        4 => f32::from(number(i)).to_le_bytes().to_vec(),
        bytes => vec![number(i); bytes],
    };
    assert_staged(Voxels::U8((0..count()).map(number).collect()), None, texel);
}

#[test]
fn words_and_what_is_valid_of_them_are_staged_side_by_side() {
    let is_hole = |i: usize| i.is_multiple_of(5);
    let number = |i: usize| {
        if is_hole(i) {
            9999
        } else {
            (i * 31 % 5000) as u16
        }
    };
    let voxels = Voxels::U16((0..count()).map(number).collect());
    // Holes are filled with what is next to them: asked of the volume itself.
    let filled = Volume::from_voxels(
        DIMS,
        DAffine3::IDENTITY,
        voxels.clone(),
        Rescale::default(),
        Some(9999.0),
    );
    let filled = filled.expect("a volume").voxels;
    let texel = |i: usize, bytes: usize| match bytes {
        2 => (filled.stored(i) as u16).to_le_bytes().to_vec(),
        _ => filled.stored(i).to_le_bytes().to_vec(),
    };
    assert_staged(voxels, Some(9999.0), texel);
}
