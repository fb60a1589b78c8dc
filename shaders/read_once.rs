//! Reads the parameters of a picture once, where an entry point begins.
//!
//! llvmpipe reads a value of a uniform buffer by one instruction where all invocations are sure to be at work, and by
//! thirty, one word for each of them, after the first branch. In compute passes what is asked for by name is copied to
//! a variable of the invocation; what is found by a number that is known only then stays where it is. Fragments gain
//! nothing by it, since there the invocations are never sure to be at work: `flat_varyings.rs` is for them.

use crate::constants::software;
use naga::{
    AddressSpace, Arena, BinaryOperator, Block, Constant, EntryPoint, Expression, Function,
    GlobalVariable, Handle, Literal, MemoryDecorations, Module, Range, ShaderStage, Span,
    Statement, Type,
};
use std::collections::{BTreeMap, BTreeSet};

/// Puts a copy in the place of each uniform buffer of a compute pass.
pub fn read_parameters_once(module: &mut Module) {
    let is_pass = |entry: &EntryPoint| entry.stage == ShaderStage::Compute;
    if !module.entry_points.iter().all(is_pass) {
        return;
    }
    let uniforms: Vec<_> = module
        .global_variables
        .iter()
        .filter(|(_, variable)| variable.space == AddressSpace::Uniform)
        .map(|(handle, variable)| (handle, variable.ty, variable.name.clone()))
        .collect();
    for (uniform, ty, name) in uniforms {
        let (copy, members) = redirect_to_copy(module, uniform, ty, name, |_| true);
        let software = software(module);
        for entry in &mut module.entry_points {
            let mut start = copied(&mut entry.function, uniform, copy, &members);
            if let Some(software) = software {
                start = only_where(software, start, &mut entry.function.expressions);
            }
            entry.function.body.splice(0..0, start);
        }
    }
}

/// A variable of the invocation that is asked in the place of a uniform buffer, and for which of its members: those
/// that are `wanted` and asked for by name. Nothing is in it yet.
pub fn redirect_to_copy(
    module: &mut Module,
    uniform: Handle<GlobalVariable>,
    ty: Handle<Type>,
    name: Option<String>,
    wanted: impl Fn(u32) -> bool,
) -> (Handle<GlobalVariable>, BTreeSet<u32>) {
    let copy = GlobalVariable {
        name: name.map(|name| format!("{name}_read")),
        space: AddressSpace::Private,
        binding: None,
        ty,
        init: None,
        memory_decorations: MemoryDecorations::empty(),
    };
    let copy = module.global_variables.append(copy, Span::UNDEFINED);
    let entries = module
        .entry_points
        .iter_mut()
        .map(|entry| &mut entry.function);
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    let mut members = BTreeSet::new();
    for function in functions.chain(entries) {
        redirect(
            &mut function.expressions,
            uniform,
            copy,
            &mut members,
            &wanted,
        );
    }
    (copy, members)
}

/// Lets what is asked for by name alone be asked of the copy, and notes it.
fn redirect(
    expressions: &mut Arena<Expression>,
    uniform: Handle<GlobalVariable>,
    copy: Handle<GlobalVariable>,
    members: &mut BTreeSet<u32>,
    wanted: impl Fn(u32) -> bool,
) {
    let is_root = |handle: &Handle<Expression>| matches!(expressions[*handle], Expression::GlobalVariable(global) if global == uniform);
    // From the expression that names the buffer to all that is made of its place.
    let mut named: Vec<(Handle<Expression>, BTreeSet<u32>, bool)> = Vec::new();
    let mut root_of = BTreeMap::new();
    for (handle, expression) in expressions.iter() {
        match expression {
            Expression::GlobalVariable(_) if is_root(&handle) => {
                root_of.insert(handle, named.len());
                named.push((handle, BTreeSet::new(), true));
            }
            Expression::AccessIndex { base, index } => {
                if let Some(&root) = root_of.get(base) {
                    if is_root(base) {
                        named[root].1.insert(*index);
                        named[root].2 &= wanted(*index);
                    }
                    root_of.insert(handle, root);
                }
            }
            Expression::Access { base, .. } => {
                if let Some(&root) = root_of.get(base) {
                    named[root].2 = false;
                    root_of.insert(handle, root);
                }
            }
            Expression::Load { pointer } if is_root(pointer) => named[root_of[pointer]].2 = false,
            _ => {}
        }
    }
    for (handle, own, is_by_name) in named {
        if is_by_name {
            expressions[handle] = Expression::GlobalVariable(copy);
            members.extend(own);
        }
    }
}

/// What other drivers than llvmpipe leave out: they read parameters where they are asked for (`uniform_loads.rs`).
fn only_where(
    software: Handle<Constant>,
    accept: Block,
    expressions: &mut Arena<Expression>,
) -> Block {
    let span = Span::UNDEFINED;
    let mut add = |expression| expressions.append(expression, span);
    let left = add(Expression::Constant(software));
    let right = add(Expression::Literal(Literal::U32(1)));
    let condition = add(Expression::Binary {
        op: BinaryOperator::Equal,
        left,
        right,
    });
    let mut block = Block::new();
    let made = Range::new_from_bounds(condition, condition);
    block.push(Statement::Emit(made), span);
    let choice = Statement::If {
        condition,
        accept,
        reject: Block::new(),
    };
    block.push(choice, span);
    block
}

/// What an entry point begins with.
fn copied(
    function: &mut Function,
    uniform: Handle<GlobalVariable>,
    copy: Handle<GlobalVariable>,
    members: &BTreeSet<u32>,
) -> Block {
    let span = Span::UNDEFINED;
    let mut block = Block::new();
    for &index in members {
        let mut add = |expression| function.expressions.append(expression, span);
        let from = add(Expression::GlobalVariable(uniform));
        let to = add(Expression::GlobalVariable(copy));
        let first = add(Expression::AccessIndex { base: from, index });
        let value = add(Expression::Load { pointer: first });
        let pointer = add(Expression::AccessIndex { base: to, index });
        block.push(
            Statement::Emit(Range::new_from_bounds(first, pointer)),
            span,
        );
        block.push(Statement::Store { pointer, value }, span);
    }
    block
}
