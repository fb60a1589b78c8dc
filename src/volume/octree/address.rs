//! Where a node is: one digit a level, from the root down.
//!
//! ```text
//! digit = 1 + x + 2 y + 4 z          x, y, z: 1 in the upper half of the parent along the axis, else 0
//! ```
//!
//! In the plane z = 0 these are the addresses of a quadtree: 343 is the third quarter of the fourth of the third.

use std::fmt;
use std::str::FromStr;

/// Address of a node of an [`Octree`](super::Octree); that of the root has no digit. Addresses are in Morton order, and that of a
/// node begins those of all nodes inside it.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Address(Vec<u8>);

/// A text that is no address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddressError {
    /// What was found in the place of a digit.
    pub found: char,
}

impl fmt::Display for AddressError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let found = self.found;
        write!(
            f,
            "an address has digits from 1 to 8, and there is {found:?}"
        )
    }
}

impl std::error::Error for AddressError {}

impl Address {
    /// The digits from the root down, 1 to 8 each.
    pub fn digits(&self) -> &[u8] {
        &self.0
    }

    /// That of a child, 0 to 7: x + 2y + 4z.
    pub(super) fn child(&self, child: u8) -> Self {
        let mut digits = self.0.clone();
        digits.push(child + 1);
        Self(digits)
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = self.0.iter().map(|digit| char::from(b'0' + digit));
        f.pad(&digits.collect::<String>())
    }
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let digit = |found: char| match found {
            '1'..='8' => Ok(found as u8 - b'0'),
            _ => Err(AddressError { found }),
        };
        text.chars().map(digit).collect::<Result<_, _>>().map(Self)
    }
}
