//! The arrays of a piece, and the one that is taken.

use super::VTI;
use super::xml::Element;
use crate::format::problem::{escape, invalid};
use crate::format::vtk::array::{Array, Attribute, choose, chosen_first, names};
use crate::volume::{Problem, VolumeSelection};

/// The array that is taken, in the first piece.
pub(super) struct Found<'a> {
    pub element: &'a Element,
    pub array: Array,
    /// Of all arrays, this one's first.
    pub names: Vec<String>,
    /// What a person should know about the other arrays.
    pub notes: Vec<String>,
    /// The same-named arrays before it in its element: names need not be unique.
    before: usize,
}

/// Finds the wanted array in a piece.
pub(super) fn find<'a>(piece: &'a Element, wanted: &VolumeSelection) -> Result<Found<'a>, Problem> {
    let mut notes = Vec::new();
    let mut arrays = Vec::new();
    for (of_cells, data) in [(false, "PointData"), (true, "CellData")] {
        for element in piece.all(data) {
            for child in element.all("DataArray") {
                let array = array(element, child, of_cells)?;
                if array.is_mark() {
                    let name = &array.name;
                    notes.push(format!("{name} is not read: what it hides is drawn"));
                } else if child.get("type") != Some("String") {
                    arrays.push((child, array));
                }
            }
        }
    }
    let described: Vec<Array> = arrays.iter().map(|(_, array)| array.clone()).collect();
    let names = names(&described);
    let chosen = choose(&described, &names, wanted, VTI)?;
    let mut before = 0_usize;
    let mut found = None;
    for (index, (element, array)) in arrays.into_iter().enumerate() {
        let same = described
            .get(chosen)
            .is_some_and(|chosen| chosen.name == array.name && chosen.of_cells == array.of_cells);
        if index == chosen {
            found = Some((element, array));
            break;
        }
        before = before.saturating_add(usize::from(same));
    }
    let (element, array) =
        found.ok_or_else(|| crate::format::problem::missing(VTI, "DataArray"))?;
    Ok(Found {
        element,
        array,
        names: chosen_first(names, chosen),
        notes,
        before,
    })
}

impl Found<'_> {
    /// The array of the same name, type and components in another piece.
    pub(super) fn same_in<'a>(&self, piece: &'a Element) -> Result<&'a Element, Problem> {
        let data = match self.array.of_cells {
            true => "CellData",
            false => "PointData",
        };
        let mut same = piece
            .all(data)
            .flat_map(|element| element.all("DataArray"))
            .filter(|child| child.get("Name").unwrap_or("") == self.array.name);
        let name = escape(&self.array.name);
        let found = same.nth(self.before).ok_or_else(|| {
            let wanted = format!("the array {name} in the {data} of each piece");
            invalid(VTI, "Piece", wanted, piece.get("Extent").unwrap_or(""))
        })?;
        let differs = ["type", "NumberOfComponents"]
            .into_iter()
            .find(|&attribute| found.get(attribute) != self.element.get(attribute));
        match differs {
            None => Ok(found),
            Some(attribute) => {
                let text = found.get(attribute).unwrap_or("nothing");
                let wanted = format!("the {attribute} of {name} to be that of the first piece");
                Err(invalid(VTI, attribute, wanted, text))
            }
        }
    }
}

fn array(data: &Element, array: &Element, of_cells: bool) -> Result<Array, Problem> {
    let name = array.get("Name").unwrap_or("").to_owned();
    let text = array.get("NumberOfComponents").unwrap_or("1");
    let components = text
        .trim()
        .parse::<u32>()
        .ok()
        .filter(|n| (1..=1 << 16).contains(n))
        .ok_or_else(|| {
            let wanted = "a number from 1 to 65536";
            invalid(VTI, "NumberOfComponents", wanted, text)
        })?;
    let is = |attribute| !name.is_empty() && data.get(attribute) == Some(name.as_str());
    let attribute = if is("Scalars") {
        Attribute::Scalars
    } else if is("Vectors") {
        Attribute::Vectors
    } else {
        Attribute::Other
    };
    Ok(Array {
        name,
        of_cells,
        components,
        attribute,
    })
}
