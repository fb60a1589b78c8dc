//! The file as a container of arrays: variables of dimensions `number`, time, level, latitude and longitude.

use super::GRIB;
use super::decode::values;
use super::group::{Group, groups};
use super::scan::{Field, scan};
use crate::format::cf::{Arrays, Attributes, Contents, Dimension, Kind, Value, Variable};
use crate::format::place::open_regular;
use crate::format::problem::{invalid, unsupported};
use crate::volume::{Limits, Piece, Problem, VoxelType, Voxels};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// An open file of messages.
pub(super) struct Messages {
    file: Mutex<Opened>,
    fields: Vec<Field>,
    /// One for each variable that is no coordinate, by its name.
    groups: BTreeMap<String, Group>,
    contents: Contents,
    coordinates: BTreeMap<String, Vec<f64>>,
    left_out: Vec<String>,
}

struct Opened {
    file: File,
    /// The field that was decoded last, with its number: boxes of a field are often asked for one after the other.
    last: Option<(usize, Arc<Vec<f32>>)>,
}

/// More variables are no file of weather.
const MAX_VARIABLES: usize = 1000;

impl Messages {
    pub(super) fn open(path: &Path, limits: &Limits) -> Result<Self, Problem> {
        let found = scan(path, limits)?;
        let mut left_out = found.left_out;
        let groups = groups(&found.fields, &mut left_out);
        if let (true, Some(why)) = (groups.is_empty(), left_out.keys().next()) {
            return Err(unsupported(GRIB, why.clone()));
        }
        if groups.len() > MAX_VARIABLES {
            let wanted = format!("at most {MAX_VARIABLES}");
            return Err(invalid(
                GRIB,
                "variables",
                wanted,
                &groups.len().to_string(),
            ));
        }
        let (file, _) = open_regular(path)?;
        let mut messages = Self {
            file: Mutex::new(Opened { file, last: None }),
            fields: found.fields,
            groups: BTreeMap::new(),
            contents: Contents {
                path: path.to_owned(),
                format: GRIB,
                variables: Vec::new(),
                attributes: Attributes::default(),
            },
            coordinates: BTreeMap::new(),
            left_out: left_out
                .iter()
                .map(|(why, count)| format!("{count} fields of the file are left out: {why}"))
                .collect(),
        };
        for group in groups {
            messages.add(group);
        }
        Ok(messages)
    }

    /// What a person should know of a variable.
    pub(super) fn notes(&self, name: &str) -> Vec<String> {
        let notes = self.groups.get(name).map(|group| group.notes.clone());
        [notes.unwrap_or_default(), self.left_out.clone()].concat()
    }

    fn add(&mut self, group: Group) {
        let Some(grid) = group.first().and_then(|index| self.fields.get(index)) else {
            return;
        };
        let (latitudes, longitudes) = (grid.grid.latitudes(), grid.grid.longitudes());
        let members = group
            .members
            .iter()
            .map(|&member| f64::from(member))
            .collect();
        #[allow(clippy::cast_precision_loss, reason = "seconds of any year are exact")]
        let times = group.times.iter().map(|&seconds| seconds as f64).collect();
        let level = group.kind.word.clone();
        let mut dimensions = Vec::new();
        if group.members.len() > 1 {
            let member = [("standard_name", "realization")];
            dimensions.push(self.axis("number", members, attributes(&member)));
        }
        let time = [
            ("axis", "T"),
            ("standard_name", "time"),
            ("units", "seconds since 1970-01-01 00:00:00"),
        ];
        dimensions.push(self.axis("time", times, attributes(&time)));
        if group.kind.unit.is_some() || group.levels.len() > 1 {
            dimensions.push(self.axis(&level, group.levels.clone(), group.kind.attributes()));
        }
        let north = [("axis", "Y"), ("units", "degrees_north")];
        dimensions.push(self.axis("latitude", latitudes, attributes(&north)));
        let east = [("axis", "X"), ("units", "degrees_east")];
        dimensions.push(self.axis("longitude", longitudes, attributes(&east)));
        let unit: Vec<(&str, &str)> = group.unit.map(|unit| ("units", unit)).into_iter().collect();
        self.contents.variables.push(Variable {
            name: group.name.clone(),
            dimensions,
            kind: Kind::Numbers(VoxelType::F32),
            attributes: attributes(&unit),
        });
        self.groups.insert(group.name.clone(), group);
    }

    /// A dimension with these points: one that is there already, or a new one.
    fn axis(&mut self, name: &str, points: Vec<f64>, attributes: Attributes) -> Dimension {
        let numbered = (2_u32..).map(|k| format!("{name}_{k}"));
        let is_free = |name: &String| {
            self.coordinates
                .get(name)
                .is_none_or(|other| *other == points)
        };
        let names = std::iter::once(name.to_owned()).chain(numbered);
        let name = names.into_iter().find(is_free).unwrap_or_default();
        let size = u64::try_from(points.len()).unwrap_or(u64::MAX);
        let dimension = Dimension {
            name: name.clone(),
            size,
        };
        if self.coordinates.insert(name.clone(), points).is_none() {
            self.contents.variables.push(Variable {
                name,
                dimensions: vec![dimension.clone()],
                kind: Kind::Numbers(VoxelType::F64),
                attributes,
            });
        }
        dimension
    }

    /// All points of a field.
    fn decoded(&self, index: usize) -> Result<Arc<Vec<f32>>, Problem> {
        let mut opened = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((last, numbers)) = &opened.last
            && *last == index
        {
            return Ok(Arc::clone(numbers));
        }
        // Room for one field at a time.
        opened.last = None;
        let field = self.fields.get(index).ok_or_else(|| outside("field"))?;
        let numbers = Arc::new(values(&mut opened.file, field)?);
        opened.last = Some((index, Arc::clone(&numbers)));
        Ok(numbers)
    }
}

fn attributes(pairs: &[(&str, &str)]) -> Attributes {
    let pairs = pairs.iter();
    Attributes(
        pairs
            .map(|(name, text)| ((*name).to_owned(), Value::Text((*text).to_owned())))
            .collect(),
    )
}

fn outside(what: &str) -> Problem {
    invalid(GRIB, what, "one of the file", "another")
}

impl Arrays for Messages {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(
        &self,
        variable: &Variable,
        start: &[u64],
        count: &[u64],
        _stored: VoxelType,
    ) -> Result<Piece, Problem> {
        let index = |n: &u64| usize::try_from(*n).unwrap_or(usize::MAX);
        let starts: Vec<usize> = start.iter().map(index).collect();
        let counts: Vec<usize> = count.iter().map(index).collect();
        let sizes: Vec<usize> = variable.dimensions.iter().map(|d| index(&d.size)).collect();
        let group = self
            .groups
            .get(&variable.name)
            .ok_or_else(|| outside("variable"))?;
        let (Some((stacks, [rows, columns])), Some((starts, [y, x])), Some((counts, [ny, nx]))) = (
            sizes.split_last_chunk(),
            starts.split_last_chunk(),
            counts.split_last_chunk(),
        ) else {
            return Err(outside("dimension"));
        };
        let mut numbers = Vec::new();
        let fields = counts
            .iter()
            .fold(1, |all: usize, n| all.saturating_mul(*n));
        for k in 0..fields {
            // The place of the field among the variable's, from its place in the box.
            let (mut rest, mut stride, mut at) = (k, 1_usize, 0_usize);
            for ((size, start), count) in stacks.iter().zip(starts).zip(counts).rev() {
                let count = (*count).max(1);
                let inside = start.saturating_add(rest.rem_euclid(count));
                at = at.saturating_add(inside.saturating_mul(stride));
                stride = stride.saturating_mul(*size);
                rest = rest.div_euclid(count);
            }
            let field = group.fields.get(at).ok_or_else(|| outside("box"))?;
            let Some(field) = field else {
                numbers.resize(
                    numbers.len().saturating_add(ny.saturating_mul(*nx)),
                    f32::NAN,
                );
                continue;
            };
            let all = self.decoded(*field)?;
            if all.len() != rows.saturating_mul(*columns) {
                return Err(outside("field"));
            }
            for row in all.chunks((*columns).max(1)).skip(*y).take(*ny) {
                numbers.extend(row.iter().skip(*x).take(*nx));
            }
        }
        Ok(Piece::from(Voxels::F32(numbers)))
    }

    fn numbers(&self, variable: &Variable) -> Result<Vec<f64>, Problem> {
        let found = self.coordinates.get(&variable.name);
        found.cloned().ok_or_else(|| outside("coordinate"))
    }
}
