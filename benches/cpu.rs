//! What work on the CPU takes: CPU references, decoding, and the tables of transfer functions.

mod median;

use flate2::{Compression, write::GzEncoder};
use median::median_of;
use std::error::Error;
use std::io::Write;
use std::path::Path;
use stratavox::camera::{BoundingSphere, Camera, Lens, View};
use stratavox::format;
use stratavox::offscreen::reference;
use stratavox::picture::ColorSpace;
use stratavox::scene::Scene;
use stratavox::technique::{Settings, Technique};
use stratavox::transfer::{Absorption, Classified, Points, Table, Window};
use stratavox::volume::{Limits, TimeComponent, Volume, VolumeSelection, phantom};

const RUNS: usize = 5;
const SIDE: u32 = 128;
const EXTENT: [u32; 2] = [128, 128];

fn main() -> Result<(), Box<dyn Error>> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!("median of {RUNS}, {threads} threads");
    let limits = Limits::default();
    let name = format!("phantom:head,n={SIDE}");
    let source = phantom::open(&name, &limits)?;
    let read = || {
        Volume::read(
            source.as_ref(),
            TimeComponent::default(),
            source.header().whole(),
            &limits,
        )
    };
    line(&name, median_of(RUNS, read));
    let volume = read()?;
    references(&volume)?;
    decoding()?;
    tables(&volume);
    Ok(())
}

fn line(what: &str, ms: f64) {
    println!("{what:<64} {ms:>8.2} ms");
}

/// Each technique's CPU reference, in f32.
fn references(volume: &Volume) -> Result<(), Box<dyn Error>> {
    let bounds = BoundingSphere::of_grid(&volume.world_from_voxel, volume.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let facing = View::Left.orbit();
    let camera = Camera::orbit(&bounds, bounds.center, facing, None, lens, EXTENT)?;
    let transfer = Window::of_range(volume.value_range).grey(Classified::Samples);
    for technique in [Technique::Raycast, Technique::Slices3d, Technique::Slices2d] {
        let settings = Settings {
            technique,
            ..Settings::default()
        };
        let scene = Scene {
            beside: Default::default(),
            volume,
            transfer: Some(&transfer),
            camera: &camera,
            extent_pixels: EXTENT,
            settings: &settings,
        };
        let what = format!(
            "reference of {technique:?}, {:?} voxels, {EXTENT:?} pixels",
            volume.dims
        );
        line(&what, median_of(RUNS, || reference::render::<f32>(&scene)));
    }
    Ok(())
}

/// From files in the page cache to a volume in memory.
fn decoding() -> Result<(), Box<dyn Error>> {
    let voxels: Vec<u8> = (0..SIDE.pow(3))
        .flat_map(|i| ((97 * (i % SIDE) + i / SIDE) as u16).to_be_bytes())
        .collect();
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    gzip.write_all(&voxels)?;
    let nrrd = |encoding: &str, data: &[u8]| {
        let head = format!(
            "NRRD0004\ntype: uint16\ndimension: 3\nsizes: {SIDE} {SIDE} {SIDE}\nspacings: 1 1 1\nendian: big\nencoding: {encoding}\n\n"
        );
        [head.as_bytes(), data].concat()
    };
    let meta_image = format!(
        "ObjectType = Image\nNDims = 3\nDimSize = {SIDE} {SIDE} {SIDE}\nElementType = MET_USHORT\nBinaryDataByteOrderMSB = True\nElementDataFile = LOCAL\n"
    );
    let folder = tempfile::tempdir()?;
    let files = [
        ("raw.nrrd", nrrd("raw", &voxels)),
        ("gzip.nrrd", nrrd("gzip", &gzip.finish()?)),
        ("raw.mha", [meta_image.as_bytes(), &voxels].concat()),
    ];
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes)?;
        read(&path)?;
        let what = format!("{name}, {SIDE}^3 big-endian u16");
        line(&what, median_of(RUNS, || read(&path)));
    }
    Ok(())
}

fn read(path: &Path) -> Result<Volume, stratavox::volume::ReadError> {
    let limits = Limits::default();
    let source = format::open(path, &VolumeSelection::default(), &limits)?;
    Volume::read(
        source.as_ref(),
        TimeComponent::default(),
        source.header().whole(),
        &limits,
    )
}

/// What a new transfer function costs before it is uploaded.
fn tables(volume: &Volume) {
    let transfer = Window::of_range(volume.value_range).grey(Classified::Samples);
    let absorption = Absorption::Extinction {
        reference_length: volume.grid().smallest_spacing(),
    };
    let (table, points) = (
        || Table::new(&transfer, absorption, ColorSpace::Linear),
        || Points::new(&transfer, absorption, ColorSpace::Linear),
    );
    let what = format!("table of {} entries", table().entries.len());
    line(&what, median_of(RUNS, table));
    let what = format!("{} control points", points().entries.len());
    line(&what, median_of(RUNS, points));
}
