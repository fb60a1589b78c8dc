//! Ties branches to opaque predicates: keeps drivers from compiling a program anew for the parameters of each picture.
//!
//! lavapipe of Mesa 22 puts the values of a uniform buffer that branches depend on into the program before each dispatch
//! and each draw (`lvp_inline_uniforms.c`), compiles that, and keeps what it compiled as long as the device lives. It
//! means to stop where that makes the program less than half as long, but compares numbers that wrap around, and goes
//! on for ever: milliseconds for each picture, a tenth of a second and a megabyte for each brick of a mixture. Later
//! versions do that to push constants alone.
//!
//! A branch counts as one of those as long as nothing but uniforms goes into its condition. So each is tied to
//! something that is always so, which no driver can know of: that the invocation is not one of those that there never
//! are. Each branch has a number k of its own, or what is asked inside of another would be known from that one.
//!
//! ```text
//! here = the number of the invocation, or the bits of the place of the fragment
//! if c        ->    if c & (here != 2^32 - 1 - k)
//! switch n    ->    switch select(none of the cases, n, here != 2^32 - 1 - k)
//! ```
//!
//! Other drivers see through it: `here` is the constant 0 where the specialization constant `software` is not 1. What
//! depends on a specialization constant alone is left as it is.

use crate::alternatives::id_of;
use crate::constants::{is_marked, marked};
use naga::{
    AddressSpace, Arena, BinaryOperator, Binding, Block, BuiltIn, Constant, Expression, Function,
    FunctionArgument, GlobalVariable, Handle, Literal, MemoryDecorations, Module, Range, Scalar,
    ScalarKind, Span, Statement, Type, TypeInner, UniqueArena,
};

/// Ties every branch of the module to what drivers cannot know.
pub fn hide_branches(module: &mut Module) {
    let number = Type {
        name: None,
        inner: TypeInner::Scalar(Scalar::U32),
    };
    let here = GlobalVariable {
        name: Some("here".into()),
        space: AddressSpace::Private,
        binding: None,
        ty: module.types.insert(number, Span::UNDEFINED),
        init: None,
        memory_decorations: MemoryDecorations::empty(),
    };
    let software = marked(module, id_of("software") as u16, Some("SOFTWARE".into()));
    let chosen = module.constants.iter().map(|(handle, _)| handle);
    let chosen = chosen.filter(|handle| is_marked(module, *handle)).collect();
    let mut hiding = Hiding {
        here: module.global_variables.append(here, Span::UNDEFINED),
        software,
        chosen,
        branches: 0,
    };
    for (_, function) in module.functions.iter_mut() {
        hiding.hide_in(function);
    }
    for entry in &mut module.entry_points {
        let function = &mut entry.function;
        hiding.hide_in(function);
        let start = hiding.start_of(function, &module.types);
        function.body.splice(0..0, start);
    }
}

struct Hiding {
    here: Handle<GlobalVariable>,
    /// 1 where the driver is llvmpipe.
    software: Handle<Constant>,
    /// All specialization constants.
    chosen: Vec<Handle<Constant>>,
    /// How many there have been.
    branches: u32,
}

impl Hiding {
    fn hide_in(&mut self, function: &mut Function) {
        self.hide_in_block(&mut function.body, &mut function.expressions);
    }

    fn hide_in_block(&mut self, block: &mut Block, expressions: &mut Arena<Expression>) {
        for (mut statement, span) in std::mem::take(block).span_into_iter() {
            match &mut statement {
                Statement::Block(inner) => self.hide_in_block(inner, expressions),
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let [from, is_here] = self.is_here(expressions, span);
                    let tied = Expression::Binary {
                        op: BinaryOperator::LogicalAnd,
                        left: *condition,
                        right: is_here,
                    };
                    *condition = expressions.append(tied, span);
                    let made = Range::new_from_bounds(from, *condition);
                    block.push(Statement::Emit(made), span);
                    self.hide_in_block(accept, expressions);
                    self.hide_in_block(reject, expressions);
                }
                Statement::Switch { selector, cases } => {
                    // What a caller gives is a constant, or the turn of a loop.
                    let is_given = match expressions[*selector] {
                        Expression::FunctionArgument(_) => true,
                        Expression::Constant(one) => self.chosen.contains(&one),
                        _ => false,
                    };
                    if !is_given {
                        self.hide_selector(block, selector, expressions, span);
                    }
                    for case in cases {
                        self.hide_in_block(&mut case.body, expressions);
                    }
                }
                Statement::Loop {
                    body,
                    continuing,
                    break_if,
                } => {
                    assert!(break_if.is_none(), "loops end by `break`");
                    self.hide_in_block(body, expressions);
                    self.hide_in_block(continuing, expressions);
                }
                _ => {}
            }
            block.push(statement, span);
        }
    }

    fn hide_selector(
        &mut self,
        block: &mut Block,
        selector: &mut Handle<Expression>,
        expressions: &mut Arena<Expression>,
        span: Span,
    ) {
        // Of numbers without a sign, or the module is not valid any longer.
        let none = expressions.append(Expression::Literal(Literal::U32(u32::MAX)), span);
        let [from, is_here] = self.is_here(expressions, span);
        let tied = Expression::Select {
            condition: is_here,
            accept: *selector,
            reject: none,
        };
        *selector = expressions.append(tied, span);
        let made = Range::new_from_bounds(from, *selector);
        block.push(Statement::Emit(made), span);
    }

    /// The first expression that has to be emitted, and what is always true.
    fn is_here(
        &mut self,
        expressions: &mut Arena<Expression>,
        span: Span,
    ) -> [Handle<Expression>; 2] {
        let mut add = |expression| expressions.append(expression, span);
        let pointer = add(Expression::GlobalVariable(self.here));
        let never = u32::MAX - self.branches;
        let right = add(Expression::Literal(Literal::U32(never)));
        let left = add(Expression::Load { pointer });
        self.branches += 1;
        let op = BinaryOperator::NotEqual;
        [left, add(Expression::Binary { op, left, right })]
    }

    /// What an entry point begins with.
    fn start_of(&self, function: &mut Function, types: &UniqueArena<Type>) -> Block {
        let is_bound = |given: &FunctionArgument| {
            use BuiltIn::{GlobalInvocationId, LocalInvocationId, Position, VertexIndex};
            matches!(
                given.binding,
                Some(Binding::BuiltIn(
                    Position { .. } | GlobalInvocationId | LocalInvocationId | VertexIndex
                ))
            )
        };
        let mut arguments = (0..).zip(&function.arguments);
        let (index, given) = arguments
            .find(|(_, given)| is_bound(given))
            .expect("an entry point knows where it is");
        let is_vector = matches!(types[given.ty].inner, TypeInner::Vector { .. });
        let span = Span::UNDEFINED;
        let mut add = |expression| function.expressions.append(expression, span);
        let pointer = add(Expression::GlobalVariable(self.here));
        let base = add(Expression::FunctionArgument(index));
        let first = is_vector.then(|| add(Expression::AccessIndex { base, index: 0 }));
        let software = add(Expression::Constant(self.software));
        let [zero, one] = [0, 1].map(|number| add(Expression::Literal(Literal::U32(number))));
        let place = add(Expression::As {
            expr: first.unwrap_or(base),
            kind: ScalarKind::Uint,
            convert: None,
        });
        let condition = add(Expression::Binary {
            op: BinaryOperator::Equal,
            left: software,
            right: one,
        });
        let value = add(Expression::Select {
            condition,
            accept: place,
            reject: zero,
        });
        let mut block = Block::new();
        if let Some(first) = first {
            let made = Range::new_from_bounds(first, first);
            block.push(Statement::Emit(made), span);
        }
        let made = Range::new_from_bounds(place, value);
        block.push(Statement::Emit(made), span);
        block.push(Statement::Store { pointer, value }, span);
        block
    }
}
