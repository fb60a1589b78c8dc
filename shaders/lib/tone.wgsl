// Light on its way to a host's target:
//
//     C' = A curve(gain C / A)
//
// The curves are Khronos' PBR neutral tone mapper (2024) and Hable's filmic one ("Uncharted 2: HDR Lighting", GDC 2010).
// CPU reference: src/picture/tone.rs.

#import frame

// What is done with light: its strength alone is another; a curve. 0: it stays.
const TONE_EXPOSED: u32 = 1u;
const TONE_NEUTRAL: u32 = 2u;
const TONE_FILMIC: u32 = 3u;

// More light looks the same: its square is a number.
const MOST_LIGHT: f32 = 1e15;

fn toned(found: vec4<f32>) -> vec4<f32> {
    if frame.tone == 0u || found.w == 0.0 {
        return found;
    }
    let exposed = frame.tone_gain * found.xyz;
    if frame.tone == TONE_EXPOSED {
        return vec4(exposed, found.w);
    }
    let light = min(exposed / found.w, vec3(MOST_LIGHT));
    if frame.tone == TONE_NEUTRAL {
        return vec4(found.w * neutral(light), found.w);
    }
    return vec4(found.w * filmic(light), found.w);
}

// Peaks over this are compressed.
const NEUTRAL_START: f32 = 0.76;
// How fast compressed colours fade to white.
const NEUTRAL_DESATURATION: f32 = 0.15;

fn neutral(light: vec3<f32>) -> vec3<f32> {
    let least = min(light.x, min(light.y, light.z));
    let foot = select(0.04, least - 6.25 * least * least, least < 0.08);
    let color = light - foot;
    let peak = max(color.x, max(color.y, color.z));
    if peak < NEUTRAL_START {
        return color;
    }
    let room = 1.0 - NEUTRAL_START;
    let white = 1.0 - room * room / (peak + room - NEUTRAL_START);
    let fade = 1.0 - 1.0 / (NEUTRAL_DESATURATION * (peak - white) + 1.0);
    let compressed = color * (white / peak);
    return compressed + fade * (white - compressed);
}

// Hable's own exposure, and what he takes for white.
const FILMIC_GAIN: f32 = 2.0;
const FILMIC_WHITE: f32 = 11.2;

fn filmic(light: vec3<f32>) -> vec3<f32> {
    return hable(FILMIC_GAIN * light) / hable(vec3(FILMIC_WHITE));
}

fn hable(x: vec3<f32>) -> vec3<f32> {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
}
