//! Named materials: which share of a value is which substance (Drebin, Carpenter & Hanrahan, SIGGRAPH 1988).
//!
//! With m_i(v) the membership of material i, a trapezoid that rises from v0 to v1, is 1 up to v2 and falls to v3:
//!
//! ```text
//! opacity = sum of m_i a_i        colour = sum of m_i a_i c_i / sum of m_i a_i        sum of m_i <= 1
//! ```
//!
//! What the memberships leave is transparent. A trapezoid with vertical edges, v0 = v1 and v2 = v3, is a binary
//! material; it holds v0 and not v3, as the later point wins at equal values.
//!
//! Between the corners of all trapezoids memberships are straight lines, so opacity has exact control points. So
//! has the weighted colour; colour itself is the quotient of two lines, with W0 and W1 the sums of weights at the
//! ends of a piece
//!
//! ```text
//! c = c0 + u (c1 - c0),   u = t W1 / ((1 - t) W0 + t W1)      |u - t| <= |sqrt W1 - sqrt W0| / (sqrt W1 + sqrt W0)
//! ```
//!
//! and a straight line where W0 = W1. Else the piece is cut where W grows by equal factors, until that bound keeps
//! every sRGB number within 1/4096.

use super::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};

/// One substance.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What messages call it.
    pub name: String,
    /// sRGB numbers, 0 to 1.
    pub srgb: [f64; 3],
    /// Where it is all there is, per reference length, 0 to 1.
    pub opacity: f64,
    /// Values, ascending: it begins, is full, is full no longer, ends.
    pub trapezoid: [f64; 4],
}

/// How far a colour number may be from the quotient.
const TOLERANCE: f64 = 1.0 / 4096.0;
/// Sums of memberships above 1 by no more than this are rounding.
const ROUNDING: f64 = 1e-9;

/// Memberships that leave less than nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct TooMuch {
    /// Where they do.
    pub value: f64,
    /// Their sum there.
    pub sum: f64,
    /// Which materials meet there.
    pub names: Vec<String>,
}

impl Material {
    /// The share at a value, as it is just above (`true`) or just below it.
    fn membership(&self, value: f64, above: bool) -> f64 {
        let [v0, v1, v2, v3] = self.trapezoid;
        let is_inside = if above {
            v0 <= value && value < v3
        } else {
            v0 < value && value <= v3
        };
        if !is_inside {
            return 0.0;
        }
        // On a slope neither is divided by nothing: the value lies strictly between its ends, or at the end of 0.
        if value < v1 {
            (value - v0) / (v1 - v0)
        } else if value > v2 {
            (v3 - value) / (v3 - v2)
        } else {
            1.0
        }
    }
}

impl TransferFunction {
    /// The function of several materials, opacity exact and colour within 1/4096.
    ///
    /// # Errors
    /// [`TooMuch`] where the memberships of some value sum to more than 1.
    pub fn of_materials(
        materials: &[Material],
        reference_length: Option<f64>,
    ) -> Result<Self, TooMuch> {
        let mut corners: Vec<f64> = materials.iter().flat_map(|m| m.trapezoid).collect();
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        let mut function = Self {
            color: Vec::new(),
            opacity: Vec::new(),
            reference_length,
            interpolation: Interpolation::Linear,
            gradient_transfer: None,
            medium: None,
        };
        let mut before: Option<Mixture> = None;
        for &value in &corners {
            let [below, above] = [false, true].map(|above| Mixture::at(materials, value, above));
            for found in [&below, &above] {
                found.check(materials)?;
            }
            if let Some(left) = &before {
                left.push_piece_to(&below, &mut function.color);
            }
            function
                .opacity
                .extend([&below, &above].map(Mixture::point));
            before = Some(above);
        }
        function.opacity.dedup();
        // Materials that are all transparent: any colour will do.
        if let (true, Some(first)) = (function.color.is_empty(), materials.first()) {
            function.color.push(ColorPoint {
                value: first.trapezoid[0],
                srgb: first.srgb,
            });
        }
        Ok(function)
    }
}

/// What the materials are together at one value.
#[derive(Clone, Debug)]
struct Mixture {
    value: f64,
    memberships: Vec<f64>,
    opacity: f64,
    /// Colour times opacity.
    light: [f64; 3],
}

impl Mixture {
    fn at(materials: &[Material], value: f64, above: bool) -> Self {
        let memberships = materials.iter().map(|m| m.membership(value, above));
        let memberships: Vec<f64> = memberships.collect();
        let (mut opacity, mut light) = (0.0, [0.0; 3]);
        for (material, share) in materials.iter().zip(&memberships) {
            let weight = share * material.opacity;
            opacity += weight;
            light = std::array::from_fn(|c| light[c] + weight * material.srgb[c]);
        }
        Self {
            value,
            memberships,
            opacity,
            light,
        }
    }

    fn check(&self, materials: &[Material]) -> Result<(), TooMuch> {
        let sum = self.memberships.iter().sum();
        if sum <= 1.0 + ROUNDING {
            return Ok(());
        }
        let there = materials.iter().zip(&self.memberships);
        let there = there.filter(|&(_, &share)| share > 0.0);
        Err(TooMuch {
            value: self.value,
            sum,
            names: there.map(|(material, _)| material.name.clone()).collect(),
        })
    }

    fn point(&self) -> OpacityPoint {
        OpacityPoint {
            value: self.value,
            opacity: self.opacity.min(1.0),
        }
    }

    fn color(&self) -> Option<[f64; 3]> {
        (self.opacity > 0.0).then(|| {
            self.light
                .map(|light| (light / self.opacity).clamp(0.0, 1.0))
        })
    }

    /// Colour points from here to the next corner, both included.
    fn push_piece_to(&self, next: &Self, color: &mut Vec<ColorPoint>) {
        // At an end without weight the quotient is what it is at the other end, all over the piece.
        let (first, last) = match (self.color(), next.color()) {
            (Some(first), Some(last)) => (first, last),
            (Some(only), None) | (None, Some(only)) => (only, only),
            // Nothing is opaque there: no colour is seen.
            (None, None) => return,
        };
        let mut push = |value, srgb| {
            let point = ColorPoint { value, srgb };
            if color.last() != Some(&point) {
                color.push(point);
            }
        };
        push(self.value, first);
        if first != last {
            let growth = next.opacity / self.opacity;
            let pieces = pieces(growth);
            for i in 1..pieces {
                // Where W is W0 growth^(i / pieces): t, and u of it.
                let share = f64::from(i) / f64::from(pieces);
                let t = (growth.powf(share) - 1.0) / (growth - 1.0);
                let u = t * growth / (1.0 - t + t * growth);
                let value = self.value + t * (next.value - self.value);
                push(
                    value,
                    std::array::from_fn(|c| first[c] + u * (last[c] - first[c])),
                );
            }
        }
        push(next.value, last);
    }
}

/// Into how many pieces a weight that grows so much is cut. Each grows by the same factor g; the largest of their
/// shares of u is 1 - 1/g of all of it at most, g > 1.
fn pieces(growth: f64) -> u32 {
    let growth = growth.max(1.0 / growth);
    let mut pieces = 1;
    loop {
        let root = growth.powf(0.5 / f64::from(pieces));
        let largest_share = (1.0 - root.powi(-2)) * growth / (growth - 1.0).max(f64::MIN_POSITIVE);
        let bound = largest_share.min(1.0) * (root - 1.0) / (root + 1.0);
        if bound <= TOLERANCE || pieces == MOST_PIECES {
            return pieces;
        }
        pieces += 1;
    }
}

/// A weight that grows by a factor of e^64 needs fewer.
const MOST_PIECES: u32 = 1024;
