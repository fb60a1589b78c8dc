//! What to do about numbers and combinations that a technique refuses, by the names in its errors.

use crate::technique::{Error, pathtrace::SHARE_OF_TURNS};

/// The hint for such an error.
pub fn hint(error: &Error) -> &'static str {
    match error {
        Error::OutOfRange { name, .. } => of_range(name),
        Error::NotFor { wanted, of, .. } => of_refusal(wanted, of),
        _ => MATRIX,
    }
}

const MATRIX: &str = "docs/matrix.md shows which technique, mode, filter and feature go together";

/// About a number of this name.
fn of_range(name: &str) -> &'static str {
    match name {
        "paths a pixel" => "--spp 16 is enough, or leave out --denoise-picture",
        "the noise" => "--noise 0.01 ends where the error is 1 %",
        "seconds" => "--seconds 60 ends after a minute",
        "tentative collisions in a macro cell" | SHARE_OF_TURNS => {
            "a smaller --density-scale, by as much as that is too large: such matter is opaque"
        }
        "the density scale" => "--density-scale 1 leaves extinction as it is",
        "the scale of albedos" => "--albedo 1 leaves albedos as they are, 0 scatters nothing",
        "the part of the first lobe" => "--phase hg:F,G1,G2 takes an F from 0 to 1",
        "the mean cosine of a phase function" => {
            "--phase hg:0.8 scatters forward, hg:-0.3 back, isotropic to all sides"
        }
        "the radius of a light" | "the radius of a light in path tracing" => {
            "--point-light X,Y,Z,R,G,B,RADIUS: without a RADIUS it is 1/400 of the diagonal"
        }
        "the place of a light" | "the distance of a light from what the camera is turned to" => {
            "--point-light and --disc-light take a place that is not --target"
        }
        "the size of lights" => "--light-size 0 makes shadows sharp, the sun is half a degree wide",
        "the turn of the sky" => "--environment-turn 90 is a quarter of a turn",
        "light of the sky" => "--environment 0.5,0.5,0.5 is an even grey sky",
        "the reflectance" => "--f0 0.04 is skin, bone and plastic, 1 is metal, 0 has no coat",
        "the roughness" => "--roughness 0.05 is polished, 1 is dull",
        "the radius of the lens" => "--aperture-radius LENGTH takes half the width of the lens",
        "the distance of focus" => "--focus-distance LENGTH, target or auto",
        "the scattering of surfaces" => "--surface-scattering 8 shows surfaces, 0 shows none",
        _ => "`stratavox render --help` says what each word takes",
    }
}

/// About `wanted`, which is for `of` alone.
fn of_refusal(wanted: &str, of: &str) -> &'static str {
    match (wanted, of) {
        ("a lens", _) => "--projection perspective, or leave out --aperture-radius",
        ("path tracing", "volumes of numbers and labels on one grid") => {
            "draw one number a voxel: --component 0, and volumes on the grid of the first; --technique raycast draws all"
        }
        ("path tracing", "central differences") => "leave out --gradient-filter and --gradients",
        ("a path-traced surface of values", _) => {
            "draw one volume: without --with, --labels, --channel and --opacity-from, or leave out --iso"
        }
        ("a function with extinction, albedo, emission or phase", _) => {
            "draw one volume, or by a function of colours and opacities"
        }
        ("path tracing", _) => "--technique raycast draws a volume in bricks",
        ("single scattering", "one volume of numbers") => {
            "draw one number a voxel: --component 0, without --with, --labels, --channel, --opacity-from and functions of \
             gradients; without --scattering single they are drawn"
        }
        ("single scattering", "an extinction that all colours share") => {
            "--technique pathtrace has one for each colour"
        }
        ("single scattering", _) => "--shadows volume draws a volume in bricks",
        _ => MATRIX,
    }
}
