//! What a file says of each column: the height of the ground, and how far the map stretches.
//!
//! ```text
//! ground = HGT, or the lowest face (PH + PHB) / g        m = length on the map / length on the Earth
//! ```

use super::super::Error;
use super::variable::{Variables, numbers};
use crate::flow::wind::MapFactors;
use crate::volume::{Header, TimeComponent, Volume, VoxelBox};

/// Free fall as WRF has it, m s-2.
const WRF_GRAVITY: f64 = 9.81;

/// Names of the height of the ground, m.
const GROUND: [&str; 2] = ["HGT", "orog"];
/// And its standard names.
const GROUND_STANDARD: [&str; 2] = ["surface_altitude", "orography"];

/// Names of masks that are 1 over land and 0 over the sea.
const LAND_MASKS: [&str; 3] = ["LANDMASK", "lsm", "land_binary_mask"];

/// Heights of the ground in world length, one a column of the grid; `None` where the file has none, or heights are none.
pub fn heights(variables: &Variables<'_>, header: &Header) -> Result<Option<Vec<f64>>, Error> {
    let metres = match header.height_metres() {
        Some(metres) if header.is_earth => metres,
        _ => return Ok(None),
    };
    let standard = header.variable_standard_names.iter();
    let by_standard = standard
        .zip(&header.variables)
        .find_map(|(standard, name)| {
            GROUND_STANDARD
                .contains(&standard.as_str())
                .then_some(name.as_str())
        });
    let named = by_standard.or_else(|| GROUND.into_iter().find(|&name| has(header, name)));
    if let Some(name) = named
        && let Some(ground) = columns(variables, header, name)?
    {
        return Ok(Some(ground.into_iter().map(|h| h / metres).collect()));
    }
    if !(has(header, "PH") && has(header, "PHB")) {
        return Ok(None);
    }
    let [first, second] = [
        lowest(variables, "PH", header)?,
        lowest(variables, "PHB", header)?,
    ];
    let (Some(first), Some(second)) = (first, second) else {
        return Ok(None);
    };
    let faces = first.iter().zip(&second);
    let height = |(a, b): (&f64, &f64)| (a + b) / WRF_GRAVITY / metres;
    Ok(Some(faces.map(height).collect()))
}

/// Where the columns of the grid are sea: 1, land 0; `None` where the file has no mask.
pub fn sea_of(variables: &Variables<'_>, header: &Header) -> Result<Option<Vec<f64>>, Error> {
    for name in LAND_MASKS {
        if has(header, name)
            && let Some(land) = columns(variables, header, name)?
        {
            return Ok(Some(land.into_iter().map(|land| 1.0 - land).collect()));
        }
    }
    Ok(None)
}

/// Factors of the map at the middles of cells; `None` where the file has none on this grid.
pub fn map_factors(
    variables: &Variables<'_>,
    header: &Header,
) -> Result<Option<MapFactors>, Error> {
    for [x, y] in [["MAPFAC_MX", "MAPFAC_MY"], ["MAPFAC_M", "MAPFAC_M"]] {
        if has(header, x)
            && has(header, y)
            && let Some(along_x) = columns(variables, header, x)?
            && let Some(along_y) = columns(variables, header, y)?
        {
            return Ok(Some([along_x, along_y]));
        }
    }
    Ok(None)
}

fn has(header: &Header, name: &str) -> bool {
    header.variables.iter().any(|other| other == name)
}

/// The first time of a variable of one number a column, where its columns are those of the grid and all have one.
fn columns(
    variables: &Variables<'_>,
    header: &Header,
    name: &str,
) -> Result<Option<Vec<f64>>, Error> {
    let source = variables.open(name)?;
    let [nx, ny, _] = header.dims;
    if source.header().dims != [nx, ny, 1] {
        return Ok(None);
    }
    let volume = variables.read(source.as_ref(), 0, 0)?;
    Ok(finite(&volume))
}

/// The lowest level of a variable as it is stored.
fn lowest(
    variables: &Variables<'_>,
    name: &str,
    header: &Header,
) -> Result<Option<Vec<f64>>, Error> {
    let source = variables.open_as_stored(name)?;
    let [nx, ny, nz] = source.header().dims;
    if [nx, ny] != header.dims[..2] || nz < 2 {
        return Ok(None);
    }
    let region = VoxelBox {
        min: [0; 3],
        max: [nx, ny, 1],
    };
    let pick = TimeComponent {
        time: 0,
        component: 0,
    };
    let volume = Volume::read(source.as_ref(), pick, region, &variables.limits)?;
    Ok(finite(&volume))
}

fn finite(volume: &Volume) -> Option<Vec<f64>> {
    let numbers: Vec<f64> = numbers(volume, 1.0).into_iter().map(f64::from).collect();
    numbers.iter().all(|n| n.is_finite()).then_some(numbers)
}
