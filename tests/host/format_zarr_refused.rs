//! Zarr stores that are not read, each refused by what is wrong or by the name of what we do not know.

use crate::zarr::{Store, all, files};
use serde_json::{Value, json};
use std::time::Instant;
use stratavox::format;
use stratavox::volume::{Limits, VolumeSelection};

/// Changes one value of the metadata of a store of one array.
fn with(name: &str, pointer: &str, value: Value) -> Store {
    let store = Store::of(name);
    let file = if name.starts_with("v2") {
        ".zarray"
    } else {
        "zarr.json"
    };
    store.edit(file, |all| {
        if let Some(place) = all.pointer_mut(pointer) {
            *place = value;
        } else {
            let (parent, field) = pointer.rsplit_once('/').expect("a path");
            all.pointer_mut(parent).expect(parent)[field] = value;
        }
    });
    store
}

#[test]
fn features_that_are_not_read_are_named() {
    let codec = |name: &str| json!([{"name": "bytes", "configuration": {"endian": "little"}}, {"name": name}]);
    for (name, pointer, value, wanted) in [
        (
            "v2-zlib",
            "/compressor",
            json!({"id": "lzma"}),
            "the codec `lzma`",
        ),
        (
            "v2-zlib",
            "/filters",
            json!([{"id": "fixedscaleoffset"}]),
            "the codec `fixedscaleoffset`",
        ),
        (
            "v2-delta-i2",
            "/filters/0/astype",
            json!("<i1"),
            "the filter delta with another type, `<i2`",
        ),
        ("v2-zlib", "/dtype", json!("<c8"), "the dtype `<c8`"),
        ("v2-zlib", "/dtype", json!("<M8[ns]"), "the dtype `<M8[ns]`"),
        ("v2-zlib", "/dtype", json!("|O"), "the dtype `|O`"),
        (
            "v2-zlib",
            "/dtype",
            json!([["a", "<i2"]]),
            "the structured dtype",
        ),
        (
            "v3-gzip",
            "/data_type",
            json!("complex64"),
            "the data type `complex64`",
        ),
        ("v3-gzip", "/codecs", codec("lz4hc9"), "the codec `lz4hc9`"),
        (
            "v3-gzip",
            "/chunk_grid",
            json!({"name": "rectangular"}),
            "the chunk grid `rectangular`",
        ),
        (
            "v3-gzip",
            "/chunk_key_encoding",
            json!({"name": "hashed"}),
            "the chunk key encoding `hashed`",
        ),
        (
            "v3-gzip",
            "/storage_transformers",
            json!([{"name": "x"}]),
            "the storage transformer",
        ),
        (
            "v3-shards-end",
            "/codecs/0/configuration/codecs/0",
            json!({"name": "sharding_indexed"}),
            "shards in shards",
        ),
        (
            "v3-shards-end",
            "/codecs/0/configuration/index_codecs/1",
            json!({"name": "gzip"}),
            "the index codecs",
        ),
    ] {
        let message = with(name, pointer, value).refused();
        assert!(
            message.contains(wanted) && message.ends_with("is not supported"),
            "{name} {pointer}: {message}"
        );
    }
}

#[test]
fn metadata_that_cannot_be_are_refused_with_field_wanted_and_found() {
    for (name, pointer, value, wanted) in [
        (
            "v2-zlib",
            "/zarr_format",
            json!(4),
            "`zarr_format`: wanted 2, found `4`",
        ),
        (
            "v2-zlib",
            "/shape",
            json!([3, 0, 6]),
            "`shape`: wanted no axis without numbers, found `[3, 0, 6]`",
        ),
        (
            "v2-zlib",
            "/shape",
            json!([3, -1, 6]),
            "`shape`: wanted a list of whole numbers",
        ),
        (
            "v2-zlib",
            "/shape",
            json!([1u64 << 40, 1u64 << 40, 6]),
            "`shape`: wanted at most 16 axes and 2^64 bytes",
        ),
        (
            "v2-zlib",
            "/shape",
            json!(vec![1; 17]),
            "`shape`: wanted at most 16 axes",
        ),
        (
            "v2-zlib",
            "/chunks",
            json!([2, 3]),
            "`chunk shape`: wanted 3 numbers above 0",
        ),
        (
            "v2-zlib",
            "/chunks",
            json!([2, 0, 6]),
            "`chunk shape`: wanted 3 numbers above 0",
        ),
        ("v2-zlib", "/order", json!("K"), "`order`: wanted C or F"),
        (
            "v2-zlib",
            "/dimension_separator",
            json!(":"),
            "`dimension_separator`: wanted `.` or `/`",
        ),
        (
            "v2-zlib",
            "/fill_value",
            json!("AAAA"),
            "`fill_value`: wanted a number that a u16 holds",
        ),
        (
            "v2-zlib",
            "/fill_value",
            json!(65536),
            "`fill_value`: wanted a number that a u16 holds",
        ),
        (
            "v2-zlib",
            "/fill_value",
            json!(0.5),
            "`fill_value`: wanted a number that a u16 holds",
        ),
        (
            "v2-zlib",
            "/compressor",
            json!("zlib"),
            "`compressor`: wanted a JSON object with an `id`",
        ),
        (
            "v2-shuffle",
            "/filters/0/elementsize",
            json!(0),
            "`elementsize`: wanted 1 to 256",
        ),
        (
            "v3-gzip",
            "/node_type",
            json!("thing"),
            "`node_type`: wanted array or group",
        ),
        (
            "v3-gzip",
            "/codecs",
            json!([]),
            "`codecs`: wanted the codec `bytes` among them",
        ),
        (
            "v3-gzip",
            "/codecs/0/configuration/endian",
            json!("middle"),
            "`endian`: wanted little or big",
        ),
        (
            "v3-transpose",
            "/codecs/0/configuration/order",
            json!([0, 0, 1]),
            "`order`: wanted each of the 3 axes once",
        ),
        (
            "v3-transpose",
            "/codecs/0/configuration/order",
            json!([0, 1, 5]),
            "`order`: wanted each of the 3 axes once",
        ),
        (
            "v3-shards-end",
            "/codecs/0/configuration/chunk_shape",
            json!([3, 2, 3]),
            "`chunk shape`: wanted numbers that divide those of a shard",
        ),
        (
            "v3-shards-end",
            "/codecs/0/configuration/index_location",
            json!("middle"),
            "`index_location`: wanted start or end",
        ),
        (
            "v3-gzip",
            "/dimension_names",
            json!(["x"]),
            "`dimension names`: wanted 3 names",
        ),
    ] {
        let message = with(name, pointer, value).refused();
        assert!(message.contains(wanted), "{name} {pointer}: {message}");
    }
    let store = Store::of("v2-zlib");
    store.write(".zarray", b"{\"shape\": [");
    assert!(
        store.refused().contains("`metadata`: wanted a JSON object"),
        "{}",
        store.refused()
    );
}

#[test]
fn chunks_that_lie_are_refused_before_memory_is_taken() {
    let huge = 1_u64 << 31;
    for (name, pointer, value, wanted) in [
        // Two gigabytes in each chunk, and the files of a chunk of 72 bytes.
        (
            "v2-zlib",
            "/chunks",
            json!([1, huge, 1]),
            "were wanted, 72 came out",
        ),
        ("v2-bz2", "/chunks", json!([1, huge, 1]), "wanted"),
        ("v2-zstd", "/chunks", json!([1, huge, 1]), "wanted"),
        ("v2-lz4", "/chunks", json!([1, huge, 1]), "wanted"),
        (
            "v2-blosc-zstd-1",
            "/chunks",
            json!([1, huge / 2, 1]),
            "wanted",
        ),
        ("v2-type-u2-little", "/chunks", json!([1, huge, 1]), "found"),
        ("v2-zlib", "/chunks", json!([huge, huge, 1]), "the limit is"),
        (
            "v3-shards-end",
            "/codecs/0/configuration/chunk_shape",
            json!([1, 1, 1]),
            "found",
        ),
        // More files than anyone has.
        (
            "v2-type-u1-little",
            "/shape",
            json!([1000, 1000, 1000]),
            "at most 65536 files",
        ),
        (
            "v2-zlib",
            "/shape",
            json!([1u64 << 33, 1, 1]),
            "wanted axes of at most 2^32 - 1",
        ),
    ] {
        let store = with(name, pointer, value);
        let start = Instant::now();
        crate::memory::start();
        let message = store.refused();
        let bytes = crate::memory::peak_since_start();
        println!(
            "{name} {pointer}: {bytes} bytes, {:?}: {message}",
            start.elapsed()
        );
        assert!(message.contains(wanted), "{name}: {message}");
        assert!(bytes < 64 << 20, "{name}: {bytes} bytes of memory");
    }
}

#[test]
fn damaged_chunks_are_named() {
    for (name, file) in [
        ("v2-zlib", "0.0.0"),
        ("v2-gzip", "0.0.0"),
        ("v2-bz2", "0.0.0"),
        ("v2-zstd-checksum", "0.0.0"),
        ("v3-zstd-checksum", "c/0/0/0"),
        ("v3-crc32c", "c/0/0/0"),
        ("v3-zstd-crc32c", "c/0/0/0"),
    ] {
        let bytes = files(name)
            .into_iter()
            .find(|(key, _)| key == file)
            .unwrap()
            .1;
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x10;
            let store = Store::of(name);
            store.write(file, &damaged);
            // A few bits carry nothing: a time, a comment's flag. What is read is then what was written.
            let source = store.open().unwrap();
            if let Ok(numbers) = all(&*source) {
                assert_eq!(
                    numbers,
                    all(&*Store::of(name).open().unwrap()).unwrap(),
                    "{name} byte {place}"
                );
            }
        }
    }
}

#[test]
fn a_chunk_that_is_cut_anywhere_is_refused() {
    let mut cuts = 0;
    for (name, file) in [
        ("v2-zlib", "0.0.0"),
        ("v2-bz2", "0.0.0"),
        ("v2-zstd", "0.0.0"),
        ("v2-lz4", "0.0.0"),
        ("v2-blosc-zstd-1", "0.0.0"),
        ("v2-blosc-blosclz-1", "0.0.0"),
        ("v2-blosc-lz4-0", "0.0.0"),
        ("v2-blosc-memcpy", "0.0.0"),
        ("v2-type-f4-big", "0.0.0"),
        ("v3-crc32c", "c/0/0/0"),
        ("v3-shards-end", "c/0/0/0"),
        ("v3-shards-start", "c/0/0/0"),
        ("v3-shards-gaps", "c/0/0/0"),
    ] {
        let bytes = files(name)
            .into_iter()
            .find(|(key, _)| key == file)
            .unwrap()
            .1;
        let store = Store::of(name);
        for cut in 0..bytes.len() {
            store.write(file, &bytes[..cut]);
            let message = store.refused();
            assert!(message.contains("zarr"), "{name} cut at {cut}: {message}");
            cuts += 1;
        }
    }
    println!("{cuts} cuts");
}

#[test]
fn a_shard_whose_index_is_wrong_is_refused() {
    let name = "v3-shards-end";
    let bytes = files(name)
        .into_iter()
        .find(|(key, _)| key == "c/0/0/0")
        .unwrap()
        .1;
    let index = bytes.len() - (8 * 16 + 4);
    // One bit of the index: the checksum tells.
    let mut damaged = bytes.clone();
    damaged[index + 3] ^= 1;
    let store = Store::of(name);
    store.write("c/0/0/0", &damaged);
    assert!(
        store.refused().contains("crc32c of the shard's index"),
        "{}",
        store.refused()
    );
    // Without a checksum, a chunk behind the end of the file, and one that ends there.
    let name = "v3-shards-gaps";
    let bytes = files(name)
        .into_iter()
        .find(|(key, _)| key == "c/0/0/0")
        .unwrap()
        .1;
    let count = 8;
    let index = bytes.len() - count * 16;
    let is_there = |entry: &usize| bytes[index + entry * 16..][..8] != [0xff; 8];
    let entry = (0..count).find(is_there).unwrap() * 16 + index;
    for (start, length) in [
        (u64::MAX - 1, 4_u64),
        (1 << 40, 4),
        (0, 1 << 40),
        (bytes.len() as u64 - 3, 4),
    ] {
        let mut damaged = bytes.clone();
        damaged[entry..entry + 8].copy_from_slice(&start.to_le_bytes());
        damaged[entry + 8..entry + 16].copy_from_slice(&length.to_le_bytes());
        let store = Store::of(name);
        store.write("c/0/0/0", &damaged);
        let message = store.refused();
        assert!(
            message.contains("`chunk`: wanted"),
            "{start} {length}: {message}"
        );
    }
}

#[test]
fn bombs_stop_at_the_length_of_a_chunk() {
    use std::io::Write;
    let zeros = vec![0_u8; 64 << 20];
    let zlib = {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
        encoder.write_all(&zeros).unwrap();
        encoder.finish().unwrap()
    };
    let lz4 = [
        &(64_u32 << 20).to_le_bytes()[..],
        &lz4_flex::block::compress(&zeros),
    ]
    .concat();
    drop(zeros);
    for (name, bomb) in [("v2-zlib", zlib), ("v2-lz4", lz4)] {
        let store = Store::of(name);
        store.write("0.0.0", &bomb);
        crate::memory::start();
        let message = store.refused();
        let bytes = crate::memory::peak_since_start();
        assert!(
            bytes < 4 << 20,
            "{name}: {bytes} bytes of memory: {message}"
        );
        // The file alone is too long for its chunk.
        assert!(
            message.contains("`chunk`: wanted at most"),
            "{name}: {message}"
        );
    }
    // A short file that stands for much: a run of zeros in blosclz, a frame of zstd that repeats one byte.
    let frame = [
        &[0x28, 0xb5, 0x2f, 0xfd, 0x00, 0x58][..],
        &[0x02, 0x00, 0x80, 0x00].repeat(200),
        &[0x03, 0, 0, 0],
    ]
    .concat();
    let store = Store::of("v2-zstd");
    store.write("0.0.0", &frame);
    crate::memory::start();
    let message = store.refused();
    assert!(message.contains("zstd"), "{message}");
    assert!(
        crate::memory::peak_since_start() < 64 << 20,
        "{} bytes",
        crate::memory::peak_since_start()
    );
}

#[test]
#[cfg(unix)]
fn nothing_outside_of_the_folder_is_read() {
    use std::os::unix::fs::symlink;
    let outside = Store::of("v2-zlib");
    let chunk = outside.path().join("0.0.0");
    // A chunk that is a link out, a link to itself, a link to nothing, a pipe, a folder.
    type Spoil<'a> = (&'static str, &'a dyn Fn(&std::path::Path));
    let spoil: [Spoil; 5] = [
        ("not a link out of it", &|path| {
            symlink(&chunk, path).unwrap()
        }),
        ("looking for the file", &|path| symlink(path, path).unwrap()),
        ("looking for the file", &|path| {
            symlink("/nowhere/at/all", path).unwrap()
        }),
        ("a pipe", &|path| {
            assert!(
                std::process::Command::new("mkfifo")
                    .arg(path)
                    .status()
                    .unwrap()
                    .success()
            );
        }),
        ("a folder", &|path| std::fs::create_dir(path).unwrap()),
    ];
    for (wanted, spoil) in spoil {
        let store = Store::of("v2-zlib");
        let path = store.path().join("0.0.0");
        std::fs::remove_file(&path).unwrap();
        spoil(&path);
        let message = store.refused();
        assert!(message.contains(wanted), "{message}");
    }
    // Groups that are links are not followed, those that go round neither.
    let store = Store::of("v2-group");
    symlink(outside.path(), store.path().join("other")).unwrap();
    symlink(store.path(), store.path().join("deep/round")).unwrap();
    assert_eq!(store.open().unwrap().header().variables, ["a", "deep/er/b"]);
    // Paths in consolidated metadata that leave the folder.
    for path in ["../x", "/etc", "a/../../x", "a\u{1b}[2J"] {
        let store = Store::of("v2-group-consolidated");
        store.edit(".zmetadata", |all| {
            let array = all["metadata"]["a/.zarray"].clone();
            all["metadata"][format!("{path}/.zarray")] = array;
        });
        let message = store.refused();
        assert!(
            message.contains("`path`: wanted the path of a node"),
            "{path}: {message}"
        );
        assert!(message.chars().all(|c| !c.is_control()), "{message:?}");
    }
}

#[test]
fn headers_longer_than_the_limit_are_not_read() {
    let store = Store::of("v2-zlib");
    let limits = Limits {
        max_header_bytes: 100,
        ..Limits::default()
    };
    let refused = format::open(&store.path(), &VolumeSelection::default(), &limits).map(|_| ());
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("the header needs"), "{message}");
}

#[test]
fn a_read_takes_the_volume_and_one_chunk_and_little_else() {
    use std::io::Write;
    const VOLUME_BYTES: usize = 64 * 256 * 256 * 2;
    const CHUNK_BYTES: usize = VOLUME_BYTES / 8;
    const BESIDE_BYTES: usize = 1 << 20;
    let numbers: Vec<u8> = (0..CHUNK_BYTES as u32 / 2)
        .flat_map(|n| ((n % 977) as u16).to_le_bytes())
        .collect();
    let zlib = {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(&numbers).unwrap();
        encoder.finish().unwrap()
    };
    for (compressor, bytes) in [(Value::Null, &numbers), (json!({"id": "zlib"}), &zlib)] {
        let store = Store::new(&[]);
        let array = json!({
            "zarr_format": 2, "shape": [64, 256, 256], "chunks": [8, 256, 256], "dtype": "<u2", "order": "C",
            "fill_value": 0, "filters": null, "compressor": compressor,
        });
        store.write(".zarray", array.to_string());
        for chunk in 0..8 {
            store.write(&format!("{chunk}.0.0"), bytes);
        }
        let source = store.open().unwrap();
        let whole = source.header().whole();
        crate::memory::start();
        let piece = source
            .read(stratavox::volume::TimeComponent::default(), whole)
            .unwrap();
        let peak = crate::memory::peak_since_start();
        assert_eq!(piece.voxels.len(), VOLUME_BYTES / 2);
        // Beside the volume: a chunk as it is in its file and as it is decoded, which grows by doubling.
        let most = VOLUME_BYTES + bytes.len() + 2 * CHUNK_BYTES + BESIDE_BYTES;
        println!("{compressor}: {peak} bytes at most, {most} allowed");
        assert!(peak <= most, "{compressor}: {peak} bytes, {most} allowed");
    }
}
