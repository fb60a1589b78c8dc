//! What can stop the program, the number it exits with, and the few lines that say so.
//!
//! | code | meaning |
//! |---|---|
//! | 0 | done |
//! | 1 | a comparison failed |
//! | 2 | the words of the command line cannot be followed |
//! | 3 | an input cannot be read |
//! | 4 | an output cannot be written |
//! | 5 | no Vulkan device can do it |
//! | 6 | a limit, or memory |
//! | 101 | a bug of ours (see [`super::bug`]) |
//! | 130 | interrupted |

use super::{flags::PHANTOM, sample_limit, signals::INTERRUPTED, stdin, technique_hints};
use crate::{
    annotate, gpu, offscreen,
    picture::{OutputError, PictureError},
    technique,
    volume::{Problem, ReadError},
};
use std::{borrow::Cow, error::Error as Cause, fmt::Write, io, path::PathBuf};

/// Why a command did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Two pictures are further apart than allowed.
    #[error("{0}")]
    Differs(String),
    /// The words are no command; the text says so at length and in colours of its own.
    #[error("{0}")]
    Arguments(String),
    /// The picture was asked to end early, and is written.
    #[error("interrupted: the picture is the mean of the paths that it had")]
    Interrupted,
    /// Another program that was started ended with this code, and has said why.
    #[error("exit code {0}")]
    Other(u8),
    /// The words cannot be followed.
    #[error("{message}")]
    Usage {
        /// What is wrong with them.
        message: String,
        /// What to write instead.
        hint: Cow<'static, str>,
    },
    /// A word that will be understood one day.
    #[error("{0} is not built yet")]
    NotBuilt(String),
    /// A volume cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A picture cannot be read.
    #[error(transparent)]
    ReadPicture(#[from] PictureError),
    /// Another input file cannot be read.
    #[error("cannot read {}: {problem}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// A picture cannot be written.
    #[error(transparent)]
    WritePicture(#[from] OutputError),
    /// Another file or the standard output cannot be written.
    #[error("cannot write {}: {problem}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// What stands in the way.
        problem: String,
        /// What to do, where that is plain.
        hint: Option<&'static str>,
    },
    /// No device, or one that cannot do it.
    #[error(transparent)]
    Device(#[from] gpu::Error),
    /// More than there is, or than is allowed.
    #[error("{message}")]
    Limit {
        /// Of what.
        message: String,
        /// How to stay below it.
        hint: Cow<'static, str>,
    },
    /// More of something than there may be.
    #[error("{message}")]
    TooMany {
        /// Of what.
        message: String,
        /// How to do with less.
        hint: &'static str,
    },
    /// More memory than there is.
    #[error("{0}")]
    Memory(String),
    /// The same, of a file that has to become bricks first.
    #[error("{message}")]
    NotInParts {
        /// What is wrong.
        message: String,
        /// The command that makes them.
        hint: String,
        /// True where a word asked for what this file has not.
        is_usage: bool,
    },
}

impl From<annotate::Error> for Error {
    fn from(error: annotate::Error) -> Self {
        let hint = match error {
            annotate::Error::NoLetter(_) => {
                "letters are those of Latin, Greek small letters, digits and signs"
            }
            annotate::Error::NoLogarithm(_) => "--colormap-scale linear, or a --window above 0",
        };
        Self::usage(error.to_string(), hint)
    }
}

impl From<offscreen::Error> for Error {
    fn from(error: offscreen::Error) -> Self {
        match error {
            offscreen::Error::Gpu(error) => Self::Device(error),
            offscreen::Error::Technique(technique::Error::NotShadedTogether) => {
                Self::not_shaded_together()
            }
            offscreen::Error::Technique(error @ technique::Error::FilterAlone { .. }) => {
                Self::usage(error.to_string(), "--filter linear draws them together")
            }
            offscreen::Error::Technique(error @ technique::Error::NoDerivative { .. }) => {
                Self::usage(
                    error.to_string(),
                    "--gradient-filter cubic is for every --filter",
                )
            }
            offscreen::Error::Technique(error @ technique::Error::NotKept { .. }) => Self::usage(
                error.to_string(),
                "--gradients auto keeps them where it can",
            ),
            offscreen::Error::Technique(error @ technique::Error::TooSteep { .. }) => Self::usage(
                error.to_string(),
                "--projection orthographic has no such rays; a smaller --fov or a light from elsewhere has fewer",
            ),
            offscreen::Error::Technique(error @ technique::Error::ShadowsNeedOneBrick { .. }) => {
                Self::Memory(error.to_string())
            }
            offscreen::Error::Technique(
                error @ (technique::Error::TooManySamples { .. }
                | technique::Error::LoopsEnd { .. }
                | technique::Error::SplatLoopsEnd { .. }
                | technique::Error::SlabsTooLong { .. }),
            ) => Self::Limit {
                message: error.to_string(),
                hint: sample_limit::hint(&error),
            },
            // A filter that a person asks for is refused before there is a picture.
            offscreen::Error::Technique(technique::Error::NotFor {
                wanted: "splatting",
                found,
                ..
            }) if found == "the filter nearest" => Self::usage(
                "--technique splat: the values are labels, and splats mix their neighbours: between two labels there is none",
                "--technique raycast draws labels; --filter linear takes them for numbers",
            ),
            offscreen::Error::Technique(error @ technique::Error::Classified { .. }) => {
                Self::Limit {
                    message: error.to_string(),
                    hint: "without --preclassified a volume takes less".into(),
                }
            }
            offscreen::Error::Technique(error) => {
                Self::usage(error.to_string(), technique_hints::hint(&error))
            }
            offscreen::Error::NoLayer { .. } => Self::NotBuilt(error.to_string()),
            offscreen::Error::NoNormals => {
                Self::usage(error.to_string(), "--component 0 takes one number a voxel")
            }
            offscreen::Error::NoLabels => {
                Self::usage(error.to_string(), "--labels FILE lays a map over INPUT")
            }
            offscreen::Error::NoLayersOfBegun => {
                Self::usage(error.to_string(), "leave out --aov or --resume")
            }
            offscreen::Error::NoLines => Self::usage(
                error.to_string(),
                "--flow stream draws lines along the wind",
            ),
            offscreen::Error::Read(error) => Self::Read(error),
            // Renderers of the program are made of all volumes of their scenes.
            offscreen::Error::FewerVolumes { .. } => unreachable!("{error}"),
            offscreen::Error::NotStreamed { .. } | offscreen::Error::Outline => Self::usage(
                error.to_string(),
                "--fit draws a reduced volume that fits into memory",
            ),
        }
    }
}

impl Error {
    /// A usage error with a hint.
    pub fn usage(message: impl Into<String>, hint: impl Into<Cow<'static, str>>) -> Self {
        Self::Usage {
            message: message.into(),
            hint: hint.into(),
        }
    }

    /// Half-angle slices show one volume.
    pub fn not_shaded_together() -> Self {
        Self::usage(
            "--shadows half-angle is for one number a voxel, and several are drawn",
            "draw one of them: --component 0, without --labels, --channel and --opacity-variable",
        )
    }

    /// The system would not let us write `path`.
    pub fn output(path: impl Into<PathBuf>, cause: &io::Error) -> Self {
        Self::Output {
            path: path.into(),
            problem: cause.to_string(),
            hint: None,
        }
    }

    /// What the process exits with.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Differs(_) => 1,
            Self::Other(code) => *code,
            Self::Interrupted => INTERRUPTED,
            Self::Arguments(_)
            | Self::Usage { .. }
            | Self::NotBuilt(_)
            | Self::NotInParts { is_usage: true, .. } => 2,
            Self::Read(ReadError {
                problem: Problem::Limit { .. },
                ..
            }) => 6,
            // The reader of a file of strangers took more than it may.
            Self::Read(ReadError {
                problem: Problem::Io { cause, .. },
                ..
            }) if matches!(
                cause.kind(),
                io::ErrorKind::TimedOut | io::ErrorKind::OutOfMemory
            ) =>
            {
                6
            }
            Self::Read(_) | Self::ReadPicture(_) | Self::Input { .. } => 3,
            Self::WritePicture(_) | Self::Output { .. } => 4,
            Self::Device(gpu::Error::Limit { .. } | gpu::Error::OutOfMemory { .. }) => 6,
            Self::Device(gpu::Error::Stopped) => INTERRUPTED,
            Self::Device(_) => 5,
            Self::Limit { .. } | Self::TooMany { .. } | Self::Memory(_) => 6,
            Self::NotInParts { .. } => 6,
        }
    }

    /// One line that says what to do, where something can be done.
    pub fn hint(&self) -> Option<&str> {
        match self {
            Self::NotInParts { hint, .. } => Some(hint),
            Self::Usage { hint, .. } => Some(hint),
            Self::TooMany { hint, .. } => Some(hint),
            Self::NotBuilt(_) => Some("`stratavox help` lists what is there"),
            Self::Output { hint, .. } => *hint,
            Self::Read(ReadError { path, problem }) => match problem {
                Problem::UnknownFormat(_) => {
                    Some("a file without a header needs its layout: --raw 256x256x109,i16")
                }
                Problem::Size { format: "raw", .. } => Some(
                    "--raw WxHxD,TYPE says how many voxels there are, and of how many bytes each",
                ),
                Problem::Limit { .. } if path.to_string_lossy().starts_with(PHANTOM) => Some(
                    "a smaller n= makes the phantom smaller, --fit does not; --max-memory 16G allows more",
                ),
                Problem::Limit { .. } => {
                    Some("--max-memory 16G allows more, where --untrusted does not forbid it")
                }
                Problem::Invalid { field, .. }
                    if ["variable", "data set", "series"].contains(&field.as_str()) =>
                {
                    Some("`stratavox info INPUT` lists them")
                }
                _ => None,
            },
            Self::Device(gpu::Error::Limit { .. } | gpu::Error::OutOfMemory { .. }) => {
                Some("a smaller --size or volume may fit; --device reference has no such limit")
            }
            Self::Memory(_) => {
                Some("--fit draws it with fewer voxels; --max-memory 16G sets what may be taken")
            }
            Self::Limit { hint, .. } => Some(hint),
            Self::Device(gpu::Error::Format { .. }) => {
                Some("--technique raycast needs no blending")
            }
            Self::Device(_) => Some(
                "`stratavox devices` says what is here; --device reference draws without Vulkan",
            ),
            Self::Arguments(_)
            | Self::Other(_)
            | Self::Interrupted
            | Self::Differs(_)
            | Self::ReadPicture(_)
            | Self::Input { .. }
            | Self::WritePicture(_) => None,
        }
    }

    /// The lines for a person: what happened, what caused it, what to do. Nothing that came from a file or
    /// a name can steer the terminal.
    pub fn lines(&self) -> String {
        match self {
            Self::Arguments(text) => return text.clone(),
            Self::Other(_) => return String::new(),
            _ => {}
        }
        let mut lines = format!("stratavox: {}\n", visible(&stdin::named(&self.to_string())));
        let mut last = self.to_string();
        let mut cause = self.source();
        while let Some(error) = cause {
            let text = error.to_string();
            // A transparent or summarizing error has already said what its cause says.
            if !last.contains(&text) {
                let _ = writeln!(lines, "  because: {}", visible(&stdin::named(&text)));
                last = text;
            }
            cause = error.source();
        }
        if let Some(hint) = self.hint() {
            let _ = writeln!(lines, "  hint: {hint}");
        }
        lines
    }
}

/// `text` on one line, with control characters spelled out and of bounded length.
pub fn visible(text: &str) -> String {
    const LONGEST: usize = 600;
    let mut shown = String::new();
    for c in text.chars() {
        if shown.len() >= LONGEST {
            shown.push_str(" ...");
            break;
        }
        match c {
            c if c.is_control() => shown.extend(c.escape_default()),
            // Marks that change the direction of text could make a line read as another one.
            '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                shown.extend(c.escape_unicode());
            }
            c => shown.push(c),
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unreadable(problem: Problem) -> Error {
        Error::Read(ReadError {
            path: "a\u{1b}[2Jb.nrrd".into(),
            problem,
        })
    }

    #[test]
    fn an_error_says_what_why_and_what_to_do_on_three_lines() {
        let lines = Error::Device(gpu::Error::NoDriver).lines();
        assert!(lines.starts_with("stratavox: no Vulkan device"), "{lines}");
        assert!(lines.contains("\n  hint: "), "{lines}");
        let io = Problem::Io {
            doing: "opening it",
            cause: io::Error::other("the cable is out"),
        };
        let lines = unreadable(io).lines();
        assert!(lines.contains("\n  because: the cable is out\n"), "{lines}");
        assert_eq!(lines.lines().count(), 2, "{lines}");
    }

    #[test]
    fn a_cause_that_was_said_is_not_said_again() {
        let error = unreadable(Problem::Missing {
            format: "nrrd",
            field: "sizes".to_owned(),
        });
        let lines = error.lines();
        assert_eq!(lines.matches("has no `sizes`").count(), 1, "{lines}");
    }

    #[test]
    fn a_hostile_name_cannot_steer_the_terminal() {
        let lines = unreadable(Problem::UnknownFormat(String::new())).lines();
        assert!(!lines.contains('\u{1b}'), "{lines:?}");
        assert!(lines.contains("a\\u{1b}[2Jb.nrrd"), "{lines:?}");
        assert!(visible(&"x".repeat(100_000)).len() < 700);
    }

    #[test]
    fn every_kind_of_error_has_the_exit_code_of_its_kind() {
        let limit = Problem::Limit {
            what: "the volume".to_owned(),
            wanted_bytes: 2,
            limit_bytes: 1,
        };
        for (error, code) in [
            (Error::Differs(String::new()), 1),
            (Error::usage("", ""), 2),
            (Error::NotBuilt("`--mode iso`".to_owned()), 2),
            (unreadable(Problem::UnknownFormat(String::new())), 3),
            (unreadable(limit), 6),
            (Error::output("x", &io::Error::other("full")), 4),
            (Error::Memory(String::new()), 6),
            (
                Error::Limit {
                    message: String::new(),
                    hint: "".into(),
                },
                6,
            ),
        ] {
            assert_eq!(error.exit_code(), code, "{error:?}");
        }
    }
}
