//! Which variables of a file are the wind: by what the conventions call them, then by their names.
//!
//! CF Metadata Conventions, standard name table; names of WRF, ECMWF, NCEP and CMIP.

/// The variables of a wind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WindNames {
    /// To the east, or along x.
    pub east: String,
    /// To the north, or along y.
    pub north: String,
    /// Upwards; without it lines stay in their level.
    pub up: Option<String>,
}

/// Pairs of standard names, the first that a file has is taken.
const STANDARD: [[&str; 2]; 4] = [
    ["eastward_wind", "northward_wind"],
    ["x_wind", "y_wind"],
    [
        "eastward_sea_water_velocity",
        "northward_sea_water_velocity",
    ],
    ["sea_water_x_velocity", "sea_water_y_velocity"],
];

/// Upwards, by standard names.
const STANDARD_UP: [&str; 3] = [
    "upward_air_velocity",
    "upward_sea_water_velocity",
    "lagrangian_tendency_of_air_pressure",
];

/// Pairs of names.
const NAMES: [[&str; 2]; 6] = [
    ["U", "V"],
    ["u", "v"],
    ["ua", "va"],
    ["uwnd", "vwnd"],
    ["UGRD", "VGRD"],
    ["UO", "VO"],
];

/// Upwards, by names.
const NAMES_UP: [&str; 7] = ["W", "w", "wa", "DZDT", "omega", "OMEGA", "wap"];

impl WindNames {
    /// Those of a file with these variables and their standard names, which are empty where there are none. `None` where it has
    /// no pair: a lone `u` is no wind.
    pub fn of(names: &[String], standard_names: &[String]) -> Option<Self> {
        let by_standard = |wanted: &str| {
            let at = standard_names.iter().position(|name| name == wanted)?;
            names.get(at).cloned()
        };
        let by_name = |wanted: &str| names.iter().find(|name| *name == wanted).cloned();
        let pair = |[east, north]: &[&str; 2], find: &dyn Fn(&str) -> Option<String>| {
            Some([find(east)?, find(north)?])
        };
        let standard = STANDARD.iter().find_map(|names| pair(names, &by_standard));
        let [east, north] =
            standard.or_else(|| NAMES.iter().find_map(|names| pair(names, &by_name)))?;
        let up = STANDARD_UP.into_iter().find_map(by_standard);
        let up = up.or_else(|| NAMES_UP.into_iter().find_map(by_name));
        Some(Self { east, north, up })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(variables: &[(&str, &str)]) -> Option<(String, String, Option<String>)> {
        let names: Vec<String> = variables
            .iter()
            .map(|(name, _)| (*name).to_owned())
            .collect();
        let standard: Vec<String> = variables.iter().map(|(_, cf)| (*cf).to_owned()).collect();
        WindNames::of(&names, &standard).map(|wind| (wind.east, wind.north, wind.up))
    }

    #[test]
    fn standard_names_go_before_names_and_a_lone_component_is_no_wind() {
        let all = [
            ("u", ""),
            ("v", ""),
            ("a", "northward_wind"),
            ("b", "eastward_wind"),
            ("c", "lagrangian_tendency_of_air_pressure"),
        ];
        let wind = |a: &str, b: &str, c: Option<&str>| {
            Some((a.to_owned(), b.to_owned(), c.map(str::to_owned)))
        };
        assert_eq!(chosen(&all), wind("b", "a", Some("c")));
        assert_eq!(chosen(&all[..3]), wind("u", "v", None));
        assert_eq!(
            chosen(&[("V", ""), ("W", ""), ("U", "")]),
            wind("U", "V", Some("W"))
        );
        assert_eq!(chosen(&[("U", ""), ("v", "")]), None);
        assert_eq!(chosen(&[("u", "")]), None);
    }
}
