//! The process in which cases run: names come in, a line each, and records go out as JSON, each between a record
//! separator and the end of its line (RFC 7464). Whatever else comes out was printed by the driver.
//!
//! ```text
//! in   raycast.ray.mip.ramp.linear.u8.orthographic
//! out  RS {"device":{...}}             once, before the first record
//! out  RS {"record":{...}}
//! ```

use super::case::Case;
use super::dump::dumped;
use super::judge::judge;
use super::measurement::Pictures;
use super::record::{DeviceRecord, Record};
use super::test_bed::TestBed;
use super::verdict::Verdict;
use crate::picture::compare::{Comparison, Image};
use crate::picture::{ColorSpace, Picture, WriteOptions, write_picture};
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, Write};
use std::path::{Path, PathBuf};

/// A line of a worker.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Line {
    /// The device that cases run on.
    Device(Box<DeviceRecord>),
    /// What is said of the case that was asked for.
    Record(Box<Record>),
}

/// No text of a driver has it, and JSON holds it escaped.
const RECORD_SEPARATOR: u8 = 0x1e;

impl Line {
    /// With the separator before it and the end of a line behind it.
    ///
    /// # Errors
    /// None but a mistake of ours.
    pub fn framed(&self) -> io::Result<Vec<u8>> {
        let mut bytes = vec![RECORD_SEPARATOR];
        serde_json::to_writer(&mut bytes, self)?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// What a driver printed in a line of output, and what the worker said behind it: `None` where that is nothing, an
    /// error with the text where it is no line of ours.
    pub fn unframed(line: &[u8]) -> (&[u8], Option<Result<Self, String>>) {
        let Some(place) = line.iter().rposition(|&byte| byte == RECORD_SEPARATOR) else {
            return (line, None);
        };
        let (printed, framed) = (&line[..place], &line[place + 1..]);
        let text = || String::from_utf8_lossy(framed).into_owned();
        (
            printed,
            Some(serde_json::from_slice(framed).map_err(|_| text())),
        )
    }
}

/// What a worker does in place of the case that it is asked for: so that the supervisor can be seen to survive it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// Ends by a signal.
    Abort,
    /// Ends with an exit code.
    Exit,
    /// Never answers.
    Hang,
    /// Answers what is no record.
    Babble,
    /// Says that the device is lost.
    LoseDevice,
    /// Says that the case fails, when it is run for the first time.
    Flake,
    /// Says that the case fails.
    Fail,
}

impl Trouble {
    /// The trouble of that word.
    pub fn of(word: &str) -> Option<Self> {
        Some(match word {
            "abort" => Self::Abort,
            "exit" => Self::Exit,
            "hang" => Self::Hang,
            "babble" => Self::Babble,
            "lose-device" => Self::LoseDevice,
            "flake" => Self::Flake,
            "fail" => Self::Fail,
            _ => return None,
        })
    }
}

/// How cases are run and answered.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answers<'a> {
    /// Where the pictures of failures are put.
    pub pictures: Option<&'a Path>,
    /// Where folders with all that passes between host and device are put, one a case.
    pub dumps: Option<&'a Path>,
    /// A pattern over names, and what happens at these cases.
    pub trouble: Option<(&'a str, Trouble)>,
}

impl Answers<'_> {
    /// Runs `case`, which ran before where `is_again` is true.
    ///
    /// # Errors
    /// Where pictures cannot be written.
    pub fn to(&self, case: &Case, is_again: bool, bed: &mut TestBed) -> io::Result<Record> {
        let is_meant = |(pattern, _): &(&str, Trouble)| super::glob::matches(pattern, &case.name);
        let trouble = self.trouble.filter(is_meant).map(|(_, trouble)| trouble);
        if let Some(trouble) = trouble {
            suffer(trouble);
        }
        let mut judged = || judge(case, bed);
        let (mut record, found) = match self.dumps {
            Some(dumps) if !is_again => dumped(dumps, &case.name, judged)?,
            _ => judged(),
        };
        match trouble {
            Some(Trouble::LoseDevice) => {
                record.verdict = Verdict::DeviceLost;
                record.reason = "asked for".to_owned();
            }
            Some(Trouble::Flake) if is_again => {}
            Some(Trouble::Flake | Trouble::Fail) => {
                record.verdict = Verdict::Fail;
                record.reason = "asked for".to_owned();
            }
            _ => {}
        }
        let shown = found.filter(|_| record.verdict == Verdict::Fail);
        if let Some((folder, found)) = self.pictures.zip(shown) {
            let path = |what: &str| folder.join(format!("{}.{what}.png", case.name));
            let paths = picture_files(&found, path)?;
            let names = paths.iter().filter_map(|path| path.file_name());
            record.pictures = names
                .map(|name| name.to_string_lossy().into_owned())
                .collect();
        }
        Ok(record)
    }
}

/// Answers until the names end.
///
/// # Errors
/// Where a line cannot be read or written.
pub fn serve(cases: &[Case], bed: &mut TestBed, answers: &Answers) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let mut is_introduced = false;
    for name in io::stdin().lock().lines() {
        let name = name?;
        let wanted = name.strip_prefix("again ").unwrap_or(&name);
        let is_again = wanted != name;
        let Some(case) = cases.iter().find(|case| case.name == wanted) else {
            return Err(io::Error::other(format!("there is no case {wanted}")));
        };
        if !is_introduced && let Ok(device) = bed.device() {
            let device = DeviceRecord::of(device.gpu());
            say(&mut out, &Line::Device(Box::new(device)))?;
            is_introduced = true;
        }
        let record = answers.to(case, is_again, bed)?;
        say(&mut out, &Line::Record(Box::new(record)))?;
    }
    Ok(())
}

fn suffer(trouble: Trouble) {
    match trouble {
        Trouble::Abort => std::process::abort(),
        Trouble::Exit => std::process::exit(3),
        Trouble::Hang => loop {
            std::thread::park();
        },
        Trouble::Babble => println!("{}no record", char::from(RECORD_SEPARATOR)),
        Trouble::LoseDevice | Trouble::Flake | Trouble::Fail => {}
    }
}

/// At once: a thread of a driver may be printing.
fn say(out: &mut impl Write, line: &Line) -> io::Result<()> {
    out.write_all(&line.framed()?)?;
    out.flush()
}

/// Expected, found and where they differ, as files at the paths that `path` gives for these words.
///
/// # Errors
/// Where one cannot be written.
pub fn picture_files(
    pictures: &Pictures,
    path: impl Fn(&str) -> PathBuf,
) -> io::Result<Vec<PathBuf>> {
    let of = |pixels: &[[f32; 4]]| Picture {
        width: pictures.width,
        height: (pixels.len() as u32) / pictures.width,
        pixels: pixels.to_vec(),
        color_space: ColorSpace::Linear,
        layers: Vec::new(),
    };
    let (expected, found) = (of(&pictures.expected), of(&pictures.found));
    let mut all = vec![("expected", expected.clone()), ("found", found.clone())];
    if let Ok(comparison) = Comparison::of(&Image::from(&expected), &Image::from(&found)) {
        all.push(("difference", comparison.picture()));
    }
    let options = WriteOptions {
        force: true,
        ..WriteOptions::default()
    };
    let mut paths = Vec::new();
    for (what, picture) in all {
        let path = path(what);
        write_picture(&picture, &path, options).map_err(io::Error::other)?;
        paths.push(path);
    }
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::case::Profile;

    #[test]
    fn what_a_driver_prints_before_an_answer_is_no_part_of_it() {
        let record = Record::unmeasured("a", Profile::Full, Verdict::Fail, "\u{1e}\n".into());
        let framed = Line::Record(Box::new(record)).framed().unwrap();
        let (end, line) = framed.split_last().unwrap();
        assert_eq!(*end, b'\n');
        for printed in [&b""[..], b"loading \xff ... ", b"{\"record\": \x1e"] {
            let all = [printed, line].concat();
            let (found, said) = Line::unframed(&all);
            assert_eq!(found, printed);
            let Some(Ok(Line::Record(record))) = said else {
                panic!("{said:?}");
            };
            assert_eq!(record.reason, "\u{1e}\n");
        }
        assert!(Line::unframed(b"{\"record\": {}}").1.is_none());
        let (_, said) = Line::unframed(b"\x1eno record");
        assert_eq!(said.unwrap().unwrap_err(), "no record");
    }
}
