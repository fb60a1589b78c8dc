//! The markup of a VTK XML file as a small tree. Text stays in the file: only its place is kept.
//!
//! Nothing in the markup can grow: no document type (and so no entities but the five of XML itself), bounded
//! depth, bounded numbers of elements and attributes, and a bounded number of bytes that are not text.

use super::VTI;
use crate::fence::fenced;
use crate::format::place::open_regular;
use crate::format::problem::{self, escape, invalid, unsupported};
use crate::volume::Problem;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

const MOST_DEPTH: usize = 32;
const MOST_ATTRIBUTES: usize = 256;
const MOST_ELEMENTS: usize = 1 << 16;

/// One element with all that is in it.
#[derive(Debug, Default)]
pub(in crate::format) struct Element {
    pub name: String,
    attributes: Vec<(String, String)>,
    pub children: Vec<Element>,
    /// Where its own text stands, if it has any.
    pub text: Option<Span>,
}

/// Bytes of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::format) struct Span {
    pub start: u64,
    pub end: u64,
}

/// A file taken apart.
#[derive(Debug)]
pub(in crate::format) struct Document {
    pub root: Element,
    /// The element `AppendedData` and the place of what it holds, behind the `_`.
    pub appended: Option<(Element, Span)>,
}

impl Element {
    /// What stands behind the attribute, if it is there.
    pub(in crate::format) fn get(&self, name: &str) -> Option<&str> {
        let mut all = self.attributes.iter();
        all.find(|(found, _)| found == name)
            .map(|(_, value)| value.as_str())
    }

    /// What stands behind an attribute that must be there.
    pub(in crate::format) fn required(&self, name: &str) -> Result<&str, Problem> {
        self.get(name)
            .ok_or_else(|| problem::missing(VTI, &format!("{} {name}", self.name)))
    }

    /// The children of a name.
    pub(in crate::format) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.name == name)
    }
}

/// Reads the markup of a file, at most `limit_bytes` of it, to its end or to where appended data begin.
pub(in crate::format) fn read(path: &Path, limit_bytes: usize) -> Result<Document, Problem> {
    // The parser is not ours: whatever it does, it is this file that is wrong.
    fenced(|| parse(path, limit_bytes)).unwrap_or_else(|words| {
        let wanted = "XML that the parser can take";
        Err(invalid(VTI, "markup", wanted, &words))
    })
}

fn parse(path: &Path, limit_bytes: usize) -> Result<Document, Problem> {
    let (mut file, metadata) = open_regular(path)?;
    check_end(&mut file, metadata.len())?;
    let limit_bytes = u64::try_from(limit_bytes).unwrap_or(u64::MAX);
    let mut reader = Reader::from_reader(Markup {
        input: BufReader::new(file),
        position: 0,
        left_bytes: limit_bytes,
    });
    let mut tree = Tree::default();
    let mut buffer = Vec::new();
    loop {
        buffer.clear();
        let step = match reader.read_event_into(&mut buffer) {
            Ok(event) => tree.step(event)?,
            Err(_) if reader.get_ref().left_bytes == 0 => {
                return Err(Problem::Limit {
                    what: "the markup".to_owned(),
                    wanted_bytes: limit_bytes.saturating_add(1),
                    limit_bytes,
                });
            }
            Err(quick_xml::Error::Io(cause)) => {
                let cause = io::Error::new(cause.kind(), cause.to_string());
                return Err(problem::io("reading the header")(cause));
            }
            Err(cause) => return Err(invalid(VTI, "markup", "XML", &cause.to_string())),
        };
        match step {
            // The parser is in the middle of text, which it has to finish.
            Step::Text => continue,
            Step::Open => {}
            Step::Done(root) => {
                return Ok(Document {
                    root,
                    appended: None,
                });
            }
            Step::Appended(element) => {
                let start = reader.get_mut().appended_start()?;
                let span = Span {
                    start,
                    end: metadata.len(),
                };
                return Ok(Document {
                    root: tree.close_all()?,
                    appended: Some((element, span)),
                });
            }
        }
        let text = reader
            .get_mut()
            .skip_text()
            .map_err(problem::io("reading the header"))?;
        tree.text(text)?;
    }
}

/// A file that was cut has lost its end, and the data before it may look whole.
fn check_end(file: &mut File, length: u64) -> Result<(), Problem> {
    let mut read = || -> io::Result<Vec<u8>> {
        let mut tail = Vec::new();
        file.seek(SeekFrom::Start(length.saturating_sub(256)))?;
        file.take(256).read_to_end(&mut tail)?;
        file.seek(SeekFrom::Start(0))?;
        Ok(tail)
    };
    let tail = read().map_err(problem::io("reading the end of the file"))?;
    if tail.trim_ascii_end().ends_with(b"</VTKFile>") {
        return Ok(());
    }
    let wanted = "`</VTKFile>` as the end of the file, which may have been cut";
    let last = tail.get(tail.len().saturating_sub(16)..).unwrap_or(&[]);
    let found = String::from_utf8_lossy(last);
    Err(invalid(VTI, "markup", wanted, &found))
}

/// The elements that are open, the outermost first.
#[derive(Default)]
struct Tree {
    open: Vec<Element>,
    count: usize,
}

/// What came of one piece of markup.
enum Step {
    Open,
    Text,
    Done(Element),
    Appended(Element),
}

impl Tree {
    fn step(&mut self, event: Event) -> Result<Step, Problem> {
        match event {
            Event::Start(tag) => {
                let element = self.element(&tag)?;
                if element.name == "AppendedData" && !self.open.is_empty() {
                    return Ok(Step::Appended(element));
                }
                if self.open.len() >= MOST_DEPTH {
                    let wanted = format!("at most {MOST_DEPTH} elements inside each other");
                    return Err(invalid(VTI, "markup", wanted, &element.name));
                }
                self.open.push(element);
                Ok(Step::Open)
            }
            Event::Empty(tag) => {
                let element = self.element(&tag)?;
                Ok(self.close(element))
            }
            Event::End(_) => match self.open.pop() {
                Some(element) => Ok(self.close(element)),
                None => Err(invalid(VTI, "markup", "XML", "an end without a beginning")),
            },
            Event::DocType(_) => Err(unsupported(VTI, "a document type (DOCTYPE, ENTITY)")),
            Event::CData(_) | Event::GeneralRef(_) => {
                Err(unsupported(VTI, "text with CDATA or entities"))
            }
            Event::Eof => Err(invalid(
                VTI,
                "markup",
                "`</VTKFile>`",
                "the end of the file",
            )),
            Event::Text(_) => Ok(Step::Text),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) => Ok(Step::Open),
        }
    }

    fn element(&mut self, tag: &BytesStart) -> Result<Element, Problem> {
        self.count = self.count.saturating_add(1);
        if self.count > MOST_ELEMENTS {
            let wanted = format!("at most {MOST_ELEMENTS} elements");
            return Err(invalid(VTI, "markup", wanted, "more"));
        }
        let name = tag.name().0.to_owned();
        let mut attributes = Vec::new();
        for attribute in tag.attributes() {
            let wrong = |cause: String| invalid(VTI, &name, "attributes of XML", &cause);
            let attribute = attribute.map_err(|cause| wrong(cause.to_string()))?;
            let value = attribute
                .normalized_value(XmlVersion::Implicit1_0)
                .map_err(|cause| wrong(cause.to_string()))?;
            attributes.push((attribute.key.0.to_owned(), value.into_owned()));
            if attributes.len() > MOST_ATTRIBUTES {
                let wanted = format!("at most {MOST_ATTRIBUTES} attributes");
                return Err(invalid(VTI, &name, wanted, "more"));
            }
        }
        Ok(Element {
            name,
            attributes,
            ..Element::default()
        })
    }

    fn close(&mut self, element: Element) -> Step {
        match self.open.last_mut() {
            Some(parent) => {
                parent.children.push(element);
                Step::Open
            }
            None => Step::Done(element),
        }
    }

    /// Appended data are the last child of the root.
    fn close_all(mut self) -> Result<Element, Problem> {
        match (self.open.pop(), self.open.len()) {
            (Some(root), 0) => Ok(root),
            (found, _) => {
                let name = found.map_or(String::new(), |element| element.name);
                let wanted = "AppendedData inside VTKFile and nothing else";
                Err(invalid(VTI, "AppendedData", wanted, &name))
            }
        }
    }

    fn text(&mut self, span: Option<Span>) -> Result<(), Problem> {
        let (Some(span), Some(element)) = (span, self.open.last_mut()) else {
            return Ok(());
        };
        if element.text.replace(span).is_some() {
            let what = format!("text in two places of `{}`", escape(&element.name));
            return Err(unsupported(VTI, what));
        }
        Ok(())
    }
}

/// The file as the parser sees it: markup is counted, text is stepped over.
struct Markup {
    input: BufReader<File>,
    position: u64,
    left_bytes: u64,
}

impl Markup {
    /// Goes to the next `<`, or the end. Gives the place of what is there if it is more than white space.
    fn skip_text(&mut self) -> io::Result<Option<Span>> {
        let mut start = None;
        loop {
            let bytes = self.input.fill_buf()?;
            let end = bytes.iter().position(|&byte| byte == b'<');
            let text = bytes.get(..end.unwrap_or(bytes.len())).unwrap_or(&[]);
            let visible = text.iter().position(|byte| !byte.is_ascii_whitespace());
            if let (None, Some(at)) = (start, visible) {
                start = Some(self.position.saturating_add(length(at)));
            }
            let count = text.len();
            let at_end = bytes.is_empty();
            self.input.consume(count);
            self.position = self.position.saturating_add(length(count));
            if end.is_some() || at_end {
                let end = self.position;
                return Ok(start.map(|start| Span { start, end }));
            }
        }
    }

    /// The place behind the `_` that appended data begin with.
    fn appended_start(&mut self) -> Result<u64, Problem> {
        let reading = "reading the beginning of the appended data";
        loop {
            let bytes = self.input.fill_buf().map_err(problem::io(reading))?;
            let first = bytes.first().copied();
            let count = bytes.len().min(1);
            self.input.consume(count);
            self.position = self.position.saturating_add(1);
            match first {
                Some(b'_') => return Ok(self.position),
                Some(byte) if byte.is_ascii_whitespace() => {}
                _ => {
                    let wanted = "`_` before the data";
                    return Err(invalid(VTI, "AppendedData", wanted, "something else"));
                }
            }
        }
    }
}

fn length(n: usize) -> u64 {
    crate::format::convert::to_u64(n)
}

impl Read for Markup {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(out)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Markup {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.left_bytes == 0 {
            return Err(io::Error::other("more markup than allowed"));
        }
        let most = usize::try_from(self.left_bytes).unwrap_or(usize::MAX);
        let bytes = self.input.fill_buf()?;
        Ok(bytes.get(..most).unwrap_or(bytes))
    }

    fn consume(&mut self, count: usize) {
        self.input.consume(count);
        self.position = self.position.saturating_add(length(count));
        self.left_bytes = self.left_bytes.saturating_sub(length(count));
    }
}
