//! What an embedder takes with it (`default-features = false`) is a short list, on whatever target, and free of C.

use std::collections::BTreeSet;
use std::env;
use std::process::Command;

/// By name: versions are those of the lock file. Of these `bytemuck_derive`, `thiserror-impl`, `zerocopy-derive` and
/// what they need run in the compiler alone, `miniz_oxide` opens the stored shaders, `spirv` and its `bitflags` name what is in
/// them, `crunchy` is for one target of graphics cards, `windows-link` for another system.
const EMBEDDER: [&str; 25] = [
    "adler2",
    "ash",
    "bitflags",
    "bytemuck",
    "bytemuck_derive",
    "cfg-if",
    "crunchy",
    "glam",
    "gpu-allocator",
    "half",
    "libloading",
    "log",
    "miniz_oxide",
    "presser",
    "proc-macro2",
    "quote",
    "spirv",
    "stratavox",
    "syn",
    "thiserror",
    "thiserror-impl",
    "unicode-ident",
    "windows-link",
    "zerocopy",
    "zerocopy-derive",
];

/// The packages of a tree on all targets, by name. Cargo fetches those that no build on this target has wanted yet.
fn tree(edges: &str, features: &str) -> BTreeSet<String> {
    tree_on("all", edges, features)
}

fn tree_on(target: &str, edges: &str, features: &str) -> BTreeSet<String> {
    let cargo = env::var("CARGO").unwrap_or("cargo".into());
    let told = Command::new(cargo)
        .args(["tree", "--locked", "--no-default-features"])
        .args(["--features", features, "--edges", edges])
        .args(["--target", target, "--prefix", "none", "--format", "{p}"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let text = String::from_utf8_lossy(&told.stdout);
    let said = String::from_utf8_lossy(&told.stderr);
    assert!(told.status.success(), "{said}");
    let name = |line: &str| line.split(' ').next().map(str::to_owned);
    text.lines()
        .filter_map(name)
        .filter(|n| !n.is_empty())
        .collect()
}

#[test]
fn an_embedder_takes_what_is_written_here_and_no_more() {
    let wanted: BTreeSet<_> = EMBEDDER.map(str::to_owned).into();
    assert_eq!(tree("normal", ""), wanted);
}

#[test]
fn the_interface_for_c_takes_no_more() {
    assert_eq!(tree("normal", "capi"), tree("normal", ""));
}

#[test]
fn nothing_that_is_built_for_an_embedder_builds_c() {
    for package in tree("normal,build", "") {
        let builds_c = ["cc", "cmake", "pkg-config", "bindgen"].contains(&package.as_str());
        assert!(!builds_c && !package.ends_with("-sys"), "{package}");
    }
}

#[test]
fn the_program_has_every_reader_and_none_of_them_builds_c() {
    // A crate of time zones builds C on Haiku alone.
    for target in [
        "x86_64-unknown-linux-gnu",
        "x86_64-pc-windows-msvc",
        "aarch64-apple-darwin",
    ] {
        let readers = tree_on(target, "normal,build", "formats");
        for package in ["grib", "hdf5-reader", "hayro-jpeg2000", "tiff"] {
            assert!(readers.contains(package), "no {package}: {readers:?}");
        }
        assert!(readers.is_subset(&tree_on(target, "normal,build", "cli")));
        for tool in ["cc", "cmake", "pkg-config", "bindgen"] {
            assert!(!readers.contains(tool), "{tool} is needed on {target}");
        }
    }
}
