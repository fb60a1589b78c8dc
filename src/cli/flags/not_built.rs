//! Words that are promised and not built yet: taken, and refused by name.

use super::Error;
use clap::Args;

/// Flags of `render` that come later.
#[derive(Args, Clone, Debug, Default)]
pub struct NotBuilt {
    #[arg(long, value_name = "VALUE,...", allow_hyphen_values = true, help_heading = HEADING)]
    iso: Option<String>,
    #[arg(long, value_name = "FILTER", help_heading = HEADING)]
    gradient_filter: Option<String>,
    /// Only `none`
    #[arg(long, value_name = "none|phong", help_heading = HEADING)]
    shading: Option<String>,
    #[arg(long, value_name = "A,D,S,N", help_heading = HEADING)]
    material: Option<String>,
}

/// Under which these stand in `--help`.
pub const HEADING: &str = "Not built yet";

impl NotBuilt {
    /// Refuses the first flag that was given.
    pub fn refuse(&self) -> Result<(), Error> {
        let shading = self.shading.as_deref().filter(|&word| word != "none");
        let given = [
            ("--iso", self.iso.as_deref()),
            ("--gradient-filter", self.gradient_filter.as_deref()),
            ("--shading", shading),
            ("--material", self.material.as_deref()),
        ];
        match given
            .into_iter()
            .find_map(|(flag, value)| Some((flag, value?)))
        {
            Some(("--shading", word)) => Err(Error::NotBuilt(format!("`--shading {word}`"))),
            Some((flag, _)) => Err(Error::NotBuilt(format!("`{flag}`"))),
            None => Ok(()),
        }
    }
}
