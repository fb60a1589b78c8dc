//! The arrays of a VTK file, of either kind: which is taken, under which names the others can be, and what the
//! numbers of a voxel are to each other.

use crate::format::problem::{escape, invalid};
use crate::volume::{ComponentKind, Problem, VolumeSelection, VoxelType};

/// What a file says about one array.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::format) struct Array {
    pub name: String,
    /// True where numbers belong to the cells between points.
    pub of_cells: bool,
    pub components: u32,
    pub attribute: Attribute,
}

/// What an array is to the program that wrote it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::format) enum Attribute {
    /// The numbers to draw.
    Scalars,
    /// A color each.
    Colors,
    Vectors,
    Other,
}

/// Names that VTK gives to marks of points and cells that are not the file's own.
const MARKS: [&str; 2] = ["vtkGhostType", "vtkGhostLevels"];

impl Array {
    /// True for arrays that hold no values to draw.
    pub(in crate::format) fn is_mark(&self) -> bool {
        MARKS.contains(&self.name.as_str())
    }

    /// What the numbers of a voxel are. VTK draws three or four bytes of active scalars as a color.
    pub(in crate::format) fn meaning(&self, stored: VoxelType) -> ComponentKind {
        let named = self.name.to_ascii_lowercase();
        let is_color = stored == VoxelType::U8
            && (matches!(self.attribute, Attribute::Scalars | Attribute::Colors)
                || named.starts_with("rgb"));
        match self.components {
            3 if is_color => ComponentKind::Rgb,
            4 if is_color => ComponentKind::Rgba,
            2 | 3 if self.attribute == Attribute::Vectors => ComponentKind::Vector,
            _ => ComponentKind::Numbers,
        }
    }
}

/// Names of the arrays, each once: an array of cells gives way to one of points.
pub(in crate::format) fn names(arrays: &[Array]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for array in arrays {
        let mut name = match array.name.as_str() {
            "" => "unnamed".to_owned(),
            name => name.to_owned(),
        };
        if names.contains(&name) && array.of_cells {
            name.push_str(" (cells)");
        }
        let mut another = 2_u32;
        let plain = name.clone();
        while names.contains(&name) {
            name = format!("{plain} ({another})");
            another = another.saturating_add(1);
        }
        names.push(name);
    }
    names
}

/// The array that is wanted, else the active scalars of points, then of cells, then the first.
pub(in crate::format) fn choose(
    arrays: &[Array],
    names: &[String],
    wanted: &VolumeSelection,
    format: &'static str,
) -> Result<usize, Problem> {
    if let Some(name) = &wanted.variable {
        let found = names.iter().position(|other| other == name);
        return found.ok_or_else(|| {
            let there: Vec<String> = names.iter().take(8).map(|name| escape(name)).collect();
            let wanted = format!("one of the arrays {}", there.join(", "));
            invalid(format, "variable", wanted, name)
        });
    }
    let is_scalars =
        |array: &Array| matches!(array.attribute, Attribute::Scalars | Attribute::Colors);
    let active = |of_cells| {
        let is_active = |array: &Array| is_scalars(array) && array.of_cells == of_cells;
        arrays.iter().position(is_active)
    };
    match active(false).or(active(true)) {
        Some(index) => Ok(index),
        None if arrays.is_empty() => Err(crate::format::problem::missing(format, "DataArray")),
        None => Ok(0),
    }
}

/// The names with the chosen one first.
pub(in crate::format) fn chosen_first(mut names: Vec<String>, chosen: usize) -> Vec<String> {
    let first = names.get_mut(..=chosen).unwrap_or_default();
    first.rotate_right(1);
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(name: &str, of_cells: bool, attribute: Attribute) -> Array {
        Array {
            name: name.to_owned(),
            of_cells,
            components: 3,
            attribute,
        }
    }

    #[test]
    fn without_a_word_the_active_scalars_are_taken_and_all_arrays_can_be_named() {
        use Attribute::{Other, Scalars, Vectors};
        let arrays = [
            array("v", false, Vectors),
            array("t", true, Scalars),
            array("t", false, Other),
            array("s", false, Scalars),
            array("v", true, Other),
            array("v", true, Other),
        ];
        let names = names(&arrays);
        assert_eq!(
            names,
            ["v", "t", "t (2)", "s", "v (cells)", "v (cells) (2)"]
        );
        let choose = |name: Option<&str>| {
            let wanted = VolumeSelection {
                variable: name.map(str::to_owned),
                ..VolumeSelection::default()
            };
            choose(&arrays, &names, &wanted, "vti")
        };
        assert_eq!(choose(None).unwrap(), 3);
        assert_eq!(choose(Some("v (cells)")).unwrap(), 4);
        assert!(choose(Some("w")).unwrap_err().to_string().contains("t (2)"));
        assert_eq!(chosen_first(names.clone(), 3)[..2], ["s", "v"]);
        assert_eq!(chosen_first(names, 0)[..2], ["v", "t"]);
    }

    #[test]
    fn bytes_are_a_color_where_they_are_drawn_as_one_or_called_so() {
        let meaning = |name, attribute, stored| array(name, false, attribute).meaning(stored);
        use Attribute::{Other, Scalars, Vectors};
        assert_eq!(meaning("x", Scalars, VoxelType::U8), ComponentKind::Rgb);
        assert_eq!(meaning("RGB", Other, VoxelType::U8), ComponentKind::Rgb);
        assert_eq!(meaning("x", Other, VoxelType::U8), ComponentKind::Numbers);
        assert_eq!(
            meaning("RGB", Other, VoxelType::F32),
            ComponentKind::Numbers
        );
        assert_eq!(meaning("x", Vectors, VoxelType::F32), ComponentKind::Vector);
    }
}
