//! Specialization constants, which naga's SPIR-V writer has none of. Part of `build.rs`.
//!
//! ```text
//! @id(7) override X: u32 = 0u     ->    const X: u32 = MARK + 7          before the module is written
//! %x = OpConstant %uint MARK + 7  ->    OpDecorate %x SpecId 7
//!                                       %x = OpSpecConstant %uint 0      in its words
//! ```
//!
//! A marked constant is only compared, switched on, and chosen by: naga would compute with its number elsewhere.

use naga::{
    Constant, Expression, Handle, Literal, Module, Override, Scalar, Span, Type, TypeInner,
};
use spirv::{Decoration, Op};

/// No constant of ours is near.
const MARK: u32 = 0x5AFE_0000;

/// Makes a marked constant of each override.
///
/// # Panics
/// An override without a number, or that is not a `u32`.
pub fn mark(module: &mut Module) {
    let overrides: Vec<(Handle<Override>, Override)> = module
        .overrides
        .iter()
        .map(|(handle, one)| (handle, one.clone()))
        .collect();
    let marked: Vec<Handle<Constant>> = overrides
        .iter()
        .map(|(_, one)| {
            let id = one.id.expect("an override has a number");
            marked(module, id, one.name.clone())
        })
        .collect();
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    let entries = module.entry_points.iter_mut();
    for function in functions.chain(entries.map(|entry| &mut entry.function)) {
        for (_, expression) in function.expressions.iter_mut() {
            if let Expression::Override(handle) = *expression {
                *expression = Expression::Constant(marked[handle.index()]);
            }
        }
    }
    module.overrides.clear();
}

/// A constant that becomes the specialization constant of that number.
pub fn marked(module: &mut Module, id: u16, name: Option<String>) -> Handle<Constant> {
    let number = Type {
        name: None,
        inner: TypeInner::Scalar(Scalar::U32),
    };
    let ty = module.types.insert(number, Span::UNDEFINED);
    let value = Expression::Literal(Literal::U32(MARK + u32::from(id)));
    let init = module.global_expressions.append(value, Span::UNDEFINED);
    let constant = Constant { name, ty, init };
    module.constants.append(constant, Span::UNDEFINED)
}

/// The constant with number 0, which says whether the driver is llvmpipe.
pub fn software(module: &Module) -> Option<Handle<Constant>> {
    let is_software = |one: &Constant| match &module.global_expressions[one.init] {
        Expression::Literal(Literal::U32(value)) => id_of_mark(*value) == Some(0),
        _ => false,
    };
    let mut constants = module.constants.iter();
    constants
        .find(|(_, one)| is_software(one))
        .map(|(handle, _)| handle)
}

/// Whether a constant is a marked one.
pub fn is_marked(module: &Module, constant: Handle<Constant>) -> bool {
    let init = module.constants[constant].init;
    let value = &module.global_expressions[init];
    matches!(value, Expression::Literal(Literal::U32(value)) if id_of_mark(*value).is_some())
}

/// The `SpecId` that a constant of this value stands for.
pub fn id_of_mark(value: u32) -> Option<u32> {
    value.checked_sub(MARK).filter(|id| *id < 0x1000)
}

/// The words of a module with specialization constants in place of marked ones, and their numbers.
///
/// # Panics
/// A marked constant that something computes with.
pub fn specialized(words: &[u32]) -> (Vec<u32>, Vec<u32>) {
    const HEADER: usize = 5;
    let mut ids = Vec::new();
    let mut results = Vec::new();
    let mut decorations = Vec::new();
    let mut body = Vec::new();
    let mut types_at = None;
    let mut rest = &words[HEADER..];
    while let Some(&first) = rest.first() {
        let (length, op) = ((first >> 16) as usize, first & 0xffff);
        let (instruction, after) = rest.split_at(length);
        rest = after;
        if types_at.is_none() && (Op::TypeVoid as u32..=Op::TypeForwardPointer as u32).contains(&op)
        {
            types_at = Some(body.len());
        }
        let id = (op == Op::Constant as u32 && length == 4)
            .then(|| id_of_mark(instruction[3]))
            .flatten();
        if let Some(id) = id {
            assert!(!ids.contains(&id), "constant {id} is there twice");
            ids.push(id);
            results.push(instruction[2]);
            body.extend([
                (4 << 16) | Op::SpecConstant as u32,
                instruction[1],
                instruction[2],
                0,
            ]);
            decorations.extend([
                (4 << 16) | Op::Decorate as u32,
                instruction[2],
                Decoration::SpecId as u32,
                id,
            ]);
            continue;
        }
        check(op, instruction, &results);
        body.extend(instruction);
    }
    let types_at = types_at.expect("a module has types");
    let parts = [
        &words[..HEADER],
        &body[..types_at],
        &decorations,
        &body[types_at..],
    ];
    (parts.concat(), ids)
}

/// That an instruction only compares, switches on or chooses by these results, or names them.
fn check(op: u32, instruction: &[u32], results: &[u32]) {
    let allowed = [Op::IEqual, Op::INotEqual, Op::Switch, Op::Name].map(|op| op as u32);
    // Whatever else has the number of a result in it may as well hold that number itself.
    let computes = [
        Op::ConstantComposite,
        Op::CompositeConstruct,
        Op::AccessChain,
        Op::IAdd,
        Op::ISub,
        Op::IMul,
        Op::Bitcast,
        Op::Store,
        Op::FunctionCall,
    ]
    .map(|op| op as u32);
    if allowed.contains(&op) || !computes.contains(&op) {
        return;
    }
    assert!(
        !instruction[1..].iter().any(|word| results.contains(word)),
        "a specialization constant is computed with"
    );
}
