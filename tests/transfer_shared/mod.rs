//! Random transfer functions and values that try them.

use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};

/// splitmix64: the same numbers everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 0 included, 1 excluded.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }
}

/// One to eight points of each kind, some at equal values, ramps no narrower than 1/32 of the span.
pub fn function(random: &mut Random) -> TransferFunction {
    // f32 tells a few million steps of each span apart.
    let choices = [(0.0, 0.001), (-1024.0, 64.0), (0.25, 0.125), (3000.0, 1.0)];
    let (origin, unit) = choices[random.below(4) as usize];
    let interpolation = match random.below(4) {
        0 => Interpolation::Step,
        _ => Interpolation::Linear,
    };
    let mut values = || {
        let mut at: Vec<u64> = (0..=random.below(8)).map(|_| random.below(33)).collect();
        at.sort_unstable();
        // f32 values, so that points in f32 are the same points.
        at.into_iter()
            .map(|k| f64::from((origin + unit * k as f64) as f32))
            .collect::<Vec<_>>()
    };
    let (color, opacity) = (values(), values());
    let color = color.into_iter().map(|value| ColorPoint {
        value,
        srgb: std::array::from_fn(|_| random.unit()),
    });
    let color = color.collect();
    let opacity = opacity.into_iter().map(|value| OpacityPoint {
        value,
        opacity: random.unit(),
    });
    TransferFunction {
        color,
        opacity: opacity.collect(),
        reference_length: None,
        interpolation,
        gradient_transfer: None,
        medium: None,
    }
}

/// Where values of `tf` jump.
pub fn jumps(tf: &TransferFunction) -> Vec<f64> {
    let color: Vec<f64> = tf.color.iter().map(|p| p.value).collect();
    let opacity: Vec<f64> = tf.opacity.iter().map(|p| p.value).collect();
    let pairs = color.windows(2).chain(opacity.windows(2));
    pairs
        .filter(|p| tf.interpolation == Interpolation::Step || p[0] == p[1])
        .map(|p| p[1])
        .collect()
}

/// f32 values inside, on and beyond the control points.
pub fn values(tf: &TransferFunction, random: &mut Random) -> Vec<f64> {
    let mut at: Vec<f64> = tf.color.iter().map(|p| p.value).collect();
    at.extend(tf.opacity.iter().map(|p| p.value));
    let low = at.iter().copied().fold(f64::INFINITY, f64::min);
    let high = at.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let span = high - low;
    for _ in 0..200 {
        at.push(low + span * (1.2 * random.unit() - 0.1));
    }
    at.extend([low - 1e6, high + 1e6]);
    at.into_iter()
        .map(|value| f64::from(value as f32))
        .collect()
}
