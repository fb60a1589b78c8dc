// Texel to value (`sampling.md` 2): code = texel * code_scale + code_offset, value = code * slope + intercept.
// Integer types sit in UNORM formats; rounding brings their code back exactly. Twin: src/volume/sample.rs.

#import frame

fn code_from_texel(texel: f32) -> f32 {
    let code = texel * frame.code_scale;
    return select(code, round(code), frame.codes_are_integers != 0u) + frame.code_offset;
}

// For texels that a sampler has mixed: no rounding.
fn code_from_mixed_texels(texel: f32) -> f32 {
    return texel * frame.code_scale + frame.code_offset;
}

fn value_from_code(code: f32) -> f32 {
    return code * frame.slope + frame.intercept;
}

// Exact where both ends are equal, unlike `mix`.
fn lerp(a: f32, b: f32, part: f32) -> f32 {
    return a + part * (b - a);
}
