//! Several numbers a voxel that are drawn together, each in a colour of its own: the words.

use super::{Component, Error, InputFlags, color::rgb};
use crate::{
    shaders::MAX_CHANNELS,
    volume::{ComponentKind, Header},
};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::{collections::BTreeSet, fmt, str::FromStr};

const HEADING: &str = "Channels";

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ChannelFlags {
    /// Draw this channel, counted from 0, together with others, in a colour (name, #hex, or R:G:B from 0 to 1) and over a
    /// window of values; once for each channel
    #[arg(
        long,
        value_name = "N[,color=COLOR][,window=LO:HI]",
        conflicts_with = "channels",
        help_heading = HEADING
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub channel: Vec<ChannelWord>,
    /// Draw these channels together, in colours and windows that suit them (the same as --component all: all of them)
    #[arg(long, value_name = "N,...", value_delimiter = ',', help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub channels: Vec<u32>,
}

/// One channel and how it is seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ChannelWord {
    /// Its number, counted from 0.
    pub index: u32,
    /// sRGB, 0 to 1.
    pub srgb: Option<[f64; 3]>,
    /// From dark to bright.
    pub window: Option<[f64; 2]>,
}

/// How the numbers of a voxel are drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Plan {
    /// One of them.
    One,
    /// Some of them, each in a colour of its own.
    Channels(Vec<ChannelWord>),
    /// As the colour that they are.
    Colors,
}

impl ChannelFlags {
    /// True where a word was given.
    pub fn are_given(&self) -> bool {
        !self.channel.is_empty() || !self.channels.is_empty()
    }

    /// What the words, or else the file, want to be drawn; and what a person should know of it. `room`: how many
    /// volumes can be drawn together.
    pub fn plan(
        &self,
        input: &InputFlags,
        header: &Header,
        room: usize,
    ) -> Result<(Plan, Option<String>), Error> {
        if self.are_given() && !matches!(input.component, None | Some(Component::All)) {
            return Err(Error::usage(
                "--component takes one channel, --channel and --channels several",
                "leave out one of them",
            ));
        }
        let all = || (0..header.components).map(word_of).collect::<Vec<_>>();
        let words = if !self.channel.is_empty() {
            self.channel.clone()
        } else if !self.channels.is_empty() {
            self.channels.iter().copied().map(word_of).collect()
        } else if input.component == Some(Component::All) && header.components > 1 {
            all()
        } else if input.component.is_some() || header.components == 1 {
            return Ok((Plan::One, None));
        } else {
            return Ok(match header.meaning {
                ComponentKind::Rgb | ComponentKind::Rgba => (Plan::Colors, None),
                ComponentKind::Channels(_) => {
                    let mut words = all();
                    let note = (words.len() > room).then(|| {
                        format!(
                            "of {} channels the first {room} are drawn; --channels takes others",
                            words.len()
                        )
                    });
                    words.truncate(room);
                    (Plan::Channels(words), note)
                }
                ComponentKind::Numbers | ComponentKind::Vector => (Plan::One, None),
            });
        };
        check(&words, header, room)?;
        Ok((Plan::Channels(words), None))
    }
}

fn word_of(index: u32) -> ChannelWord {
    ChannelWord {
        index,
        ..ChannelWord::default()
    }
}

fn check(words: &[ChannelWord], header: &Header, room: usize) -> Result<(), Error> {
    let mut seen = BTreeSet::new();
    for word in words {
        let index = word.index;
        if index >= header.components {
            return Err(Error::usage(
                format!(
                    "channel {index}: a voxel has {} of them, counted from 0",
                    header.components
                ),
                "--channels 0",
            ));
        }
        if !seen.insert(index) {
            return Err(Error::usage(
                format!("channel {index} is named twice"),
                "--channels 0,1",
            ));
        }
    }
    if words.len() > room {
        return Err(Error::usage(
            format!(
                "{} channels: at most {room} can be drawn together ({MAX_CHANNELS}, labels among them)",
                words.len()
            ),
            "choose some: --channels 0,1,2",
        ));
    }
    Ok(())
}

impl FromStr for ChannelWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.split(',');
        let index = parts.next().unwrap_or_default();
        let index = index
            .parse()
            .map_err(|_| format!("wanted the number of a channel, found {index:?}"))?;
        let mut word = word_of(index);
        for part in parts {
            match part.split_once('=') {
                Some(("color", color)) if word.srgb.is_none() => word.srgb = Some(rgb(color)?),
                Some(("window", window)) if word.window.is_none() => {
                    word.window = Some(window_of(window)?);
                }
                _ => {
                    return Err(format!(
                        "wanted color=... or window=..., each once, found {part:?}"
                    ));
                }
            }
        }
        Ok(word)
    }
}

pub(super) fn window_of(text: &str) -> Result<[f64; 2], String> {
    let ends = text.split_once(':').and_then(|(low, high)| {
        let ends: [f64; 2] = [low.parse().ok()?, high.parse().ok()?];
        (ends[0] < ends[1] && (ends[1] - ends[0]).is_finite()).then_some(ends)
    });
    ends.ok_or_else(|| format!("window {text:?}: wanted LO:HI, a low value and a higher one"))
}

impl fmt::Display for ChannelWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.index)?;
        if let Some([r, g, b]) = self.srgb {
            write!(f, ",color={r}:{g}:{b}")?;
        }
        if let Some([low, high]) = self.window {
            write!(f, ",window={low}:{high}")?;
        }
        Ok(())
    }
}

impl TryFrom<String> for ChannelWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<ChannelWord> for String {
    fn from(word: ChannelWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_comes_back_as_it_was_written() {
        for text in ["2", "0,color=0:0.5:1", "1,color=1:0:1,window=-3:4.5"] {
            let word: ChannelWord = text.parse().expect(text);
            assert_eq!(word.to_string(), text);
        }
        let word: ChannelWord = "1,window=0:9,color=magenta".parse().expect("a channel");
        assert_eq!(word.srgb, Some([1.0, 0.0, 1.0]));
    }

    #[test]
    fn what_is_no_channel_is_refused_by_its_part() {
        for (text, wanted) in [
            ("x", "\"x\""),
            ("0,color=puce", "puce"),
            ("0,color=2:0:0", "2:0:0"),
            ("0,window=4:4", "4:4"),
            ("0,window=0:1,window=0:2", "each once"),
            ("0,hue=3", "hue=3"),
        ] {
            let problem = text.parse::<ChannelWord>().expect_err(text);
            assert!(problem.contains(wanted), "{text}: {problem}");
        }
    }
}
