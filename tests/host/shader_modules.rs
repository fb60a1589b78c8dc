//! How many modules of shaders there are, how large they are, and that each variant is valid as a driver folds it.

use std::collections::BTreeMap;
use std::process::Command;
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
    assert!((50..=110).contains(&drawing.len()), "{}", drawing.len());
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

/// Some variants of each module, the first and the last of each constant among them, with their constants folded, are valid.
#[test]
fn folded_variants_are_valid() {
    let is_there = |tool: &str| Command::new(tool).arg("--version").output().is_ok();
    if !is_there("spirv-opt") || !is_there("spirv-val") {
        println!("skipped: no spirv-opt and spirv-val are installed");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut checked = 0;
    for module in modules() {
        let same = |shader: &&Shader| std::ptr::eq(shader.spirv(), module.spirv());
        let variants: Vec<&Shader> = SHADERS.iter().filter(same).collect();
        let ends = [variants[0], variants[variants.len() - 1]];
        let raw = folder.path().join("raw.spv");
        let folded = folder.path().join("folded.spv");
        std::fs::write(&raw, bytemuck::cast_slice(module.spirv())).expect("a file");
        for (software, variant) in [0, 1].into_iter().zip(ends) {
            let mut values = format!("{SOFTWARE_ID}:{software}");
            for (id, value) in variant.constants {
                values += &format!(" {id}:{value}");
            }
            let known = declared(module.spirv());
            let values: Vec<&str> = values
                .split(' ')
                .filter(|pair| known.iter().any(|id| pair.starts_with(&format!("{id}:"))))
                .collect();
            let mut command = Command::new("spirv-opt");
            if !values.is_empty() {
                command.args(["--set-spec-const-default-value", &values.join(" ")]);
            }
            command.args([
                "--freeze-spec-const",
                "--eliminate-dead-branches",
                "--target-env=vulkan1.2",
            ]);
            let run = command
                .arg(&raw)
                .arg("-o")
                .arg(&folded)
                .output()
                .expect("spirv-opt");
            assert!(
                run.status.success(),
                "{}: {}",
                variant.name,
                String::from_utf8_lossy(&run.stderr)
            );
            let run = Command::new("spirv-val")
                .args(["--target-env", "vulkan1.2"])
                .arg(&folded)
                .output();
            let run = run.expect("spirv-val");
            assert!(
                run.status.success(),
                "{}: {}",
                variant.name,
                String::from_utf8_lossy(&run.stderr)
            );
            checked += 1;
        }
    }
    println!("{checked} folded variants are valid");
    assert!(checked > 200, "{checked}");
}
