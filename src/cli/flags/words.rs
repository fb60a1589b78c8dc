//! What settings choose, as options and scene files name it: by the tables of [`Named`].

use crate::{
    named::Named,
    picture::ColorSpace,
    technique::{Filter, FilterBy, Lattice, Mode, Order, Technique},
};
use clap::{ValueEnum, builder::PossibleValue};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

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
                of_name(&String::deserialize(deserializer)?)
            }
        }
    )*};
}

by_name! {
    Technique: Self::ALL,
    Mode: Self::ALL,
    Filter: Self::ALL,
    FilterBy: Self::ALL,
    // `--jitter` chooses the third.
    Lattice: &[Self::Ray, Self::Planes],
    Order: Self::ALL,
    ColorSpace: Self::ALL,
}

fn of_name<T: Named + ValueEnum, E: Error>(found: &str) -> Result<T, E> {
    let values = T::value_variants();
    let value = values.iter().find(|value| value.name() == found);
    value.copied().ok_or_else(|| {
        let names: Vec<_> = values
            .iter()
            .map(|value| format!("`{}`", value.name()))
            .collect();
        let names = names.join(", ");
        E::custom(format!(
            "unknown variant `{found}`, expected one of {names}"
        ))
    })
}
