//! Functions of files, as flags and scenes carry them.

use super::{Error, with_causes};
use crate::{
    cli::output::say_aside,
    transfer::{
        Scale, TransferFunction, import_transfer_function, transfer_function_from_json,
        transfer_function_to_json,
    },
};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A function that stood in a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inlined {
    /// Ours.
    pub transfer_function: serde_json::Value,
    /// True where its points stand at fractions of the window or of the volume's range.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub of_fractions: bool,
}

impl Inlined {
    /// What stands in the file at `path`; what cannot be taken over is said.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let imported = import_transfer_function(path, None).map_err(|error| Error::Input {
            path: path.to_owned(),
            problem: with_causes(&error.problem),
        })?;
        for piece in &imported.left_out {
            say_aside(&format!("{}: not taken over: {piece}", path.display()));
        }
        let mut transfer_function = inlined(&imported.function).transfer_function;
        if imported.preintegrated {
            transfer_function["preintegrated"] = true.into();
        }
        Ok(Self {
            transfer_function,
            of_fractions: imported.scale == Scale::Fractions,
        })
    }
}

/// The function as flags carry it.
pub fn inlined(function: &TransferFunction) -> Inlined {
    let text = transfer_function_to_json(function);
    Inlined {
        transfer_function: serde_json::from_str(&text).expect("what we have just written as JSON"),
        of_fractions: false,
    }
}

/// The function that a scene states.
pub fn function_in(value: &serde_json::Value) -> Result<TransferFunction, Error> {
    transfer_function_from_json(value.to_string().as_bytes()).map_err(|problem| Error::Input {
        path: Path::new("the scene's transfer_function").to_owned(),
        problem: with_causes(&problem),
    })
}
