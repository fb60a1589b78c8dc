//! Names and pages keep to the field's terms: what was once called otherwise does not come back.
//!
//! A term is found case-sensitively and as a whole: neither letters, digits nor an underscore beside it. Plain English words that
//! were once names (left, corner, class, word) are not on the list.

use std::fs;
use std::path::{Path, PathBuf};

/// A term that is not used, and what is said in its place.
const FORBIDDEN: &[(&str, &str)] = &[
    ("Alike", "HomogeneousRanges"),
    ("Apron", "Halo"),
    ("CLAMPED_LIES", "CLAMPED_FAULTS"),
    ("Graded", "GradientTransfer"),
    ("Keep::Always", "GradientStorage::Precomputed"),
    ("Keep::Never", "GradientStorage::OnTheFly"),
    ("LIES", "FAULTS"),
    ("Lie", "Fault"),
    ("Mix::Alone", "SampleInputs::Scalar"),
    ("Mix::Graded", "SampleInputs::ScalarGradient"),
    ("Nearer", "DepthConvention"),
    ("NotGraded", "NoGradientTransfer"),
    ("Pencil", "TileFrustum"),
    ("ROOMS_A_WORD", "CELLS_PER_WORD"),
    ("Rooms", "DistanceMap"),
    ("Settings::keep_gradients", "Settings::gradient_storage"),
    ("Shot", "FrameInfo, or PictureCase"),
    ("Sight::Open", "DepthAccess::None"),
    ("Sight::Read", "DepthAccess::Sampled"),
    ("Steepness", "GradientMagnitude"),
    ("Take::Between", "SampleKind::InterpolatedSlice"),
    ("Take::Slab", "SampleKind::Preintegrated"),
    ("Twin", "CPU reference"),
    (
        "algorithms.md",
        "a section of docs/sampling.md, or a publication",
    ),
    ("among_few", "dynamic_indexing"),
    ("apron", "halo"),
    ("ask_both_sides", "evaluate_both_operands"),
    ("dearer", "more expensive"),
    ("dearest", "most expensive"),
    ("graded:", "gradient_transfer:"),
    ("hang on", "depend on"),
    ("hangs on", "depends on"),
    ("in_sight", "visible_interval"),
    ("is_graded", "uses_gradient"),
    ("keeps_empty_space", "disable_space_skipping"),
    ("known_distances", "tile_bounds_distances"),
    ("looks_of_picture", "fetches_of_picture"),
    ("material_lit", "material_shaded"),
    ("material_weighed", "material_gradient_opacity"),
    ("mixture::Part", "GpuChannel"),
    ("nothing_picture", "clear_picture"),
    ("paint_by", "color_by_volume"),
    ("room_of", "distance_to_occupied"),
    ("rooms", "distances, or distance map"),
    ("sight_host", "ends_at_host_depth"),
    ("slope_taps", "central_differences_taps"),
    ("square_points", "patch_points"),
    ("sv_function", "sv_transfer_function"),
    ("sv_level", "sv_isosurface"),
    ("sv_shot", "sv_frame_info"),
    ("technique::Part", "GpuChannel"),
    ("tells the truth", "conforms"),
    ("the issue", "the reason itself"),
    ("twin", "CPU reference, or reference"),
    ("twins", "CPU references"),
    ("verify --part", "verify --partial"),
];

/// Where terms are looked for, beside files that lie in the root. Help is part of the sources.
const FOLDERS: &[&str] = &[
    "src", "shaders", "tests", "examples", "benches", "docs", "include",
];
const ENDINGS: &[&str] = &["rs", "wgsl", "md", "h", "c", "txt", "json", "toml", "py"];

fn is_part_of_a_word(byte: Option<&u8>) -> bool {
    byte.is_some_and(|byte| byte.is_ascii_alphanumeric() || *byte == b'_')
}

/// Whether a line has the term as a whole.
fn has(line: &str, term: &str) -> bool {
    let bytes = line.as_bytes();
    line.match_indices(term).any(|(at, _)| {
        let before = at.checked_sub(1).and_then(|at| bytes.get(at));
        !is_part_of_a_word(before) && !is_part_of_a_word(bytes.get(at + term.len()))
    })
}

/// The texts under a folder, but for fixtures, which others wrote, and this list.
fn texts(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let is_text = |ending: &std::ffi::OsStr| ENDINGS.iter().any(|known| ending == *known);
        if path.is_dir() {
            if !path.ends_with("fixtures") {
                texts(&path, found);
            }
        } else if path.extension().is_some_and(is_text) && !path.ends_with("host/vocabulary.rs") {
            found.push(path);
        }
    }
}

#[test]
fn names_and_pages_keep_to_the_terms_of_the_field() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![
        root.join("README.md"),
        root.join("build.rs"),
        root.join("Makefile"),
    ];
    for folder in FOLDERS {
        texts(&root.join(folder), &mut files);
    }
    assert!(files.len() > 1000, "{} files", files.len());
    let mut wrong = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).expect("a text");
        for (number, line) in text.lines().enumerate() {
            for (term, instead) in FORBIDDEN.iter().filter(|(term, _)| has(line, term)) {
                let name = file.strip_prefix(root).unwrap_or(&file).display();
                wrong.push(format!("{name}:{}: {term:?}: say {instead}", number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_term_is_found_as_a_whole() {
    assert!(has("where it hangs on.", "hangs on"));
    assert!(has("a Shot", "Shot"));
    assert!(!has("Screenshot and Shots", "Shot"));
    assert!(!has("sv_levels", "sv_level"));
}
