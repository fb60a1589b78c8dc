//! Runs a program once for each barrier that it records, with that barrier ordering nothing, under the validation of
//! synchronization: `layer.c` stands between.

use std::fs;
use std::process::Command;

const NAME: &str = "VK_LAYER_STRATAVOX_missing_barrier";
const VALIDATION: &str = "VK_LAYER_KHRONOS_validation";

/// The layer, built, and where the loader finds it.
pub struct MissingBarrier {
    folder: tempfile::TempDir,
}

/// What a run came to.
pub struct Heard {
    pub barriers: u32,
    /// What the validation layer said.
    pub said: Vec<String>,
}

impl MissingBarrier {
    /// `None` where there is no compiler, or no headers of layers.
    pub fn new() -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let library = folder.path().join("layer.so");
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/missing_barrier/layer.c");
        let built = Command::new("cc")
            .args(["-shared", "-fPIC", "-Wall", "-Wextra", source, "-o"])
            .arg(&library)
            .output();
        let is_built = built.is_ok_and(|built| built.status.success());
        if !is_built {
            println!("skipped: no compiler, or no headers of Vulkan (Debian: libvulkan-dev)");
            return None;
        }
        let manifest = format!(
            r#"{{"file_format_version": "1.2.0", "layer": {{"name": "{NAME}", "type": "INSTANCE",
            "library_path": "{}", "api_version": "1.3.0", "implementation_version": "1",
            "description": "one barrier orders nothing"}}}}"#,
            library.display()
        );
        fs::write(folder.path().join("layer.json"), manifest).unwrap();
        Some(Self { folder })
    }

    /// Runs the program; barrier number `missing` orders nothing.
    pub fn run(&self, mut command: Command, missing: Option<u32>) -> Heard {
        let enabled = "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT";
        command
            .env("VK_ADD_LAYER_PATH", self.folder.path())
            .env("VK_INSTANCE_LAYERS", format!("{NAME}:{VALIDATION}"))
            .env("VK_LAYER_ENABLES", enabled)
            .env_remove("MISSING_BARRIER");
        if let Some(missing) = missing {
            command.env("MISSING_BARRIER", missing.to_string());
        }
        let told = command.output().expect("it runs");
        let text =
            [told.stdout, told.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        let lines = || text.iter().flat_map(|text| text.lines());
        assert!(told.status.success(), "{text:?}");
        let barriers = lines().find_map(|line| line.strip_suffix(" barriers"));
        let barriers = barriers.unwrap_or_else(|| panic!("the layer was not there: {text:?}"));
        let is_said = |line: &&str| line.contains("Validation Error");
        Heard {
            barriers: barriers.parse().unwrap(),
            said: lines().filter(is_said).map(str::to_owned).collect(),
        }
    }

    /// Each barrier of the program is missed but for those that are known to be `unheard`.
    pub fn assert_each_is_missed(&self, program: impl Fn() -> Command, unheard: &[u32]) {
        let whole = self.run(program(), None);
        assert_eq!(whole.said, Vec::<String>::new());
        assert!(whole.barriers > 5, "only {} barriers", whole.barriers);
        let is_heard = |&missing: &u32| {
            let heard = self.run(program(), Some(missing));
            !heard.said.is_empty()
        };
        let found: Vec<_> = (0..whole.barriers)
            .filter(|missing| !is_heard(missing))
            .collect();
        println!(
            "{} barriers, without these nothing is heard: {found:?}",
            whole.barriers
        );
        assert_eq!(found, unheard);
    }
}
