//! Evaluates both operands of `&&` and `||` where the second costs nothing (if-conversion of short-circuit operators).
//!
//! naga makes a branch of each, so that the second operand is evaluated only where the first leaves it open. Most second
//! operands are a comparison: on devices that run both arms under a mask such a branch costs more than it spares. And
//! SwiftShader takes, for each loop, as many steps as there are shortest ways through it (`Function::ExistsPath`, which
//! marks a block when it leaves it and not when it comes to it): twice as many for each branch with arms of the same
//! length (`docs/conformance.md`).
//!
//! ```text
//! var r; if a { r = b } else { r = false }    ->    r = select(false, b, a)
//! ```
//!
//! Answers are the same, bit for bit. A second operand that calls, reads a texture, or reads at a place that the first may
//! have to allow stays behind its branch.

use naga::{
    AddressSpace, Arena, Block, Expression, Function, GlobalVariable, Handle, LocalVariable,
    Module, Span, Statement,
};

/// Replaces such branches of the whole module.
pub fn evaluate_both_operands(module: &mut Module) {
    let globals = &module.global_variables;
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    let entries = module
        .entry_points
        .iter_mut()
        .map(|entry| &mut entry.function);
    for function in functions.chain(entries) {
        let Function {
            body,
            expressions,
            local_variables: locals,
            ..
        } = function;
        Flattening { globals, locals }.flatten_in(body, expressions);
    }
}

/// What names and places of variables depend on.
struct Flattening<'m> {
    globals: &'m Arena<GlobalVariable>,
    locals: &'m Arena<LocalVariable>,
}

impl Flattening<'_> {
    fn flatten_in(&self, block: &mut Block, expressions: &mut Arena<Expression>) {
        for (mut statement, span) in std::mem::take(block).span_into_iter() {
            match &mut statement {
                Statement::Block(inner) => self.flatten_in(inner, expressions),
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => {
                    self.flatten_in(accept, expressions);
                    self.flatten_in(reject, expressions);
                    if let Some(mut flattened) =
                        self.flattened(*condition, accept, reject, expressions)
                    {
                        block.append(&mut flattened);
                        continue;
                    }
                }
                Statement::Switch { cases, .. } => {
                    for case in cases {
                        self.flatten_in(&mut case.body, expressions);
                    }
                }
                Statement::Loop {
                    body, continuing, ..
                } => {
                    self.flatten_in(body, expressions);
                    self.flatten_in(continuing, expressions);
                }
                _ => {}
            }
            block.push(statement, span);
        }
    }

    /// What stands in the place of the branch, where it is one of those.
    fn flattened(
        &self,
        condition: Handle<Expression>,
        accept: &Block,
        reject: &Block,
        expressions: &mut Arena<Expression>,
    ) -> Option<Block> {
        let answer = |statement: &Statement| match *statement {
            Statement::Store { pointer, value } => Some((pointer, value)),
            _ => None,
        };
        let [left_open] = &reject[..] else {
            return None;
        };
        let (same, otherwise) = answer(left_open)?;
        let (last, before) = accept.split_last()?;
        let (pointer, value) = answer(last)?;
        let is_one = self.result_variable(pointer, expressions)?
            == self.result_variable(same, expressions)?;
        let is_literal = matches!(expressions[otherwise], Expression::Literal(_));
        let is_free = before
            .iter()
            .all(|statement| self.costs_nothing(statement, expressions));
        if !(is_one && is_literal && is_free) {
            return None;
        }
        let mut block = Block::from_vec(before.to_vec());
        let from = expressions.len();
        let value = expressions.append(
            Expression::Select {
                condition,
                accept: value,
                reject: otherwise,
            },
            Span::UNDEFINED,
        );
        let made = expressions.range_from(from);
        block.push(Statement::Emit(made), Span::UNDEFINED);
        block.push(Statement::Store { pointer, value }, Span::UNDEFINED);
        Some(block)
    }

    /// The variable of a result. Those have no name: what a shader calls by one may be read elsewhere.
    fn result_variable(
        &self,
        pointer: Handle<Expression>,
        expressions: &Arena<Expression>,
    ) -> Option<Handle<LocalVariable>> {
        match expressions[pointer] {
            Expression::LocalVariable(local) if self.locals[local].name.is_none() => Some(local),
            _ => None,
        }
    }

    /// Arithmetic, loads from places that are always there, and results inside of the second operand.
    fn costs_nothing(&self, statement: &Statement, expressions: &Arena<Expression>) -> bool {
        match statement {
            Statement::Emit(range) => range.clone().all(|made| match expressions[made] {
                Expression::Load { pointer } => self.is_always_there(pointer, expressions),
                Expression::AccessIndex { .. }
                | Expression::Splat { .. }
                | Expression::Swizzle { .. }
                | Expression::Compose { .. }
                | Expression::Unary { .. }
                | Expression::Binary { .. }
                | Expression::Select { .. }
                | Expression::Relational { .. }
                | Expression::Math { .. }
                | Expression::As { .. } => true,
                _ => false,
            }),
            Statement::Store { pointer, .. } => {
                self.result_variable(*pointer, expressions).is_some()
            }
            _ => false,
        }
    }

    fn is_always_there(
        &self,
        pointer: Handle<Expression>,
        expressions: &Arena<Expression>,
    ) -> bool {
        match expressions[pointer] {
            Expression::LocalVariable(_) => true,
            Expression::GlobalVariable(global) => matches!(
                self.globals[global].space,
                AddressSpace::Private | AddressSpace::Uniform
            ),
            Expression::AccessIndex { base, .. } => self.is_always_there(base, expressions),
            _ => false,
        }
    }
}
