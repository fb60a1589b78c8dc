//! Fourteen teeth in each jaw, on the horseshoe of [`super::bone::arch`].

use super::bone::arch;
use glam::DVec3;

/// A tooth near a point.
pub(super) struct Tooth {
    /// To the surface, negative inside.
    pub distance: f64,
    /// True in the crown, false in the root.
    pub crown: bool,
}

/// Width along the arch, half the thickness across it, from the middle outwards.
const UPPER: [[f64; 2]; 7] = [
    [8.6, 3.2],
    [6.8, 3.0],
    [7.6, 3.8],
    [7.0, 4.4],
    [6.8, 4.4],
    [10.0, 5.2],
    [9.4, 5.0],
];
const LOWER: [[f64; 2]; 7] = [
    [5.6, 2.8],
    [6.0, 2.9],
    [6.9, 3.6],
    [7.0, 3.8],
    [7.1, 4.0],
    [11.0, 5.0],
    [10.4, 4.8],
];

/// Where the biting edges meet.
const BITE: f64 = -49.5;

pub(super) fn nearest(p: DVec3) -> Option<Tooth> {
    if p.y < 20.0 || !(-76.0..=-26.0).contains(&p.z) {
        return None;
    }
    let upper = row(p, 77.0, &UPPER, p.z - BITE);
    let lower = row(p, 75.0, &LOWER, BITE - 1.0 - p.z);
    match (upper, lower) {
        (Some(a), Some(b)) => Some(if a.distance < b.distance { a } else { b }),
        (a, b) => a.or(b),
    }
}

/// `height` grows from the biting edge to the root.
fn row(p: DVec3, front: f64, teeth: &[[f64; 2]; 7], height: f64) -> Option<Tooth> {
    const CROWN: f64 = 8.5;
    const WHOLE: f64 = 21.0;
    let (across, along) = arch(p, front);
    if across.abs() > 8.0 || !(-2.0..WHOLE + 2.0).contains(&height) {
        return None;
    }
    let mut start = 0.0;
    let (index, [width, thickness]) = teeth.iter().enumerate().find_map(|(i, tooth)| {
        let here = along < start + tooth[0];
        if !here {
            start += tooth[0];
        }
        here.then_some((i, *tooth))
    })?;
    let along = along - start - 0.5 * width;
    let is_molar = index > 2;
    let toward_root = ((height - CROWN) / (WHOLE - CROWN)).clamp(0.0, 1.0);
    let toward_edge = (1.0 - height / CROWN).clamp(0.0, 1.0);
    // Roots taper; front teeth end in an edge, the others in a shallow bowl.
    let half_width =
        (0.5 * width - 0.35) * (1.0 - 0.65 * toward_root) - 0.5 * toward_edge * toward_edge;
    let sharpening = if is_molar { 0.15 } else { 0.7 };
    let half_thickness = thickness * (1.0 - 0.6 * toward_root) * (1.0 - sharpening * toward_edge);
    let bowl = if is_molar {
        0.9 - 0.05 * (across * across + along * along)
    } else {
        0.0
    };
    // A rounded box: the p-norm of 4 between an ellipse and a rectangle.
    let norm = ((along / half_width).powi(4) + (across / half_thickness).powi(4))
        .sqrt()
        .sqrt();
    let side = (norm - 1.0) * half_width.min(half_thickness);
    let distance = side.max(bowl.max(0.0) - height).max(height - WHOLE);
    Some(Tooth {
        distance,
        crown: height < CROWN,
    })
}
