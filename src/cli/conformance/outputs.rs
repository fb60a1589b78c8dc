//! Files that a run writes.

use super::super::{
    Error,
    output::{self, write_whole},
    signals::Gate,
};
use crate::conformance::case::Case;
use crate::conformance::dump::folder_of;
use crate::conformance::record::Package;
use crate::conformance::report::{html, junit, qpa};
use clap::Args;
use std::path::{Path, PathBuf};

/// Where to write what was found.
#[derive(Args, Debug)]
pub struct Outputs {
    /// Write all records
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the verdicts for a server of continuous integration
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write a test log as the Khronos suites do
    #[arg(long, value_name = "FILE")]
    qpa: Option<PathBuf>,
    /// Write a page with the pictures of what failed into a folder
    #[arg(long, value_name = "DIR")]
    html: Option<PathBuf>,
    /// Write shaders, parameters, buffers and pictures of each case into a folder of its own in this one
    #[arg(long, value_name = "DIR")]
    dump: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

impl Outputs {
    /// The folder of the page.
    pub fn pictures(&self) -> Option<&Path> {
        self.html.as_deref()
    }

    /// The folder of dumps.
    pub fn dumps(&self) -> Option<&Path> {
        self.dump.as_deref()
    }

    /// Refuses what cannot be written, before the work; makes the folders of the page and of the dumps.
    pub fn check(&self, inputs: &[PathBuf], chosen: &[&Case]) -> Result<(), Error> {
        let files = self.json.iter().chain(&self.junit).chain(&self.qpa);
        let files: Vec<PathBuf> = files.cloned().collect();
        output::check(&files, inputs, self.force)?;
        if let Some(dumps) = &self.dump {
            std::fs::create_dir_all(dumps).map_err(|cause| Error::output(dumps, &cause))?;
            let folders = chosen.iter().map(|case| folder_of(dumps, &case.name));
            let found = folders.into_iter().find(|folder| folder.exists());
            if let Some(path) = found.filter(|_| !self.force) {
                let (problem, hint) = ("it exists".to_owned(), Some("--force replaces it"));
                return Err(Error::Output {
                    path,
                    problem,
                    hint,
                });
            }
        }
        let Some(folder) = &self.html else {
            return Ok(());
        };
        std::fs::create_dir_all(folder).map_err(|cause| Error::output(folder, &cause))?;
        output::check(&[folder.join("index.html")], &[], self.force)
    }

    /// Each file whole or not at all.
    pub fn write(&self, package: &Package, gate: &Gate) -> Result<(), Error> {
        let write =
            |path: &Path, text: String| write_whole(path, text.as_bytes(), self.force, gate);
        if let Some(path) = &self.json {
            let text = serde_json::to_string_pretty(package).map_err(|cause| Error::Output {
                path: path.clone(),
                problem: cause.to_string(),
                hint: None,
            })?;
            write(path, format!("{text}\n"))?;
        }
        if let Some(path) = &self.junit {
            write(path, junit(package))?;
        }
        if let Some(path) = &self.qpa {
            write(path, qpa(package))?;
        }
        if let Some(folder) = &self.html {
            write(&folder.join("index.html"), html(package))?;
        }
        Ok(())
    }
}
