//! Chooses among few parameters the one that is found by a number.
//!
//! What a compute pass asks of its parameters by name is read once (`read_once.rs`). What it finds by a number that is
//! known only then, an element of an array or a component of a vector, llvmpipe reads word by word for each invocation,
//! thirty instructions a word. All elements by name, and one of them chosen, are fewer:
//!
//! ```text
//! frame.lights[i]    ->    select(select(frame.lights[0], frame.lights[1], i == 1), frame.lights[2], i == 2)
//! ```
//!
//! A number beyond the end, which nobody asks for, finds the first.

use naga::{
    AddressSpace, Arena, ArraySize, BinaryOperator, Block, Expression, Function, GlobalVariable,
    Handle, Literal, LocalVariable, Module, Range, ScalarKind, ShaderStage, Span, Statement, Type,
    TypeInner, UniqueArena,
};
use std::collections::BTreeMap;

/// So many elements are few.
const MOST: u32 = 8;

/// Rewrites each such place of a compute pass.
pub fn choose_among_few(module: &mut Module) {
    let is_pass = |stage| stage == ShaderStage::Compute;
    if !module.entry_points.iter().all(|entry| is_pass(entry.stage)) {
        return;
    }
    let entries = module
        .entry_points
        .iter_mut()
        .map(|entry| &mut entry.function);
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(entries) {
        choose_in(function, &mut module.types, &module.global_variables);
    }
}

fn choose_in(
    function: &mut Function,
    types: &mut UniqueArena<Type>,
    globals: &Arena<GlobalVariable>,
) {
    let mut choices = BTreeMap::new();
    let handles: Vec<_> = function.expressions.iter().map(|(made, _)| made).collect();
    for made in handles {
        if let Some(choice) = Choice::of(made, function, types, globals) {
            choices.insert(made, choice);
        }
    }
    for (&made, choice) in &choices {
        // Who asks for the place asks for the variable.
        function.expressions[made] = Expression::LocalVariable(choice.chosen);
    }
    let Function {
        body, expressions, ..
    } = function;
    choose_in_block(body, expressions, &choices);
}

/// What one place is replaced by.
struct Choice {
    uniform: Handle<GlobalVariable>,
    /// From the buffer to all elements.
    path: Vec<u32>,
    count: u32,
    number: Handle<Expression>,
    chosen: Handle<LocalVariable>,
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
        })
    }

    /// Chooses, where the place was asked for.
    fn chosen(&self, expressions: &mut Arena<Expression>) -> Block {
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

fn choose_in_block(
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
            Statement::Block(inner) => choose_in_block(inner, expressions, choices),
            Statement::If { accept, reject, .. } => {
                choose_in_block(accept, expressions, choices);
                choose_in_block(reject, expressions, choices);
            }
            Statement::Switch { cases, .. } => {
                for case in cases {
                    choose_in_block(&mut case.body, expressions, choices);
                }
            }
            Statement::Loop {
                body, continuing, ..
            } => {
                choose_in_block(body, expressions, choices);
                choose_in_block(continuing, expressions, choices);
            }
            _ => {}
        }
        block.push(statement, span);
    }
}
