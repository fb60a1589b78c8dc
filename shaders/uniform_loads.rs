//! Loads parameters from their uniform buffer on every driver but llvmpipe: undoes `read_once.rs` where the
//! specialization constant `software` is not 1. Part of `build.rs`.
//!
//! ```text
//! %r = OpLoad %T %copy[..]    ->    %a = OpLoad %T %copy[..]
//!                                   %b = OpLoad %T %uniform[..]
//!                                   %r = OpSelect %T (software == 1) %a %b
//! ```
//!
//! Drivers fold the choice, and one of the two reads is dead. A uniform buffer is a structure with one member, which naga
//! puts around the parameters; the copy is the parameters alone.

use super::no_contraction::instructions;
use spirv::{Decoration, Op, StorageClass};
use std::collections::BTreeMap;

const HEADER: usize = 5;
/// The word of the header that says how many ids there are.
const BOUND: usize = 3;

/// The words of a module with these choices; `software` is the `SpecId` of the constant. As they are where there is no
/// such constant, or no copy of a uniform buffer.
pub fn read_directly(software: u32, words: &[u32]) -> Vec<u32> {
    let Some(mut module) = Choosing::of(software, words) else {
        return words.to_vec();
    };
    let mut head = words[..HEADER].to_vec();
    let (mut before, mut functions) = (Vec::new(), Vec::new());
    for (_, instruction) in instructions(words) {
        let is_function = !functions.is_empty() || op(instruction) == Op::Function as u32;
        match is_function {
            true => module.write(instruction, &mut functions),
            false => before.extend_from_slice(instruction),
        }
    }
    head[BOUND] = module.bound;
    [head, before, module.declared, functions].concat()
}

fn op(instruction: &[u32]) -> u32 {
    instruction[0] & 0xffff
}

fn instruction(op: Op, operands: &[u32]) -> Vec<u32> {
    let length = operands.len() as u32 + 1;
    [&[length << 16 | op as u32], operands].concat()
}

/// What goes into the choices.
struct Choosing {
    bound: u32,
    /// Whether the driver is llvmpipe.
    is_software: u32,
    /// The number 0.
    first: u32,
    /// The uniform buffer of each copy.
    uniforms: BTreeMap<u32, u32>,
    /// What pointers point to, and pointers into uniform buffers by that.
    pointees: BTreeMap<u32, u32>,
    pointers: BTreeMap<u32, u32>,
    /// Places in copies: the operands of the same places in their buffers, and what is there.
    places: BTreeMap<u32, (Vec<u32>, u32)>,
    /// Types and constants that were not there before.
    declared: Vec<u32>,
}

impl Choosing {
    fn of(software: u32, words: &[u32]) -> Option<Self> {
        let (mut pointees, mut pointers) = (BTreeMap::new(), BTreeMap::new());
        let (mut private, mut uniform) = (Vec::new(), BTreeMap::new());
        let (mut constant, mut number, mut bool_type) = (None, None, None);
        let mut only_members = BTreeMap::new();
        for (_, of) in instructions(words) {
            let is = |wanted: Op| op(of) == wanted as u32;
            if is(Op::Decorate) && of[2] == Decoration::SpecId as u32 && of[3] == software {
                constant = Some(of[1]);
            } else if is(Op::TypeBool) {
                bool_type = Some(of[1]);
            } else if is(Op::TypeStruct) && of.len() == 3 {
                only_members.insert(of[1], of[2]);
            } else if is(Op::TypePointer) {
                pointees.insert(of[1], of[3]);
                if of[2] == StorageClass::Uniform as u32 {
                    pointers.insert(of[3], of[1]);
                }
            } else if is(Op::SpecConstant) && Some(of[2]) == constant {
                number = Some(of[1]);
            } else if is(Op::Variable) && of[3] == StorageClass::Private as u32 {
                private.push((of[2], pointees[&of[1]]));
            } else if is(Op::Variable) && of[3] == StorageClass::Uniform as u32 {
                let around = pointees[&of[1]];
                if let Some(&parameters) = only_members.get(&around) {
                    uniform.insert(parameters, of[2]);
                }
            }
        }
        let copies = private.into_iter();
        let uniforms: BTreeMap<u32, u32> = copies
            .filter_map(|(copy, of)| Some((copy, *uniform.get(&of)?)))
            .collect();
        let (constant, number) = (constant?, number?);
        if uniforms.is_empty() {
            return None;
        }
        let mut made = Self {
            bound: words[BOUND],
            is_software: 0,
            first: 0,
            uniforms,
            pointees,
            pointers,
            places: BTreeMap::new(),
            declared: Vec::new(),
        };
        let bool_type = bool_type.unwrap_or_else(|| made.declare(Op::TypeBool, &[], &[]));
        made.first = made.declare(Op::Constant, &[number], &[0]);
        let one = made.declare(Op::Constant, &[number], &[1]);
        made.is_software = made.declare(
            Op::SpecConstantOp,
            &[bool_type],
            &[Op::IEqual as u32, constant, one],
        );
        Some(made)
    }

    fn id(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }

    /// Declares a result with operands before and behind its id.
    fn declare(&mut self, op: Op, before: &[u32], behind: &[u32]) -> u32 {
        let id = self.id();
        let operands = [before, &[id], behind].concat();
        self.declared.extend(instruction(op, &operands));
        id
    }

    /// The type of pointers into uniform buffers to a type.
    fn pointer_to(&mut self, pointee: u32) -> u32 {
        if let Some(&pointer) = self.pointers.get(&pointee) {
            return pointer;
        }
        let class = StorageClass::Uniform as u32;
        let pointer = self.declare(Op::TypePointer, &[], &[class, pointee]);
        self.pointers.insert(pointee, pointer);
        pointer
    }

    /// An instruction of a function, and what is beside it.
    fn write(&mut self, of: &[u32], out: &mut Vec<u32>) {
        if op(of) == Op::AccessChain as u32
            && let Some(&uniform) = self.uniforms.get(&of[3])
        {
            let place = [&[uniform, self.first], &of[4..]].concat();
            self.places.insert(of[2], (place, self.pointees[&of[1]]));
        }
        let place = (op(of) == Op::Load as u32)
            .then(|| self.places.get(&of[3]))
            .flatten();
        let Some((place, pointee)) = place.cloned() else {
            out.extend_from_slice(of);
            return;
        };
        let [ty, result, copy] = [of[1], of[2], of[3]];
        let pointer = self.pointer_to(pointee);
        let [of_copy, chain, of_uniform] = [self.id(), self.id(), self.id()];
        out.extend(instruction(Op::Load, &[ty, of_copy, copy]));
        out.extend(instruction(
            Op::AccessChain,
            &[&[pointer, chain], &place[..]].concat(),
        ));
        out.extend(instruction(Op::Load, &[ty, of_uniform, chain]));
        let operands = [ty, result, self.is_software, of_copy, of_uniform];
        out.extend(instruction(Op::Select, &operands));
    }
}
