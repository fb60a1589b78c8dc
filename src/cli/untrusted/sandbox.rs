//! Landlock: the process that reads opens nothing but its input, and connects to nothing.

use landlock::{
    ABI, Access, AccessFs, AccessNet, Ruleset, RulesetAttr, RulesetCreatedAttr, Scope,
    path_beneath_rules,
};
use std::{io, path::Path};

/// What the newest kernel that is known here restricts. An older one restricts what it can.
const NEWEST: ABI = ABI::V6;

/// Takes from this process, for as long as it lives, every file but `path`, which is a file or a folder with all that
/// lies in it, and that for reading; TCP; and signals and abstract sockets of other processes.
///
/// A kernel without Landlock (before Linux 5.13, or built without it) restricts nothing; this is no error.
///
/// # Errors
/// Landlock is there and refuses the rules.
pub fn restrict_to(path: &Path) -> io::Result<()> {
    let restricted = || {
        Ruleset::default()
            .handle_access(AccessFs::from_all(NEWEST))?
            .handle_access(AccessNet::from_all(NEWEST))?
            .scope(Scope::from_all(NEWEST))?
            .create()?
            .add_rules(path_beneath_rules(
                [path],
                AccessFs::ReadFile | AccessFs::ReadDir,
            ))?
            .restrict_self()
    };
    restricted().map_err(io::Error::other)?;
    Ok(())
}
