//! What settings choose, as options and scene files name it: by the tables of [`Named`].

use crate::{
    named::Named,
    picture::ColorSpace,
    points::interpolate::Method,
    technique::{Filter, FilterBy, Lattice, Mode, Order, Technique, splat::Sheets},
};
use clap::{ValueEnum, builder::PossibleValue};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::{fmt, marker::PhantomData};

/// Options and scene files take these values.
macro_rules! by_name {
    ($($of:ty: $values:expr,)*) => {$(
        impl ValueEnum for $of {
            fn value_variants<'a>() -> &'a [Self] {
                $values
            }

            fn to_possible_value(&self) -> Option<PossibleValue> {
                let value = PossibleValue::new(self.name());
                Some(match self.about() {
                    "" => value,
                    about => value.help(about),
                })
            }
        }

        impl Serialize for $of {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> Deserialize<'de> for $of {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_str(Name(PhantomData))
            }
        }
    )*};
}

by_name! {
    Technique: Self::ALL,
    Mode: Self::ALL,
    Filter: Self::ALL,
    FilterBy: Self::ALL,
    // `--jitter` chooses the other one.
    Lattice: &[Self::Ray, Self::Planes, Self::Bresenham],
    Order: Self::ALL,
    ColorSpace: Self::ALL,
    Sheets: Self::ALL,
    Method: Self::ALL,
}

/// Takes a name while the deserializer stands at it: what is wrong with it has the line that it is on.
struct Name<T>(PhantomData<T>);

impl<T: Named + ValueEnum> de::Visitor<'_> for Name<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = T::value_variants()
            .iter()
            .map(|value| format!("`{}`", value.name()));
        write!(f, "one of {}", names.collect::<Vec<_>>().join(", "))
    }

    fn visit_str<E: de::Error>(self, found: &str) -> Result<T, E> {
        let mut values = T::value_variants().iter();
        let value = values.find(|value| value.name() == found);
        value.copied().ok_or_else(|| {
            E::custom(format_args!(
                "unknown variant `{found}`, expected {}",
                &self as &dyn de::Expected
            ))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::flags::SamplingFlags;

    #[test]
    fn scene_files_take_the_names_that_options_take_and_no_others() {
        for &filter in Filter::ALL {
            let text = serde_json::to_string(&filter).expect("a name");
            assert_eq!(text, format!("\"{filter}\""));
            assert_eq!(
                serde_json::from_str::<Filter>(&text).expect("the same"),
                filter
            );
            assert_eq!(Filter::from_str(filter.name(), false), Ok(filter));
        }
        let refused = |text| serde_json::from_str::<SamplingFlags>(text).expect_err("refused");
        let jitter = refused("{\"lattice\": \"jitter\"}").to_string();
        assert!(
            jitter.contains("expected one of `ray`, `planes`, `bresenham`"),
            "{jitter}"
        );
        let late = refused("{\"mode\":\n\"splat\"\n\n}");
        assert_eq!(late.line(), 2, "{late}");
    }
}
