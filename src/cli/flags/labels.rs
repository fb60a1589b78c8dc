//! A label map that lies over a volume, or cuts parts out of it: the words.

use super::{Error, numbers::share};
use crate::{
    cli::small_file,
    technique::DEFAULT_DIM,
    transfer::{LabelTable, MAX_FILE_BYTES},
};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::{
    fmt,
    ops::RangeInclusive,
    path::{Path, PathBuf},
    str::FromStr,
};

const HEADING: &str = "Labels";

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LabelFlags {
    /// A label map of the same place: each label is drawn over the volume in a colour of its own; in modes but composite
    /// the first label along each ray lies over the picture
    #[arg(long, value_name = "FILE", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub labels: Option<PathBuf>,
    /// Names, colours and opacities of labels: a transfer function file with a key `labels`, an ITK-SNAP description, a
    /// Slicer colour table, or lines `1 name`
    #[arg(long, value_name = "FILE", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label_tf: Option<PathBuf>,
    /// Show only what has these labels; without --label-tf the volume keeps its own colours
    #[arg(long, value_name = "N,A-B,...", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label_show: Option<LabelList>,
    /// Hide what has these labels
    #[arg(long, value_name = "N,A-B,...", conflicts_with = "label_show", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label_hide: Option<LabelList>,
    /// Make what has these labels faint and grey: so much is left of its opacity and its colour [default: 0.2]
    #[arg(long, value_name = "N,A-B,...[:F]", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label_dim: Option<DimmedLabels>,
    /// Opacity of labels, 0 to 1. Over a section or a projection it multiplies that of the table [default: 0.5]; in
    /// composites labels have it where no table says one, per 1/512 of the diagonal [default: 0.05, lit 0.15]
    #[arg(long, value_name = "A", value_parser = share, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label_opacity: Option<f64>,
}

/// `1,2,5-9`, or `1,2,5-9:0.1`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct DimmedLabels {
    labels: LabelList,
    share: Option<f64>,
}

/// `1,2,5-9`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct LabelList(Vec<RangeInclusive<i64>>);

impl LabelFlags {
    /// The table of `--label-tf`.
    pub fn table(&self) -> Result<Option<LabelTable>, Error> {
        let Some(path) = &self.label_tf else {
            return Ok(None);
        };
        let parse = |text: &[u8]| LabelTable::parse(text).map_err(|problem| problem.to_string());
        small_file::parsed(path, "a table of labels", MAX_FILE_BYTES, parse).map(Some)
    }

    /// True where labels cut and nothing says that they are drawn too.
    pub fn only_cut(&self) -> bool {
        self.cut() && self.label_tf.is_none()
    }

    /// True where words say how labels are seen: hidden or dimmed.
    pub fn cut(&self) -> bool {
        self.label_show.is_some() || self.label_hide.is_some() || self.label_dim.is_some()
    }

    /// Whether what has this label is faint; the words count more than the table.
    pub fn dims(&self, table: Option<&LabelTable>, label: i64) -> bool {
        match &self.label_dim {
            Some(all) => all.labels.has(label),
            None => table.is_some_and(|table| table.dimmed.contains(&label)),
        }
    }

    /// What is left of the opacity and of the colour of dimmed labels.
    pub fn dim(&self) -> Result<f64, Error> {
        let of_words = self.label_dim.as_ref().and_then(|all| all.share);
        match of_words {
            Some(share) => Ok(share),
            None => Ok(self
                .table()?
                .and_then(|table| table.dim)
                .unwrap_or(DEFAULT_DIM)),
        }
    }

    /// True where words say which labels are left.
    pub fn shows_some(&self) -> bool {
        self.label_show.is_some() || self.label_hide.is_some()
    }

    /// Whether the words leave what has this label.
    pub fn shows(&self, label: i64) -> bool {
        let is_shown = self.label_show.as_ref().is_none_or(|all| all.has(label));
        is_shown && !self.label_hide.as_ref().is_some_and(|all| all.has(label))
    }

    /// The files.
    pub fn files(&self) -> [Option<&Path>; 2] {
        [self.labels.as_deref(), self.label_tf.as_deref()]
    }

    /// The same words with other paths.
    pub fn with_paths(&self, path: impl Fn(&Path) -> PathBuf) -> Self {
        let [labels, label_tf] = self.files().map(|file| file.map(&path));
        Self {
            labels,
            label_tf,
            ..self.clone()
        }
    }
}

impl LabelList {
    fn has(&self, label: i64) -> bool {
        self.0.iter().any(|range| range.contains(&label))
    }
}

impl FromStr for LabelList {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || format!("wanted labels such as 1,2,5-9, found {text:?}");
        let number = |word: &str| word.trim().parse::<i64>().map_err(|_| wanted());
        let range = |word: &str| -> Result<_, String> {
            // The first character may be a sign.
            let dash = word.char_indices().skip(1).find(|&(_, c)| c == '-');
            let [low, high] = match dash {
                Some((at, _)) => [number(&word[..at])?, number(&word[at + 1..])?],
                None => [number(word)?; 2],
            };
            (low <= high).then_some(low..=high).ok_or_else(wanted)
        };
        text.split(',')
            .map(range)
            .collect::<Result<_, _>>()
            .map(Self)
    }
}

impl FromStr for DimmedLabels {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (labels, share) = match text.split_once(':') {
            None => (text, None),
            Some((labels, share)) => {
                let found = share
                    .trim()
                    .parse()
                    .ok()
                    .filter(|x| (0.0..=1.0).contains(x));
                let wanted =
                    || format!("wanted a number from 0 to 1 after the colon, found {share:?}");
                (labels, Some(found.ok_or_else(wanted)?))
            }
        };
        let labels = labels.parse()?;
        Ok(Self { labels, share })
    }
}

impl fmt::Display for DimmedLabels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.labels.fmt(f)?;
        self.share.map_or(Ok(()), |share| write!(f, ":{share}"))
    }
}

impl TryFrom<String> for DimmedLabels {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<DimmedLabels> for String {
    fn from(list: DimmedLabels) -> Self {
        list.to_string()
    }
}

impl fmt::Display for LabelList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<_> = self
            .0
            .iter()
            .map(|range| match (range.start(), range.end()) {
                (low, high) if low == high => low.to_string(),
                (low, high) => format!("{low}-{high}"),
            })
            .collect();
        f.write_str(&words.join(","))
    }
}

impl TryFrom<String> for LabelList {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<LabelList> for String {
    fn from(list: LabelList) -> Self {
        list.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_of_labels_has_its_numbers_and_ranges() {
        let list: LabelList = "1,5-9,-3".parse().expect("a list");
        let found: Vec<i64> = (-4..=10).filter(|&label| list.has(label)).collect();
        assert_eq!(found, [-3, 1, 5, 6, 7, 8, 9]);
        assert_eq!(list.to_string(), "1,5-9,-3");
    }

    #[test]
    fn what_is_no_list_of_labels_is_refused() {
        for text in ["", "a", "3-1", "1,,2", "1.5"] {
            assert!(text.parse::<DimmedLabels>().is_err(), "{text}");
            let problem = text.parse::<LabelList>().expect_err(text);
            assert!(problem.contains("1,2,5-9"), "{text}: {problem}");
        }
        for text in ["1:", "1:2", "1:-0.1", "1:x", "1:nan"] {
            let problem = text.parse::<DimmedLabels>().expect_err(text);
            assert!(problem.contains("from 0 to 1"), "{text}: {problem}");
        }
    }

    #[test]
    fn the_words_on_dimming_count_more_than_the_table() {
        let text = r#"{"stratavox_transfer_function":1,"dim":[7],"labels":[[1,"a",0,0,1,1]]}"#;
        let table = LabelTable::parse(text.as_bytes()).expect("a table");
        let silent = LabelFlags::default();
        assert!(silent.dims(Some(&table), 7) && !silent.dims(Some(&table), 3));
        let flags = LabelFlags {
            label_dim: Some("3,5-6:0.25".parse().expect("a list")),
            ..LabelFlags::default()
        };
        assert!(flags.dims(Some(&table), 3) && !flags.dims(Some(&table), 7));
        assert_eq!(flags.dim().expect("a share"), 0.25);
        assert_eq!(String::from(flags.label_dim.expect("set")), "3,5-6:0.25");
    }
}
