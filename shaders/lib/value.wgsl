// Texel to value (`sampling.md` 2): code = texel * scale + offset, value = code * slope + intercept.
// Integer types sit in UNORM formats; rounding brings their code back exactly. CPU reference: src/volume/sample.rs.

#import frame

struct Coding {
    scale: f32,
    offset: f32,
    slope: f32,
    intercept: f32,
    is_integer: u32,
}

// That of the volume, the first channel.
fn volume_coding() -> Coding {
    return Coding(frame.code_scale, frame.code_offset, frame.slope, frame.intercept, frame.codes_are_integers);
}

fn code_from_texel(coding: Coding, texel: f32) -> f32 {
    let code = texel * coding.scale;
    return select(code, round(code), coding.is_integer != 0u) + coding.offset;
}

// For texels that a sampler has mixed: no rounding.
fn code_from_mixed_texels(coding: Coding, texel: f32) -> f32 {
    return texel * coding.scale + coding.offset;
}

fn value_from_code(coding: Coding, code: f32) -> f32 {
    return code * coding.slope + coding.intercept;
}

// Exact where both ends are equal, unlike `mix`.
fn lerp(a: f32, b: f32, part: f32) -> f32 {
    return a + part * (b - a);
}
