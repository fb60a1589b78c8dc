//! What follows the lattice: `POINT_DATA` and `CELL_DATA` with their arrays.

use super::VTK;
use super::array::{Array, Attribute};
use super::header::Lattice;
use super::scan::Scan;
use crate::format::convert::to_u64;
use crate::format::problem::{invalid, unsupported};
use crate::format::select::Axis;
use crate::volume::{Problem, VoxelType};

/// One array and its place in the file.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub array: Array,
    pub stored: VoxelType,
    pub start: u64,
    pub end: u64,
}

/// All arrays that can be drawn.
#[derive(Debug, Default)]
pub(super) struct Sections {
    pub all: Vec<Section>,
    pub notes: Vec<String>,
    pub time: Option<f64>,
}

/// More arrays than any file has.
const MOST_ARRAYS: usize = 4096;

/// Bytes of an array, if they are below 2^64.
pub(super) fn bytes(axes: &[Axis], stored: VoxelType) -> Result<u64, Problem> {
    axes.iter()
        .try_fold(to_u64(stored.bytes()), |product, axis| {
            product.checked_mul(axis.size)
        })
        .ok_or_else(|| invalid(VTK, "DIMENSIONS", "below 2^64 bytes of voxels", "more"))
}

/// Reads to the end of the file.
pub(super) fn read(scan: &mut Scan, lattice: &Lattice) -> Result<Sections, Problem> {
    let mut found = Sections {
        time: lattice.time,
        ..Sections::default()
    };
    let mut of_cells = lattice.next == "CELL_DATA";
    let mut count = voxel_count(scan, lattice, of_cells)?;
    while let Some(word) = scan.keyword()? {
        match word.as_str() {
            "POINT_DATA" | "CELL_DATA" => {
                of_cells = word == "CELL_DATA";
                count = voxel_count(scan, lattice, of_cells)?;
            }
            "METADATA" => scan.skip_to_empty_line()?,
            "LOOKUP_TABLE" => {
                scan.after(&word)?;
                let size: u64 = scan.number(&word, "a number of colors")?;
                scan.line()?;
                let numbers = size.saturating_mul(4);
                scan.array(numbers, numbers)?;
            }
            "FIELD" => {
                for field in field(scan)? {
                    if field.tuples == count {
                        found.add(field.section(of_cells))?;
                    }
                }
            }
            _ => {
                let section = attribute(scan, &word, count, of_cells)?;
                found.add(section)?;
            }
        }
    }
    Ok(found)
}

impl Sections {
    fn add(&mut self, section: Option<Section>) -> Result<(), Problem> {
        let Some(section) = section else {
            return Ok(());
        };
        if section.array.is_mark() {
            let name = &section.array.name;
            self.notes
                .push(format!("{name} is not read: what it hides is drawn"));
            return Ok(());
        }
        if self.all.len() >= MOST_ARRAYS {
            let wanted = format!("at most {MOST_ARRAYS} arrays");
            return Err(invalid(VTK, "POINT_DATA", wanted, "more"));
        }
        self.all.push(section);
        Ok(())
    }
}

/// The number behind `POINT_DATA` or `CELL_DATA`, which says again what the lattice has said.
fn voxel_count(scan: &mut Scan, lattice: &Lattice, of_cells: bool) -> Result<u64, Problem> {
    let field = if of_cells { "CELL_DATA" } else { "POINT_DATA" };
    let wanted = lattice
        .dims(of_cells)
        .into_iter()
        .try_fold(1_u64, |product, n| product.checked_mul(n.into()))
        .ok_or_else(|| invalid(VTK, "DIMENSIONS", "below 2^64 voxels", "more"))?;
    let found: u64 = scan.number(field, "a whole number")?;
    scan.line()?;
    match found == wanted {
        true => Ok(found),
        false => Err(invalid(
            VTK,
            field,
            format!("the {wanted} that the dimensions make"),
            &found.to_string(),
        )),
    }
}

/// An array with a keyword of its own.
fn attribute(
    scan: &mut Scan,
    word: &str,
    count: u64,
    of_cells: bool,
) -> Result<Option<Section>, Problem> {
    let known = [
        "SCALARS",
        "COLOR_SCALARS",
        "VECTORS",
        "NORMALS",
        "TENSORS",
        "TENSORS6",
        "TEXTURE_COORDINATES",
        "GLOBAL_IDS",
        "PEDIGREE_IDS",
        "EDGE_FLAGS",
    ];
    if !known.contains(&word) {
        let wanted = "the beginning of an array, such as SCALARS";
        return Err(invalid(VTK, "data", wanted, word));
    }
    let name = decoded(&scan.after(word)?);
    let number = "a number of components from 1 to 65536";
    let (kind, components) = match word {
        "COLOR_SCALARS" => ("unsigned_char".to_owned(), scan.number(word, number)?),
        "TEXTURE_COORDINATES" => {
            let components = scan.number(word, number)?;
            (scan.after(word)?, components)
        }
        "SCALARS" => {
            let kind = scan.after(word)?;
            let rest = scan.line()?.unwrap_or_default();
            let components = match rest.trim() {
                "" => 1,
                text => text.parse().map_err(|_| invalid(VTK, word, number, text))?,
            };
            let table = scan.keyword()?.unwrap_or_default();
            if table != "LOOKUP_TABLE" {
                return Err(invalid(VTK, word, "LOOKUP_TABLE behind it", &table));
            }
            scan.after(&table)?;
            (kind, components)
        }
        _ => {
            let components = match word {
                "VECTORS" | "NORMALS" => 3,
                "TENSORS" => 9,
                "TENSORS6" => 6,
                _ => 1,
            };
            (scan.after(word)?, components)
        }
    };
    scan.line()?;
    let attribute = match word {
        "SCALARS" => Attribute::Scalars,
        "COLOR_SCALARS" => Attribute::Colors,
        "VECTORS" => Attribute::Vectors,
        _ => Attribute::Other,
    };
    let array = Array {
        name,
        of_cells,
        components,
        attribute,
    };
    section(scan, array, &kind, count)
}

/// Steps over the numbers of an array.
fn section(
    scan: &mut Scan,
    array: Array,
    kind: &str,
    tuples: u64,
) -> Result<Option<Section>, Problem> {
    if !(1..=1 << 16).contains(&array.components) {
        let wanted = "a number of components from 1 to 65536";
        return Err(invalid(
            VTK,
            &array.name,
            wanted,
            &array.components.to_string(),
        ));
    }
    let numbers = tuples
        .checked_mul(array.components.into())
        .ok_or_else(|| invalid(VTK, &array.name, "below 2^64 numbers", "more"))?;
    let Some(stored) = stored_type(kind)? else {
        // Eight marks a byte; in words one each.
        scan.array(numbers, numbers.div_ceil(8))?;
        return Ok(None);
    };
    let bytes = numbers
        .checked_mul(to_u64(stored.bytes()))
        .ok_or_else(|| invalid(VTK, &array.name, "below 2^64 bytes", "more"))?;
    let (start, end) = scan.array(numbers, bytes)?;
    Ok(Some(Section {
        array,
        stored,
        start,
        end,
    }))
}

/// The type of a name; `None` for bits.
fn stored_type(kind: &str) -> Result<Option<VoxelType>, Problem> {
    Ok(Some(match kind.to_ascii_lowercase().as_str() {
        "bit" => return Ok(None),
        "char" | "signed_char" => VoxelType::I8,
        "unsigned_char" => VoxelType::U8,
        "short" => VoxelType::I16,
        "unsigned_short" => VoxelType::U16,
        "int" | "vtkidtype" => VoxelType::I32,
        "unsigned_int" => VoxelType::U32,
        "long" | "long_long" | "vtktypeint64" => VoxelType::I64,
        "unsigned_long" | "unsigned_long_long" | "vtktypeuint64" => VoxelType::U64,
        "float" => VoxelType::F32,
        "double" => VoxelType::F64,
        "string" | "utf8_string" | "variant" | "unicode_string" => {
            return Err(unsupported(VTK, format!("an array of type {kind}")));
        }
        _ => return Err(invalid(VTK, "type", "a type such as unsigned_short", kind)),
    }))
}

/// One array of a field.
pub(super) struct Field {
    pub name: String,
    pub tuples: u64,
    /// Its number, where it has just one, in words.
    pub number: Option<f64>,
    found: Option<Section>,
}

impl Field {
    fn section(self, of_cells: bool) -> Option<Section> {
        self.found.map(|mut section| {
            section.array.of_cells = of_cells;
            section
        })
    }
}

/// The arrays of `FIELD name count`, the word itself being read.
pub(super) fn field(scan: &mut Scan) -> Result<Vec<Field>, Problem> {
    scan.after("FIELD")?;
    let count: usize = scan.number("FIELD", "a number of arrays")?;
    scan.line()?;
    let mut fields = Vec::new();
    while fields.len() < count {
        let name = scan.after("FIELD")?;
        match name.to_ascii_uppercase().as_str() {
            "METADATA" => {
                scan.skip_to_empty_line()?;
                continue;
            }
            "NULL_ARRAY" => {
                scan.line()?;
                fields.push(Field {
                    name,
                    tuples: 0,
                    number: None,
                    found: None,
                });
                continue;
            }
            _ => {}
        }
        if fields.len() >= MOST_ARRAYS {
            let wanted = format!("at most {MOST_ARRAYS} arrays");
            return Err(invalid(VTK, "FIELD", wanted, &count.to_string()));
        }
        let wanted = "components, tuples and a type";
        let components: u32 = scan.number(&name, wanted)?;
        let tuples: u64 = scan.number(&name, wanted)?;
        let kind = scan.after(&name)?;
        scan.line()?;
        let array = Array {
            name: decoded(&name),
            of_cells: false,
            components,
            attribute: Attribute::Other,
        };
        let name = array.name.clone();
        let number = match (components, tuples) {
            (1, 1) => scan.peek_number(&kind)?,
            _ => None,
        };
        let found = section(scan, array, &kind, tuples)?;
        fields.push(Field {
            name,
            tuples,
            number,
            found,
        });
    }
    Ok(fields)
}

/// A name with `%20` for a space and the like.
fn decoded(name: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = name.as_bytes();
    while let [byte, tail @ ..] = rest {
        let digit = |digit: &u8| char::from(*digit).to_digit(16);
        let code = match rest {
            [b'%', high, low, ..] => digit(high)
                .zip(digit(low))
                .and_then(|(high, low)| u8::try_from(high << 4 | low).ok()),
            _ => None,
        };
        bytes.push(code.unwrap_or(*byte));
        rest = match code {
            Some(_) => rest.get(3..).unwrap_or(&[]),
            None => tail,
        };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
