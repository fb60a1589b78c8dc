//! Fields put together into variables: `[member, time, level]`, each sorted, whatever their order in the file.

use super::level::Kind;
use super::parameter::parameter;
use super::product::Product;
use super::scan::Field;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// The fields of one variable.
pub(super) struct Group {
    pub name: String,
    pub unit: Option<&'static str>,
    pub kind: Kind,
    pub members: Vec<u8>,
    /// Seconds since 1970.
    pub times: Vec<i64>,
    pub levels: Vec<f64>,
    /// Numbers of fields, levels fastest; `None` where the file has no field.
    pub fields: Vec<Option<usize>>,
    pub notes: Vec<String>,
}

impl Group {
    /// A field of it, and with it the grid.
    pub(super) fn first(&self) -> Option<usize> {
        self.fields.iter().copied().flatten().next()
    }
}

/// What fields of one variable have in common, before the grid.
type Key = ([u8; 3], u16, [u8; 2], Option<[u8; 2]>);

fn key(product: &Product) -> Key {
    let Product {
        parameter,
        centre,
        level,
        statistic,
        ..
    } = *product;
    (parameter, centre, level.surfaces, statistic)
}

fn order(a: &Product, b: &Product) -> Ordering {
    let place = |product: &Product| (product.member, product.seconds);
    let [low, high] = [a, b].map(|product| product.level.height);
    place(a).cmp(&place(b)).then(low.total_cmp(&high))
}

/// Puts fields together. Where several say the same of the same moment, the second ones are a variable of their own.
pub(super) fn groups(fields: &[Field], left_out: &mut BTreeMap<String, u32>) -> Vec<Group> {
    // A file has few grids; fields refer to them by number.
    let mut grids = Vec::new();
    let mut alike: BTreeMap<(usize, Key), Vec<usize>> = BTreeMap::new();
    for (index, field) in fields.iter().enumerate() {
        let found = grids.iter().position(|grid| *grid == field.grid);
        let grid = found.unwrap_or_else(|| {
            grids.push(field.grid);
            grids.len().saturating_sub(1)
        });
        alike
            .entry((grid, key(&field.product)))
            .or_default()
            .push(index);
    }
    let product = |index: usize| fields.get(index).map(|field| &field.product);
    let mut found = Vec::new();
    for indices in alike.values_mut() {
        indices.sort_by(|a, b| match (product(*a), product(*b)) {
            (Some(a), Some(b)) => order(a, b),
            _ => Ordering::Equal,
        });
        let mut turns: Vec<Vec<usize>> = Vec::new();
        let (mut turn, mut last) = (0_usize, None);
        for &index in indices.iter() {
            let is_same = match (last.and_then(product), product(index)) {
                (Some(a), Some(b)) => order(a, b) == Ordering::Equal,
                _ => false,
            };
            turn = if is_same { turn.saturating_add(1) } else { 0 };
            last = Some(index);
            if turns.len() <= turn {
                turns.push(Vec::new());
            }
            if let Some(of_turn) = turns.get_mut(turn) {
                of_turn.push(index);
            }
        }
        found.extend(
            turns
                .iter()
                .filter_map(|indices| group(fields, indices, left_out)),
        );
    }
    // The variable with the most levels keeps the plain name.
    found.sort_by_key(|group| std::cmp::Reverse(group.levels.len()));
    let mut taken = BTreeSet::new();
    for group in &mut found {
        if !taken.insert(group.name.clone()) {
            let name = format!("{}_{}", group.name, group.kind.word);
            let numbered = (2_u32..).map(|k| format!("{name}_{k}"));
            let free = std::iter::once(name.clone()).chain(numbered);
            group.name = free
                .into_iter()
                .find(|name| !taken.contains(name))
                .unwrap_or(name);
            taken.insert(group.name.clone());
        }
    }
    found
}

fn group(
    fields: &[Field],
    indices: &[usize],
    left_out: &mut BTreeMap<String, u32>,
) -> Option<Group> {
    let products = || {
        indices
            .iter()
            .filter_map(|&index| Some(&fields.get(index)?.product))
    };
    let first = *products().next()?;
    let members: BTreeSet<u8> = products().map(|product| product.member).collect();
    let times: BTreeSet<i64> = products().map(|product| product.seconds).collect();
    let mut levels: Vec<f64> = products().map(|product| product.level.height).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| a.total_cmp(b).is_eq());
    let members: Vec<u8> = members.into_iter().collect();
    let times: Vec<i64> = times.into_iter().collect();
    let size = members
        .len()
        .saturating_mul(times.len())
        .saturating_mul(levels.len());
    // A table that is nearly empty is no variable.
    if size > indices.len().saturating_mul(8) {
        let why = "levels and times of a variable that have nothing in common".to_owned();
        let count = left_out.entry(why).or_insert(0);
        *count = count.saturating_add(u32::try_from(indices.len()).unwrap_or(u32::MAX));
        return None;
    }
    let mut places = vec![None; size];
    for &index in indices {
        let product = &fields.get(index)?.product;
        let member = members.binary_search(&product.member).ok()?;
        let time = times.binary_search(&product.seconds).ok()?;
        let level = levels
            .binary_search_by(|level| level.total_cmp(&product.level.height))
            .ok()?;
        let at = member.saturating_mul(times.len()).saturating_add(time);
        let at = at.saturating_mul(levels.len()).saturating_add(level);
        *places.get_mut(at)? = Some(index);
    }
    let mut notes = Vec::new();
    if indices.len() < size {
        notes.push(format!(
            "the file has {} of {size} fields of the variable: where a level has none at a time there is no data",
            indices.len()
        ));
    }
    if let Some(field) = indices.first().and_then(|&index| fields.get(index))
        && !field.grid.is_consistent()
    {
        notes.push("the rows run as their latitudes say, not as the scanning mode does".to_owned());
    }
    let (name, unit) = parameter(first.parameter);
    Some(Group {
        name,
        unit,
        kind: first.level.kind(first.centre),
        members,
        times,
        levels,
        fields: places,
        notes,
    })
}
