//! How many modules of shaders there are, how large they are, and that each variant is valid as a driver folds it.

use crate::spirv_words::{SpirvVal, count};
use std::collections::BTreeMap;
use stratavox::shaders::{BindingKind, SHADERS, SOFTWARE_ID, Shader};

fn is_probe(shader: &Shader) -> bool {
    shader.name.starts_with("probe/")
}

/// One variant of each module.
fn modules() -> Vec<&'static Shader> {
    let mut modules = BTreeMap::new();
    for shader in SHADERS {
        modules.entry(shader.spirv().as_ptr()).or_insert(shader);
    }
    modules.into_values().collect()
}

#[test]
fn modules_are_few_and_small() {
    let (probes, drawing): (Vec<&Shader>, Vec<&Shader>) =
        modules().into_iter().partition(|s| is_probe(s));
    let bytes: usize = drawing.iter().map(|s| size_of_val(s.spirv())).sum();
    println!(
        "{} modules of {bytes} bytes, {} of probes, {} variants",
        drawing.len(),
        probes.len(),
        SHADERS.len()
    );
    // 106, three of shear-warp, six of splats, two of slabs by footprint texels, three of paths, two of light through
    // several volumes, one of light that is scattered once, four of geometry, two of fields of points, the three passes
    // that make runs of classified voxels, and the two that sum up noise.
    assert!((50..=134).contains(&drawing.len()), "{}", drawing.len());
    assert!(probes.len() <= 70, "{}", probes.len());
    assert!(bytes <= 12_000_000, "{bytes}");
    let stored = concat!(env!("OUT_DIR"), "/shaders.deflate");
    let stored = std::fs::metadata(stored).expect("what the build has written");
    assert!(stored.len() <= 4_000_000, "{} bytes stored", stored.len());
}

#[test]
fn a_stage_has_as_many_images_to_write_as_vulkan_asks_of_every_device() {
    for shader in modules() {
        let count = |kind| {
            shader
                .bindings
                .iter()
                .filter(|slot| slot.kind == kind)
                .count()
        };
        assert!(count(BindingKind::StorageImage) <= 4, "{}", shader.name);
    }
}

/// Numbers of the constants of a module, by its decorations.
fn declared(words: &[u32]) -> Vec<u32> {
    let mut ids = Vec::new();
    let mut rest = &words[5..];
    while let Some(&first) = rest.first() {
        let instruction = &rest[..(first >> 16) as usize];
        rest = &rest[instruction.len()..];
        let is_id = first & 0xffff == spirv::Op::Decorate as u32
            && instruction[2] == spirv::Decoration::SpecId as u32;
        ids.extend(is_id.then(|| instruction[3]));
    }
    ids.sort_unstable();
    ids
}

#[test]
fn every_variant_gives_each_constant_of_its_module_a_value() {
    let mut with_constants = 0;
    for shader in SHADERS {
        let mut given: Vec<u32> = shader.constants.iter().map(|(id, _)| *id).collect();
        with_constants += usize::from(!given.is_empty());
        let declared = declared(shader.spirv());
        if declared.contains(&SOFTWARE_ID) {
            given.push(SOFTWARE_ID);
        }
        given.sort_unstable();
        assert_eq!(given, declared, "{}", shader.name);
    }
    assert!(with_constants > 700, "{with_constants}");
}

/// Some variants of each module, the first and the last of each constant among them, with their constants folded.
fn some_variants() -> Vec<(&'static Shader, bool)> {
    let ends = |module: &Shader| {
        let same = |shader: &&Shader| std::ptr::eq(shader.spirv(), module.spirv());
        let variants: Vec<&Shader> = SHADERS.iter().filter(same).collect();
        [(variants[0], false), (variants[variants.len() - 1], true)]
    };
    modules().into_iter().flat_map(ends).collect()
}

#[test]
fn words_without_conversions_have_none() {
    let ops = [spirv::Op::ConvertFToU, spirv::Op::ConvertFToS];
    let conversions = |words: &[u32]| ops.iter().map(|op| count(words, *op)).sum::<usize>();
    let mut before = 0;
    for shader in modules() {
        before += conversions(&shader.folded(true));
        assert_eq!(
            conversions(&shader.without_conversions()),
            0,
            "{}",
            shader.name
        );
    }
    println!("{before} conversions");
    assert!(before > 500, "{before}");
}

#[test]
fn folded_variants_choose_nothing_by_constants() {
    let (mut of_modules, mut of_variants) = (0, 0);
    for (shader, is_llvmpipe) in some_variants() {
        let folded = shader.folded(is_llvmpipe);
        for op in [spirv::Op::SpecConstant, spirv::Op::SpecConstantOp] {
            assert_eq!(count(&folded, op), 0, "{}", shader.name);
        }
        of_modules += count(shader.spirv(), spirv::Op::Function);
        of_variants += count(&folded, spirv::Op::Function);
    }
    println!("{of_variants} functions of {of_modules}");
    assert!(
        4 * of_variants < 3 * of_modules,
        "{of_variants} of {of_modules}"
    );
}

#[test]
fn folded_variants_are_valid() {
    let Some(validator) = SpirvVal::new() else {
        return;
    };
    let every = SHADERS.iter().flat_map(|shader| {
        let of = move |is_llvmpipe| (shader, shader.folded(is_llvmpipe));
        [true, false].into_iter().map(of)
    });
    let some = some_variants();
    let converting = some
        .iter()
        .filter(|(_, is_llvmpipe)| *is_llvmpipe)
        .map(|(shader, _)| (*shader, shader.without_conversions()));
    let mut checked = 0;
    for (shader, words) in every.chain(converting) {
        checked += 1;
        validator.assert_valid(shader.name, &words);
    }
    println!("{checked} folded variants are valid");
    assert!(checked > 1800, "{checked}");
}
