//! What values measure, where their unit says so: enough to choose colours by.

/// What the unit of a volume's values says of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// No unit, or one that says nothing of the look of the values.
    #[default]
    Unknown,
    /// Radioactivity taken up by a body, as in PET: becquerels per millilitre, counts, SUV.
    Uptake,
    /// A field of nature: temperature, wind, pressure, humidity. It has no background of air around an object.
    Field,
}

/// Units of PET by DICOM PS3.3 C.8.9.1 (Units, 0054,1001) that measure uptake.
const UPTAKE: [&str; 5] = ["BQML", "CNTS", "GML", "CM2ML", "PROPCNTS"];

/// Units by UDUNITS, as CF conventions have them, of the fields of weather and ocean models. `m` and `1` are
/// left out: lengths and shares measure many things.
const FIELD: [&str; 17] = [
    "K",
    "degC",
    "celsius",
    "kg kg-1",
    "g kg-1",
    "kg/kg",
    "g/kg",
    "m s-1",
    "m/s",
    "Pa",
    "hPa",
    "Pa s-1",
    "m2 s-2",
    "s-1",
    "K m2 kg-1 s-1",
    "kg m-3",
    "W m-2",
];

impl Quantity {
    /// What `unit` says, as a file words it: `m s**-1` and `m s^-1` are `m s-1`.
    ///
    /// ```
    /// # use stratavox::volume::Quantity;
    /// assert_eq!(Quantity::of_unit(Some("BQML")), Quantity::Uptake);
    /// assert_eq!(Quantity::of_unit(Some("m s**-1")), Quantity::Field);
    /// assert_eq!(Quantity::of_unit(Some("HU")), Quantity::Unknown);
    /// assert_eq!(Quantity::of_unit(None), Quantity::Unknown);
    /// ```
    pub fn of_unit(unit: Option<&str>) -> Self {
        let unit = unit.unwrap_or_default().replace("**", "").replace('^', "");
        if UPTAKE.contains(&unit.trim()) {
            Self::Uptake
        } else if FIELD.contains(&unit.trim()) {
            Self::Field
        } else {
            Self::Unknown
        }
    }
}
