//! The straight form of a variant: its module as `spirv-opt` folds it, a judge of what the library gives the driver.

use std::{
    io::Write,
    process::{Command, Stdio},
};
use stratavox::shaders::{SOFTWARE_ID, Shader};

/// After the values of constants are set. The driver inlines and optimizes functions by itself.
const FOLDING: [&str; 5] = [
    "--freeze-spec-const",
    "--fold-spec-const-op-composite",
    "--ccp",
    "--eliminate-dead-branches",
    "--eliminate-dead-functions",
];

/// Whether `spirv-opt` is installed.
pub fn is_installed() -> bool {
    let asked = Command::new("spirv-opt").arg("--version").output();
    asked.is_ok_and(|output| output.status.success())
}

/// The words of that form, for a graphics card.
pub fn words(shader: &Shader) -> Result<Vec<u32>, String> {
    let of_variant = shader.constants.iter().copied();
    let values = [(SOFTWARE_ID, 0)].into_iter().chain(of_variant);
    let values: Vec<String> = values.map(|(id, v)| format!("{id}:{v}")).collect();
    let mut child = Command::new("spirv-opt")
        .arg(format!(
            "--set-spec-const-default-value={}",
            values.join(" ")
        ))
        .args(FOLDING)
        .args(["-", "-o", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| format!("spirv-opt: {e}"))?;
    let mut input = child.stdin.take().expect("a pipe");
    let module = shader.spirv().iter();
    let bytes: Vec<u8> = module.flat_map(|w| w.to_le_bytes()).collect();
    // Its output comes after the whole input: neither waits for the other.
    let written = input.write_all(&bytes);
    drop(input);
    let output = child.wait_with_output().map_err(|e| e.to_string())?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() || written.is_err() {
        return Err(format!("spirv-opt refuses {}: {said}", shader.name));
    }
    let words = output.stdout.chunks_exact(4);
    Ok(words
        .map(|word| u32::from_le_bytes(word.try_into().expect("four bytes")))
        .collect())
}
