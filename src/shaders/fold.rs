//! The code of one variant: what its specialization constants choose, without what they do not.
//!
//! ```text
//! %x = OpSpecConstant %uint 0    ->    %x = OpConstant %uint VALUE
//! %c = OpIEqual %x %one          ->    known
//! OpBranchConditional %c %a %b   ->    OpBranch %a
//! OpSwitch %x %a 1 %b            ->    OpBranch %b, or OpSwitch %x %b where %b may break out of it
//! %r = OpSelect %c %a %b         ->    %r = OpCopyObject %a
//! ```
//!
//! Blocks that nothing branches to, functions that nothing calls and results that nothing uses go. Drivers fold
//! constants by themselves, but some only after they have inlined all variants of a module: SwiftShader takes half a
//! minute for that.

use spirv::{Decoration, Op};
use std::collections::{BTreeMap, BTreeSet};

pub(super) const HEADER: usize = 5;

type Instruction<'w> = &'w [u32];

/// The words of a module whose specialization constants have these values, by `SpecId`.
///
/// # Panics
/// A specialization constant without a value: the build gives each variant all of them.
pub fn folded(words: &[u32], constants: &[(u32, u32)]) -> Vec<u32> {
    let all: Vec<Instruction<'_>> = instructions(&words[HEADER..]).collect();
    let of_functions = all.iter().position(|of| is(of, Op::Function));
    let (head, functions) = all.split_at(of_functions.unwrap_or(all.len()));
    let mut known = Known::default();
    let head = known.declarations(head, constants);
    let functions: BTreeMap<u32, Vec<u32>> = functions
        .split_inclusive(|of| is(of, Op::FunctionEnd))
        .map(|function| (function[0][2], Function::of(function, &mut known).words()))
        .collect();
    let entry = instructions(&head).find(|of| is(of, Op::EntryPoint));
    let mut called = BTreeSet::new();
    let mut calls: Vec<u32> = entry.map(|of| of[2]).into_iter().collect();
    while let Some(function) = calls.pop() {
        if called.insert(function) {
            let inside = instructions(&functions[&function]);
            calls.extend(inside.filter(|of| is(of, Op::FunctionCall)).map(|of| of[3]));
        }
    }
    // Callees stand before their callers or behind them: in the order of the module.
    let order = all.iter().filter(|of| is(of, Op::Function)).map(|of| of[2]);
    let body: Vec<u32> = order
        .filter(|function| called.contains(function))
        .flat_map(|function| functions[&function].iter().copied())
        .collect();
    let results = instructions(&head).chain(instructions(&body));
    let results: BTreeSet<u32> = results.filter_map(result).collect();
    let of_what_is_left = |of: &Instruction<'_>| {
        let names = [Op::Name, Op::MemberName, Op::Decorate, Op::MemberDecorate];
        !names.iter().any(|op| is(of, *op)) || results.contains(&of[1])
    };
    let head = instructions(&head).filter(of_what_is_left).flatten();
    [&words[..HEADER], &head.copied().collect::<Vec<_>>(), &body].concat()
}

pub(super) fn instructions(words: &[u32]) -> impl Iterator<Item = Instruction<'_>> {
    let mut rest = words;
    std::iter::from_fn(move || {
        let length = (rest.first()? >> 16) as usize;
        let (instruction, after) = rest.split_at(length);
        rest = after;
        Some(instruction)
    })
}

pub(super) fn is(instruction: &[u32], op: Op) -> bool {
    instruction[0] & 0xffff == op as u32
}

pub(super) fn instruction(op: Op, operands: &[u32]) -> Vec<u32> {
    let length = operands.len() as u32 + 1;
    [&[length << 16 | op as u32], operands].concat()
}

/// The id that an instruction defines.
fn result(of: Instruction<'_>) -> Option<u32> {
    const NONE: [Op; 33] = [
        Op::Nop,
        Op::Source,
        Op::SourceExtension,
        Op::SourceContinued,
        Op::Name,
        Op::MemberName,
        Op::Line,
        Op::NoLine,
        Op::Extension,
        Op::MemoryModel,
        Op::EntryPoint,
        Op::ExecutionMode,
        Op::Capability,
        Op::FunctionEnd,
        Op::Store,
        Op::CopyMemory,
        Op::Decorate,
        Op::MemberDecorate,
        Op::ImageWrite,
        Op::EmitVertex,
        Op::EndPrimitive,
        Op::ControlBarrier,
        Op::MemoryBarrier,
        Op::AtomicStore,
        Op::LoopMerge,
        Op::SelectionMerge,
        Op::Branch,
        Op::BranchConditional,
        Op::Switch,
        Op::Kill,
        Op::Return,
        Op::ReturnValue,
        Op::Unreachable,
    ];
    let op = of[0] & 0xffff;
    let first = [Op::ExtInstImport, Op::String, Op::Label];
    let is_type = (Op::TypeVoid as u32..=Op::TypeFunction as u32).contains(&op);
    if NONE.iter().any(|none| op == *none as u32) {
        return None;
    }
    match is_type || first.iter().any(|first| op == *first as u32) {
        true => Some(of[1]),
        false => Some(of[2]),
    }
}

/// Values of ids that the constants decide: numbers, 0 and 1 of booleans.
#[derive(Default)]
struct Known(BTreeMap<u32, u32>);

impl Known {
    /// What stands before the functions, with constants in place of specialization constants.
    fn declarations(&mut self, head: &[Instruction<'_>], constants: &[(u32, u32)]) -> Vec<u32> {
        let mut numbers = BTreeMap::new();
        let mut made = Vec::new();
        for of in head {
            if is(of, Op::Decorate) && of[2] == Decoration::SpecId as u32 {
                numbers.insert(of[1], of[3]);
            } else if is(of, Op::SpecConstant) {
                let number = numbers[&of[2]];
                let given = constants.iter().find(|(id, _)| *id == number);
                let (_, value) = given.unwrap_or_else(|| panic!("constant {number} has no value"));
                self.0.insert(of[2], *value);
                made.extend(instruction(Op::Constant, &[of[1], of[2], *value]));
            } else if is(of, Op::SpecConstantOp) {
                let op = [&[of[0]], &of[1..3], &of[4..]].concat();
                let value = self.value(of[3], &op).expect("of known constants");
                self.0.insert(of[2], value);
                let constant = [Op::ConstantFalse, Op::ConstantTrue][value as usize];
                made.extend(instruction(constant, &of[1..3]));
            } else {
                // Floats too: nothing asks for them.
                match of.len() {
                    4 if is(of, Op::Constant) => _ = self.0.insert(of[2], of[3]),
                    3 if is(of, Op::ConstantTrue) => _ = self.0.insert(of[2], 1),
                    3 if is(of, Op::ConstantFalse) => _ = self.0.insert(of[2], 0),
                    _ => {}
                }
                made.extend_from_slice(of);
            }
        }
        made
    }

    fn of(&self, id: u32) -> Option<u32> {
        self.0.get(&id).copied()
    }

    /// What an operation with its type, its result and its operands comes to.
    fn value(&self, op: u32, of: Instruction<'_>) -> Option<u32> {
        let at = |k: usize| self.of(*of.get(k)?);
        let is = |wanted: Op| op == wanted as u32;
        if is(Op::IEqual) || is(Op::LogicalEqual) {
            Some((at(3)? == at(4)?).into())
        } else if is(Op::INotEqual) || is(Op::LogicalNotEqual) {
            Some((at(3)? != at(4)?).into())
        } else if is(Op::LogicalNot) {
            Some(1 - at(3)?)
        } else if is(Op::LogicalAnd) {
            match (at(3), at(4)) {
                (Some(0), _) | (_, Some(0)) => Some(0),
                (Some(_), Some(_)) => Some(1),
                _ => None,
            }
        } else if is(Op::LogicalOr) {
            match (at(3), at(4)) {
                (Some(1), _) | (_, Some(1)) => Some(1),
                (Some(_), Some(_)) => Some(0),
                _ => None,
            }
        } else if is(Op::Select) {
            at(if at(3)? == 1 { 4 } else { 5 })
        } else {
            None
        }
    }
}

/// A function in blocks, each without the branches that are never taken.
struct Function {
    /// `OpFunction` and its parameters.
    start: Vec<u32>,
    blocks: Vec<Block>,
}

struct Block {
    label: u32,
    body: Vec<Vec<u32>>,
    /// Where it leads to.
    next: Vec<u32>,
    /// What a merge instruction names: its merge block, and the block in which a loop continues.
    merges: Vec<u32>,
}

impl Function {
    fn of(function: &[Instruction<'_>], known: &mut Known) -> Self {
        let first = function.iter().position(|of| is(of, Op::Label));
        let (start, blocks) = function.split_at(first.expect("a function has a body"));
        let blocks = blocks[..blocks.len() - 1].chunk_by(|_, of| !is(of, Op::Label));
        let blocks = blocks.map(|block| Block::of(block, known)).collect();
        let mut made = Self {
            start: start.concat(),
            blocks,
        };
        made.remove_unreachable();
        made.remove_unused();
        made
    }

    fn block(&self, label: u32) -> &Block {
        let mut blocks = self.blocks.iter();
        blocks
            .find(|block| block.label == label)
            .expect("a block of the function")
    }

    /// Labels that are reached from one.
    fn reached_from(&self, label: u32) -> BTreeSet<u32> {
        let mut reached = BTreeSet::new();
        let mut next = vec![label];
        while let Some(label) = next.pop() {
            if reached.insert(label) {
                next.extend(&self.block(label).next);
            }
        }
        reached
    }

    fn remove_unreachable(&mut self) {
        // A choice of one is a branch, unless something inside leaves it by its merge block.
        for at in 0..self.blocks.len() {
            let block = &self.blocks[at];
            let is_choice = block
                .body
                .last()
                .is_some_and(|of| is(of, Op::Switch) && of.len() == 3);
            if is_choice && !self.reached_from(block.next[0]).contains(&block.merges[0]) {
                self.blocks[at].branch();
            }
        }
        let reached = self.reached_from(self.blocks[0].label);
        let is_reached = |block: &&Block| reached.contains(&block.label);
        let headers: Vec<(u32, Vec<u32>)> = self
            .blocks
            .iter()
            .filter(is_reached)
            .map(|block| (block.label, block.merges.clone()))
            .collect();
        self.blocks.retain_mut(|block| {
            if reached.contains(&block.label) {
                return true;
            }
            let header = headers
                .iter()
                .find(|(_, merges)| merges.contains(&block.label));
            let Some((header, merges)) = header else {
                return false;
            };
            // Merge instructions name it all the same.
            let end = match merges[0] == block.label {
                true => instruction(Op::Unreachable, &[]),
                false => instruction(Op::Branch, &[*header]),
            };
            block.body = vec![instruction(Op::Label, &[block.label]), end];
            true
        });
        let edges: BTreeSet<(u32, u32)> = self
            .blocks
            .iter()
            .flat_map(|block| block.next.iter().map(|next| (block.label, *next)))
            .collect();
        for block in &mut self.blocks {
            for of in block.body.iter_mut().filter(|of| is(of, Op::Phi)) {
                let pairs = of[3..].chunks_exact(2);
                let pairs = pairs.filter(|pair| edges.contains(&(pair[1], block.label)));
                let operands = [&of[1..3], &pairs.flatten().copied().collect::<Vec<_>>()].concat();
                *of = instruction(Op::Phi, &operands);
            }
        }
    }

    /// Removes results that nothing uses. Words that are no ids may keep one that has the same number.
    fn remove_unused(&mut self) {
        const PURE: [Op; 12] = [
            Op::Load,
            Op::AccessChain,
            Op::Select,
            Op::CopyObject,
            Op::IEqual,
            Op::INotEqual,
            Op::LogicalEqual,
            Op::LogicalAnd,
            Op::LogicalOr,
            Op::LogicalNot,
            Op::CompositeExtract,
            Op::CompositeConstruct,
        ];
        let all = self.blocks.iter().flat_map(|block| &block.body);
        let mut used: BTreeSet<u32> = all
            .filter(|of| is(of, Op::Phi))
            .flat_map(|of| of[3..].iter().copied())
            .collect();
        // A definition stands before its uses.
        for block in self.blocks.iter_mut().rev() {
            let mut kept: Vec<Vec<u32>> = block.body.drain(..).rev().collect();
            kept.retain(|of| {
                let is_pure = PURE.iter().any(|op| is(of, *op));
                if is_pure && !used.contains(&of[2]) {
                    return false;
                }
                used.extend(&of[1..]);
                true
            });
            kept.reverse();
            block.body = kept;
        }
    }

    fn words(self) -> Vec<u32> {
        let bodies = self
            .blocks
            .iter()
            .flat_map(|block| block.body.iter().flatten());
        let end = instruction(Op::FunctionEnd, &[]);
        self.start
            .iter()
            .chain(bodies)
            .chain(&end)
            .copied()
            .collect()
    }
}

impl Block {
    fn of(block: &[Instruction<'_>], known: &mut Known) -> Self {
        let mut made = Self {
            label: block[0][1],
            body: Vec::new(),
            next: Vec::new(),
            merges: Vec::new(),
        };
        for of in block {
            made.push(of, known);
        }
        made
    }

    fn push(&mut self, of: Instruction<'_>, known: &mut Known) {
        if is(of, Op::SelectionMerge) {
            self.merges = vec![of[1]];
        } else if is(of, Op::LoopMerge) {
            self.merges = of[1..3].to_vec();
        } else if is(of, Op::Branch) {
            self.next = vec![of[1]];
        } else if is(of, Op::BranchConditional) {
            match known.of(of[1]) {
                Some(value) => {
                    self.next = vec![of[if value == 1 { 2 } else { 3 }]];
                    return self.branch();
                }
                None => self.next = of[2..4].to_vec(),
            }
        } else if is(of, Op::Switch) {
            let cases = of[3..].chunks_exact(2);
            if let Some(value) = known.of(of[1]) {
                let case = cases.clone().find(|case| case[0] == value);
                self.next = vec![case.map_or(of[2], |case| case[1])];
                let operands = [of[1], self.next[0]];
                return self.body.push(instruction(Op::Switch, &operands));
            }
            self.next = cases.map(|case| case[1]).chain([of[2]]).collect();
        } else if let Some(value) = known.value(of[0] & 0xffff, of) {
            known.0.insert(of[2], value);
        } else if is(of, Op::Select)
            && let Some(condition) = known.of(of[3])
        {
            let chosen = of[if condition == 1 { 4 } else { 5 }];
            let operands = [of[1], of[2], chosen];
            return self.body.push(instruction(Op::CopyObject, &operands));
        }
        self.body.push(of.to_vec());
    }

    /// Ends in a branch to the only block that is next, and merges nothing but a loop.
    fn branch(&mut self) {
        if self.body.last().is_some_and(|of| is(of, Op::Switch)) {
            self.body.pop();
        }
        if self
            .body
            .last()
            .is_some_and(|of| is(of, Op::SelectionMerge))
        {
            self.body.pop();
            self.merges.clear();
        }
        self.body.push(instruction(Op::Branch, &self.next));
    }
}
