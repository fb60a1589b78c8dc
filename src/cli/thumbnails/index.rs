//! What became of each volume: a line each for `--index`, and for a person at the end.

use super::super::error::visible;
use serde::Serialize;

/// The file of `--index`.
#[derive(Debug, Default, Serialize)]
pub struct Index {
    stratavox_thumbnails: u32,
    drawn: usize,
    kept: usize,
    failed: usize,
    volumes: Vec<Row>,
}

/// One volume.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Row {
    /// The file or folder.
    pub input: String,
    /// Its picture, where there is one, by its name in the folder of pictures.
    pub picture: Option<String>,
    /// What became of it.
    pub became: Became,
    /// Voxels that were drawn, along x, y and z.
    pub dims: Option<[u32; 3]>,
    /// Why there is no picture.
    pub error: Option<String>,
    /// What a person should know about it.
    pub notes: Vec<String>,
}

/// What became of a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Became {
    /// A picture, by this run.
    Drawn,
    /// Its picture was there.
    Kept,
    /// No picture.
    #[default]
    Failed,
}

impl Index {
    /// Without a row.
    pub fn new() -> Self {
        Self {
            stratavox_thumbnails: 1,
            ..Self::default()
        }
    }

    /// One more.
    pub fn add(&mut self, row: Row) {
        *match row.became {
            Became::Drawn => &mut self.drawn,
            Became::Kept => &mut self.kept,
            Became::Failed => &mut self.failed,
        } += 1;
        self.volumes.push(row);
    }

    /// `12 drawn, 1 failed`.
    pub fn summary(&self) -> String {
        let kept = match self.kept {
            0 => String::new(),
            kept => format!(", {kept} kept"),
        };
        format!("{} drawn{kept}, {} failed", self.drawn, self.failed)
    }

    /// As the file has it.
    pub fn json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("plain data as JSON");
        text.push('\n');
        text
    }
}

impl Row {
    /// Lines for a person.
    pub fn lines(&self) -> Vec<String> {
        let said = self.notes.iter().chain(&self.error);
        said.map(|text| format!("{}: {}", visible(&self.input), visible(text)))
            .collect()
    }
}
