//! Runs a program once for each barrier that it records, with that barrier ordering nothing, under the validation of
//! synchronization: `layer.c` stands between.

#![allow(dead_code, reason = "each test file uses its part")]

#[path = "../layer/mod.rs"]
mod layer;

use std::process::Command;

/// What is bound in the place of a mask or of a host's depth buffer where there is none: nobody reads it, and layers know.
pub const STAND_IN: &str = "image 0 to 5";

/// A rendering that begins: layers of 2023 do not look at what dynamic rendering loads and clears. The barrier before
/// one to a new image, before one that goes on with it, and the first of a depth attachment, the host's and the renderer's.
pub const NEW_TARGET: &str = "image 0 to 2";
pub const SAME_TARGET: &str = "image 2 to 2";
pub const NEW_DEPTH_COPY: &str = "image 0 to 1000241000";
pub const NEW_DEPTH: &str = "image 0 to 3";
/// Memory that the CPU has written or will read: no layer sees what the CPU does.
pub const WRITTEN_BY_HOST: &str = "image 8 to 1";
pub const READ_BY_HOST: &str = "memory 1000 to 2000";
/// What is read is written by the next function, and there is none in a program of one.
pub const NEXT_FUNCTION: &str = "buffer 200000000 to 700000000";
/// A list of tiles, after it was drawn: of a brick or a part of the picture before, and there is none in a picture of
/// one.
pub const LIST_BEFORE: &str = "buffer 1 to 1000";
/// The same of the images that rays fill.
pub const PART_BEFORE: &str = "memory 700000000 to 700000000";
/// What is empty, which rays read: the barrier before it orders that too.
pub const ORDERED_TWICE: &str = "buffer 700000000 to 200000000";

const NAME: &str = "VK_LAYER_STRATAVOX_missing_barrier";
const VALIDATION: &str = "VK_LAYER_KHRONOS_validation";

/// The layer, built, and where the loader finds it.
pub struct MissingBarrier {
    folder: tempfile::TempDir,
}

/// What a run came to.
pub struct Heard {
    pub barriers: u32,
    /// What kind of barrier ordered nothing.
    pub missing: Option<String>,
    /// What the validation layer said.
    pub said: Vec<String>,
}

impl MissingBarrier {
    /// `None` where there is no compiler, or no headers of layers.
    pub fn new() -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        if !layer::build(folder.path(), NAME, include_str!("layer.c")) {
            println!("skipped: {}", layer::UNBUILT);
            return None;
        }
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
        let barriers = lines().find_map(|line| line.strip_suffix(" barriers"));
        let barriers = barriers.unwrap_or_else(|| panic!("the layer was not there: {text:?}"));
        let is_said = |line: &&str| line.contains("Validation Error");
        // A program that listens ends with an error then.
        let is_told = lines().any(|line| is_said(&line));
        assert!(told.status.success() || is_told, "{text:?}");
        Heard {
            barriers: barriers.parse().unwrap(),
            missing: lines()
                .find_map(|line| line.strip_prefix("missing: "))
                .map(str::to_owned),
            said: lines().filter(is_said).map(str::to_owned).collect(),
        }
    }

    /// Each barrier of the program is missed but for those that are known to be `unheard`, each as often as it stands
    /// there.
    pub fn assert_each_is_missed(&self, program: impl Fn() -> Command, unheard: &[&str]) {
        let whole = self.run(program(), None);
        assert_eq!(whole.said, Vec::<String>::new());
        assert!(whole.barriers > 5, "only {} barriers", whole.barriers);
        let mut known = unheard.to_vec();
        for missing in 0..whole.barriers {
            let heard = self.run(program(), Some(missing));
            if heard.said.is_empty() {
                let what = heard.missing.expect("the layer says what it left out");
                println!(
                    "barrier {missing} of {}: nothing is heard without {what}",
                    whole.barriers
                );
                let place = known.iter().position(|known| *known == what);
                known.remove(place.unwrap_or_else(|| panic!("nothing is heard without {what}")));
            }
        }
    }
}
