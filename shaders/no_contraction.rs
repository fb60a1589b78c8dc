//! Decorates float arithmetic with `NoContraction`, which naga's SPIR-V writer never does.
//!
//! Without it a driver may round `a * b + c` once, as one fused operation, instead of twice. Whether it does depends on
//! the instructions around, so that two programs with the same expression round it differently. With it each instruction
//! is rounded by itself, in every program alike.

use spirv::{Decoration, Op};

/// Words before the first instruction.
const HEADER_WORDS: usize = 5;

/// The float instructions that may be decorated and that round. `OpFNegate` is exact.
const ARITHMETIC: [Op; 13] = [
    Op::FAdd,
    Op::FSub,
    Op::FMul,
    Op::FDiv,
    Op::FRem,
    Op::FMod,
    Op::VectorTimesScalar,
    Op::MatrixTimesScalar,
    Op::VectorTimesMatrix,
    Op::MatrixTimesVector,
    Op::MatrixTimesMatrix,
    Op::OuterProduct,
    Op::Dot,
];

/// The module with each result of float arithmetic decorated.
pub fn forbid_contraction(words: &[u32]) -> Vec<u32> {
    let mut decorations = Vec::new();
    let mut first_type = None;
    for (at, instruction) in instructions(words) {
        if is_float_arithmetic(instruction) {
            let result = instruction[2];
            decorations.extend([
                3 << 16 | Op::Decorate as u32,
                result,
                Decoration::NoContraction as u32,
            ]);
        }
        // Types follow the decorations.
        if first_type.is_none() && is_type(instruction) {
            first_type = Some(at);
        }
    }
    let first_type = first_type.expect("a function has a type");
    [&words[..first_type], &decorations, &words[first_type..]].concat()
}

/// Each instruction of a module, and the index of its first word.
pub fn instructions(words: &[u32]) -> impl Iterator<Item = (usize, &[u32])> {
    let mut at = HEADER_WORDS;
    std::iter::from_fn(move || {
        let count = (*words.get(at)? >> 16) as usize;
        let instruction = &words[at..at + count];
        at += count;
        Some((at - count, instruction))
    })
}

/// Whether an instruction is float arithmetic that rounds.
pub fn is_float_arithmetic(instruction: &[u32]) -> bool {
    ARITHMETIC.iter().any(|op| is(instruction, *op))
}

fn is_type(instruction: &[u32]) -> bool {
    (Op::TypeVoid as u32..=Op::TypeFunction as u32).contains(&(instruction[0] & 0xffff))
}

fn is(instruction: &[u32], op: Op) -> bool {
    instruction[0] & 0xffff == op as u32
}
