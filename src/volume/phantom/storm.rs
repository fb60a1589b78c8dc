//! A thunderstorm with an anvil, in closed form: several variables, several times.
//!
//! Kilometres, x east, y north, z up, nowhere on the globe; the storm drifts to the north-east and grows while time goes
//! on:
//!
//! ```text
//! age = i / (N - 1) of time i of N, hour = 24 age        the only one of N = 1 is the grown storm, hour 24
//! ```
//!
//! It looks like weather and obeys no law of it, but for the still air around it: temperature falls by
//! 6.5 K/km to a tropopause at 12 km (the standard atmosphere, ISO 2533) and vapor by 1/e in 2.5 km.

use super::noise::turbulence;
use crate::volume::field::Field;
use glam::{DVec2, DVec3};

/// Corners of the box.
pub(super) const MIN: DVec3 = DVec3::new(-24.0, -24.0, 0.0);
pub(super) const MAX: DVec3 = DVec3::new(24.0, 24.0, 18.0);

/// What a storm can tell of a point.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Variable {
    /// Cloud water and ice, g/kg.
    Cloud,
    /// Water vapor, g/kg.
    Vapor,
    /// K.
    Temperature,
    /// Wind to the east, m/s.
    U,
    /// Wind to the north, m/s.
    V,
    /// Wind upwards, m/s.
    W,
}

/// All of them; the first is the default.
pub(super) const VARIABLES: [Variable; 6] = [
    Variable::Cloud,
    Variable::Vapor,
    Variable::Temperature,
    Variable::U,
    Variable::V,
    Variable::W,
];

impl Variable {
    pub fn name(self) -> &'static str {
        match self {
            Self::Cloud => "cloud",
            Self::Vapor => "vapor",
            Self::Temperature => "temperature",
            Self::U => "u",
            Self::V => "v",
            Self::W => "w",
        }
    }

    /// By UDUNITS.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Cloud | Self::Vapor => "g kg-1",
            Self::Temperature => "K",
            Self::U | Self::V | Self::W => "m s-1",
        }
    }

    /// The CF standard name; water and ice of clouds together have none.
    pub fn standard_name(self) -> Option<&'static str> {
        match self {
            Self::Cloud => None,
            Self::Vapor => Some("humidity_mixing_ratio"),
            Self::Temperature => Some("air_temperature"),
            Self::U => Some("eastward_wind"),
            Self::V => Some("northward_wind"),
            Self::W => Some("upward_air_velocity"),
        }
    }

    /// In words.
    pub fn long_name(self) -> &'static str {
        match self {
            Self::Cloud => "Cloud water and ice",
            Self::Vapor => "Water vapor mixing ratio",
            Self::Temperature => "Temperature",
            Self::U => "Wind to the east",
            Self::V => "Wind to the north",
            Self::W => "Wind upwards",
        }
    }

    /// What no point of any time leaves.
    pub fn value_range(self) -> [f64; 2] {
        match self {
            Self::Cloud => [0.0, 4.0],
            Self::Vapor => [0.0, 20.0],
            Self::Temperature => [200.0, 320.0],
            Self::U | Self::V => [-80.0, 80.0],
            Self::W => [-20.0, 50.0],
        }
    }
}

/// One variable at one time.
pub(super) struct Storm {
    variable: Variable,
    /// The middle of the updraft on the ground.
    center: DVec2,
    /// 0.5 when young, 1 when grown.
    strength: f64,
    /// Shifts the billows.
    phase: DVec3,
}

const TROPOPAUSE: f64 = 12.0;
const CLOUD_BASE: f64 = 1.2;
/// The updraft leans over with height, km per km.
const TILT: DVec2 = DVec2::new(0.35, 0.15);
const UPDRAFT_RADIUS: f64 = 3.0;

/// How long the storm grows.
const HOURS: f64 = 24.0;

/// 0 for the first of several times, 1 for the last. One time alone is the grown storm.
fn age(time: u32, times: u32) -> f64 {
    match times {
        0 | 1 => 1.0,
        _ => f64::from(time) / f64::from(times - 1),
    }
}

/// The hour of each time, to the hundredth: `0 h`, `3.43 h`.
pub(super) fn time_names(times: u32) -> Vec<String> {
    let hour = |time| (HOURS * age(time, times) * 100.0).round() / 100.0;
    (0..times).map(|time| format!("{} h", hour(time))).collect()
}

impl Storm {
    pub fn new(variable: Variable, time: u32, times: u32) -> Self {
        let age = age(time, times);
        Self {
            variable,
            center: DVec2::new(-18.0, -12.0).lerp(DVec2::new(-9.0, -5.0), age),
            strength: 0.5 + 0.5 * smoothstep(0.0, 0.8, age),
            phase: DVec3::new(2.0, 1.0, -6.0) * age,
        }
    }

    /// Away from the axis of the updraft, at this height.
    fn off_axis(&self, p: DVec3) -> DVec2 {
        p.truncate() - self.center - TILT * p.z
    }

    /// 0 to 1 in the updraft: widest at half its height.
    fn updraft(&self, p: DVec3) -> f64 {
        let top = TROPOPAUSE * self.strength.sqrt() + 1.5;
        let height = (p.z / top).clamp(0.0, 1.0);
        let r = self.off_axis(p) / UPDRAFT_RADIUS;
        (std::f64::consts::PI * height).sin() * (-0.5 * r.length_squared()).exp()
    }

    fn cloud(&self, p: DVec3) -> f64 {
        if p.z < CLOUD_BASE - 1.0 {
            return 0.0;
        }
        let away = self.off_axis(p);
        let top = CLOUD_BASE + (TROPOPAUSE + 1.0 - CLOUD_BASE) * self.strength.sqrt();
        let billows = 0.22 * turbulence(p * 0.4 + self.phase);
        // The tower is a ball on a stem; 1 in its middle, 0 on its wall.
        let width = 3.5 + 4.0 * self.strength;
        let ball = 1.0
            - (away / width)
                .extend((p.z - 0.62 * top) / (0.46 * top))
                .length();
        let stem = 1.0 - away.length() / (0.8 * width);
        let tower = ball.max(stem.min((0.62 * top - p.z) / 3.0));
        // The anvil spreads with the wind, a thin sheet under the tropopause, thinner with distance.
        let spread = 4.0 + 11.0 * smoothstep(0.4, 1.0, self.strength);
        let downwind = away - DVec2::new(0.55, 0.25) * spread;
        let reach = 1.0 - DVec2::new(downwind.x / spread, downwind.y / (0.62 * spread)).length();
        let thickness = 0.7 + 1.5 * reach.max(0.0);
        let sheet = 1.0 - ((p.z - (top - 1.0)) / thickness).abs();
        let anvil = reach.min(sheet).min(0.5) - 0.6 * smoothstep(0.85, 0.5, self.strength);
        let base = (p.z - CLOUD_BASE + 0.15) / 0.6;
        let inside = (tower.max(anvil) + billows).min(base);
        let water =
            3.2 * smoothstep(0.0, 0.45, inside) * (0.35 + 0.65 * smoothstep(0.0, 0.9, tower));
        water * (1.0 + 0.2 * billows)
    }

    fn vapor(&self, p: DVec3) -> f64 {
        let still = 16.0 * (-p.z / 2.5).exp();
        let lifted = 16.0 * (-p.z / 5.0).exp();
        let moist = 1.0 + 0.06 * turbulence(p * 0.12 + self.phase);
        (still + (lifted - still) * self.updraft(p).sqrt() * self.strength) * moist
    }

    fn temperature(&self, p: DVec3) -> f64 {
        let still = 300.0 - 6.5 * p.z.min(TROPOPAUSE);
        // Rain cools the air that spreads behind the storm on the ground.
        let behind = p.truncate() - self.center + DVec2::new(7.0, 3.0);
        let cold_pool = (-0.5 * (behind / 8.0).length_squared() - p.z / 0.8).exp();
        still + self.strength * (7.0 * self.updraft(p) - 9.0 * cold_pool)
    }

    fn wind(&self, p: DVec3) -> DVec3 {
        let shear = DVec2::new(
            4.0 + 1.8 * p.z.min(TROPOPAUSE),
            3.0 + 0.7 * p.z.min(TROPOPAUSE),
        );
        // A vortex, fastest at the radius of the updraft: (r / s) exp((1 - r^2 / s^2) / 2).
        let r = self.off_axis(p) / UPDRAFT_RADIUS;
        let spin = 22.0 * self.strength * (0.5 - 0.5 * r.length_squared() - p.z / 12.0).exp();
        let around = r.perp() * spin;
        // Air that went up comes down in a wide ring.
        let ring =
            (-0.5 * (r.length() - 3.0).powi(2) - p.z / 9.0).exp() * smoothstep(0.0, 2.0, p.z);
        let upward = self.strength * (40.0 * self.updraft(p) - 6.0 * ring);
        (shear + around).extend(upward)
    }
}

impl Field for Storm {
    fn value(&self, p: DVec3) -> f64 {
        match self.variable {
            Variable::Cloud => self.cloud(p),
            Variable::Vapor => self.vapor(p),
            Variable::Temperature => self.temperature(p),
            Variable::U => self.wind(p).x,
            Variable::V => self.wind(p).y,
            Variable::W => self.wind(p).z,
        }
    }
}

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let f = ((x - low) / (high - low)).clamp(0.0, 1.0);
    f * f * (3.0 - 2.0 * f)
}
