//! What each axis of the stored array means: space, time or component.
//!
//! Said by `space directions` (a vector means space), else by `kinds`, else by `spacings` (a number means space),
//! else guessed from the number of axes and noted.

use super::NRRD;
use super::fields::Fields;
use super::space::vectors;
use crate::format::problem::{invalid, unsupported};
use crate::format::select::{Axis, Role};
use crate::format::text::{integers, numbers};
use crate::volume::Problem;

/// Axes that Teem allows.
const MOST_AXES: usize = 16;

/// The stored array.
#[derive(Debug)]
pub(super) struct Array {
    /// Fastest first.
    pub axes: Vec<Axis>,
    /// Along x, y, z; 1 where there is no such axis.
    pub dims: [u32; 3],
    pub components: u32,
    pub times: u32,
    /// What `kinds` says of the components; alone where there is one axis of them.
    pub meaning: crate::volume::ComponentKind,
    /// What was guessed.
    pub notes: Vec<String>,
}

/// What one axis is, as far as the header says.
#[derive(Clone, Copy, Debug, PartialEq)]
enum AxisKind {
    Space,
    Time,
    Component,
    /// A list of something, or nothing is said.
    Open,
}

impl Array {
    pub(super) fn of(fields: &Fields) -> Result<Self, Problem> {
        let sizes = sizes(fields)?;
        let mut notes = Vec::new();
        let mut meanings = meanings(fields, sizes.len())?;
        let spaces =
            |meanings: &[AxisKind]| meanings.iter().filter(|&&m| m == AxisKind::Space).count();
        if meanings.iter().all(|&m| m == AxisKind::Open) {
            guess(&sizes, &mut meanings, &mut notes);
        } else if spaces(&meanings) == 4 && !meanings.contains(&AxisKind::Time) {
            if let Some(last) = meanings.last_mut() {
                *last = AxisKind::Time;
            }
            notes.push("of four space axes the slowest is taken as time".to_owned());
        }
        if !(1..=3).contains(&spaces(&meanings)) {
            let what = format!("an array with {} space axes", spaces(&meanings));
            return Err(unsupported(NRRD, what));
        }
        let slowest = sizes.len().saturating_sub(1);
        let mut next_space = 0..;
        let mut array = Self {
            axes: Vec::new(),
            dims: [1; 3],
            components: 1,
            times: 1,
            meaning: crate::volume::ComponentKind::Numbers,
            notes,
        };
        for (index, (&size, meaning)) in sizes.iter().zip(meanings).enumerate() {
            let role = match meaning {
                AxisKind::Space => Role::Space(next_space.next().unwrap_or(0)),
                AxisKind::Time => Role::Time,
                AxisKind::Component => Role::Component,
                AxisKind::Open if fields.list_is_sequence || index == slowest => Role::Time,
                AxisKind::Open => Role::Component,
            };
            array.add(role, size)?;
        }
        array.meaning = of_components(fields, &array);
        Ok(array)
    }

    fn add(&mut self, role: Role, size: u64) -> Result<(), Problem> {
        let total = match role {
            Role::Space(k) => self.dims.get_mut(k),
            Role::Time => Some(&mut self.times),
            Role::Component => Some(&mut self.components),
        };
        let wanted = "below 2^32 voxels along an axis, times and components";
        if let Some(total) = total {
            *total = u64::from(*total)
                .checked_mul(size)
                .and_then(|n| u32::try_from(n).ok())
                .ok_or_else(|| invalid(NRRD, "sizes", wanted, &size.to_string()))?;
        }
        self.axes.push(Axis { role, size });
        Ok(())
    }
}

/// Section 6 of the definition: what the one axis of components says that they are together.
fn of_components(fields: &Fields, array: &Array) -> crate::volume::ComponentKind {
    use crate::volume::ComponentKind;
    let roles = || array.axes.iter().map(|axis| &axis.role);
    let is_component = |role: &&Role| matches!(role, Role::Component);
    let place = roles().position(|role| is_component(&role));
    let (Some(place), 1) = (place, roles().filter(is_component).count()) else {
        return ComponentKind::Numbers;
    };
    let kinds = fields.get("kinds").unwrap_or_default();
    let kind = kinds
        .split_ascii_whitespace()
        .nth(place)
        .unwrap_or_default();
    match (kind.to_ascii_lowercase().as_str(), array.components) {
        ("rgb-color" | "3-color", 3) => ComponentKind::Rgb,
        ("rgba-color" | "4-color", 4) => ComponentKind::Rgba,
        (
            "vector" | "covariant-vector" | "normal" | "2-vector" | "3-vector" | "4-vector"
            | "3-gradient" | "3-normal",
            2..,
        ) => ComponentKind::Vector,
        _ => ComponentKind::Numbers,
    }
}

fn sizes(fields: &Fields) -> Result<Vec<u64>, Problem> {
    let text = fields.required("dimension")?;
    let dimension = integers(text)
        .and_then(|all| <[i64; 1]>::try_from(all).ok())
        .and_then(|[dimension]| usize::try_from(dimension).ok())
        .filter(|dimension| (1..=MOST_AXES).contains(dimension))
        .ok_or_else(|| invalid(NRRD, "dimension", "a number from 1 to 16", text))?;
    let text = fields.required("sizes")?;
    integers(text)
        .filter(|sizes| sizes.len() == dimension)
        .and_then(|sizes| {
            let sizes = sizes.into_iter().map(|n| u64::try_from(n).ok());
            sizes.map(|n| n.filter(|&n| n > 0)).collect()
        })
        .ok_or_else(|| {
            let wanted = format!("{dimension} whole numbers above 0");
            invalid(NRRD, "sizes", wanted, text)
        })
}

fn meanings(fields: &Fields, dimension: usize) -> Result<Vec<AxisKind>, Problem> {
    let mut meanings = match fields.get("kinds") {
        Some(text) => kinds(text, dimension)?,
        None => vec![AxisKind::Open; dimension],
    };
    let spatial: Vec<bool> = if let Some(directions) = vectors(fields, "space directions")? {
        if directions.len() != dimension {
            let text = fields.required("space directions")?;
            let wanted = format!("{dimension} vectors or `none`");
            return Err(invalid(NRRD, "space directions", wanted, text));
        }
        // In a space with time, the time axis has a vector too: along the fourth coordinate only.
        let in_space =
            |vector: &Vec<f64>| vector.len() < 4 || vector.iter().take(3).any(|&x| x != 0.0);
        directions
            .iter()
            .map(|vector| vector.as_ref().is_some_and(in_space))
            .collect()
    } else if let Some(text) = fields.get("spacings") {
        let spacings = numbers(text)
            .filter(|all| all.len() == dimension)
            .ok_or_else(|| invalid(NRRD, "spacings", format!("{dimension} numbers"), text))?;
        // NaN marks an axis without length; where all or none are marked, that says nothing.
        let marked = spacings.iter().filter(|x| x.is_nan()).count();
        if marked == 0 || marked == dimension {
            return Ok(meanings);
        }
        spacings.iter().map(|x| !x.is_nan()).collect()
    } else {
        return Ok(meanings);
    };
    if spatial.contains(&true) {
        for (meaning, spatial) in meanings.iter_mut().zip(spatial) {
            *meaning = match (spatial, *meaning) {
                (true, AxisKind::Time) => AxisKind::Time,
                (true, _) => AxisKind::Space,
                (false, AxisKind::Space) => AxisKind::Open,
                (false, other) => other,
            };
        }
    }
    Ok(meanings)
}

/// The names of section 6 of the definition, in any case.
fn kinds(text: &str, dimension: usize) -> Result<Vec<AxisKind>, Problem> {
    let kinds: Vec<AxisKind> = text
        .split_ascii_whitespace()
        .map(|kind| match kind.to_ascii_lowercase().as_str() {
            "domain" | "space" => AxisKind::Space,
            "time" => AxisKind::Time,
            "list" | "???" | "none" => AxisKind::Open,
            _ => AxisKind::Component,
        })
        .collect();
    if kinds.len() == dimension {
        Ok(kinds)
    } else {
        Err(invalid(NRRD, "kinds", format!("{dimension} kinds"), text))
    }
}

/// Nothing is said: up to three axes are space; of more, a first one of up to four numbers is a component, and
/// what follows three space axes is time.
fn guess(sizes: &[u64], meanings: &mut [AxisKind], notes: &mut Vec<String>) {
    let extra = sizes.len() > 3;
    let component_first = extra && sizes.first().is_some_and(|&size| size <= 4);
    let mut spaces = 0..3;
    for (index, meaning) in meanings.iter_mut().enumerate() {
        *meaning = if index == 0 && component_first {
            AxisKind::Component
        } else if spaces.next().is_some() {
            AxisKind::Space
        } else {
            AxisKind::Time
        };
    }
    if extra {
        let first = if component_first {
            "the fastest axis is taken as components, the next three as space"
        } else {
            "the three fastest axes are taken as space"
        };
        notes.push(format!(
            "the file does not say what its {} axes are: {first}, others as time",
            sizes.len()
        ));
    }
}
