//! One step of an explicit Runge–Kutta formula of order 5, with an estimate of its error and a polynomial through it.
//!
//! ```text
//! k_i   = v(t + c_i h, y + h Σ_j a_ij k_j),  i = 1..7,   k_1 given: the last stage of the step before (FSAL)
//! y(1)  = y + h Σ_j a_7j k_j                             order 5
//! error = h Σ_i e_i k_i                                  the difference to the formula of order 4
//! y(s)  = y + s (r_2 + (1 - s) (r_3 + s (r_4 + (1 - s) r_5))),   0 <= s <= 1      order 4
//!         r_2 = y(1) - y,  r_3 = h k_1 - r_2,  r_4 = r_2 - h k_7 - r_3,  r_5 = h Σ_i d_i k_i
//! ```
//!
//! Dormand, Prince, "A family of embedded Runge–Kutta formulae", J. Comp. Appl. Math. 6, 1980; the polynomial and the
//! step control: Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I", 2nd ed. 1993, II.4 to II.6.

use glam::DVec3;

/// Stages of a step.
const STAGES: usize = 7;

/// The numbers of the formula.
#[derive(Clone, Debug)]
struct Tableau {
    /// When a stage is, in steps.
    c: [f64; STAGES],
    /// What a stage begins with, of those before it.
    a: [[f64; STAGES - 1]; STAGES],
    /// The error.
    e: [f64; STAGES],
    /// The polynomial.
    d: [f64; STAGES],
}

const DORMAND_PRINCE: Tableau = Tableau {
    c: [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0],
    a: [
        [0.0; 6],
        [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
            0.0,
            0.0,
        ],
        [
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
            0.0,
        ],
        [
            35.0 / 384.0,
            0.0,
            500.0 / 1113.0,
            125.0 / 192.0,
            -2187.0 / 6784.0,
            11.0 / 84.0,
        ],
    ],
    e: [
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339_200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ],
    d: [
        -12_715_105_075.0 / 11_282_082_432.0,
        0.0,
        87_487_479_700.0 / 32_700_410_799.0,
        -10_690_763_975.0 / 1_880_347_072.0,
        701_980_252_875.0 / 199_316_789_632.0,
        -1_453_857_185.0 / 822_651_844.0,
        69_997_945.0 / 29_380_423.0,
    ],
};

/// A step that was made.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// When it begins.
    pub time: f64,
    /// How long it is; negative of a step back.
    pub duration: f64,
    /// Where it begins.
    pub start: DVec3,
    /// Where it ends.
    pub end: DVec3,
    stages: [DVec3; STAGES],
}

/// Steps from `start` at `time`, where the velocity is `first`.
///
/// # Errors
/// Where `velocity` fails for a stage.
#[inline]
pub fn step<E>(
    velocity: impl Fn(f64, DVec3) -> Result<DVec3, E>,
    time: f64,
    start: DVec3,
    duration: f64,
    first: DVec3,
) -> Result<Step, E> {
    step_by(&DORMAND_PRINCE, velocity, time, start, duration, first)
}

#[inline(always)]
fn step_by<E>(
    table: &Tableau,
    velocity: impl Fn(f64, DVec3) -> Result<DVec3, E>,
    time: f64,
    start: DVec3,
    duration: f64,
    first: DVec3,
) -> Result<Step, E> {
    let mut stages = [first; STAGES];
    let mut end = start;
    for i in 1..STAGES {
        let mean = weighted(&stages[..i], &table.a[i][..i]);
        // The last stage is at the end of the step.
        end = start + duration * mean;
        stages[i] = velocity(time + table.c[i] * duration, end)?;
    }
    Ok(Step {
        time,
        duration,
        start,
        end,
        stages,
    })
}

#[inline(always)]
fn weighted(stages: &[DVec3], weights: &[f64]) -> DVec3 {
    let pairs = stages.iter().zip(weights);
    pairs.fold(DVec3::ZERO, |sum, (&stage, &weight)| sum + weight * stage)
}

impl Step {
    /// How far the end is off, by the formula of order 4.
    #[inline]
    pub fn error(&self) -> DVec3 {
        self.error_by(&DORMAND_PRINCE)
    }

    #[inline(always)]
    fn error_by(&self, table: &Tableau) -> DVec3 {
        self.duration * weighted(&self.stages, &table.e)
    }

    /// The velocity at the end: the first stage of the next step.
    pub fn last_velocity(&self) -> DVec3 {
        self.stages[STAGES - 1]
    }

    /// The polynomial of the way.
    #[inline]
    pub fn dense(&self) -> Dense {
        self.dense_by(&DORMAND_PRINCE)
    }

    #[inline(always)]
    fn dense_by(&self, table: &Tableau) -> Dense {
        let chord = self.end - self.start;
        let r3 = self.duration * self.stages[0] - chord;
        let r4 = chord - self.duration * self.last_velocity() - r3;
        let r5 = self.duration * weighted(&self.stages, &table.d);
        Dense {
            start: self.start,
            coefficients: [chord, r3, r4, r5],
        }
    }
}

/// The way of a step.
#[derive(Clone, Copy, Debug)]
pub struct Dense {
    start: DVec3,
    /// r_2 to r_5.
    coefficients: [DVec3; 4],
}

impl Dense {
    /// The place after this part of the step, 0 to 1.
    #[inline]
    pub fn at(&self, part: f64) -> DVec3 {
        let [r2, r3, r4, r5] = self.coefficients;
        let rest = 1.0 - part;
        self.start + part * (r2 + rest * (r3 + part * (r4 + rest * r5)))
    }
}

/// How long the next step is, by the error of the last one: a PI controller.
///
/// ```text
/// accepted   h · clamp(0.9 e^-0.17 e_before^0.04, 0.2, 5)        e = error / tolerance
/// rejected   h · max(0.9 e^-0.2, 0.2)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Controller {
    before: f64,
}

/// An error under this part of the tolerance is as good as none.
const LEAST: f64 = 1e-10;

impl Default for Controller {
    /// Before the first step.
    fn default() -> Self {
        Self { before: 1e-4 }
    }
}

impl Controller {
    /// How much longer the step after an accepted one may be.
    pub fn growth(&mut self, error: f64) -> f64 {
        let factor = 0.9 * error.max(LEAST).powf(-0.17) * self.before.powf(0.04);
        self.before = error.max(1e-4);
        factor.clamp(0.2, 5.0)
    }

    /// How much shorter a rejected step is tried again.
    pub fn reduction(error: f64) -> f64 {
        (0.9 * error.max(LEAST).powf(-0.2)).max(0.2)
    }
}

#[cfg(test)]
mod tests;
