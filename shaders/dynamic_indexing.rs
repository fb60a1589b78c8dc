//! Replaces dynamic indexing of a few parameters by selects.
//!
//! What a compute pass asks of its parameters by name is read once (`read_once.rs`). What it finds by a number that is
//! known only then, an element of an array or a component of a vector, llvmpipe reads word by word for each invocation,
//! thirty instructions a word. All elements by name, and one of them chosen, are fewer:
//!
//! ```text
//! frame.lights[i]    ->    select(select(frame.lights[0], frame.lights[1], i == 1), frame.lights[2], i == 2)
//! ```
//!
//! A number beyond the end, which nobody asks for, finds the first. Other drivers read the one element: the
//! specialization constant `software` chooses between the two.

use crate::constants::software;
use naga::{
    AddressSpace, Arena, ArraySize, BinaryOperator, Block, Constant, Expression, Function,
    GlobalVariable, Handle, Literal, LocalVariable, Module, Range, ScalarKind, ShaderStage, Span,
    Statement, Type, TypeInner, UniqueArena,
};
use std::collections::BTreeMap;

/// So many elements are few.
const MOST: u32 = 8;

/// Rewrites each such place of a compute pass.
pub fn index_by_selects(module: &mut Module) {
    let is_pass = |stage| stage == ShaderStage::Compute;
    if !module.entry_points.iter().all(|entry| is_pass(entry.stage)) {
        return;
    }
    let software = software(module);
    let entries = module
        .entry_points
        .iter_mut()
        .map(|entry| &mut entry.function);
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(entries) {
        rewrite(
            function,
            &mut module.types,
            &module.global_variables,
            software,
        );
    }
}

fn rewrite(
    function: &mut Function,
    types: &mut UniqueArena<Type>,
    globals: &Arena<GlobalVariable>,
    software: Option<Handle<Constant>>,
) {
    let mut choices = BTreeMap::new();
    let handles: Vec<_> = function.expressions.iter().map(|(made, _)| made).collect();
    for made in handles {
        if let Some(choice) = Choice::of(made, function, types, globals) {
            choices.insert(made, Choice { software, ..choice });
        }
    }
    for (&made, choice) in &choices {
        // What reads the place reads the variable.
        function.expressions[made] = Expression::LocalVariable(choice.chosen);
    }
    let Function {
        body, expressions, ..
    } = function;
    rewrite_block(body, expressions, &choices);
}

/// What one place is replaced by.
struct Choice {
    uniform: Handle<GlobalVariable>,
    /// From the buffer to all elements.
    path: Vec<u32>,
    count: u32,
    number: Handle<Expression>,
    chosen: Handle<LocalVariable>,
    /// 1 where the driver is llvmpipe; `None`: as if it were.
    software: Option<Handle<Constant>>,
}

impl Choice {
    fn of(
        place: Handle<Expression>,
        function: &mut Function,
        types: &mut UniqueArena<Type>,
        globals: &Arena<GlobalVariable>,
    ) -> Option<Self> {
        let Expression::Access { base, index } = function.expressions[place] else {
            return None;
        };
        let (uniform, path) = path_to(base, &function.expressions)?;
        if globals[uniform].space != AddressSpace::Uniform {
            return None;
        }
        let mut all = globals[uniform].ty;
        for &k in &path {
            all = match &types[all].inner {
                TypeInner::Struct { members, .. } => members[k as usize].ty,
                TypeInner::Array { base, .. } => *base,
                _ => return None,
            };
        }
        let (count, element) = match types[all].inner {
            TypeInner::Array {
                base,
                size: ArraySize::Constant(count),
                ..
            } => (count.get(), base),
            TypeInner::Vector { size, scalar } => {
                let inner = TypeInner::Scalar(scalar);
                (
                    size as u32,
                    types.insert(Type { name: None, inner }, Span::UNDEFINED),
                )
            }
            _ => return None,
        };
        let chosen = LocalVariable {
            name: Some("chosen".into()),
            ty: element,
            init: None,
        };
        (count <= MOST).then(|| Self {
            uniform,
            path,
            count,
            number: index,
            chosen: function.local_variables.append(chosen, Span::UNDEFINED),
            software: None,
        })
    }

    /// Chooses, where the place was read, or reads that element.
    fn chosen(&self, expressions: &mut Arena<Expression>) -> Block {
        let selects = self.selects(expressions);
        let Some(software) = self.software else {
            return selects;
        };
        let span = Span::UNDEFINED;
        let mut add = |expression| expressions.append(expression, span);
        let left = add(Expression::Constant(software));
        let right = add(Expression::Literal(Literal::U32(1)));
        let condition = add(Expression::Binary {
            op: BinaryOperator::Equal,
            left,
            right,
        });
        let pointer = add(Expression::LocalVariable(self.chosen));
        let buffer = add(Expression::GlobalVariable(self.uniform));
        let mut all = buffer;
        let mut first = None;
        for &index in &self.path {
            all = add(Expression::AccessIndex { base: all, index });
            first.get_or_insert(all);
        }
        let place = add(Expression::Access {
            base: all,
            index: self.number,
        });
        let value = add(Expression::Load { pointer: place });
        let made = Range::new_from_bounds(first.unwrap_or(place), value);
        let mut direct = Block::new();
        direct.push(Statement::Emit(made), span);
        direct.push(Statement::Store { pointer, value }, span);
        let mut block = Block::new();
        let made = Range::new_from_bounds(condition, condition);
        block.push(Statement::Emit(made), span);
        let choice = Statement::If {
            condition,
            accept: selects,
            reject: direct,
        };
        block.push(choice, span);
        block
    }

    fn selects(&self, expressions: &mut Arena<Expression>) -> Block {
        let span = Span::UNDEFINED;
        let mut block = Block::new();
        let mut add = |expression| expressions.append(expression, span);
        // Those have a value from the beginning, and are not emitted.
        let buffer = add(Expression::GlobalVariable(self.uniform));
        let pointer = add(Expression::LocalVariable(self.chosen));
        let numbers: Vec<_> = (0..self.count)
            .map(|k| add(Expression::Literal(Literal::U32(k))))
            .collect();
        let number = add(Expression::As {
            expr: self.number,
            kind: ScalarKind::Uint,
            convert: Some(4),
        });
        let mut value = None;
        for (k, right) in (0..).zip(numbers) {
            let place = self.path.iter().chain([&k]).fold(buffer, |base, &index| {
                add(Expression::AccessIndex { base, index })
            });
            let element = add(Expression::Load { pointer: place });
            value = Some(match value {
                None => element,
                Some(others) => {
                    let condition = add(Expression::Binary {
                        op: BinaryOperator::Equal,
                        left: number,
                        right,
                    });
                    add(Expression::Select {
                        condition,
                        accept: element,
                        reject: others,
                    })
                }
            });
        }
        let value = value.expect("an array has elements");
        block.push(Statement::Emit(Range::new_from_bounds(number, value)), span);
        block.push(Statement::Store { pointer, value }, span);
        block
    }
}

/// The buffer that a place lies in, and the way from there, where all of that is by name.
fn path_to(
    place: Handle<Expression>,
    expressions: &Arena<Expression>,
) -> Option<(Handle<GlobalVariable>, Vec<u32>)> {
    match expressions[place] {
        Expression::GlobalVariable(global) => Some((global, Vec::new())),
        Expression::AccessIndex { base, index } => {
            let (global, mut path) = path_to(base, expressions)?;
            path.push(index);
            Some((global, path))
        }
        _ => None,
    }
}

fn rewrite_block(
    block: &mut Block,
    expressions: &mut Arena<Expression>,
    choices: &BTreeMap<Handle<Expression>, Choice>,
) {
    for (mut statement, span) in std::mem::take(block).span_into_iter() {
        match &mut statement {
            Statement::Emit(range) => {
                let made: Vec<_> = range.clone().collect();
                for run in
                    made.chunk_by(|a, b| !choices.contains_key(a) && !choices.contains_key(b))
                {
                    match choices.get(&run[0]) {
                        Some(choice) => block.append(&mut choice.chosen(expressions)),
                        None => {
                            let range = Range::new_from_bounds(run[0], run[run.len() - 1]);
                            block.push(Statement::Emit(range), span);
                        }
                    }
                }
                continue;
            }
            Statement::Block(inner) => rewrite_block(inner, expressions, choices),
            Statement::If { accept, reject, .. } => {
                rewrite_block(accept, expressions, choices);
                rewrite_block(reject, expressions, choices);
            }
            Statement::Switch { cases, .. } => {
                for case in cases {
                    rewrite_block(&mut case.body, expressions, choices);
                }
            }
            Statement::Loop {
                body, continuing, ..
            } => {
                rewrite_block(body, expressions, choices);
                rewrite_block(continuing, expressions, choices);
            }
            _ => {}
        }
        block.push(statement, span);
    }
}
