//! Whether a device conforms: cases with exact answers, and a verdict for each.
//!
//! ```text
//! tree::cases -> Case (name, profile, needs, run)
//! judge       -> run on a TestBed (a device) -> Measurement (expected, found, allowed) -> Record (verdict)
//! supervisor  -> hands names to a worker, a process of its own, and hears records: what dies there dies alone
//! report      -> JSON, JUnit, HTML;  package verifies one, difference compares two
//! ```
//!
//! A bound is derived and never fitted: its derivation is text in the record, and what was measured stands beside it.
//! `docs/conformance.md` has the words.

pub mod baseline;
pub mod case;
pub mod difference;
pub mod dump;
mod facts;
pub mod glob;
pub mod in_process;
pub mod judge;
pub mod measurement;
pub mod need;
pub mod oracle;
pub mod package;
pub mod record;
pub mod repeat;
pub mod report;
pub mod selection;
pub mod stress;
pub mod supervisor;
pub mod test_bed;
pub mod tree;
pub mod verdict;
pub mod waiver;
pub mod worker;

/// The version of the layout of packages.
pub const SCHEMA: u32 = 2;
