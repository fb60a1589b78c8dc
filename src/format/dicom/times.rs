//! Several pictures in one place: times, echoes and strengths of diffusion, or the same picture twice.

use super::moment::Kind;
use super::stack::Sorting;
use super::tags::{IMAGE_POSITION, SOP_INSTANCE_UID};
use crate::volume::ReadError;

/// Pictures by place along the stack, and in each place by time.
pub(super) type Places = Vec<Vec<usize>>;
/// Whether two pictures have the same pixels.
pub(super) type Same<'a> = &'a mut dyn FnMut(usize, usize) -> Result<bool, ReadError>;

/// Places with one picture for each time.
pub(super) struct Times {
    pub places: Places,
    pub count: usize,
    pub names: Vec<String>,
}

/// Tells the pictures of each place apart.
pub(super) fn times(
    sorting: &Sorting,
    mut places: Places,
    same: Same,
    notes: &mut Vec<String>,
) -> Result<Times, ReadError> {
    let most = places.iter().map(Vec::len).max().unwrap_or(0);
    if most <= 1 {
        return Ok(Times {
            places,
            count: 1,
            names: Vec::new(),
        });
    }
    if let Some(times) = by_moment(sorting, &places, notes) {
        return Ok(times);
    }
    let before: usize = places.iter().map(Vec::len).sum();
    drop_references(&mut places, same)?;
    let after: usize = places.iter().map(Vec::len).sum();
    if after < before {
        let dropped = before.saturating_sub(after);
        notes.push(format!("{dropped} pictures are in the folder twice, in the same place with the same pixels: one of each is taken"));
    }
    if places.iter().all(|place| place.len() == 1) {
        return Ok(Times {
            places,
            count: 1,
            names: Vec::new(),
        });
    }
    match by_moment(sorting, &places, notes).or_else(|| by_number(sorting, &places, notes)) {
        Some(times) => Ok(times),
        None => Err(unequal(sorting, &places)),
    }
}

/// The first attribute that tells all pictures of every place apart.
fn by_moment(sorting: &Sorting, places: &Places, notes: &mut Vec<String>) -> Option<Times> {
    let count = equal_count(places)?;
    let of = |kind: Kind, index: usize| kind.of(&sorting.picture(index).ok()?.moments);
    Kind::ALL.into_iter().find_map(|kind| {
        let sorted = sorted_by(places, |index| of(kind, index))?;
        let numbers = |place: &Vec<usize>| -> Vec<Option<f64>> {
            place.iter().map(|index| of(kind, *index)).collect()
        };
        let first = numbers(sorted.first()?);
        let are_same = sorted.iter().all(|place| numbers(place) == first);
        if kind.is_same_everywhere() && !are_same {
            return None;
        }
        let earliest = first.first().copied().flatten()?;
        notes.push(format!(
            "{count} pictures lie in each place: they are told apart by their {}",
            kind.word()
        ));
        let names = first
            .iter()
            .flatten()
            .map(|number| kind.name(*number, earliest));
        Some(Times {
            names: names.collect(),
            places: sorted,
            count,
        })
    })
}

/// Where nothing else differs, the numbers of the pictures may.
fn by_number(sorting: &Sorting, places: &Places, notes: &mut Vec<String>) -> Option<Times> {
    let count = equal_count(places)?;
    let sorted = sorted_by(places, |index| sorting.picture(index).ok()?.instance)?;
    notes.push(format!(
        "{count} pictures lie in each place: they are told apart by their instance numbers alone"
    ));
    Some(Times {
        places: sorted,
        count,
        names: Vec::new(),
    })
}

fn equal_count(places: &Places) -> Option<usize> {
    let count = places.first()?.len();
    places
        .iter()
        .all(|place| place.len() == count)
        .then_some(count)
}

/// Each place by a number that all its pictures have and no two share.
fn sorted_by(places: &Places, number: impl Fn(usize) -> Option<f64>) -> Option<Places> {
    places
        .iter()
        .map(|place| {
            let mut sorted: Vec<(f64, usize)> = Vec::new();
            for index in place {
                sorted.push((number(*index)?, *index));
            }
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let differ = sorted
                .windows(2)
                .all(|pair| matches!(pair, [a, b] if a.0 < b.0));
            differ.then(|| sorted.into_iter().map(|(_, index)| index).collect())
        })
        .collect()
}

/// Keeps the first of pictures in one place that have the same pixels.
fn drop_references(places: &mut Places, same: Same) -> Result<(), ReadError> {
    for place in places {
        let mut kept: Vec<usize> = Vec::new();
        for index in place.iter().copied() {
            let mut is_reference = false;
            for other in &kept {
                is_reference = is_reference || same(*other, index)?;
            }
            if !is_reference {
                kept.push(index);
            }
        }
        *place = kept;
    }
    Ok(())
}

fn unequal(sorting: &Sorting, places: &Places) -> ReadError {
    let fewest = places.iter().min_by_key(|place| place.len());
    let most = places.iter().max_by_key(|place| place.len());
    match (fewest.map(Vec::as_slice), most.map(Vec::as_slice)) {
        (Some([few, ..]), Some(many @ [a, b, ..])) if fewest.map(Vec::len) != Some(many.len()) => {
            let wanted = format!("as many pictures as where {} lies", sorting.name(*few));
            let found = format!(
                "{} there, among them {} and {}",
                many.len(),
                sorting.name(*a),
                sorting.name(*b)
            );
            sorting.wrong(*b, IMAGE_POSITION, wanted, found)
        }
        (_, Some([a, b, ..])) => {
            let wanted = format!(
                "a time, an echo or a number that tells it from {} in the same place",
                sorting.name(*a)
            );
            sorting.wrong(*b, SOP_INSTANCE_UID, wanted, "none".to_owned())
        }
        _ => sorting.wrong(0, IMAGE_POSITION, "a picture".to_owned(), "none".to_owned()),
    }
}
