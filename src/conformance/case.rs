//! A case: a name in the tree, what it asks of a device, and what it does there.

use super::measurement::Measurement;
use super::need::Found;
use super::test_bed::TestBed;
use crate::gpu::{self, Item};
use crate::offscreen;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Which devices must pass it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// Any device of Vulkan 1.3: minutes on two cores.
    Baseline,
    /// All but what takes a gibibyte of memory or more.
    Full,
    /// All there is.
    Large,
}

impl Profile {
    /// The word of the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Full => "full",
            Self::Large => "large",
        }
    }
}

/// Why a case could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum Stop {
    /// The device or the library refused.
    #[error(transparent)]
    Offscreen(#[from] offscreen::Error),
    /// The device has less of something than this case wants of it, which is known when its sizes are.
    #[error("{}: wanted {}, the device says {}", .0.name, .0.wanted, .0.device_says)]
    Lacking(Box<Found>),
    /// The suite did not do its work.
    #[error("{0}")]
    Suite(String),
}

impl From<gpu::Error> for Stop {
    fn from(error: gpu::Error) -> Self {
        Self::Offscreen(error.into())
    }
}

/// What a case does.
pub type Run = Box<dyn Fn(&mut TestBed) -> Result<Measurement, Stop> + Send + Sync>;

/// One question to a device.
pub struct Case {
    /// Words from the general to the special, dots between.
    pub name: String,
    /// Where it belongs.
    pub profile: Profile,
    /// What a device has to have for it.
    pub needs: Vec<Item>,
    /// Whether it calls `vkCreateEvent`, of which the library has no need.
    pub wants_events: bool,
    /// The measurement.
    pub run: Run,
}

impl Case {
    /// A case of the baseline that needs nothing beyond it.
    pub fn new(
        name: impl Into<String>,
        run: impl Fn(&mut TestBed) -> Result<Measurement, Stop> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            profile: Profile::Baseline,
            needs: Vec::new(),
            wants_events: false,
            run: Box::new(run),
        }
    }

    /// The same, which needs something.
    pub fn needing(mut self, item: Item) -> Self {
        self.needs.push(item);
        self
    }

    /// The same, which needs events.
    pub fn wanting_events(mut self) -> Self {
        self.wants_events = true;
        self
    }

    /// The same, in another profile.
    pub fn of(mut self, profile: Profile) -> Self {
        self.profile = profile;
        self
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Case")
            .field("name", &self.name)
            .field("profile", &self.profile)
            .finish_non_exhaustive()
    }
}
