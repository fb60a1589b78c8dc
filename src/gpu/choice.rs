//! Which device of this machine to use.

use super::{Error, instance::Candidate};

/// A wish for a device. [`super::list_devices`] shows what there is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// The first usable one: discrete, integrated, virtual, cpu, other.
    #[default]
    Default,
    /// The first whose name holds this text, upper or lower case.
    Name(String),
    /// Its place in [`super::list_devices`].
    Index(usize),
    /// The one with this UUID.
    Uuid([u8; 16]),
    /// The first that computes on the CPU.
    Cpu,
}

impl From<&str> for DeviceChoice {
    /// `cpu`, an index, a UUID of 32 hexadecimal digits (dashes are skipped), or part of a name.
    fn from(word: &str) -> Self {
        if word.eq_ignore_ascii_case("cpu") {
            return Self::Cpu;
        }
        if let Ok(index) = word.parse() {
            return Self::Index(index);
        }
        uuid(word).map_or_else(|| Self::Name(word.into()), Self::Uuid)
    }
}

fn uuid(word: &str) -> Option<[u8; 16]> {
    let digits: Vec<char> = word.chars().filter(|&c| c != '-').collect();
    if digits.len() != 32 {
        return None;
    }
    let mut uuid = [0; 16];
    for (byte, pair) in uuid.iter_mut().zip(digits.chunks(2)) {
        let digit = |k: usize| pair[k].to_digit(16);
        *byte = u8::try_from(16 * digit(0)? + digit(1)?).ok()?;
    }
    Some(uuid)
}

impl DeviceChoice {
    /// Takes the device out of `devices`, which are in order of preference.
    pub(super) fn pick(
        &self,
        mut devices: Vec<Candidate>,
        is_usable: impl Fn(&Candidate) -> bool,
    ) -> Result<Candidate, Error> {
        let found = match self {
            // Where none is usable, the best one's shortcomings make the error.
            Self::Default => devices.iter().position(is_usable).or(Some(0)),
            Self::Name(part) => {
                let part = part.to_lowercase();
                devices
                    .iter()
                    .position(|device| device.identity.name.to_lowercase().contains(&part))
            }
            Self::Index(index) => Some(*index),
            Self::Uuid(uuid) => devices
                .iter()
                .position(|device| device.identity.uuid == *uuid),
            Self::Cpu => devices.iter().position(Candidate::is_cpu),
        };
        match found.filter(|&index| index < devices.len()) {
            Some(index) => Ok(devices.swap_remove(index)),
            None => Err(Error::NoMatch {
                wanted: self.to_string(),
                devices: devices.iter().map(Candidate::title).collect(),
            }),
        }
    }
}

impl std::fmt::Display for DeviceChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Default => write!(f, "the default"),
            Self::Name(part) => write!(f, "name `{}`", part.escape_debug()),
            Self::Index(index) => write!(f, "index {index}"),
            Self::Uuid(uuid) => write!(f, "uuid {:032x}", u128::from_be_bytes(*uuid)),
            Self::Cpu => write!(f, "`cpu`"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_cpu_an_index_a_uuid_or_part_of_a_name() {
        let uuid = [
            0x6d, 0x65, 0x73, 0x61, 0x32, 0x32, 0x2e, 0x33, 0x2e, 0x36, 0x2d, 0, 0, 0, 0, 0xff,
        ];
        let cases = [
            ("CPU", DeviceChoice::Cpu),
            ("12", DeviceChoice::Index(12)),
            (
                "6d657361-3232-2e33-2e36-2d00000000ff",
                DeviceChoice::Uuid(uuid),
            ),
            (
                "6D6573613232 2e332e362d00000000ff",
                DeviceChoice::Name("6D6573613232 2e332e362d00000000ff".into()),
            ),
            ("llvmpipe", DeviceChoice::Name("llvmpipe".into())),
        ];
        for (word, wanted) in cases {
            assert_eq!(DeviceChoice::from(word), wanted, "{word}");
        }
    }
}
