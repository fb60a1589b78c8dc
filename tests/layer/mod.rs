//! A Vulkan layer of a test, in C: built where there is a compiler, with `chain.h` beside it.

use std::fs;
use std::path::Path;
use std::process::Command;

/// What is missing where a layer cannot be built.
pub const UNBUILT: &str = "no compiler, or no headers of Vulkan (Debian: libvulkan-dev)";

/// Puts a layer of that name into a folder, for `VK_ADD_LAYER_PATH`. False where it cannot be built.
pub fn build(folder: &Path, name: &str, source: &str) -> bool {
    let (layer, library) = (folder.join("layer.c"), folder.join("layer.so"));
    fs::write(folder.join("chain.h"), include_str!("chain.h")).unwrap();
    fs::write(&layer, source).unwrap();
    let built = Command::new("cc")
        .args(["-shared", "-fPIC", "-Wall", "-Wextra"])
        .arg(&layer)
        .arg("-o")
        .arg(&library)
        .output();
    let manifest = format!(
        r#"{{"file_format_version": "1.2.0", "layer": {{"name": "{name}", "type": "INSTANCE",
        "library_path": "{}", "api_version": "1.3.0", "implementation_version": "1",
        "description": "of a test"}}}}"#,
        library.display()
    );
    fs::write(folder.join("layer.json"), manifest).unwrap();
    built.is_ok_and(|built| built.status.success())
}
