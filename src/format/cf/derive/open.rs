//! From a recipe to a [`Source`]: its parts opened, all on the grid of the first.

use super::super::choose::{Choice, choose};
use super::super::grid::Role;
use super::super::model::{Arrays, Variable};
use super::parts::{Origin, Part};
use super::recipe::Recipe;
use super::source::{Argument, Derived, Numbers};
use crate::format::problem::{escape, invalid};
use crate::volume::{Header, Limits, Problem, Source};

/// Opens the voxels of a variable as stored, on the grid of all parts.
pub(in super::super) type OpenPart<'o> = &'o dyn Fn(Choice) -> Result<Box<dyn Source>, Problem>;

impl Recipe<'_> {
    /// The variable, computed on the grid of `reference`, the header of its first part.
    ///
    /// # Errors
    /// Where a part lies on another grid, or cannot be opened.
    pub(in super::super) fn open(
        &self,
        arrays: &dyn Arrays,
        reference: &Header,
        limits: &Limits,
        open: OpenPart<'_>,
    ) -> Result<Box<dyn Source>, Problem> {
        let argument = |part: &Part| {
            let terms = part.terms.iter().map(|(origin, scale)| {
                let numbers = self.numbers(arrays, reference, origin, open)?;
                Ok((numbers, *scale))
            });
            Ok(Argument {
                terms: terms.collect::<Result<_, Problem>>()?,
                offset: part.offset,
            })
        };
        let arguments = self.arguments.iter().map(argument);
        Ok(Box::new(Derived {
            arguments: arguments.collect::<Result<_, Problem>>()?,
            formula: self.formula,
            header: self.header(reference),
            max_bytes: limits.max_bytes,
        }))
    }

    fn numbers(
        &self,
        arrays: &dyn Arrays,
        reference: &Header,
        origin: &Origin,
        open: OpenPart<'_>,
    ) -> Result<Numbers, Problem> {
        let elsewhere = |found: &str| {
            let field = format!("grid of {}", origin.name());
            let first = self.reference().map_or("", |first| first.name.as_str());
            let wanted = format!("that of {}", escape(first));
            invalid(arrays.format(), &field, wanted, found)
        };
        let variable = match origin {
            Origin::Variable(variable) => *variable,
            Origin::Levels(levels, _) => {
                let is_whole = u32::try_from(levels.len()) == Ok(reference.dims[2]);
                let numbers = || Numbers::Layers(levels.clone());
                return is_whole
                    .then(numbers)
                    .ok_or_else(|| elsewhere(&levels.len().to_string()));
            }
        };
        let choice = choose(arrays, &self.selection(variable))?;
        let first = self.reference().map_or_else(
            || Ok(Vec::new()),
            |first| Ok(grid_axes(&choose(arrays, &self.selection(first))?)),
        )?;
        let axes = grid_axes(&choice);
        // What has no time holds at all times.
        let is_same = axes.len() <= first.len()
            && first
                .iter()
                .all(|axis| axis.0 == Role::Time || axes.contains(axis))
            && axes.iter().all(|axis| first.contains(axis));
        if !is_same {
            return Err(elsewhere(&words(variable)));
        }
        let source = open(choice)?;
        let found = source.header();
        let is_same = found.dims == reference.dims
            && (found.times == reference.times || found.times == 1)
            && found.components == 1;
        if !is_same {
            return Err(elsewhere(&words(variable)));
        }
        Ok(Numbers::Voxels(source))
    }
}

/// Names of the dimensions along space and time, without WRF's mark of staggering.
fn grid_axes(choice: &Choice) -> Vec<(Role, String)> {
    let pairs = choice.roles.iter().zip(&choice.variable.dimensions);
    let axes = pairs.filter(|(role, _)| matches!(role, Role::Space(_) | Role::Time));
    axes.map(|(role, dimension)| {
        let name = dimension.name.strip_suffix("_stag");
        (*role, name.unwrap_or(&dimension.name).to_owned())
    })
    .collect()
}

/// The dimensions of a variable, such as `lat 61, lon 120`.
fn words(variable: &Variable) -> String {
    let dimensions = variable.dimensions.iter();
    let words = dimensions.map(|dimension| format!("{} {}", dimension.name, dimension.size));
    words.collect::<Vec<_>>().join(", ")
}
