//! Transfer functions of keys, and one between two others.
//!
//! Two of as many colour (opacity) points are mixed point by point, value and colour: a peak wanders. Else both
//! are taken at the values of either, and the numbers there are mixed: one fades into the other. Colours are
//! mixed as sRGB numbers, as they are between the points of one function.

use crate::transfer::{
    ColorPoint, Interpolation, OpacityPoint, Scale, TransferFunction, import_transfer_function,
    transfer_function_from_json,
};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Between `a` (`s = 0`) and `b` (`s = 1`), which must agree on their interpolation.
/// `spacing` is the reference length of a function that has none of its own.
pub fn mixed(a: &TransferFunction, b: &TransferFunction, s: f64, spacing: f64) -> TransferFunction {
    let color = mixed_points(
        &a.color
            .iter()
            .map(|p| (p.value, p.srgb))
            .collect::<Vec<_>>(),
        &b.color
            .iter()
            .map(|p| (p.value, p.srgb))
            .collect::<Vec<_>>(),
        s,
        a.interpolation,
    );
    let opacity = mixed_points(
        &a.opacity
            .iter()
            .map(|p| (p.value, [p.opacity]))
            .collect::<Vec<_>>(),
        &b.opacity
            .iter()
            .map(|p| (p.value, [p.opacity]))
            .collect::<Vec<_>>(),
        s,
        a.interpolation,
    );
    let reference_length = match (a.reference_length, b.reference_length) {
        (None, None) => None,
        (a, b) => Some(lerp(a.unwrap_or(spacing), b.unwrap_or(spacing), s)),
    };
    TransferFunction {
        color: color
            .into_iter()
            .map(|(value, srgb)| ColorPoint { value, srgb })
            .collect(),
        opacity: opacity
            .into_iter()
            .map(|(value, [opacity])| OpacityPoint { value, opacity })
            .collect(),
        reference_length,
        interpolation: a.interpolation,
        gradient_transfer: None,
        medium: None,
    }
}

fn lerp(a: f64, b: f64, s: f64) -> f64 {
    a + s * (b - a)
}

type Points<const N: usize> = [(f64, [f64; N])];

fn mixed_points<const N: usize>(
    a: &Points<N>,
    b: &Points<N>,
    s: f64,
    interpolation: Interpolation,
) -> Vec<(f64, [f64; N])> {
    let mix = |a: [f64; N], b: [f64; N]| std::array::from_fn(|c| lerp(a[c], b[c], s));
    if a.len() == b.len() {
        let pairs = a.iter().zip(b);
        return pairs
            .map(|(&(va, xa), &(vb, xb))| (lerp(va, vb, s), mix(xa, xb)))
            .collect();
    }
    let mut values: Vec<f64> = a.iter().chain(b).map(|point| point.0).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let mut points = Vec::new();
    for value in values {
        let [below, above] = [Side::Below, Side::Above].map(|side| {
            let [a, b] = [a, b].map(|points| at(points, value, side, interpolation));
            mix(a, b)
        });
        // Two points at one value are a jump.
        if below != above && interpolation == Interpolation::Linear {
            points.push((value, below));
        }
        points.push((value, above));
    }
    points
}

/// From where a value is come to.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Below,
    Above,
}

/// What `points` say at `value`; zero where there are none.
fn at<const N: usize>(
    points: &Points<N>,
    value: f64,
    side: Side,
    interpolation: Interpolation,
) -> [f64; N] {
    let is_passed = |point: f64| match side {
        Side::Below => point < value,
        Side::Above => point <= value,
    };
    let passed = points.iter().take_while(|p| is_passed(p.0)).count();
    let (left, right) = (passed.checked_sub(1), points.get(passed));
    match (left.map(|i| points[i]), right) {
        (None, None) => [0.0; N],
        (None, Some(right)) => right.1,
        (Some(left), None) => left.1,
        (Some(left), Some(_)) if interpolation == Interpolation::Step => left.1,
        (Some(left), Some(right)) => {
            let t = (value - left.0) / (right.0 - left.0);
            std::array::from_fn(|c| lerp(left.1[c], right.1[c], t))
        }
    }
}

/// The function of a key: what stands in it, or in the file that it names, which is put to `inputs`.
pub fn of_key(
    tf: &Value,
    folder: &Path,
    inputs: &mut Vec<PathBuf>,
) -> Result<TransferFunction, String> {
    match tf {
        Value::String(name) => {
            let path = folder.join(name);
            let imported =
                import_transfer_function(&path, None).map_err(|error| error.to_string())?;
            if imported.scale == Scale::Fractions {
                return Err(format!(
                    "the points of {name} stand at fractions of a range, wanted values"
                ));
            }
            inputs.push(path);
            of_value(imported.function)
        }
        Value::Object(_) => transfer_function_from_json(tf.to_string().as_bytes())
            .map_err(|error| error.to_string())
            .and_then(of_value),
        _ => Err("wanted the name of a file or a transfer function".to_owned()),
    }
}

/// Between two functions of gradients there is none.
fn of_value(function: TransferFunction) -> Result<TransferFunction, String> {
    if function.medium.is_some() {
        return Err(
            "extinction, albedo, emission and phase have no keys: --tf gives them to the whole film"
                .to_owned(),
        );
    }
    if function.uses_gradient() {
        return Err(
            "widgets and gradient opacity have no keys: --tf gives them to the whole film"
                .to_owned(),
        );
    }
    Ok(function)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn function(color: &[(f64, f64)], opacity: &[(f64, f64)]) -> TransferFunction {
        TransferFunction {
            color: color
                .iter()
                .map(|&(value, x)| ColorPoint {
                    value,
                    srgb: [x, 0.0, 1.0],
                })
                .collect(),
            opacity: opacity
                .iter()
                .map(|&(value, opacity)| OpacityPoint { value, opacity })
                .collect(),
            reference_length: None,
            interpolation: Interpolation::Linear,
            gradient_transfer: None,
            medium: None,
        }
    }

    #[test]
    fn functions_of_as_many_points_are_mixed_point_by_point() {
        let a = function(&[(0.0, 0.0), (10.0, 1.0)], &[(0.0, 0.0), (4.0, 1.0)]);
        let b = function(&[(4.0, 0.5), (30.0, 0.0)], &[(8.0, 0.5), (12.0, 0.0)]);
        let wanted = function(&[(1.0, 0.125), (15.0, 0.75)], &[(2.0, 0.125), (6.0, 0.75)]);
        assert_eq!(mixed(&a, &b, 0.25, 1.0), wanted);
        assert_eq!(mixed(&a, &b, 0.0, 1.0), a);
        assert_eq!(mixed(&a, &b, 1.0, 1.0), b);
    }

    #[test]
    fn functions_of_other_counts_fade_into_each_other_at_every_value() {
        let a = function(&[(0.0, 0.0), (8.0, 1.0)], &[(1.0, 0.5)]);
        let b = function(
            &[(0.0, 1.0), (4.0, 0.0), (8.0, 1.0)],
            &[(0.0, 0.0), (2.0, 1.0)],
        );
        let found = mixed(&a, &b, 0.5, 1.0);
        // At 4 half of a's 0.5 and half of b's 0; at 1 half of a's 0.5 and half of b's 0.5.
        let wanted = function(
            &[(0.0, 0.5), (4.0, 0.25), (8.0, 1.0)],
            &[(0.0, 0.25), (1.0, 0.5), (2.0, 0.75)],
        );
        assert_eq!(found, wanted);
    }

    #[test]
    fn a_jump_stays_a_jump() {
        let a = function(&[(0.0, 0.0)], &[(0.0, 0.0), (5.0, 0.0), (5.0, 1.0)]);
        let b = function(&[(0.0, 0.0)], &[(0.0, 0.0)]);
        let found = mixed(&a, &b, 0.5, 1.0).opacity;
        let found: Vec<_> = found.iter().map(|p| (p.value, p.opacity)).collect();
        assert_eq!(found, [(0.0, 0.0), (5.0, 0.0), (5.0, 0.5)]);
    }

    #[test]
    fn a_length_of_its_own_is_mixed_with_the_spacing() {
        let mut a = function(&[(0.0, 0.0)], &[(0.0, 0.0)]);
        let b = a.clone();
        a.reference_length = Some(4.0);
        assert_eq!(mixed(&a, &b, 0.5, 2.0).reference_length, Some(3.0));
        assert_eq!(mixed(&b, &b, 0.5, 2.0).reference_length, None);
    }
}
