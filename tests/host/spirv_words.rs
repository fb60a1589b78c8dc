//! What tests ask of SPIR-V.

use crate::no_contraction::pass::instructions;
use spirv::Op;
use std::path::PathBuf;
use std::process::Command;

/// How many instructions of a kind a module has.
pub fn count(words: &[u32], op: Op) -> usize {
    let all = instructions(words);
    all.filter(|(_, of)| of[0] & 0xffff == op as u32).count()
}

/// `spirv-val`, with the file that it reads.
pub struct SpirvVal {
    folder: tempfile::TempDir,
}

impl SpirvVal {
    /// `None` where it is not installed, which is printed.
    pub fn new() -> Option<Self> {
        if Command::new("spirv-val").arg("--version").output().is_err() {
            println!("skipped: no spirv-val is installed");
            return None;
        }
        let folder = tempfile::tempdir().expect("a folder");
        Some(Self { folder })
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("module.spv")
    }

    pub fn assert_valid(&self, what: &str, words: &[u32]) {
        std::fs::write(self.file(), bytemuck::cast_slice(words)).expect("a file");
        let mut command = Command::new("spirv-val");
        let run = command.args(["--target-env", "vulkan1.2"]);
        let run = run.arg(self.file()).output().expect("spirv-val");
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{what}: {said}");
    }
}
