//! A device that has less than all of Vulkan, as those of MoltenVK: `layer.c` makes one of each device of this machine.
//! The extension that Vulkan wants there is enabled, and no part that may be missing is used.

use std::path::Path;
use std::process::Command;

const NAME: &str = "VK_LAYER_STRATAVOX_portability_subset";
const VALIDATION: &str = "VK_LAYER_KHRONOS_validation";

/// The layer, built, in a folder; `None` where it cannot be.
fn built() -> Option<tempfile::TempDir> {
    let folder = tempfile::tempdir().unwrap();
    let is_built = crate::layer::build(folder.path(), NAME, include_str!("layer.c"));
    if !is_built {
        println!("skipped: {}", crate::layer::UNBUILT);
    }
    is_built.then_some(folder)
}

/// What the program and the layers above it say. `layers`: the first is nearest to the program.
fn said(layer: &Path, layers: &str, is_subset: bool, args: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stratavox"));
    command
        .args(args)
        .env("VK_ADD_LAYER_PATH", layer)
        .env("VK_INSTANCE_LAYERS", layers)
        .env_remove("STRATAVOX_VALIDATION")
        .env_remove("SUBSET");
    if is_subset {
        command.env("SUBSET", "1");
    }
    let output = command.output().expect("it runs");
    let text =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(output.status.success(), "{args:?}: {text:?}");
    text.concat()
}

fn picture(folder: &Path, flags: &[&str]) -> (String, Vec<String>) {
    let to = folder.join("picture.npy").display().to_string();
    let args = ["render", "phantom:head,n=24", "--size", "24x20", "--force"];
    let args = [&args[..], &["-o", to.as_str()], flags].concat();
    (to.clone(), args.into_iter().map(str::to_owned).collect())
}

const WAYS: &[&[&str]] = &[
    &[],
    &["--shading", "phong", "--filter", "cubic"],
    &["--mode", "mip"],
    &["--mode", "iso"],
    &["--technique", "slices-3d"],
    &["--technique", "slices-3d", "--mode", "average"],
    &["--technique", "slices-2d", "--no-skip"],
    &["--shadows", "half-angle", "--technique", "slices-3d"],
];

#[test]
fn a_subset_has_its_extension_enabled_and_is_asked_for_nothing_that_it_lacks() {
    let Some(layer) = built() else { return };
    let layers = format!("{VALIDATION}:{NAME}");
    for way in WAYS {
        let (file, args) = picture(layer.path(), way);
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let whole = said(layer.path(), &layers, false, &args);
        assert!(
            whole.contains("portability subset: not enabled"),
            "{way:?}: {whole}"
        );
        let drawn = std::fs::read(&file).unwrap();
        let subset = said(layer.path(), &layers, true, &args);
        assert!(
            subset.contains("portability subset: enabled"),
            "{way:?}: {subset}"
        );
        for text in [whole, subset] {
            assert!(!text.contains("Validation Error"), "{way:?}: {text}");
        }
        assert!(
            std::fs::read(&file).unwrap() == drawn,
            "{way:?}: another picture"
        );
    }
}

/// One part is asked for by conformance alone.
#[test]
fn what_a_subset_lacks_is_not_supported_in_conformance() {
    let Some(layer) = built() else { return };
    let filter = "probe.relay.events";
    for is_subset in [false, true] {
        let to = layer.path().join("run.json").display().to_string();
        let args = ["conformance", "--force", "--filter", filter, "--json", &to];
        said(layer.path(), NAME, is_subset, &args);
        let text = std::fs::read_to_string(&to).unwrap();
        let is_missing = text.contains("not_supported") && text.contains("\"events\"");
        assert_eq!(is_missing, is_subset, "{filter}: {text}");
    }
}

#[test]
fn devices_are_listed_with_the_extension_that_they_want() {
    let Some(layer) = built() else { return };
    for (is_subset, found) in [(false, "not listed"), (true, "listed")] {
        let told = said(layer.path(), NAME, is_subset, &["devices", "--json"]);
        let at = told.find("VK_KHR_portability_subset").expect("in the list");
        let start = told[..at].rfind('{').unwrap();
        let entry = &told[start..at + told[at..].find('}').unwrap()];
        assert!(
            entry.contains(&format!("\"found\": \"{found}\"")),
            "{entry}"
        );
    }
}
