//! Where the steps of a jittered ray begin: CPU reference of `shaders/lib/jitter.wgsl`.
//!
//! ```text
//! u = frac((r + 1/2) / n^2 + jitter)        part = 1 - |2 u - 1|
//! ```
//!
//! r are the numbers of a dither array by void and cluster, which `build.rs` makes (`shaders/blue_noise.rs`).

use crate::shaders::{BLUE_NOISE_SIDE, Frame};

/// For a texture: two bytes a number, row after row.
pub static BLUE_NOISE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/blue_noise.bin"));

const _: () = assert!(BLUE_NOISE.len() == 2 * (BLUE_NOISE_SIDE * BLUE_NOISE_SIDE) as usize);
// Ranks are 12 bits.
const _: () = assert!(BLUE_NOISE_SIDE == 64);

/// The number of a place of the torus.
fn rank([x, y]: [u32; 2]) -> u32 {
    let place = (y % BLUE_NOISE_SIDE * BLUE_NOISE_SIDE + x % BLUE_NOISE_SIDE) as usize;
    u16::from_le_bytes([BLUE_NOISE[2 * place], BLUE_NOISE[2 * place + 1]]).into()
}

/// Which part of a step lies in the domain at first, over 0 and at most 1.
pub fn jitter_of(frame: &Frame, [x, y]: [u32; 2]) -> f32 {
    let [dx, dy] = frame.jitter_shift;
    let rank = rank([x.wrapping_add(dx), y.wrapping_add(dy)]);
    let part = ((rank << 20) + (1 << 19)).wrapping_add(frame.jitter);
    let folded = if part >= 1 << 31 {
        !(part << 1)
    } else {
        part << 1
    };
    ((folded >> 8) as f32 + 0.5) / 16_777_216.0
}
