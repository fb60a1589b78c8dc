//! From the words of `--flow-seeds` to places in the wind.

use super::super::{Error, map::OnEarth};
use super::variable::Variables;
use super::wind::Wind;
use crate::flow::{
    SeedPlace, SeedTable, Seeds, VectorField, grid_seeds, height_of_pressure, plane_seeds,
    rake_seeds, random_seeds, seeds_where,
};
use crate::volume::Header;
use glam::DVec3;
use std::path::Path;

/// A longer file of seeds is none.
const MOST_BYTES: u64 = 64 << 20;

/// Places, each with its time where a file gives one. Of even lines there are none: they find their own.
pub fn places(
    seeds: &Seeds,
    wind: &Wind,
    variables: &Variables<'_>,
) -> Result<Vec<(DVec3, Option<f64>)>, Error> {
    let grid = &wind.grid;
    let plain = match seeds {
        Seeds::Even | Seeds::EvenAt(_) => Vec::new(),
        Seeds::Grid(counts) => grid_seeds(grid, *counts),
        Seeds::Random { count, seed } => random_seeds(grid, *count, *seed),
        Seeds::Plane { axis, at, count } => plane_seeds(grid, *axis, *at, *count),
        Seeds::Rake { from, to, count } => rake_seeds(*from, *to, *count),
        Seeds::Where {
            variable,
            comparison,
            threshold,
            count,
        } => {
            let source = variables.open(variable)?;
            let time = wind.times.first().map_or(0, |&(time, _)| time);
            let time = time.min(source.header().times.saturating_sub(1));
            let volume = variables.read(source.as_ref(), time, 0)?;
            let found = seeds_where(&volume, *comparison, *threshold, *count, 0);
            if found.is_empty() {
                let [low, high] = volume.value_range;
                return Err(Error::usage(
                    format!("--flow-seeds: in no voxel is {variable} there: it is {low} to {high}"),
                    format!("--flow-seeds 'where:{variable}>{low},100'"),
                ));
            }
            found
        }
        Seeds::File(path) => return of_file(path, &wind.header),
    };
    Ok(plain.into_iter().map(|place| (place, None)).collect())
}

/// Refuses seeds of which none lies where there is a wind.
pub fn check(seeds: &[(DVec3, Option<f64>)], wind: &Wind, start: f64) -> Result<(), Error> {
    let is_in = |&(place, time): &(DVec3, Option<f64>)| {
        let time = time.unwrap_or(start);
        wind.field.velocity(time, place).is_ok()
    };
    if seeds.iter().any(is_in) {
        return Ok(());
    }
    let far = wind.grid.far_corner();
    let ends = [DVec3::ZERO, far].map(|p| wind.grid.world_from_voxel.transform_point3(p));
    let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    Err(Error::usage(
        format!(
            "--flow-seeds: none of {} seeds lies in the wind (box {},{},{} to {},{},{})",
            seeds.len(),
            low.x,
            low.y,
            low.z,
            high.x,
            high.y,
            high.z
        ),
        "--flow-seeds random:200 lies anywhere in the box",
    ))
}

fn of_file(path: &Path, header: &Header) -> Result<Vec<(DVec3, Option<f64>)>, Error> {
    let failed = |problem: String| Error::Input {
        path: path.to_owned(),
        problem,
    };
    let size = std::fs::metadata(path).map_err(|cause| failed(cause.to_string()))?;
    if !size.is_file() || size.len() > MOST_BYTES {
        return Err(failed(format!(
            "wanted a file of at most {MOST_BYTES} bytes"
        )));
    }
    let text = std::fs::read_to_string(path).map_err(|cause| failed(cause.to_string()))?;
    let table = SeedTable::of(&text).map_err(|problem| failed(problem.to_string()))?;
    let on_earth = OnEarth::of(header);
    let place = |p: DVec3| -> Result<DVec3, Error> {
        if table.are == SeedPlace::World {
            return Ok(p);
        }
        let nowhere = "it has degrees, and the grid of the wind has no place on the Earth that is known, or its latitudes and \
                       its map differ: x,y,z are wanted";
        let on_earth = on_earth
            .as_ref()
            .ok_or_else(|| failed(nowhere.to_owned()))?;
        let [x, y] = on_earth.place([p.x, p.y]).ok_or_else(|| {
            let place = format!("longitude {}, latitude {}", p.x, p.y);
            failed(format!("{place} lies nowhere on the map of the wind"))
        })?;
        let heights = "lon,lat,height or lon,lat,pressure are wanted";
        let metres = header.height_metres();
        let z = match (table.are, metres, header.level_length()) {
            (SeedPlace::Level, _, Some(length)) => p.z * length,
            (SeedPlace::Level, ..) => {
                return Err(failed(format!(
                    "it has levels, and the wind has heights: {heights}"
                )));
            }
            (SeedPlace::Pressure, Some(metres), _) => {
                let height = height_of_pressure(100.0 * p.z);
                let wanted = || format!("a pressure over 0 is wanted, found {}", p.z);
                height.ok_or_else(|| failed(wanted()))? / metres
            }
            (_, Some(metres), _) => p.z / metres,
            (_, None, _) => {
                return Err(failed(
                    "it has heights, and levels of the wind are only numbers: lon,lat,level are wanted, 0 the lowest"
                        .to_owned(),
                ));
            }
        };
        Ok(DVec3::new(x, y, z))
    };
    let seeds = table.seeds.iter();
    seeds
        .map(|seed| Ok((place(seed.place)?, seed.time)))
        .collect()
}
