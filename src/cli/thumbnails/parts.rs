//! The volumes that one input holds: series of a folder, variables of a file.
//!
//! ```text
//! header -> UID of each series | name of each variable, or of the first -> the word that picks it, and what its
//!           picture is called
//! ```

use crate::{
    cli::{flags::InputFlags, load},
    volume::{Header, Series},
};

/// Which of several volumes of an input.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// The word of `--series`.
    pub series: Option<String>,
    /// The word of `--variable`.
    pub variable: Option<String>,
    /// What stands behind the name of the input; empty of the only one.
    pub name: String,
    /// What a person should know of the choice.
    pub note: Option<String>,
}

/// Letters of a name: descriptions may be long.
const LONGEST_NAME: usize = 60;

/// Which of several variables are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variables {
    /// Each.
    All,
    /// The first that is no coordinate.
    First,
}

/// The volumes of an input, as far as its header tells; words of `flags` choose one. What cannot be opened is one.
pub fn of_input(input: &str, flags: &InputFlags, variables: Variables) -> Vec<Part> {
    let mut flags = InputFlags {
        path: Some(input.to_owned()),
        ..flags.clone()
    };
    let is_whole = flags.file().is_none() && variables == Variables::All;
    if is_whole || flags.series.is_some() || flags.variable.is_some() {
        return vec![Part::default()];
    }
    match load::open(&flags, &flags.limits()) {
        Ok(source) if variables == Variables::First && source.header().series.len() < 2 => {
            let note = flags.take_first_variable(source.header());
            vec![Part {
                variable: flags.variable,
                note,
                ..Part::default()
            }]
        }
        Ok(source) => of_header(source.header()),
        // Said where it is drawn.
        Err(_) => vec![Part::default()],
    }
}

fn of_header(header: &Header) -> Vec<Part> {
    let mut parts: Vec<Part> = match (&header.series[..], &header.variables[..]) {
        (series @ [_, _, ..], _) => series.iter().map(of_series).collect(),
        (_, variables @ [_, _, ..]) => variables.iter().map(|name| of_variable(name)).collect(),
        _ => return vec![Part::default()],
    };
    // Descriptions may be the same, or none.
    let names: Vec<String> = parts.iter().map(|part| part.name.to_lowercase()).collect();
    for (at, part) in parts.iter_mut().enumerate() {
        let is_alike = names.iter().filter(|name| **name == names[at]).count() > 1;
        if part.name.is_empty() || is_alike {
            let number = (at + 1).to_string();
            part.name = [part.name.as_str(), &number].join(" ").trim().to_owned();
        }
    }
    parts
}

fn of_series(series: &Series) -> Part {
    Part {
        series: Some(series.uid.clone()),
        name: short(&series.description),
        ..Part::default()
    }
}

fn of_variable(variable: &str) -> Part {
    Part {
        variable: Some(variable.to_owned()),
        name: short(variable.trim_matches('/')),
        ..Part::default()
    }
}

fn short(name: &str) -> String {
    let plain = name.chars().filter(|c| !c.is_control());
    plain
        .take(LONGEST_NAME)
        .collect::<String>()
        .trim()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Format, VoxelType};
    use glam::DAffine3;

    #[test]
    fn series_are_called_by_their_descriptions_and_numbered_where_these_do_not_tell() {
        let mut header = Header::new(Format::Dicom, [1; 3], VoxelType::U8, DAffine3::IDENTITY);
        assert_eq!(of_header(&header), [Part::default()]);
        let series = |uid: &str, description: &str| Series {
            uid: uid.to_owned(),
            description: description.to_owned(),
            pictures: 1,
        };
        header.series = vec![series("1.2", "Thorax")];
        assert_eq!(of_header(&header), [Part::default()]);
        header.series.extend([
            series("1.3", ""),
            series("1.4", "Scout\u{1b}"),
            series("1.5", "scout"),
        ]);
        let parts = of_header(&header);
        let names: Vec<_> = parts.iter().map(|part| part.name.as_str()).collect();
        assert_eq!(names, ["Thorax", "2", "Scout 3", "scout 4"]);
        assert_eq!(parts[3].series.as_deref(), Some("1.5"));
    }
}
