//! The harness of mutated files: what every reader must survive.
#![allow(dead_code, reason = "each test program uses a part of it")]

use crate::files::Folder;
use crate::memory;
use crate::mutate::{self, Mutation, Random};
use std::panic::{AssertUnwindSafe, catch_unwind};
use stratavox::format;
use stratavox::volume::{Limits, ReadError, TimeComponent, VolumeSelection};

/// Small, so that a lie shows.
pub const LIMITS: Limits = Limits {
    max_bytes: 4 << 20,
    max_files: 100,
    max_header_bytes: 1 << 16,
    detached: true,
};

/// What a read may take beyond the volume.
const BESIDE_BYTES: usize = 64 << 20;

/// Files that belong together; the first is opened.
pub type Base = Vec<(&'static str, Vec<u8>)>;

/// Reads all of a mutated file, one time and component after the other. Gives the number of voxels read.
pub fn read_all(folder: &Folder, base: &Base) -> Result<u64, ReadError> {
    // Slices are opened as the folder that they lie in.
    let opened = if base[0].0 == "slice0.dcm" {
        ""
    } else {
        base[0].0
    };
    let source = format::open(&folder.path(opened), &VolumeSelection::default(), &LIMITS)?;
    let header = source.header();
    assert!(header.world_from_voxel.inverse().is_finite(), "{header:?}");
    let mut voxels = 0;
    for time in 0..header.times.min(4) {
        for component in 0..header.components.min(4) {
            let piece = source.read(TimeComponent { time, component }, header.whole())?;
            assert_eq!(piece.voxels.len() as u64, header.voxel_count(), "voxels");
            voxels += header.voxel_count();
        }
    }
    Ok(voxels)
}

/// How many mutations of each reader there are: `STRATAVOX_MUTATIONS`, else 5 000, and 20 000 in long sweeps.
pub fn mutations() -> u64 {
    match std::env::var("STRATAVOX_MUTATIONS") {
        Ok(number) => number.parse().expect("STRATAVOX_MUTATIONS is a number"),
        Err(_) if crate::sweep::is_long() => 20_000,
        Err(_) => 5_000,
    }
}

/// Mutates the bases of one reader in turn.
pub fn survive(reader: &str, bases: &[Base]) {
    let count = mutations();
    let folder = Folder::new();
    let mut whole = Vec::new();
    for base in bases {
        for (name, bytes) in base {
            folder.write(name, bytes);
        }
        let voxels = read_all(&folder, base).unwrap_or_else(|e| panic!("{reader}: {e}"));
        whole.push(voxels);
    }
    let (mut refused, mut read, mut worst_memory) = (0_u64, 0_u64, 0_usize);
    for number in 0..count {
        let which = (number % bases.len() as u64) as usize;
        let base = &bases[which];
        let mut random = Random::new(number);
        let (name, bytes) = &base[random.below(base.len())];
        let (mutated, mutation) = mutate::mutate(bytes, &mut random);
        folder.write(name, &mutated);
        memory::start();
        let outcome = catch_unwind(AssertUnwindSafe(|| read_all(&folder, base)));
        let memory = memory::peak_since_start();
        worst_memory = worst_memory.max(memory);
        let failed = |what: &str| -> ! {
            let kept = std::env::temp_dir().join(format!("stratavox-mutation-{reader}-{number}"));
            std::fs::write(&kept, &mutated).unwrap();
            panic!("{reader} mutation {number} ({mutation:?} of {name}): {what}; kept as {kept:?}");
        };
        let Ok(outcome) = outcome else {
            failed("a panic");
        };
        if memory > LIMITS.max_bytes as usize + BESIDE_BYTES {
            failed(&format!("{memory} bytes of memory"));
        }
        match outcome {
            Err(_) => refused += 1,
            Ok(voxels) => {
                read += 1;
                // Every base ends with its last voxel, or with a line end that carries nothing.
                let lost = bytes.len().saturating_sub(mutated.len());
                if mutation == Mutation::Cut && lost > 1 {
                    failed("a volume out of a file that was cut");
                }
                // Less than one bit a voxel cannot be voxels, unless they are compressed: there the checksum tells.
                let present: usize = base
                    .iter()
                    .map(|(name, _)| {
                        std::fs::metadata(folder.path(name)).map_or(0, |m| m.len() as usize)
                    })
                    .sum();
                if voxels > whole[which] && voxels as usize > 1032 * present {
                    failed("more voxels than the bytes can hold");
                }
            }
        }
        folder.write(name, bytes);
    }
    println!(
        "{reader}: {count} mutations, {refused} refused, {read} read, at most {worst_memory} bytes of memory"
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
