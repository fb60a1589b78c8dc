//! The interface for C: its header, its libraries, a host in C, and what careless hosts do.
//!
//! A compiler and the headers of Vulkan are wanted for most of it; where they are not installed, a test says that it
//! was skipped. The libraries are built once, by the cargo that runs this, beside everything else in the target folder.

mod capi_layout;
mod missing_barrier;

#[path = "../examples/embed.rs"]
#[allow(dead_code, reason = "its `main` is not called")]
mod example;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::{env, fs};

/// What makes the header: another version writes another text.
const CBINDGEN: &str = "cbindgen 0.29.4";

const WARNINGS: [&str; 4] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(command: &mut Command) -> Output {
    let shown = format!("{command:?}");
    command
        .output()
        .unwrap_or_else(|cause| panic!("{shown}: {cause}"))
}

/// What a program printed; its end is a success.
fn printed(command: &mut Command) -> String {
    let shown = format!("{command:?}");
    let output = run(command);
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{shown}\n{out}\n{err}");
    out
}

fn has(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output();
    let is_there = found.is_ok_and(|output| output.status.success());
    if !is_there {
        println!("skipped: `{program}` is not installed");
    }
    is_there
}

/// A compiler, and the headers and the loader of Vulkan.
fn can_link() -> bool {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("try.c");
    fs::write(
        &source,
        "#include <vulkan/vulkan.h>\nint main(void) { return 0; }\n",
    )
    .unwrap();
    let mut command = Command::new("cc");
    command
        .arg(&source)
        .args(["-lvulkan", "-o"])
        .arg(folder.path().join("try"));
    let can = has("cc") && run(&mut command).status.success();
    if !can {
        println!("skipped: the headers of Vulkan are not installed (Debian: libvulkan-dev)");
    }
    can
}

/// The folder with `libstratavox.so` and `libstratavox.a`.
fn libraries() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        // target/debug/deps/capi-...
        let program = env::current_exe().unwrap();
        let profile = program.ancestors().nth(2).unwrap();
        let target = profile.parent().unwrap();
        let mut command = Command::new(env!("CARGO"));
        command
            .current_dir(root())
            .args(["rustc", "--locked", "--quiet", "--lib"])
            .args(["--no-default-features", "--features", "capi"])
            .args(["--crate-type", "cdylib,staticlib", "--target-dir"])
            .arg(target);
        if profile.ends_with("release") {
            command.arg("--release");
        }
        printed(&mut command);
        profile.to_owned()
    })
}

/// A program in C, linked with one of the libraries.
struct Program {
    folder: tempfile::TempDir,
    path: PathBuf,
}

impl Program {
    fn new(sources: &[&str], flags: &[&str], is_static: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("program");
        let libraries = libraries();
        let mut command = Command::new("cc");
        command
            .arg("-std=c99")
            .args(WARNINGS)
            .args(flags)
            .arg("-I")
            .arg(root().join("include"))
            .args(sources.iter().map(|source| root().join(source)));
        match is_static {
            true => command.arg(libraries.join("libstratavox.a")),
            false => command.arg("-L").arg(libraries).arg("-lstratavox"),
        };
        command
            .args(["-lvulkan", "-lm", "-ldl", "-lpthread", "-o"])
            .arg(&path);
        printed(&mut command);
        Self { folder, path }
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command.env("LD_LIBRARY_PATH", libraries());
        command
    }
}

#[test]
fn the_header_is_what_cbindgen_makes_of_the_sources() {
    let home = env::var("CBINDGEN").unwrap_or("cbindgen".into());
    if !has(&home) {
        return;
    }
    let version = printed(Command::new(&home).arg("--version"));
    if version.trim() != CBINDGEN {
        println!(
            "skipped: {} is installed, wanted {CBINDGEN}",
            version.trim()
        );
        return;
    }
    let mut command = Command::new(&home);
    command
        .current_dir(root())
        .args(["--quiet", "--config", "include/cbindgen.toml", "."]);
    let made = printed(&mut command);
    let kept = fs::read_to_string(root().join("include/stratavox.h")).unwrap();
    assert!(
        made == kept,
        "`make header` makes another include/stratavox.h"
    );
}

#[test]
fn the_header_compiles_without_a_warning_in_c_and_in_cpp() {
    let folder = tempfile::tempdir().unwrap();
    let source = "#include \"stratavox.h\"\nint main() { return SV_OK; }\n";
    for (compiler, standard, name) in [
        ("cc", "c99", "a.c"),
        ("cc", "c17", "b.c"),
        ("c++", "c++11", "c.cpp"),
        ("c++", "c++17", "d.cpp"),
    ] {
        if !has(compiler) {
            continue;
        }
        let path = folder.path().join(name);
        // In C, `main()` declares no prototype.
        let source = match compiler {
            "cc" => source.replace("main()", "main(void)"),
            _ => source.to_owned(),
        };
        fs::write(&path, source).unwrap();
        let mut command = Command::new(compiler);
        command
            .arg(format!("-std={standard}"))
            .args(WARNINGS)
            .args(["-fsyntax-only", "-I"])
            .arg(root().join("include"))
            .arg(&path);
        printed(&mut command);
    }
}

#[test]
fn c_and_rust_agree_on_each_size_and_offset() {
    let asserts = capi_layout::asserts();
    assert!(asserts.len() > 200, "only {} of them", asserts.len());
    if !has("cc") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("layout.c");
    let head = "#include \"stratavox.h\"\n#include <stddef.h>\n";
    let compiles = |asserts: &[String]| {
        fs::write(&path, format!("{head}{}", asserts.concat())).unwrap();
        let mut command = Command::new("cc");
        command
            .args(["-std=c11", "-fsyntax-only", "-I"])
            .arg(root().join("include"))
            .arg(&path);
        run(&mut command)
    };
    let found = compiles(&asserts);
    let text = String::from_utf8_lossy(&found.stderr);
    assert!(found.status.success(), "{text}");
    // One that is wrong is seen.
    let wrong = ["_Static_assert(sizeof(sv_frame_info) == 1, \"sv_frame_info\");\n".to_owned()];
    assert!(!compiles(&wrong).status.success());
}

/// Names of functions that the header declares.
fn declared() -> BTreeSet<String> {
    let header = fs::read_to_string(root().join("include/stratavox.h")).unwrap();
    let lines = header.lines().filter(|line| !line.starts_with("//"));
    let code: String = lines.collect::<Vec<_>>().join(" ");
    let calls = code.split('(').filter_map(|before| {
        let name = before.rsplit([' ', '*']).next()?;
        let returns = before.trim_end_matches(name).trim_end();
        let is_function = returns.ends_with("sv_status") || returns.ends_with("uint32_t");
        (name.starts_with("sv_") && is_function).then(|| name.to_owned())
    });
    calls.collect()
}

#[test]
fn the_library_exports_what_the_header_declares_and_no_more() {
    let listed = fs::read_to_string(root().join("tests/capi/symbols.txt")).unwrap();
    let listed: BTreeSet<String> = listed.lines().map(str::to_owned).collect();
    assert_eq!(declared(), listed, "the header, and tests/capi/symbols.txt");
    if !has("nm") {
        return;
    }
    let symbols = |flag: &str| -> BTreeSet<String> {
        let library = libraries().join("libstratavox.so");
        let text = printed(Command::new("nm").args(["-D", flag]).arg(library));
        let names = text
            .lines()
            .filter_map(|line| line.split_whitespace().last());
        names.map(str::to_owned).collect()
    };
    assert_eq!(symbols("--defined-only"), listed);
    // Vulkan is reached through the host's function alone.
    let vulkan = symbols("--undefined-only");
    let vulkan: Vec<_> = vulkan
        .iter()
        .filter(|name| name.starts_with("vk"))
        .collect();
    assert!(vulkan.is_empty(), "{vulkan:?}");
}

#[test]
fn the_host_in_c_draws_the_picture_of_the_host_in_rust() {
    if !can_link() {
        return;
    }
    let program = Program::new(&["examples/embed.c"], &[], false);
    let path = program.folder.path().join("sphere.ppm");
    printed(program.command().arg(&path));
    let found = fs::read(&path).unwrap();
    let head = b"P6\n256 256\n255\n";
    assert!(found.starts_with(head));
    let path = program.folder.path().join("sphere.png");
    example::run(&path).unwrap();
    let wanted = image::open(&path).unwrap().into_rgb8().into_raw();
    assert_eq!(found.len() - head.len(), wanted.len());
    let pairs = found[head.len()..].iter().zip(&wanted);
    let off = pairs.filter(|(found, wanted)| found != wanted).count();
    assert_eq!(off, 0, "bytes that differ");
}

#[test]
fn a_host_in_c_follows_lines_and_a_volume_ends_at_their_tubes() {
    if !can_link() {
        return;
    }
    let program = Program::new(&["examples/lines.c"], &[], false);
    let path = program.folder.path().join("lines.ppm");
    let told = printed(program.command().arg(&path));
    // Around the axis and up: each comes in by the floor and leaves by the roof.
    let ends: Vec<_> = told.lines().collect();
    assert_eq!(ends.len(), 5, "{told}");
    assert!(
        ends.iter().all(|line| line.ends_with("causes 1 and 1")),
        "{told}"
    );
    let found = fs::read(&path).unwrap();
    let pixels = found["P6\n320 240\n255\n".len()..].as_chunks::<3>().0;
    let is_tube = |[r, _, b]: &&[u8; 3]| r.abs_diff(*b) > 60 && (*r).max(*b) > 120;
    let is_fog = |[r, g, b]: &&[u8; 3]| r.abs_diff(*g) < 12 && g.abs_diff(*b) < 16 && *g > 120;
    let tubes = pixels.iter().filter(is_tube).count();
    let fog = pixels.iter().filter(is_fog).count();
    // The title in the upper left, white on the dark.
    let rows = (0..30).flat_map(|y| &pixels[320 * y..320 * y + 200]);
    let words = rows.filter(|pixel| pixel.iter().all(|&c| c > 200)).count();
    println!("{tubes} pixels of tubes, {fog} of the ball alone, {words} of words");
    assert!(words > 60, "{words}");
    assert!(tubes > 4000 && fog > 500, "{tubes} and {fog}");
}

#[test]
fn each_barrier_of_the_host_in_c_is_needed() {
    let mode = stratavox::gpu::Validation::default().mode().unwrap();
    if mode != Some(stratavox::gpu::ValidationMode::Synchronization) {
        println!("skipped: STRATAVOX_VALIDATION=sync is not set");
        return;
    }
    if !can_link() {
        return;
    }
    let Some(layer) = missing_barrier::MissingBarrier::new() else {
        return;
    };
    let program = Program::new(&["examples/embed.c"], &[], false);
    let path = program.folder.path().join("sphere.ppm");
    let command = || {
        let mut command = program.command();
        command.arg(&path).env_remove("STRATAVOX_VALIDATION");
        command
    };
    let unheard = [
        missing_barrier::STAND_IN,
        missing_barrier::STAND_IN,
        missing_barrier::NEXT_FUNCTION,
        missing_barrier::LIST_BEFORE,
        missing_barrier::PART_BEFORE,
        missing_barrier::ORDERED_TWICE,
        missing_barrier::NEW_TARGET,
        missing_barrier::READ_BY_HOST,
    ];
    layer.assert_each_is_missed(command, &unheard);
}

#[test]
fn a_host_in_c_draws_by_each_level_and_gets_depths_and_picks_back() {
    if !can_link() {
        return;
    }
    let program = Program::new(
        &[
            "tests/capi/levels.c",
            "tests/capi/levels_depth.c",
            "tests/capi/levels_life.c",
            "tests/capi/levels_passes.c",
        ],
        &[],
        false,
    );
    let told = printed(&mut program.command());
    let good = told.lines().filter(|line| line.starts_with("ok: ")).count();
    assert!(good >= 45, "{told}");
}

#[test]
fn abuse_is_refused_in_words_and_breaks_nothing() {
    if !can_link() {
        return;
    }
    let sanitized = ["-g", "-fsanitize=address,undefined"];
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("try.c");
    fs::write(&source, "int main(void) { return 0; }\n").unwrap();
    let mut command = Command::new("cc");
    command
        .args(sanitized)
        .arg(&source)
        .arg("-o")
        .arg(folder.path().join("try"));
    let flags: &[&str] = match run(&mut command).status.success() {
        true => &sanitized,
        false => {
            println!("skipped: the sanitizer of addresses (run without it)");
            &[]
        }
    };
    let program = Program::new(
        &[
            "tests/capi/abuse.c",
            "tests/capi/abuse_frames.c",
            "tests/capi/abuse_geometry.c",
            "tests/capi/abuse_handles.c",
            "tests/capi/abuse_objects.c",
            "tests/capi/abuse_pictures.c",
            "tests/capi/abuse_structures.c",
        ],
        flags,
        true,
    );
    let mut command = program.command();
    // Software drivers leave memory behind when they are unloaded.
    command
        .env("ASAN_OPTIONS", "detect_leaks=0")
        .env("UBSAN_OPTIONS", "halt_on_error=1");
    let told = printed(&mut command);
    let words: Vec<_> = told.lines().last().unwrap().split_whitespace().collect();
    let refused: usize = words[0].parse().unwrap();
    assert!(refused >= 300, "{told}");
    assert_eq!(&words[1..5], ["calls", "refused,", "0", "failures,"]);
}
