//! New voxels of a box of a volume that is drawn: the picture is to the bit that of a new volume.

use crate::embed_shared::{Host, HostImage};
use crate::mutate::Random;
use ash::vk;
use glam::{DVec3, dvec3};
use half::f16;
use std::sync::Arc;
use stratavox::camera::Camera;
use stratavox::embed::{Error, FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{Caps, Load};
use stratavox::technique::{Filter, Mode, Order, Settings, Technique};
use stratavox::volume::{self, Rescale, VoxelBox, VoxelPart, VoxelType, Voxels};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const EXTENT: [u32; 2] = [40, 33];
/// Several macro cells along each axis, several cubes of corners, and whole numbers of neither.
const DIMS: [u32; 3] = [37, 22, 27];

const STORED: [VoxelType; 6] = [
    VoxelType::U8,
    VoxelType::I8,
    VoxelType::U16,
    VoxelType::I16,
    VoxelType::F16,
    VoxelType::F32,
];

/// Numbers from 0 to 1 as stored ones, and what makes values of them again.
fn stored(kind: VoxelType, values: &[f64]) -> (Voxels, Rescale) {
    let codes = |first: f64, last: f64| {
        let slope = 1.0 / (last - first);
        let rescale = Rescale {
            slope,
            intercept: -first * slope,
        };
        let code = move |value: &f64| (first + value * (last - first)).round();
        (values.iter().map(code), rescale)
    };
    let floats = Rescale::default();
    match kind {
        VoxelType::U8 => {
            let (codes, rescale) = codes(0.0, 255.0);
            (Voxels::U8(codes.map(|c| c as u8).collect()), rescale)
        }
        VoxelType::I8 => {
            let (codes, rescale) = codes(-128.0, 127.0);
            (Voxels::I8(codes.map(|c| c as i8).collect()), rescale)
        }
        VoxelType::U16 => {
            let (codes, rescale) = codes(0.0, 65535.0);
            (Voxels::U16(codes.map(|c| c as u16).collect()), rescale)
        }
        VoxelType::I16 => {
            let (codes, rescale) = codes(-32768.0, 32767.0);
            (Voxels::I16(codes.map(|c| c as i16).collect()), rescale)
        }
        VoxelType::F16 => {
            let halves = values.iter().map(|&v| f16::from_f64(v)).collect();
            (Voxels::F16(halves), floats)
        }
        _ => {
            let numbers = values.iter().map(|&v| v as f32).collect();
            (Voxels::F32(numbers), floats)
        }
    }
}

/// A volume as a host keeps it, to be changed box by box.
struct Kept {
    values: Vec<f64>,
    mask: Option<Vec<u8>>,
    kind: VoxelType,
}

impl Kept {
    /// A ball in empty space.
    fn new(kind: VoxelType, has_holes: bool) -> Self {
        let middle = DVec3::from_array(DIMS.map(f64::from)) / 2.0;
        let value = |p: DVec3| (0.9 - 0.07 * p.distance(middle)).max(0.0);
        let values: Vec<_> = all().map(|[x, y, z]| value(at(x, y, z))).collect();
        let hole = |[x, y, z]: [u32; 3]| u8::from((x + 2 * y + 3 * z) % 17 != 0);
        Self {
            mask: has_holes.then(|| all().map(hole).collect()),
            values,
            kind,
        }
    }

    /// Other values, and other holes, in a box.
    fn change(&mut self, region: VoxelBox, random: &mut Random) {
        let (empty, level) = (random.below(3) == 0, random.below(80) as f64 / 100.0);
        for (i, [x, y, z]) in all().enumerate() {
            let p = [x, y, z];
            if (0..3).all(|k| (region.min[k]..region.max[k]).contains(&p[k])) {
                let noise = random.below(21) as f64 / 100.0;
                self.values[i] = if empty { 0.0 } else { level + noise };
                if let Some(mask) = &mut self.mask {
                    mask[i] = u8::from(random.below(9) > 0);
                }
            }
        }
    }

    fn volume(&self) -> volume::Volume {
        let (voxels, rescale) = stored(self.kind, &self.values);
        let affine = crate::shared::sheared_affine();
        let mut made = volume::Volume::from_voxels(DIMS, affine, voxels, rescale, None).unwrap();
        made.validity = self.mask.clone();
        // As large as it will be needed.
        made.value_range = [0.0, 1.0];
        made
    }
}

fn all() -> impl Iterator<Item = [u32; 3]> {
    let [nx, ny, nz] = DIMS;
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

fn at(x: u32, y: u32, z: u32) -> DVec3 {
    dvec3(x.into(), y.into(), z.into()) + 0.5
}

/// Any box: often at an edge of the volume, of a cell, of a cube of corners; sometimes one voxel, or all.
fn any_box(random: &mut Random) -> VoxelBox {
    let mut found = VoxelBox {
        min: [0; 3],
        max: DIMS,
    };
    for (k, dim) in DIMS.into_iter().enumerate() {
        let dim = dim as usize;
        let at = |random: &mut Random| match random.below(4) {
            0 => (random.below(6) * 8).min(dim - 1),
            1 => [0, dim - 1][random.below(2)],
            _ => random.below(dim),
        };
        let (a, b) = (at(random), at(random));
        found.min[k] = a.min(b) as u32;
        found.max[k] = a.max(b) as u32 + 1;
        if random.below(5) == 0 {
            found.max[k] = found.min[k] + 1;
        }
    }
    found
}

fn class(settings: &Settings) -> RendererDesc {
    RendererDesc {
        settings: settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 2,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    }
}

fn uploaded(host: &Host, voxels: &volume::Volume, settings: &Settings) -> Arc<Volume> {
    let mut made = Volume::new(host.gpu(), voxels, settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { made.record_upload(host.gpu(), cmd).unwrap() });
    Arc::new(made)
}

fn renderer(host: &Host, volume: &Arc<Volume>, settings: &Settings) -> Renderer {
    let function = crate::shared::ramps();
    let class = class(settings);
    Renderer::new(host.gpu(), volume, Some(&function), class, EXTENT, &[]).unwrap()
}

/// A frame into an image that is copied from.
///
/// # Safety
/// As `record_into`.
unsafe fn record(
    cmd: vk::CommandBuffer,
    renderer: &mut Renderer,
    camera: &Camera,
    frame: u32,
    image: &HostImage,
) {
    let depth = None;
    let shot = FrameInfo {
        frame,
        camera,
        depth,
    };
    let load = Load::Clear([0.0; 4]);
    // SAFETY: the caller's promise.
    unsafe {
        renderer
            .record_into(cmd, &shot, &image.target(), load)
            .unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    }
}

fn picture(host: &Host, renderer: &mut Renderer, camera: &Camera) -> Vec<[f64; 4]> {
    let image = HostImage::new(host, FORMAT, EXTENT);
    // SAFETY: `run` waits.
    host.run(|cmd| unsafe { record(cmd, renderer, camera, 0, &image) });
    image.numbers()
}

/// Changes a volume several times while it is drawn, and compares with new ones.
fn changes(host: &Host, settings: &Settings, mut kept: Kept, seed: usize) {
    let mut random = Random::new(seed as u64);
    let first = kept.volume();
    let grid = first.grid();
    let camera = crate::shared::oblique_camera(&grid, crate::shared::projections(&grid)[seed % 2]);
    let there = uploaded(host, &first, settings);
    let mut renderer = renderer(host, &there, settings);
    let mut before = picture(host, &mut renderer, &camera);
    let mut as_new = self::renderer(host, &there, settings);
    let mut differing = 0;
    for n in 0..3 {
        let region = any_box(&mut random);
        kept.change(region, &mut random);
        let changed = kept.volume();
        let made = host.gpu().pipelines_made();
        let update = there.stage_update(region, (&changed).into()).unwrap();
        let images = [(); 2].map(|()| HostImage::new(host, FORMAT, EXTENT));
        // One recording: what is drawn before the update and after it has no other order than our barriers.
        // SAFETY: recorded in the order of submission; `run` waits.
        host.run(|cmd| unsafe {
            record(cmd, &mut renderer, &camera, 0, &images[0]);
            there.record_update(cmd, update).unwrap();
            record(cmd, &mut renderer, &camera, 1, &images[1]);
        });
        let what = format!("{region:?} of {:?}, update {n}: {settings:?}", kept.kind);
        let [old, new] = images.map(|image| image.numbers());
        assert!(old == before, "the frame before has changed: {what}");
        assert_eq!(host.gpu().pipelines_made(), made, "compiled: {what}");
        let fresh = uploaded(host, &changed, settings);
        let function = crate::shared::ramps();
        as_new.set_volume(&fresh, Some(&function)).unwrap();
        let wanted = picture(host, &mut as_new, &camera);
        let off = new.iter().zip(&wanted).filter(|(f, w)| f != w).count();
        assert_eq!(off, 0, "pixels unlike those of a new volume: {what}");
        differing += usize::from(new != old);
        before = new;
    }
    assert!(differing > 0, "no update shows: {settings:?}");
}

fn ways() -> Vec<Settings> {
    let rays = [Mode::Composite, Mode::Mip].map(|mode| Settings {
        mode,
        ..Settings::default()
    });
    let filters = [Filter::Nearest, Filter::CatmullRom].map(|filter| Settings {
        filter,
        ..Settings::default()
    });
    let slices = [Technique::Slices3d, Technique::Slices2d].map(|technique| Settings {
        technique,
        order: Order::BackToFront,
        ..Settings::default()
    });
    rays.into_iter().chain(filters).chain(slices).collect()
}

#[test]
fn an_updated_volume_is_drawn_as_a_new_one() {
    let host = Host::new();
    for (seed, settings) in ways().iter().enumerate() {
        for (k, kind) in STORED.into_iter().enumerate() {
            let has_holes = (seed + k) % 3 == 0;
            changes(&host, settings, Kept::new(kind, has_holes), 10 * seed + k);
        }
    }
}

#[test]
fn a_volume_in_bricks_is_updated_with_its_halos() {
    let host = Host::with_caps(Caps {
        max_image_dimension_3d: 14,
        max_image_array_layers: 11,
        ..Caps::UNLIMITED
    });
    for (seed, settings) in ways().iter().enumerate() {
        for (k, kind) in [VoxelType::U8, VoxelType::I16, VoxelType::F32]
            .into_iter()
            .enumerate()
        {
            let kept = Kept::new(kind, seed % 2 == 0);
            changes(&host, settings, kept, 100 + 10 * seed + k);
        }
    }
}

#[test]
fn a_box_that_ends_where_a_cell_does_is_seen_from_the_cells_beside() {
    let host = Host::new();
    // Between two voxels a half of the matter is seen, and the second is of an empty cell.
    let filters = [Filter::Linear, Filter::CatmullRom];
    for (filter, kind) in filters.into_iter().zip([VoxelType::U8, VoxelType::F32]) {
        let settings = Settings {
            filter,
            ..Settings::default()
        };
        let mut kept = Kept::new(kind, false);
        kept.values.fill(0.0);
        let empty = kept.volume();
        let camera = crate::shared::oblique_camera(
            &empty.grid(),
            crate::shared::projections(&empty.grid())[1],
        );
        let region = VoxelBox {
            min: [8; 3],
            max: [16; 3],
        };
        for (value, p) in kept.values.iter_mut().zip(all()) {
            if p.iter().all(|n| (8..16).contains(n)) {
                *value = 0.9;
            }
        }
        let changed = kept.volume();
        let there = uploaded(&host, &empty, &settings);
        let mut drawn = renderer(&host, &there, &settings);
        let before = picture(&host, &mut drawn, &camera);
        let update = there.stage_update(region, (&changed).into()).unwrap();
        // SAFETY: `run` waits.
        host.run(|cmd| unsafe { there.record_update(cmd, update).unwrap() });
        let found = picture(&host, &mut drawn, &camera);
        let fresh = uploaded(&host, &changed, &settings);
        let wanted = picture(&host, &mut renderer(&host, &fresh, &settings), &camera);
        assert!(before != wanted && found == wanted, "{filter:?}");
    }
}

#[test]
fn no_more_voxels_are_looked_at_than_those_that_are_named() {
    let host = Host::new();
    let (settings, mut random) = (Settings::default(), Random::new(7));
    for kind in [VoxelType::U8, VoxelType::U16, VoxelType::F32] {
        let mut kept = Kept::new(kind, false);
        let there = uploaded(&host, &kept.volume(), &settings);
        let mut drawn = renderer(&host, &there, &settings);
        let region = VoxelBox {
            min: [13, 8, 9],
            max: [17, 11, 12],
        };
        kept.change(region, &mut random);
        let changed = kept.volume();
        let reads = there.update_reads(region).unwrap();
        assert!(region.is_in(&reads) && reads != VoxelPart::from(&changed).held);
        let inside = |[x, y, z]: [u32; 3]| {
            let p = [x, y, z];
            (0..3).all(|k| (reads.min[k]..reads.max[k]).contains(&p[k]))
        };
        let chosen = all().zip(&kept.values).filter(|(p, _)| inside(*p));
        let values: Vec<_> = chosen.map(|(_, &value)| value).collect();
        let (voxels, _) = stored(kind, &values);
        let part = VoxelPart {
            held: reads,
            voxels: &voxels,
            validity: None,
        };
        let update = there.stage_update(region, part).unwrap();
        // SAFETY: `run` waits.
        host.run(|cmd| unsafe { there.record_update(cmd, update).unwrap() });
        let camera = crate::shared::oblique_camera(
            there.grid(),
            crate::shared::projections(there.grid())[0],
        );
        let fresh = uploaded(&host, &changed, &settings);
        let wanted = picture(&host, &mut renderer(&host, &fresh, &settings), &camera);
        assert!(picture(&host, &mut drawn, &camera) == wanted, "{kind:?}");
    }
}

#[test]
fn what_is_staged_lives_until_the_update_has_run() {
    let host = Host::with_timeline();
    let gpu = host.gpu();
    let (settings, mut kept) = (Settings::default(), Kept::new(VoxelType::U8, false));
    let there = uploaded(&host, &kept.volume(), &settings);
    // SAFETY: the upload was waited for.
    unsafe { gpu.retire(0) };
    let before = gpu.live_objects();
    let region = any_box(&mut Random::new(3));
    kept.change(region, &mut Random::new(4));
    let update = there.stage_update(region, (&kept.volume()).into()).unwrap();
    gpu.announce(1);
    let staged = gpu.live_objects();
    assert_ne!(staged, before);
    // SAFETY: `run` waits.
    unsafe {
        host.run(|cmd| there.record_update(cmd, update).unwrap());
        gpu.retire(0);
        assert_eq!(gpu.live_objects(), staged, "gone before it was done");
        gpu.retire(1);
    }
    assert_eq!(gpu.live_objects(), before, "never destroyed");
}

#[test]
fn what_a_volume_does_not_take_is_refused_by_name() {
    let host = Host::new();
    let settings = Settings::default();
    let kept = Kept::new(VoxelType::U8, false);
    let right = kept.volume();
    let there = uploaded(&host, &right, &settings);
    let region = VoxelBox {
        min: [3, 4, 5],
        max: [9, 6, 8],
    };
    let refused = |region: VoxelBox, part: VoxelPart| {
        let staged = there.stage_update(region, part).map(drop);
        staged.expect_err("refused").to_string()
    };
    let (nothing, outside) = (
        VoxelBox {
            max: region.min,
            ..region
        },
        VoxelBox {
            max: [38, 22, 27],
            ..region
        },
    );
    let part = VoxelPart::from(&right);
    let small = VoxelPart {
        held: VoxelBox {
            max: [9, 6, 7],
            ..region
        },
        ..part
    };
    let (wide, _) = stored(VoxelType::U16, &kept.values);
    let mask: Vec<u8> = all().map(|p| u8::from(p != [4, 5, 6])).collect();
    for (text, found) in [
        ("a box of one voxel or more in", refused(nothing, part)),
        ("found from [3, 4, 5] to before [38", refused(outside, part)),
        ("which the update looks at", refused(region, small)),
        (
            "wanted voxels of u8, found voxels of u16",
            refused(
                region,
                VoxelPart {
                    voxels: &wide,
                    ..part
                },
            ),
        ),
        (
            "voxels, and as many bytes of a mask",
            refused(
                region,
                VoxelPart {
                    validity: Some(&mask[1..]),
                    ..part
                },
            ),
        ),
        (
            "holes in a volume without",
            refused(
                region,
                VoxelPart {
                    validity: Some(&mask),
                    ..part
                },
            ),
        ),
    ] {
        assert!(found.contains(text), "wanted {text}, found: {found}");
    }
    // Values outside of what the volume was made with, and what is no number.
    for bad in [1.5, f64::NAN] {
        let mut floats = Kept::new(VoxelType::F32, false);
        let there = uploaded(&host, &floats.volume(), &settings);
        let inside = all().position(|p| p == [4, 5, 6]).unwrap();
        floats.values[inside] = bad;
        let (voxels, _) = stored(VoxelType::F32, &floats.values);
        let part = VoxelPart {
            voxels: &voxels,
            ..part
        };
        let found = there.stage_update(region, part).expect_err("outside");
        assert!(found.to_string().contains("values from 0 to 1"), "{found}");
    }
    let cubic = Settings {
        filter: Filter::Cubic,
        ..Settings::default()
    };
    let splines = uploaded(&host, &right, &cubic);
    let found = splines.stage_update(region, part).map(drop);
    assert!(matches!(found, Err(Error::NotEmbedded { .. })), "{found:?}");
    // An update of another volume, and one before the upload.
    let other = Volume::new(host.gpu(), &right, &settings).unwrap();
    let (update, early) = (
        there.stage_update(region, part).unwrap(),
        other.stage_update(region, part).unwrap(),
    );
    // SAFETY: nothing is recorded.
    unsafe {
        let cmd = vk::CommandBuffer::null();
        let found = other.record_update(cmd, update);
        assert!(matches!(found, Err(Error::Update { .. })), "{found:?}");
        let found = other.record_update(cmd, early);
        assert!(matches!(found, Err(Error::NotUploaded)), "{found:?}");
    }
}
