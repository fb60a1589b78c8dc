//! Small XML as a tree: no document type, no entities but the five, limited in depth and number.

use super::super::FileProblem;
use quick_xml::{Reader, XmlVersion, events::BytesStart, events::Event};

const MAX_DEPTH: usize = 32;
const MAX_ELEMENTS: usize = 100_000;

/// An element and what is in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Element {
    pub name: String,
    pub attributes: Vec<(String, String)>,
    pub text: String,
    pub children: Vec<Element>,
}

impl Element {
    /// What an attribute says.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(key, _)| key == name);
        found.map(|(_, value)| value.as_str())
    }

    /// The first child of a name.
    pub fn child(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.name == name)
    }

    /// This element and all inside it, in the order of the file.
    pub fn all(&self) -> Vec<&Element> {
        let mut found = vec![self];
        for child in &self.children {
            found.extend(child.all());
        }
        found
    }

    /// The first element of a name, at any depth.
    pub fn find(&self, name: &str) -> Option<&Element> {
        self.all().into_iter().find(|element| element.name == name)
    }

    /// The numbers between the tags.
    pub fn numbers(&self) -> Result<Vec<f64>, FileProblem> {
        numbers(&self.text, &self.name)
    }

    /// The number that an attribute says; `None` where there is no such attribute.
    pub fn number(&self, attribute: &str) -> Result<Option<f64>, FileProblem> {
        let Some(text) = self.attribute(attribute) else {
            return Ok(None);
        };
        let field = format!("{} {attribute}", self.name);
        let number = numbers(text, &field)?;
        match number.as_slice() {
            [number] => Ok(Some(*number)),
            _ => Err(no_number(&field, text)),
        }
    }

    /// The number that an attribute must say.
    pub fn needed(&self, attribute: &str) -> Result<f64, FileProblem> {
        self.number(attribute)?
            .ok_or_else(|| no_number(&format!("{} {attribute}", self.name), ""))
    }
}

/// Numbers separated by blanks.
pub(super) fn numbers(text: &str, field: &str) -> Result<Vec<f64>, FileProblem> {
    let number = |word: &str| word.parse().map_err(|_| no_number(field, word));
    text.split_whitespace().map(number).collect()
}

fn no_number(field: &str, found: &str) -> FileProblem {
    FileProblem::Field {
        field: field.to_owned(),
        wanted: "a number",
        found: format!("{:?}", found.chars().take(40).collect::<String>()),
    }
}

/// The root element of `text`.
pub(super) fn parse(text: &str) -> Result<Element, FileProblem> {
    let mut reader = Reader::from_str(text);
    let mut open: Vec<Element> = vec![Element::default()];
    let mut count = 0;
    loop {
        match reader.read_event().map_err(broken)? {
            Event::Start(start) => open.push(element(&start)?),
            Event::Empty(start) => {
                let child = element(&start)?;
                add(&mut open, child);
            }
            Event::End(_) => {
                let Some(child) = open.pop().filter(|_| !open.is_empty()) else {
                    return Err(FileProblem::Xml(
                        "an element ends that did not begin".to_owned(),
                    ));
                };
                add(&mut open, child);
            }
            Event::Text(text) => push(&mut open, &text.xml10_content()),
            Event::CData(text) => push(&mut open, &text.xml10_content()),
            Event::DocType(_) => {
                return Err(FileProblem::Xml(
                    "it declares a document type, which is not read: take the `<!DOCTYPE` out"
                        .to_owned(),
                ));
            }
            // Text of characters by number does not stand where we look.
            Event::GeneralRef(_) | Event::Comment(_) | Event::Decl(_) | Event::PI(_) => continue,
            Event::Eof => break,
        }
        count += 1;
        if open.len() > MAX_DEPTH || count > MAX_ELEMENTS {
            let problem = format!("it has more than {MAX_DEPTH} levels or {MAX_ELEMENTS} elements");
            return Err(FileProblem::Xml(problem));
        }
    }
    let root = open.pop().filter(|_| open.is_empty());
    let root = root.and_then(|mut top| top.children.pop().filter(|_| top.children.is_empty()));
    root.ok_or_else(|| FileProblem::Xml("wanted one element around all others, closed".to_owned()))
}

fn element(start: &BytesStart) -> Result<Element, FileProblem> {
    let mut element = Element {
        name: start.name().0.to_owned(),
        ..Element::default()
    };
    for attribute in start.attributes() {
        let attribute = attribute.map_err(broken)?;
        let value = attribute
            .normalized_value(XmlVersion::Implicit1_0)
            .map_err(broken)?;
        element
            .attributes
            .push((attribute.key.0.to_owned(), value.into_owned()));
    }
    Ok(element)
}

fn add(open: &mut [Element], child: Element) {
    if let Some(parent) = open.last_mut() {
        parent.children.push(child);
    }
}

fn push(open: &mut [Element], text: &str) {
    if let Some(parent) = open.last_mut() {
        parent.text.push_str(text);
    }
}

fn broken(cause: impl std::fmt::Display) -> FileProblem {
    FileProblem::Xml(cause.to_string())
}
