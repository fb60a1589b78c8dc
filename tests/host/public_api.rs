//! What the library shows of itself without features is `docs/public-api.txt`: what a release changes of it is seen
//! there, line by line. Slow, and asked for by `make api`; `STRATAVOX_API=write` writes the page anew.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// All public items, a line each, as rustdoc knows them.
fn listed() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = root.join("target/api");
    let told = Command::new(env!("CARGO"))
        .args([
            "rustdoc",
            "--locked",
            "--quiet",
            "--lib",
            "--no-default-features",
        ])
        .arg("--target-dir")
        .arg(&target)
        .args([
            "--",
            "-Z",
            "unstable-options",
            "--output-format",
            "json",
            "--cap-lints",
            "allow",
        ])
        // JSON is for nightly compilers only; the one that is asked is the one that `public-api` is for.
        .env("RUSTC_BOOTSTRAP", "1")
        .env_remove("RUSTDOCFLAGS")
        .current_dir(root)
        .output()
        .expect("cargo runs");
    let said = String::from_utf8_lossy(&told.stderr);
    assert!(told.status.success(), "{said}");
    let api = public_api::Builder::from_rustdoc_json(target.join("doc/stratavox.json"))
        .omit_blanket_impls(true)
        .omit_auto_trait_impls(true)
        .omit_auto_derived_impls(true)
        .build()
        .expect("rustdoc of this compiler and `public-api` speak the same format");
    api.to_string()
}

#[test]
#[ignore = "builds the library once more: make api"]
fn the_public_api_is_the_one_that_is_written_down() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/public-api.txt");
    let found = listed();
    if env::var("STRATAVOX_API").as_deref() == Ok("write") {
        fs::write(&page, found).unwrap();
        return;
    }
    let wanted = fs::read_to_string(&page).unwrap();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let (found, wanted) = (lines(&found), lines(&wanted));
    let gone: Vec<_> = wanted.iter().filter(|line| !found.contains(line)).collect();
    let new: Vec<_> = found.iter().filter(|line| !wanted.contains(line)).collect();
    assert!(
        gone.is_empty() && new.is_empty(),
        "gone, which breaks those who use it: {gone:#?}\nnew: {new:#?}\n`STRATAVOX_API=write make api` writes the page"
    );
}
