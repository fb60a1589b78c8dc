//! The architecture is a test: a module uses lower floors only, and inside its floor only itself.
//!
//! Every `crate::name` of the library's sources is an edge, in `use` lines, in grouped imports, in paths
//! inside code and in links of the documentation. Two folders under `technique` are strangers to each other,
//! data never names Vulkan, and what owns Vulkan's objects never names a volume.

use std::{fs, path::Path};

/// Modules by floor, as `src/lib.rs` tells them; floors 0, 1, 3 and 5 have steps inside.
const FLOORS: &[&[&str]] = &[
    &["shaders", "real", "fence", "named"],
    &["ray", "color", "blue_noise"],
    &["lattice"],
    &[
        "gpu", "volume", "transfer", "camera", "picture", "mesh", "figure",
    ],
    &["points", "flow", "geometry"],
    &["resident", "isosurface", "format"],
    &["technique"],
    &["resolve", "look"],
    &["embed"],
    &["scene"],
    &["offscreen", "annotate"],
    &["conformance"],
    &["cli", "capi"],
];

/// Modules that hold data and must build where there is no Vulkan.
const FREE_OF_VULKAN: &[&str] = &[
    "shaders",
    "real",
    "fence",
    "named",
    "ray",
    "lattice",
    "color",
    "blue_noise",
    "volume",
    "transfer",
    "camera",
    "picture",
    "mesh",
    "figure",
    "points",
    "flow",
    "geometry",
    "isosurface",
    "format",
    "scene",
    "annotate",
];

fn floor_of(module: &str) -> usize {
    FLOORS
        .iter()
        .position(|floor| floor.contains(&module))
        .unwrap_or_else(|| panic!("`{module}` has no floor: give it one in src/lib.rs and here"))
}

/// The part of a source file that the floors are about: no line comments (a reader may be pointed upward),
/// and not the tests at its end.
fn code_of(text: &str) -> String {
    let end = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
    text[..end]
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// First names after each `crate::`, those of a group `crate::{a::b, c}` too.
fn modules_named(code: &str) -> Vec<String> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let first_name = |path: &str| {
        path.trim_start()
            .split(|c| !is_name(c))
            .next()
            .unwrap_or_default()
            .to_owned()
    };
    let mut named = Vec::new();
    for after in code.split("crate::").skip(1) {
        let Some(group) = after.strip_prefix('{') else {
            named.push(first_name(after));
            continue;
        };
        let mut depth = 0;
        let mut starts = vec![0];
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => starts.push(at + 1),
                _ => {}
            }
        }
        named.extend(starts.into_iter().map(|at| first_name(&group[at..])));
    }
    // Items at the root (re-exports, macros) begin with a capital letter or have no floor to break.
    named.retain(|name| name.starts_with(|c: char| c.is_ascii_lowercase()));
    named
}

/// What a source file of `module` may not name but does.
fn forbidden(module: &str, text: &str) -> Vec<String> {
    let code = code_of(text);
    let mut found: Vec<_> = modules_named(&code)
        .into_iter()
        .filter(|other| other != module && floor_of(other) >= floor_of(module))
        .collect();
    let names_ash = code
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .any(|word| word == "ash");
    if FREE_OF_VULKAN.contains(&module) && names_ash {
        found.push("ash".to_owned());
    }
    found
}

/// Techniques other than `folder` that a source file under `technique/folder` names.
fn other_techniques(folder: &str, text: &str, folders: &[String]) -> Vec<String> {
    let code = code_of(text);
    folders
        .iter()
        .filter(|&other| other != folder)
        .filter(|other| {
            ["technique::", "super::", "super::super::"]
                .iter()
                .any(|parent| code.contains(&format!("{parent}{other}::")))
        })
        .cloned()
        .collect()
}

fn source_files(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
        let path = entry.expect("an entry of a folder").path();
        if path.is_dir() {
            files.extend(source_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

#[test]
fn every_module_uses_lower_floors_only() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut read = 0;
    let mut wrong = Vec::new();
    for path in source_files(&src) {
        let inside = path.strip_prefix(&src).expect("a file under src");
        let first = inside.components().next().expect("a name").as_os_str();
        let module = first.to_str().expect("plain names").trim_end_matches(".rs");
        if ["lib", "main"].contains(&module) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a source file");
        for other in forbidden(module, &text) {
            wrong.push(format!("{} names `{other}`", inside.display()));
        }
        read += 1;
    }
    assert!(read > 10, "only {read} files were read");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_technique_names_another() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/technique");
    let folders: Vec<String> = fs::read_dir(&folder)
        .expect("src/technique")
        .map(|entry| entry.expect("an entry").path())
        // The executor plays what techniques record: it is none of them.
        .filter(|path| path.is_dir() && !path.ends_with("gather"))
        .map(|path| {
            path.file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    let mut wrong = Vec::new();
    for technique in &folders {
        for path in source_files(&folder.join(technique)) {
            let text = fs::read_to_string(&path).expect("a source file");
            for other in other_techniques(technique, &text, &folders) {
                wrong.push(format!("{} names `{other}`", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_technique_may_use_the_gpu_but_not_the_other_way_round() {
    let none: [&str; 0] = [];
    assert_eq!(forbidden("technique", "use crate::gpu::Image;"), none);
    assert_eq!(forbidden("gpu", "use crate::volume::Volume;"), ["volume"]);
    assert_eq!(
        forbidden("gpu", "fn f(v: &crate::volume::Volume) {}"),
        ["volume"]
    );
    assert_eq!(forbidden("volume", "use ash::vk;"), ["ash"]);
    assert_eq!(forbidden("resident", "use ash::vk;"), none);
    assert_eq!(
        forbidden(
            "format",
            "use crate::{volume::{self, Source}, cli::run, Volume};"
        ),
        ["cli"]
    );
    assert_eq!(
        forbidden("camera", "/// See [`crate::cli`], and ash.\n"),
        none
    );
    assert_eq!(
        forbidden(
            "camera",
            "#[cfg(test)]\nmod tests {\n    use crate::technique::Mode;\n}"
        ),
        none
    );
    assert_eq!(
        forbidden("camera", "#[cfg(test)]\nuse crate::technique::Mode;"),
        ["technique"]
    );
}

#[test]
fn one_technique_that_names_another_is_found() {
    let folders = ["raycast", "slices_3d"].map(str::to_owned);
    let none: [&str; 0] = [];
    let of = |text| other_techniques("raycast", text, &folders);
    assert_eq!(of("use crate::technique::raycast::Params;"), none);
    assert_eq!(of("use super::super::slices_3d::planes;"), ["slices_3d"]);
    assert_eq!(
        of("let n = crate::technique::slices_3d::count();"),
        ["slices_3d"]
    );
}

#[test]
#[should_panic(expected = "`utils` has no floor")]
fn a_module_without_a_floor_is_refused() {
    floor_of("utils");
}
