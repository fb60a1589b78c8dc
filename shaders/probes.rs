//! What shaders of probes have beyond the core: subgroups, push constants, and numbers that are none. Part of
//! `build.rs`.

use naga::valid::Capabilities;
use spirv::Capability;

/// What naga is to let through.
pub fn capabilities(file: &str) -> Capabilities {
    match file {
        "probe/subgroup" => Capabilities::SUBGROUP,
        "probe/push" => Capabilities::IMMEDIATES,
        _ => Capabilities::empty(),
    }
}

/// What SPIR-V may be written with; only what a shader uses is declared.
pub fn spirv_capabilities(file: &str) -> &'static [Capability] {
    match file {
        "probe/subgroup" => &[
            Capability::GroupNonUniform,
            Capability::GroupNonUniformVote,
            Capability::GroupNonUniformArithmetic,
            Capability::GroupNonUniformBallot,
            Capability::GroupNonUniformShuffle,
        ],
        _ => &[],
    }
}

/// Words of a shader as they are kept.
pub fn finished(file: &str, words: Vec<u32>) -> Vec<u32> {
    match file.starts_with("probe/specials") {
        true => preserving(words),
        false => words,
    }
}

/// The same shader, which asks for infinities, signs of zero and what is no number to be kept in 32-bit floats
/// (`SignedZeroInfNanPreserve`, core in SPIR-V 1.4): naga has no word for it.
fn preserving(words: Vec<u32>) -> Vec<u32> {
    const HEADER: usize = 5;
    const OP_CAPABILITY: u32 = 17;
    const OP_ENTRY_POINT: u32 = 15;
    const OP_EXECUTION_MODE: u32 = 16;
    const CAPABILITY: u32 = 4466;
    const MODE: u32 = 4461;
    let mut made = words[..HEADER].to_vec();
    made.extend([2 << 16 | OP_CAPABILITY, CAPABILITY]);
    let mut at = HEADER;
    while at < words.len() {
        let count = (words[at] >> 16) as usize;
        made.extend(&words[at..at + count]);
        if words[at] & 0xffff == OP_ENTRY_POINT {
            let function = words[at + 2];
            made.extend([4 << 16 | OP_EXECUTION_MODE, function, MODE, 32]);
        }
        at += count;
    }
    made
}
