//! Seeds of a text file: a line a seed.
//!
//! ```text
//! x,y,z[,t]                           world, seconds
//! lon,lat,height|pressure|level[,t]   degrees, m, hPa or a level from 0 at the lowest; a first line of these names says so
//! ```

use glam::DVec3;

/// A seed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed {
    /// As the names of the columns say.
    pub place: DVec3,
    /// Seconds; `None` where the file has no such column.
    pub time: Option<f64>,
}

/// What the first three columns are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedPlace {
    /// A place of the world.
    World,
    /// Degrees of longitude and of latitude, and a height in m.
    Height,
    /// Degrees of longitude and of latitude, and a pressure in hPa.
    Pressure,
    /// Degrees of longitude and of latitude, and the number of a level, 0 the lowest.
    Level,
}

/// The seeds of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct SeedTable {
    /// What their places are.
    pub are: SeedPlace,
    /// In the order of the lines.
    pub seeds: Vec<Seed>,
}

/// Why a text has no seeds.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// A line has too few or too many numbers.
    #[error("line {line}: {wanted} numbers wanted, found {found}")]
    Count {
        /// From 1.
        line: usize,
        /// What the first line has, or 3.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
    /// A field is no number.
    #[error("line {line}: a finite number wanted, found {found:?}")]
    Number {
        /// From 1.
        line: usize,
        /// The field.
        found: String,
    },
    /// The first line has other names.
    #[error(
        "line 1: x,y,z or lon,lat,height or lon,lat,pressure or lon,lat,level wanted, each with or without t, found {0:?}"
    )]
    Names(String),
    /// There is no seed.
    #[error("a line with a place wanted, found none")]
    Empty,
}

impl SeedTable {
    /// Of a text of values that commas separate; empty lines and those that begin with # say nothing.
    ///
    /// # Errors
    /// [`TableError`], with the number of the line.
    pub fn of(text: &str) -> Result<Self, TableError> {
        let lines = text
            .lines()
            .enumerate()
            .map(|(i, line)| (i + 1, line.trim()));
        let mut lines = lines
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
            .peekable();
        let mut are = SeedPlace::World;
        let mut columns = None;
        if let Some(&(_, first)) = lines.peek()
            && first
                .split(',')
                .all(|name| name.trim().parse::<f64>().is_err())
        {
            let (found, count) = names(first)?;
            are = found;
            columns = Some(count);
            lines.next();
        }
        let mut seeds = Vec::new();
        for (line, text) in lines {
            let numbers = numbers(line, text)?;
            let found = numbers.len();
            let wanted = *columns.get_or_insert(if found == 4 { 4 } else { 3 });
            let (&[x, y, z, ..], true) = (numbers.as_slice(), found == wanted) else {
                return Err(TableError::Count {
                    line,
                    wanted,
                    found,
                });
            };
            seeds.push(Seed {
                place: DVec3::new(x, y, z),
                time: numbers.get(3).copied(),
            });
        }
        match seeds.is_empty() {
            true => Err(TableError::Empty),
            false => Ok(Self { are, seeds }),
        }
    }
}

/// What columns of these names are, and how many there are.
fn names(line: &str) -> Result<(SeedPlace, usize), TableError> {
    let names: Vec<String> = line
        .split(',')
        .map(|name| name.trim().to_lowercase())
        .collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let (places, count) = match names.as_slice() {
        [places @ .., "t" | "time"] => (places, 4),
        places => (places, 3),
    };
    let are = match places {
        ["x", "y", "z"] => SeedPlace::World,
        ["lon" | "longitude", "lat" | "latitude", "height"] => SeedPlace::Height,
        ["lon" | "longitude", "lat" | "latitude", "pressure"] => SeedPlace::Pressure,
        ["lon" | "longitude", "lat" | "latitude", "level"] => SeedPlace::Level,
        _ => return Err(TableError::Names(line.chars().take(80).collect())),
    };
    Ok((are, count))
}

fn numbers(line: usize, text: &str) -> Result<Vec<f64>, TableError> {
    let number = |field: &str| {
        let number: Option<f64> = field.trim().parse().ok();
        let number = number.filter(|number| number.is_finite());
        number.ok_or_else(|| TableError::Number {
            line,
            found: field.chars().take(80).collect(),
        })
    };
    text.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_read_with_and_without_names_and_times() {
        let plain = SeedTable::of("# three\n1,2,3\n\n 4 , 5,6\n").expect("seeds");
        assert_eq!((plain.are, plain.seeds.len()), (SeedPlace::World, 2));
        assert_eq!(plain.seeds[1].place, DVec3::new(4.0, 5.0, 6.0));
        let timed = SeedTable::of("Lon,Lat,Pressure,T\n-90,25,850,3600\n").expect("seeds");
        assert_eq!(timed.are, SeedPlace::Pressure);
        assert_eq!(timed.seeds[0].time, Some(3600.0));
        assert_eq!(
            SeedTable::of("lon,lat,level\n1,2,3").map(|t| t.are),
            Ok(SeedPlace::Level)
        );
        assert_eq!(
            SeedTable::of("x,y,z,t\n1,2,3,4").map(|t| t.are),
            Ok(SeedPlace::World)
        );
    }

    #[test]
    fn what_is_wrong_is_said_with_the_line() {
        let said = |text: &str| SeedTable::of(text).expect_err(text).to_string();
        assert_eq!(said("1,2,3\n\n1,2"), "line 3: 3 numbers wanted, found 2");
        assert_eq!(said("1,2"), "line 1: 3 numbers wanted, found 2");
        assert_eq!(said("1,2,3,4\n1,2,3"), "line 2: 4 numbers wanted, found 3");
        assert_eq!(
            said("1,2,inf"),
            "line 1: a finite number wanted, found \"inf\""
        );
        assert_eq!(
            said("1,2,3\na,b,c"),
            "line 2: a finite number wanted, found \"a\""
        );
        assert!(said("lat,lon,height\n1,2,3").contains("lon,lat,height"));
        assert!(said("x,y,z\n").contains("found none"));
    }
}
