//! What a transfer function says of matter that scatters light, beside colour and opacity (`sampling.md` 4).
//!
//! ```text
//! sigma(v)    extinction per world length       in place of opacity
//! albedo(v)   the part of it that scatters      in place of the colour, linear numbers
//! E(v)        radiance per world length         that matter sends out by itself
//! ```
//!
//! Techniques that scatter nothing see the colour, and of the mean sigma of the three colours the opacity 1 - exp(-sigma d0).

use super::{Interpolation, OpacityPoint, TransferFunction, extinction};
use crate::color::decode_srgb;

/// Three numbers at a value: red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumPoint {
    /// After rescale.
    pub value: f64,
    /// Not negative.
    pub linear: [f64; 3],
}

/// Where a medium scatters light to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Phase {
    /// To all sides alike.
    #[default]
    Isotropic,
    /// As particles far smaller than the wavelength do.
    Rayleigh,
    /// Henyey & Greenstein's, with the mean cosine g, -0.99 to 0.99: positive forward, negative back.
    HenyeyGreenstein(f64),
    /// A part of `part` (0 to 1) by the first g, the rest by the second.
    TwoLobes {
        /// Of the first.
        part: f64,
        /// Mean cosines of both.
        g: [f64; 2],
    },
}

/// What scattering techniques take in place of colour and opacity. Lists are by ascending value; between two points lies
/// what [`TransferFunction::interpolation`] says, beyond the ends all is constant. An empty list says nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MediumTransfer {
    /// Per world length. Opacity beside it must be [`TransferFunction::with_extinction`]'s.
    pub extinction: Vec<MediumPoint>,
    /// 0 to 1.
    pub albedo: Vec<MediumPoint>,
    /// Radiance per world length.
    pub emission: Vec<MediumPoint>,
    /// A wish, as of pre-integration: what is drawn by is [`PathTracing::phase`].
    ///
    /// [`PathTracing::phase`]: crate::technique::pathtrace::PathTracing::phase
    pub phase: Option<Phase>,
}

impl MediumTransfer {
    /// Whether the three colours differ in their extinction.
    pub fn has_colored_extinction(&self) -> bool {
        let is_colored = |point: &MediumPoint| point.linear[1..] != [point.linear[0]; 2];
        self.extinction.iter().any(is_colored)
    }

    /// Whether it says nothing.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The names of the keys that are there, as in files.
    pub fn keys(&self) -> Vec<&'static str> {
        let lists = [&self.extinction, &self.albedo, &self.emission];
        let is_there = lists.map(|list| !list.is_empty());
        let names = ["extinction", "albedo", "emission", "phase"];
        let is_there = is_there.into_iter().chain([self.phase.is_some()]);
        let keys = names.into_iter().zip(is_there);
        keys.filter_map(|(name, is_there)| is_there.then_some(name))
            .collect()
    }

    /// Of all points.
    pub(super) fn values(&self) -> impl Iterator<Item = f64> {
        let lists = [&self.extinction, &self.albedo, &self.emission];
        lists.into_iter().flatten().map(|point| point.value)
    }

    /// The same with its values moved.
    pub(super) fn moved(mut self, moved: impl Fn(f64) -> f64) -> Self {
        let lists = [&mut self.extinction, &mut self.albedo, &mut self.emission];
        for point in lists.into_iter().flatten() {
            point.value = moved(point.value);
        }
        self
    }
}

/// How far the lines between points of opacity may lie from 1 - exp(-x): of x in steps of 1/32 no more than
/// (1/32)^2 / 8 = 1/8192.
const DEPTHS_PER_POINT: f64 = 32.0;
const MOST_PER_PAIR: f64 = 256.0;

impl TransferFunction {
    /// This function with the opacity that an extinction has over `reference_length`; without that over the length behind
    /// which half of the light is left in the densest matter.
    pub fn with_extinction(self, extinction: Vec<MediumPoint>) -> Self {
        let grey = |point: &MediumPoint| point.linear.iter().sum::<f64>() / 3.0;
        let most = extinction.iter().map(grey).fold(0.0, f64::max);
        let half = (most > 0.0).then(|| std::f64::consts::LN_2 / most);
        let length = self.reference_length.or(half);
        let depth = |point: &MediumPoint| grey(point) * length.unwrap_or(0.0);
        let at = |value, depth: f64| OpacityPoint {
            value,
            opacity: -(-depth).exp_m1(),
        };
        let first = extinction
            .first()
            .map(|point| at(point.value, depth(point)));
        let pairs = extinction.windows(2).flat_map(|pair| {
            let [x, y] = [depth(&pair[0]), depth(&pair[1])];
            let [a, b] = [pair[0].value, pair[1].value];
            let parts = match self.interpolation {
                Interpolation::Linear if b > a => {
                    let parts = (DEPTHS_PER_POINT * (y - x).abs()).ceil();
                    parts.clamp(1.0, MOST_PER_PAIR) as u32
                }
                _ => 1,
            };
            (1..=parts).map(move |k| match k == parts {
                true => at(b, y),
                false => {
                    let t = f64::from(k) / f64::from(parts);
                    at(a + t * (b - a), x + t * (y - x))
                }
            })
        });
        let opacity = first.into_iter().chain(pairs).collect();
        Self {
            opacity,
            reference_length: length,
            medium: Some(Box::new(MediumTransfer {
                extinction,
                ..*self.medium.unwrap_or_default()
            })),
            ..self
        }
    }

    /// Extinction per world length, of red, green and blue; of opacity for `reference_length` where nothing else is said.
    pub fn extinctions(&self, value: f64, reference_length: f64) -> [f64; 3] {
        match self.of_medium(|medium| &medium.extinction, value) {
            Some(found) => found,
            None => [extinction(self.opacity(value), reference_length); 3],
        }
    }

    /// The part of light that matter scatters and does not absorb: linear numbers from 0 to 1.
    pub fn albedo(&self, value: f64) -> [f64; 3] {
        let own = self.of_medium(|medium| &medium.albedo, value);
        own.unwrap_or_else(|| self.srgb(value).map(decode_srgb))
    }

    /// Radiance per world length.
    pub fn emission(&self, value: f64) -> [f64; 3] {
        let own = self.of_medium(|medium| &medium.emission, value);
        own.unwrap_or([0.0; 3])
    }

    /// Whether matter sends out light.
    pub fn emits(&self) -> bool {
        self.medium
            .as_ref()
            .is_some_and(|medium| !medium.emission.is_empty())
    }

    fn of_medium(
        &self,
        list: impl Fn(&MediumTransfer) -> &Vec<MediumPoint>,
        value: f64,
    ) -> Option<[f64; 3]> {
        let list = self
            .medium
            .as_deref()
            .map(list)
            .filter(|list| !list.is_empty())?;
        let points = list.iter().map(|point| (point.value, point.linear));
        Some(super::law::between(points, self.interpolation, value))
    }

    /// A function with opacity wherever this one has opacity or sends out light.
    pub(crate) fn with_emission_seen(&self) -> Self {
        let emission = self.medium.iter().flat_map(|medium| &medium.emission);
        let is_lit = |point: &MediumPoint| point.linear.iter().any(|&c| c > 0.0);
        let lit = emission.map(|point| (point.value, is_lit(point)));
        let opaque = self
            .opacity
            .iter()
            .map(|point| (point.value, point.opacity > 0.0));
        let mut points: Vec<_> = opaque.chain(lit).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let opacity = points.into_iter().map(|(value, is_point_seen)| {
            let light = self.emission(value).iter().sum::<f64>();
            let is_seen = is_point_seen || self.opacity(value) > 0.0 || light > 0.0;
            OpacityPoint {
                value,
                opacity: f64::from(u8::from(is_seen)),
            }
        });
        Self {
            opacity: opacity.collect(),
            ..self.clone()
        }
    }

    /// The colours alone: of a function that another one makes opaque.
    pub(super) fn medium_of_colors(&self, other: &Self) -> Option<Box<MediumTransfer>> {
        let albedo = other.medium.as_ref().map(|medium| medium.albedo.clone());
        let medium = MediumTransfer {
            albedo: albedo.unwrap_or_default(),
            ..*self.medium.clone().unwrap_or_default()
        };
        (!medium.is_empty()).then(|| Box::new(medium))
    }
}
