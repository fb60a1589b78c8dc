//! Mutated Zarr stores: no panic, no memory in proportion to a lie, no volume out of a file that was cut.
//!
//! `STRATAVOX_MUTATIONS` is the number of mutations, 20 000 where it is not set. The same number gives the same
//! mutations; a failure prints the number of the one that failed and keeps its file.

use crate::mutate::{Mutation, Random};
use crate::zarr::Store;
use std::panic::{AssertUnwindSafe, catch_unwind};
use stratavox::format;
use stratavox::volume::{Limits, ReadError, TimeComponent, VolumeSelection};

/// Small, so that a lie shows.
const LIMITS: Limits = Limits {
    max_bytes: 4 << 20,
    max_files: 1000,
    max_header_bytes: 1 << 16,
    detached: true,
};

/// What a read may take beyond the volume.
const BESIDE_BYTES: usize = 64 << 20;

const BASES: [&str; 23] = [
    "v2-type-i2-big",
    "v2-zlib",
    "v2-bz2",
    "v2-zstd-checksum",
    "v2-lz4",
    "v2-blosc-lz4-1",
    "v2-blosc-zstd-2",
    "v2-blosc-zlib-0",
    "v2-blosc-blosclz-1",
    "v2-blosclz-runs",
    "v2-fortran",
    "v2-shuffle",
    "v2-delta-f8",
    "v2-absent-nan",
    "v2-group-consolidated",
    "v3-zstd-crc32c",
    "v3-transpose",
    "v3-shards-start",
    "v3-shards-gaps",
    "ngff-0.4",
    "ngff-0.5",
    "weather-v2",
    "weather-v3",
];

/// Reads the first times and components of a store. Gives the number of voxels read.
fn read_all(store: &Store) -> Result<u64, ReadError> {
    let source = format::open(&store.path(), &VolumeSelection::default(), &LIMITS)?;
    let header = source.header();
    assert!(header.world_from_voxel.inverse().is_finite(), "{header:?}");
    let mut voxels = 0;
    for time in 0..header.times.min(3) {
        for component in 0..header.components.min(3) {
            let piece = source.read(TimeComponent { time, component }, header.whole())?;
            assert_eq!(piece.voxels.len() as u64, header.voxel_count(), "voxels");
            voxels += header.voxel_count();
        }
    }
    Ok(voxels)
}

#[test]
fn zarr_survives_mutations() {
    let count = crate::survive::mutations();
    let bases = BASES.map(|name| (name, crate::zarr::files(name), Store::of(name)));
    for (name, _, store) in &bases {
        read_all(store).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
    let (mut refused, mut read, mut worst_memory) = (0_u64, 0_u64, 0_usize);
    for number in 0..count {
        let (name, files, store) = &bases[(number % bases.len() as u64) as usize];
        let mut random = Random::new(number);
        let (key, bytes) = &files[random.below(files.len())];
        let (mutated, mutation) = crate::mutate::mutate(bytes, &mut random);
        store.write(key, &mutated);
        crate::memory::start();
        let outcome = catch_unwind(AssertUnwindSafe(|| read_all(store)));
        let memory = crate::memory::peak_since_start();
        worst_memory = worst_memory.max(memory);
        let failed = |what: &str| -> ! {
            let kept = std::env::temp_dir().join(format!("stratavox-mutation-zarr-{number}"));
            std::fs::write(&kept, &mutated).unwrap();
            panic!("mutation {number} ({mutation:?} of {key} of {name}): {what}; kept as {kept:?}");
        };
        let Ok(outcome) = outcome else {
            failed("a panic");
        };
        if memory > LIMITS.max_bytes as usize + BESIDE_BYTES {
            failed(&format!("{memory} bytes of memory"));
        }
        match outcome {
            Err(_) => refused += 1,
            Ok(_) => {
                read += 1;
                // Of a group or an image not every array is read.
                let is_read = !name.starts_with("ngff")
                    && !name.contains("group")
                    && !name.contains("weather");
                if mutation == Mutation::Cut && is_read && mutated.len() < bytes.len() {
                    failed("a volume out of a file that was cut");
                }
            }
        }
        store.write(key, bytes);
    }
    println!(
        "zarr: {count} mutations, {refused} refused, {read} read, at most {worst_memory} bytes of memory"
    );
    assert_eq!(refused + read, count);
    assert!(
        refused > count / 4,
        "{refused} of {count} refused: the mutations do no harm"
    );
    assert!(
        read > 0 || count < 1000,
        "nothing was read: the mutations do only harm"
    );
}
