//! Converts floats to integers by shifts, for drivers that take long over the instruction for it.
//!
//! ```text
//! |x| = 2^(e - 150) m      e: bits 23 to 30 of x; m: those below, behind a one
//! e <= 150:   whole part = m >> min(150 - e, 31)
//! e > 150:    whole part = m << e - 150
//! ```
//!
//! llvmpipe of newer Mesa converts by `llvm.fptoui.sat` and `llvm.fptosi.sat`, which LLVM 15 makes of some seven
//! instructions for each invocation by itself on x86; these are thirteen, or sixteen with a sign, for eight of them
//! (`docs/performance.md`). What fits into 32 bits comes out the same, bit for bit. Nothing else is asked for: naga
//! limits what it converts.

use super::fold::{HEADER, instruction, instructions, is};
use spirv::{GlslStd450Op, Op};
use std::collections::BTreeMap;

/// The word of the header that says how many ids there are.
const BOUND: usize = 3;

/// The words of a module, which convert by shifts. Of floats and whole numbers of 32 bits: shaders have no others.
pub(super) fn converting_by_shifts(words: &[u32]) -> Vec<u32> {
    let mut converting = Converting::of(words);
    let (mut before, mut functions) = (Vec::new(), Vec::new());
    for of in instructions(&words[HEADER..]) {
        if functions.is_empty() && !is(of, Op::Function) {
            before.extend_from_slice(of);
        } else if !converting.writes(of, &mut functions) {
            functions.extend_from_slice(of);
        }
    }
    let mut head = words[..HEADER].to_vec();
    head[BOUND] = converting.bound;
    [head, before, converting.declared, functions].concat()
}

/// What stands in the place of conversions.
struct Converting {
    bound: u32,
    /// The instructions of GLSL.
    glsl: Option<u32>,
    /// Types of whole numbers: the type of a component, and how many there are.
    types: BTreeMap<u32, (u32, u32)>,
    /// Constants by type and value.
    constants: BTreeMap<(u32, u32), u32>,
    /// Constants that were not there before.
    declared: Vec<u32>,
}

impl Converting {
    fn of(words: &[u32]) -> Self {
        let mut made = Self {
            bound: words[BOUND],
            glsl: None,
            types: BTreeMap::new(),
            constants: BTreeMap::new(),
            declared: Vec::new(),
        };
        for of in instructions(&words[HEADER..]) {
            if is(of, Op::ExtInstImport)
                && bytemuck::cast_slice::<u32, u8>(&of[2..]).starts_with(b"GLSL.std.450\0")
            {
                made.glsl = Some(of[1]);
            } else if is(of, Op::TypeInt) {
                made.types.insert(of[1], (of[1], 1));
            } else if is(of, Op::TypeVector) && made.types.contains_key(&of[2]) {
                made.types.insert(of[1], (of[2], of[3]));
            } else if is(of, Op::Function) {
                break;
            }
        }
        made
    }

    fn id(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }

    /// That number in each component.
    fn constant(&mut self, ty: u32, value: u32) -> u32 {
        if let Some(&made) = self.constants.get(&(ty, value)) {
            return made;
        }
        let (component, count) = self.types[&ty];
        let (op, values) = match count {
            1 => (Op::Constant, vec![value]),
            _ => {
                let one = self.constant(component, value);
                (Op::ConstantComposite, vec![one; count as usize])
            }
        };
        let made = self.id();
        let operands = [&[ty, made], &values[..]].concat();
        self.declared.extend(instruction(op, &operands));
        self.constants.insert((ty, value), made);
        made
    }

    /// Writes what stands in the place of an instruction; false where it stays.
    fn writes(&mut self, of: &[u32], out: &mut Vec<u32>) -> bool {
        let has_sign = is(of, Op::ConvertFToS);
        let Some(glsl) = self.glsl.filter(|_| has_sign || is(of, Op::ConvertFToU)) else {
            return false;
        };
        let [ty, result, x] = [of[1], of[2], of[3]];
        let [below_e, one, all_of_e, middle, most, places] =
            [0x7f_ffff, 1 << 23, 255, 150, 31, 23].map(|value| self.constant(ty, value));
        let mut add = |op: Op, operands: &[u32]| {
            let id = self.id();
            out.extend(instruction(op, &[&[ty, id], operands].concat()));
            id
        };
        let bits = add(Op::Bitcast, &[x]);
        let shifted = add(Op::ShiftRightLogical, &[bits, places]);
        let e = add(Op::BitwiseAnd, &[shifted, all_of_e]);
        let below = add(Op::BitwiseAnd, &[bits, below_e]);
        let m = add(Op::BitwiseOr, &[below, one]);
        // Of e above 150 this is negative: without a sign it is large, and its sign says so.
        let right = add(Op::ISub, &[middle, e]);
        let least = add(Op::ExtInst, &[glsl, GlslStd450Op::UMin as u32, right, most]);
        let small = add(Op::ShiftRightLogical, &[m, least]);
        let left = add(Op::ISub, &[e, middle]);
        let left = add(Op::BitwiseAnd, &[left, most]);
        let shifted = add(Op::ShiftLeftLogical, &[m, left]);
        let is_large = add(Op::ShiftRightArithmetic, &[right, most]);
        let large = add(Op::BitwiseAnd, &[shifted, is_large]);
        let (op, [left, right]) = match has_sign {
            false => (Op::BitwiseOr, [small, large]),
            true => {
                let whole = add(Op::BitwiseOr, &[small, large]);
                let sign = add(Op::ShiftRightArithmetic, &[bits, most]);
                (Op::ISub, [add(Op::BitwiseXor, &[whole, sign]), sign])
            }
        };
        out.extend(instruction(op, &[ty, result, left, right]));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A module with one conversion: types 2 and 3 are `u32` and `i32`, 9 is converted to 10.
    fn module(op: Op, ty: u32) -> Vec<u32> {
        let glsl: Vec<u32> = bytemuck::pod_collect_to_vec(b"GLSL.std.450\0\0\0\0");
        let parts = [
            instruction(Op::ExtInstImport, &[&[1], &glsl[..]].concat()),
            instruction(Op::TypeInt, &[2, 32, 0]),
            instruction(Op::TypeInt, &[3, 32, 1]),
            instruction(Op::Function, &[4, 5, 0, 6]),
            instruction(op, &[ty, 10, 9]),
            instruction(Op::FunctionEnd, &[]),
        ];
        [vec![0x0723_0203, 0x1_0500, 0, 11, 0], parts.concat()].concat()
    }

    /// What a module makes of a float: bits of number 10.
    fn run(words: &[u32], x: f32) -> u32 {
        let mut values = BTreeMap::from([(9, x.to_bits())]);
        for of in instructions(&words[HEADER..]) {
            let value = |at: usize| values[&of[at]];
            let made = match of[0] & 0xffff {
                op if op == Op::Constant as u32 => of[3],
                op if op == Op::Bitcast as u32 => value(3),
                op if op == Op::ShiftRightLogical as u32 => value(3) >> value(4),
                op if op == Op::ShiftRightArithmetic as u32 => (value(3) as i32 >> value(4)) as u32,
                op if op == Op::ShiftLeftLogical as u32 => value(3) << value(4),
                op if op == Op::BitwiseAnd as u32 => value(3) & value(4),
                op if op == Op::BitwiseOr as u32 => value(3) | value(4),
                op if op == Op::BitwiseXor as u32 => value(3) ^ value(4),
                op if op == Op::ISub as u32 => value(3).wrapping_sub(value(4)),
                op if op == Op::ExtInst as u32 => {
                    assert_eq!(of[4], GlslStd450Op::UMin as u32);
                    value(5).min(value(6))
                }
                op => {
                    let stays = [
                        Op::ExtInstImport,
                        Op::TypeInt,
                        Op::Function,
                        Op::FunctionEnd,
                    ];
                    assert!(stays.iter().any(|stays| *stays as u32 == op), "{op}");
                    continue;
                }
            };
            assert!(of[2] < words[BOUND]);
            values.insert(of[2], made);
        }
        values[&10]
    }

    #[test]
    fn whole_parts_are_those_of_the_instruction() {
        let to_u32 = converting_by_shifts(&module(Op::ConvertFToU, 2));
        let to_i32 = converting_by_shifts(&module(Op::ConvertFToS, 3));
        // Both ends, zeros, and every exponent with some of what is below.
        let below = [0, 1, 0x2a_aaab, 0x55_5555, 0x7f_fffe, 0x7f_ffff];
        let all = (0..158).flat_map(|e: u32| below.map(|low| f32::from_bits(e << 23 | low)));
        let mut count = 0;
        for x in all.chain([4_294_967_040.0, 3e9]) {
            assert_eq!(run(&to_u32, x), x as u32, "{x:e}");
            if x < 2_147_483_648.0 {
                assert_eq!(run(&to_i32, x) as i32, x as i32, "{x:e}");
                assert_eq!(run(&to_i32, -x) as i32, -x as i32, "-{x:e}");
            }
            count += 1;
        }
        assert_eq!(run(&to_u32, -0.0), 0);
        assert_eq!(run(&to_i32, -2_147_483_648.0) as i32, i32::MIN);
        assert_eq!(count, 950);
    }
}
