//! Words of `conformance` that are more than a number or a name.

use crate::conformance::case::Profile;
use crate::conformance::record::Stress;
use crate::gpu::Caps;
use clap::ValueEnum;

/// `--profile`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ProfileWord {
    /// What any device of Vulkan 1.3 must pass
    #[default]
    Baseline,
    /// All but what takes a gibibyte of memory or more
    Full,
    /// All there is
    Large,
}

impl From<ProfileWord> for Profile {
    fn from(word: ProfileWord) -> Self {
        match word {
            ProfileWord::Baseline => Self::Baseline,
            ProfileWord::Full => Self::Full,
            ProfileWord::Large => Self::Large,
        }
    }
}

/// `--limits`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum LimitsWord {
    /// What the device says of itself
    #[default]
    Device,
    /// No more than Vulkan 1.3 demands of every device
    VulkanMinimum,
}

impl LimitsWord {
    pub fn caps(self) -> Caps {
        match self {
            Self::Device => Caps::UNLIMITED,
            Self::VulkanMinimum => Caps::VULKAN_MINIMUM,
        }
    }

    pub fn word(self) -> &'static str {
        match self {
            Self::Device => "device",
            Self::VulkanMinimum => "vulkan-minimum",
        }
    }
}

/// `QUEUES,THREADS`.
pub fn stress(text: &str) -> Result<Stress, String> {
    const MOST: u32 = 256;
    let number = |text: &str| text.parse().ok().filter(|n| (1..=MOST).contains(n));
    let found = text.split_once(',');
    let found = found.and_then(|(queues, threads)| {
        Some(Stress {
            queues: number(queues)?,
            threads: number(threads)?,
        })
    });
    found.ok_or_else(|| {
        format!("wanted QUEUES,THREADS from 1 to {MOST}, such as 2,8, found {text:?}")
    })
}

/// `I/N`.
pub fn shard(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("wanted I/N with I from 1 to N, such as 2/4, found {text:?}");
    let (part, parts) = text.split_once('/').ok_or_else(wrong)?;
    let [part, parts] = [part, parts].map(str::parse);
    match (part, parts) {
        (Ok(part), Ok(parts)) if (1..=parts).contains(&part) => Ok([part, parts]),
        _ => Err(wrong()),
    }
}
