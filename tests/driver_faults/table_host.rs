//! Injected faults of what hosts alone get, tone and noise: the tests of these must see each.

use super::Fault::{self, Shader};

/// Light on its way into a host's target.
pub const TONE_FAULTS: &[(&str, Fault)] = &[
    (
        "alpha bends a curve",
        Shader(
            "lib/tone.wgsl",
            "min(exposed / found.w, vec3(MOST_LIGHT))",
            "min(exposed, vec3(MOST_LIGHT))",
        ),
    ),
    (
        "light is not premultiplied again",
        Shader(
            "lib/tone.wgsl",
            "found.w * neutral(light)",
            "neutral(light)",
        ),
    ),
    (
        "light is exposed behind the curve",
        Shader(
            "lib/tone.wgsl",
            "found.w * filmic(light)",
            "found.w * frame.tone_gain * filmic(light / frame.tone_gain)",
        ),
    ),
    (
        "dark colours keep their foot",
        Shader("lib/tone.wgsl", "light - foot", "light"),
    ),
    (
        "bright colours do not fade",
        Shader(
            "lib/tone.wgsl",
            "compressed + fade * (white - compressed)",
            "compressed",
        ),
    ),
    (
        "another light is white",
        Shader(
            "lib/tone.wgsl",
            "FILMIC_WHITE: f32 = 11.2",
            "FILMIC_WHITE: f32 = 11.25",
        ),
    ),
    (
        "light without a curve keeps its strength",
        Shader("lib/tone.wgsl", "vec4(exposed, found.w)", "found"),
    ),
];

/// How noisy a picture of paths is.
pub const NOISE_FAULTS: &[(&str, Fault)] = &[
    (
        "frames count by the paths before them",
        Shader(
            "path_noise.wgsl",
            "before * ((before + count) / count)",
            "before",
        ),
    ),
    (
        "deviations are those of the last frame",
        Shader(
            "path_noise.wgsl",
            "then.y + weight * change * change",
            "weight * change * change",
        ),
    ),
    (
        "luminance is green",
        Shader(
            "path_noise.wgsl",
            "vec3(0.2126, 0.7152, 0.0722)",
            "vec3(0.0, 1.0, 0.0)",
        ),
    ),
    (
        "the lower part of a tile is left out",
        Shader(
            "path_noise.wgsl",
            "turn < across * across",
            "turn < across * across - across",
        ),
    ),
    (
        "tiles of a row are those of the first",
        Shader(
            "path_noise.wgsl",
            "group.y * noise_tiles().x + group.x",
            "group.y * noise_tiles().x",
        ),
    ),
    (
        "the last tiles are left out",
        Shader(
            "path_noise_sums.wgsl",
            "tile < tiles.x * tiles.y",
            "tile < tiles.x",
        ),
    ),
    (
        "a workgroup is the sum of its even threads",
        Shader("lib/noise_tiles.wgsl", "stride > 0u", "stride > 1u"),
    ),
];
