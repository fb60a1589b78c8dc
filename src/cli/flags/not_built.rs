//! Words that are promised and not built yet: taken, and refused by name.

use super::Error;
use clap::Args;

/// Flags of `render` that come later.
#[derive(Args, Clone, Debug, Default)]
pub struct NotBuilt {
    #[arg(long, value_name = "FILTER", help_heading = HEADING)]
    gradient_filter: Option<String>,
}

/// Under which these stand in `--help`.
pub const HEADING: &str = "Not built yet";

impl NotBuilt {
    /// Refuses the first flag that was given.
    pub fn refuse(&self) -> Result<(), Error> {
        let given = [("--gradient-filter", self.gradient_filter.as_deref())];
        match given
            .into_iter()
            .find_map(|(flag, value)| Some((flag, value?)))
        {
            Some((flag, _)) => Err(Error::NotBuilt(format!("`{flag}`"))),
            None => Ok(()),
        }
    }
}
