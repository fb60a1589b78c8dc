//! What quantities of nature are drawn in: by CF standard name, else by unit.

use super::Colormap;

/// How the colours of a quantity lie over its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// From the low values to the high ones.
    Rising,
    /// Where there are values on both sides of zero, blue below it and red above; else from low to high.
    AboutZero,
}

/// A row of the table: a CF standard name or a unit, and its colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meaning {
    /// A standard name of CF conventions, or a unit by UDUNITS.
    pub word: &'static str,
    /// The word of `--colormap`.
    pub colors: &'static str,
    /// How they lie over the values.
    pub scale: Scale,
}

const fn rising(word: &'static str, colors: &'static str) -> Meaning {
    Meaning {
        word,
        colors,
        scale: Scale::Rising,
    }
}

const fn about_zero(word: &'static str, colors: &'static str) -> Meaning {
    Meaning {
        word,
        colors,
        scale: Scale::AboutZero,
    }
}

/// Standard names first: a unit is asked only where there is no name in the table.
pub const MEANINGS: [Meaning; 47] = [
    rising("air_temperature", "roma,reverse"),
    rising("air_potential_temperature", "roma,reverse"),
    rising("sea_water_temperature", "roma,reverse"),
    rising("sea_water_potential_temperature", "roma,reverse"),
    rising("sea_surface_temperature", "roma,reverse"),
    rising("dew_point_temperature", "roma,reverse"),
    rising("specific_humidity", "viridis"),
    rising("humidity_mixing_ratio", "viridis"),
    rising("relative_humidity", "viridis"),
    rising("mass_fraction_of_cloud_liquid_water_in_air", "viridis"),
    rising("mass_fraction_of_cloud_ice_in_air", "viridis"),
    rising("cloud_area_fraction_in_atmosphere_layer", "viridis"),
    about_zero("eastward_wind", "wind"),
    about_zero("northward_wind", "wind"),
    about_zero("upward_air_velocity", "wind"),
    about_zero("lagrangian_tendency_of_air_pressure", "wind"),
    about_zero("atmosphere_relative_vorticity", "wind"),
    about_zero("divergence_of_wind", "wind"),
    about_zero("eastward_sea_water_velocity", "wind"),
    about_zero("northward_sea_water_velocity", "wind"),
    rising("wind_speed", "wind"),
    rising("sea_water_speed", "wind"),
    rising("air_pressure", "batlow"),
    rising("geopotential", "batlow"),
    rising("geopotential_height", "batlow"),
    rising("sea_water_salinity", "cividis"),
    rising("mole_fraction_of_ozone_in_air", "plasma"),
    rising("mass_fraction_of_ozone_in_air", "plasma"),
    rising("equivalent_reflectivity_factor", "turbo"),
    rising("rainfall_flux", "viridis"),
    rising("K", "roma,reverse"),
    rising("degC", "roma,reverse"),
    rising("celsius", "roma,reverse"),
    rising("kg kg-1", "viridis"),
    rising("kg/kg", "viridis"),
    rising("g kg-1", "viridis"),
    rising("g/kg", "viridis"),
    rising("kg m-3", "viridis"),
    about_zero("m s-1", "wind"),
    about_zero("m/s", "wind"),
    about_zero("s-1", "wind"),
    about_zero("Pa s-1", "wind"),
    rising("Pa", "batlow"),
    rising("hPa", "batlow"),
    rising("m2 s-2", "batlow"),
    rising("W m-2", "inferno"),
    rising("dBZ", "turbo"),
];

impl Meaning {
    /// The row of a standard name, else of a unit: `m s**-1` and `m s^-1` are `m s-1`.
    pub fn of(standard_name: Option<&str>, unit: Option<&str>) -> Option<Self> {
        let find = |word: &str| MEANINGS.into_iter().find(|meaning| meaning.word == word);
        let unit = unit.map(|unit| unit.replace("**", "").replace('^', ""));
        let by_name = standard_name.and_then(find);
        by_name.or_else(|| unit.and_then(|unit| find(unit.trim())))
    }

    /// Its colours.
    pub fn colormap(self) -> Colormap {
        self.colors.parse().expect("a map that a test has read")
    }

    /// The rows as lines of a table of the documents.
    pub fn table() -> String {
        let line = |meaning: Meaning| {
            let zero = match meaning.scale {
                Scale::Rising => "",
                Scale::AboutZero => "blue and red about 0; of one sign: ",
            };
            format!("| `{}` | {zero}{} |\n", meaning.word, meaning.colors)
        };
        MEANINGS.map(line).concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_the_documents_is_that_of_the_program() {
        for meaning in MEANINGS {
            assert_eq!(meaning.colormap().to_string(), meaning.colors);
        }
        let page = include_str!("../../docs/transfer-functions.md");
        assert!(
            page.contains(&Meaning::table()),
            "wanted\n{}",
            Meaning::table()
        );
    }

    #[test]
    fn a_name_wins_over_a_unit_and_units_are_read_as_they_are_written() {
        let colors = |name, unit| Meaning::of(name, unit).map(|meaning| meaning.colors);
        assert_eq!(colors(Some("wind_speed"), Some("K")), Some("wind"));
        assert_eq!(colors(Some("of_my_own"), Some("K")), Some("roma,reverse"));
        assert_eq!(colors(None, Some(" m s**-1")), Some("wind"));
        assert_eq!(colors(None, Some("furlong")), None);
    }
}
