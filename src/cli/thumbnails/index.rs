//! What became of each volume: a line each for `--index`, and for a person at the end.

use crate::cli::flags::ViewWord;
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

/// One picture of a volume.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Row {
    /// The file or folder.
    pub input: String,
    /// The UID of the series, of a folder that holds several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<String>,
    /// The name of the variable, of a file that holds several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub variable: Option<String>,
    /// The side that it is seen from, where several were asked for: each has a row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewWord>,
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
    /// What the camera was fitted to, and by which flags.
    pub framed: Vec<String>,
}

impl Row {
    /// True for another view of the same volume.
    fn is_of_same_volume(&self, other: &Self) -> bool {
        let volume = |row: &Self| (row.input.clone(), row.series.clone(), row.variable.clone());
        volume(self) == volume(other)
    }
}

/// What became of a picture.
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

/// Notes in the order in which they came, each once, with the volumes that it is about; how each was framed comes last, so
/// that it leaves the page to what is unusual.
pub fn notes_of(rows: &[Row]) -> Vec<String> {
    const MOST: usize = 20;
    let mut all: Vec<(&str, Vec<&Row>)> = Vec::new();
    let said = |notes: fn(&Row) -> &[String]| {
        rows.iter()
            .flat_map(move |row| notes(row).iter().map(move |note| (row, note)))
    };
    for (row, note) in said(|row| &row.notes).chain(said(|row| &row.framed)) {
        match all.iter_mut().find(|(known, _)| known == note) {
            // Said of the volume, whatever it is seen from.
            Some((_, about)) if about.iter().any(|known| known.is_of_same_volume(row)) => {}
            Some((_, about)) => about.push(row),
            None => all.push((note, vec![row])),
        }
    }
    let left_out = all.len().saturating_sub(MOST);
    let shown = all.iter().take(MOST).map(|(note, about)| match about[..] {
        [one] => format!("{}: {note}", one.input),
        _ => format!("{} volumes: {note}", about.len()),
    });
    let rest = (left_out > 0).then(|| format!("{left_out} notes more: --index has them all"));
    shown.chain(rest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_about_many_volumes_is_said_once_and_no_more_than_a_page_in_all() {
        let row = |input: usize, notes: &[&str]| Row {
            input: input.to_string(),
            notes: notes.iter().map(|&note| note.to_owned()).collect(),
            ..Row::default()
        };
        let rows = [
            row(1, &["a"]),
            row(2, &["b", "a"]),
            row(3, &[]),
            row(4, &["c"]),
        ];
        assert_eq!(notes_of(&rows), ["2 volumes: a", "2: b", "4: c"]);
        let views = [row(1, &["a"]), row(1, &["a"]), row(1, &["b"])];
        assert_eq!(notes_of(&views), ["1: a", "1: b"]);
        let framed = Row {
            framed: vec!["f".to_owned()],
            ..row(1, &[])
        };
        assert_eq!(notes_of(&[framed, row(2, &["b"])]), ["2: b", "1: f"]);
        let rows: Vec<Row> = (0..50).map(|k| row(k, &[&format!("note {k}")])).collect();
        let notes = notes_of(&rows);
        assert!(
            notes.len() == 21 && notes[20].starts_with("30 notes more"),
            "{notes:?}"
        );
    }
}
