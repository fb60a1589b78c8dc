//! Injected faults of splats, beside those of `table.rs`: of how high they are, of where they are cut, and of the ray that they are
//! seen along.

use super::Fault::{self, Shader};

/// b^2 by the plane that lies across the ray, and by differences of numbers as large as the distance of the eye:
///
/// ```text
/// b^2 = w.Mw - (d.Mw)^2 / (d.Md)        w from the eye
/// ```
const FROM_THE_EYE: [&str; 2] = [
    "    return line.form.x * w.x * w.x",
    "    let t = sqrt(dot(line.origin, line.origin) / dot(line.direction, line.direction));
    let off = vec3(w, 0.0) + t * line.direction;
    let ahead = dot(line.direction, off);
    let square = dot(off, off) - ahead * ahead / dot(line.direction, line.direction);
    if frame.splat_reach > 0.0 {
        return frame.splat_diagonal.x * square;
    }
    return line.form.x * w.x * w.x",
];

/// The footprint of a voxel by the ray through its centre, which is the same for all pixels (affine), for that of the pixel's ray.
const AFFINE: [&str; 2] = [
    "let square = splat_square(line, w);",
    "let off = vec3(w, 0.0);
            let middle = off + t * line.direction;
            let ahead = dot(off, middle);
            let square = frame.splat_diagonal.x * (dot(off, off) - ahead * ahead / dot(middle, middle));",
];

/// The same of points, on the plane through their centre that lies along the picture (Zwicker et al. 2001).
const AFFINE_POINTS: [&str; 2] = [
    "    let off = (from_eye - t * ray.direction)",
    "    let s = dot(frame.forward, from_eye) / dot(frame.forward, ray.direction);
    let u = from_eye - s * ray.direction;
    let off = (u - dot(u, from_eye) / dot(from_eye, from_eye) * from_eye)",
];

/// What is wrong, how, and the case that must see it.
pub const SPLAT_FAULTS: &[(&str, Fault, &str)] = &[
    (
        "splats are as high as 1 over their width, and not over its square",
        Shader(
            "lib/splat_line.wgsl",
            "frame.splat_peak / kappa",
            "0.6 * frame.splat_peak / kappa",
        ),
        "splat.image.xray.plain.perspective",
    ),
    (
        "what is cut off splats is lost",
        Shader(
            "lib/splat_line.wgsl",
            "frame.splat_peak / kappa",
            "(1.0 - exp(-0.5 * cut * cut)) * frame.splat_peak / kappa",
        ),
        "splat.image.xray.short.perspective",
    ),
    (
        "splats in sheets that the domain cuts are cut with them",
        Shader(
            "lib/splat_voxel.wgsl",
            "SplatRange(inside, vec2(-ENDLESS, ENDLESS)",
            "SplatRange(inside, inside",
        ),
        "splat.image.composite.plain.perspective",
    ),
    (
        "how near splats are is a difference of squares of how far the eye is",
        Shader("lib/splat_line.wgsl", FROM_THE_EYE[0], FROM_THE_EYE[1]),
        "splat.image.xray.far.perspective",
    ),
    (
        "splats are seen along rays through their own centres",
        Shader("lib/splat_each.wgsl", AFFINE[0], AFFINE[1]),
        "splat.image.xray.near.perspective",
    ),
    (
        "points are seen along rays through their own centres",
        Shader("lib/view_points.wgsl", AFFINE_POINTS[0], AFFINE_POINTS[1]),
        "splat.points.xray.among.perspective",
    ),
];
