//! A volume of many, and the pictures that are made of it.
//!
//! ```text
//! volume -> NAME.png | by --views: NAME-VIEW.png of each
//! ```

use super::{Became, Row, parts::Part};
use crate::cli::flags::ViewWord;
use std::path::PathBuf;

/// One volume and its pictures.
#[derive(Debug)]
pub struct Item {
    /// As `render` takes it.
    pub input: String,
    /// Which of the volumes that it holds.
    pub part: Part,
    /// Of each view one.
    pub pictures: Vec<WantedPicture>,
}

/// A picture of a volume.
#[derive(Clone, Debug)]
pub struct WantedPicture {
    /// The side to stand on, where several are asked for.
    pub view: Option<ViewWord>,
    /// A name in the folder of pictures.
    pub picture: PathBuf,
    /// The picture is there and stays.
    pub is_kept: bool,
}

impl Item {
    /// True where a picture is not there yet.
    pub fn is_wanted(&self) -> bool {
        self.missing().next().is_some()
    }

    /// The pictures that are to be drawn, and which they are.
    pub fn missing(&self) -> impl Iterator<Item = (usize, &WantedPicture)> {
        let all = self.pictures.iter().enumerate();
        all.filter(|(_, wanted)| !wanted.is_kept)
    }

    /// What becomes of each, as long as nothing has.
    pub fn rows(&self) -> Vec<Row> {
        let row = |wanted: &WantedPicture| Row {
            input: self.input.clone(),
            series: self.part.series.clone(),
            variable: self.part.variable.clone(),
            view: wanted.view,
            picture: Some(wanted.picture.display().to_string()),
            became: match wanted.is_kept {
                true => Became::Kept,
                false => Became::Failed,
            },
            ..Row::default()
        };
        self.pictures.iter().map(row).collect()
    }
}
