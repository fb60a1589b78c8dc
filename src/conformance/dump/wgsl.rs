//! The WGSL that a shader was compiled from.

#[path = "../../../shaders/compose.rs"]
mod compose;
#[path = "../../../shaders/variants.rs"]
#[allow(dead_code, reason = "a variant by itself has no constants")]
mod variants;

use compose::{Source, combinations, fills, name};
use variants::{ENTRIES, PROBES};

include!(concat!(env!("OUT_DIR"), "/wgsl.rs"));

/// The text of the variant of that name, its imports in their places. `build.rs` still changes what is compiled of it
/// (`shaders/*.rs`), so that it says what the SPIR-V computes and not every instruction of it.
pub fn wgsl(variant: &str) -> Option<String> {
    let text = |path: &str| {
        let found = FILES.iter().find(|(name, _)| *name == path);
        found.map_or_else(String::new, |(_, text)| (*text).to_owned())
    };
    let entries = ENTRIES.iter().chain(PROBES);
    let mut entries = entries.filter(|(file, _)| variant.starts_with(file));
    entries.find_map(|(file, slots)| {
        let mut all = combinations(slots).into_iter();
        let words = all.find(|words| name(file, words) == variant)?;
        Some(Source::read(file, &fills(slots, &words), &text).text)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::SHADERS;

    #[test]
    fn every_shader_has_a_text_with_its_bindings_and_no_import() {
        for shader in SHADERS.iter() {
            let text = wgsl(shader.name).unwrap_or_else(|| panic!("{}", shader.name));
            assert!(text.contains("fn main("), "{}", shader.name);
            assert!(!text.contains("#import"), "{}", shader.name);
            // Those that only other variants of the module read are not in it.
            let read = shader
                .bindings
                .iter()
                .filter(|slot| text.contains(&format!(" {}:", slot.name)));
            assert!(
                read.count() > 0 || shader.bindings.is_empty(),
                "{}",
                shader.name
            );
        }
    }
}
