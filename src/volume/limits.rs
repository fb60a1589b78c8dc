//! What reading may take: `declared bytes <= max_bytes`, asked before anything is allocated.

/// What a reader may use. Checked against declared sizes before anything is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// Memory that one volume may take.
    pub max_bytes: u64,
    /// Files that one header may name.
    pub max_files: usize,
    /// Bytes of a text header.
    pub max_header_bytes: usize,
    /// True where a header may name other files, always in its own folder.
    pub detached: bool,
}

impl Limits {
    /// For files of strangers: one file, small headers, little memory.
    pub const UNTRUSTED: Self = Self {
        max_bytes: 1 << 30,
        max_files: 4096,
        max_header_bytes: 1 << 16,
        detached: false,
    };
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_bytes: 4 << 30,
            max_files: 65_536,
            max_header_bytes: 1 << 20,
            detached: true,
        }
    }
}
