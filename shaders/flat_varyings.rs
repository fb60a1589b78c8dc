//! Gives fragments parameters as flat varyings of the vertices, in place of the uniform buffer.
//!
//! llvmpipe reads a value of a uniform buffer by one instruction where the first of eight invocations is sure to be at
//! work. Of fragments it never is, and each value takes thirty (`invocation_0_must_be_active` in Mesa's
//! `lp_bld_nir_soa.c`): half of the time of a slice. What vertices hand over without interpolation takes one.
//!
//! ```text
//! location 0        the slice
//! location 1 + i    16 bytes of the parameters, the i-th row of those that ROWS names
//! ```
//!
//! Together they are the least that Vulkan allows for, 64 components. `shaders/lib/vertex_planes.wgsl` and
//! `vertex_stack.wgsl` hand them over.

use crate::read_once::redirect_to_copy;
use naga::{
    AddressSpace, Binding, Block, Expression, Function, FunctionArgument, GlobalVariable, Handle,
    Interpolation, Module, Range, Scalar, ScalarKind, ShaderStage, Span, Statement, StructMember,
    SwizzleComponent, Type, TypeInner, VectorSize,
};

/// Members of `Frame` that rows begin with, in the order of their locations: those of all slices, and after these what
/// view-aligned ones want and what those of a stack do.
const ROWS: [&str; 11] = [
    "origin",
    "origin_dx",
    "origin_dy",
    "direction",
    "direction_dx",
    "direction_dy",
    "domain_min",
    "domain_max",
    "brick_min",
    "brick_max",
    "voxel_from_world",
];
const PLANES: [&str; 2] = ["forward", "dims"];
const STACK: [&str; 2] = ["brick_origin", "brick_dims"];

const ROW_BYTES: u32 = 16;

/// Makes a fragment entry point take what it asks of the handed parameters from its inputs, and checks that a vertex
/// entry point hands over these rows in this order. `of` are `planes` or a `stack`.
///
/// # Panics
/// Where it does not.
pub fn hand_over(module: &mut Module, of: &str) {
    let own = match of {
        "planes" => PLANES,
        _ => STACK,
    };
    let names = [&ROWS[..], &own].concat();
    match module.entry_points[0].stage {
        ShaderStage::Fragment => take(module, &names),
        _ => check(module, &names),
    }
}

/// The parameters: where they are, what type they have, and their members.
fn frame_of(module: &Module) -> (Handle<GlobalVariable>, Handle<Type>, Vec<StructMember>) {
    let is_frame = |variable: &GlobalVariable| variable.name.as_deref() == Some("frame");
    let mut globals = module.global_variables.iter();
    let (uniform, variable) = globals
        .find(|(_, variable)| variable.space == AddressSpace::Uniform && is_frame(variable))
        .expect("a slicer has parameters");
    match &module.types[variable.ty].inner {
        TypeInner::Struct { members, .. } => (uniform, variable.ty, members.clone()),
        other => panic!("parameters are a struct, not {other:?}"),
    }
}

/// The rows that are handed over, counted from the first of the parameters, by location.
fn rows_of(module: &Module, names: &[&str], members: &[StructMember]) -> Vec<u32> {
    let rows = names.iter().flat_map(|name| {
        let mut members = members.iter();
        let member = members
            .find(|member| member.name.as_deref() == Some(name))
            .unwrap_or_else(|| panic!("no parameter {name}"));
        let first = member.offset / ROW_BYTES;
        let bytes = module.types[member.ty].inner.size(module.to_ctx());
        first..first + bytes.div_ceil(ROW_BYTES)
    });
    rows.collect()
}

fn take(module: &mut Module, names: &[&str]) {
    let (uniform, ty, members) = frame_of(module);
    let rows = rows_of(module, names, &members);
    let bits = Type {
        name: None,
        inner: TypeInner::Vector {
            size: VectorSize::Quad,
            scalar: Scalar::U32,
        },
    };
    let bits = module.types.insert(bits, Span::UNDEFINED);
    let argument_of = |member: &StructMember| {
        let row = member.offset / ROW_BYTES;
        rows.iter().position(|handed| *handed == row)
    };
    let is_handed = |index: u32| argument_of(&members[index as usize]).is_some();
    let name = module.global_variables[uniform].name.clone();
    let (copy, asked) = redirect_to_copy(module, uniform, ty, name, is_handed);
    let types = module.types.clone();
    let function = &mut module.entry_points[0].function;
    let first = function.arguments.len() as u32;
    for (location, row) in (1..).zip(&rows) {
        function.arguments.push(FunctionArgument {
            name: Some(format!("row_{row}")),
            ty: bits,
            binding: Some(Binding::Location {
                location,
                interpolation: Some(Interpolation::Flat),
                sampling: None,
                blend_src: None,
                per_primitive: false,
            }),
        });
    }
    let mut block = Block::new();
    for index in asked {
        let member = &members[index as usize];
        let argument = first + argument_of(member).expect("asked for") as u32;
        let lane = member.offset % ROW_BYTES / 4;
        let inner = &types[member.ty].inner;
        let count = match inner {
            TypeInner::Matrix { columns, .. } => *columns as u32,
            _ => 1,
        };
        let rows: Vec<_> = (argument..argument + count)
            .map(|row| append(function, Expression::FunctionArgument(row)))
            .collect();
        let base = append(function, Expression::GlobalVariable(copy));
        let pointer = append(function, Expression::AccessIndex { base, index });
        let value = value_of(function, &rows, lane, (member.ty, inner));
        let made = Range::new_from_bounds(pointer, value);
        block.push(Statement::Emit(made), Span::UNDEFINED);
        block.push(Statement::Store { pointer, value }, Span::UNDEFINED);
    }
    function.body.splice(0..0, block);
}

/// What a member is whose rows are these arguments, from this lane on.
fn value_of(
    function: &mut Function,
    rows: &[Handle<Expression>],
    lane: u32,
    (ty, inner): (Handle<Type>, &TypeInner),
) -> Handle<Expression> {
    let as_kind = |expr, kind| Expression::As {
        expr,
        kind,
        convert: None,
    };
    match *inner {
        TypeInner::Scalar(Scalar { kind, .. }) => {
            let (base, index) = (rows[0], lane);
            let bits = append(function, Expression::AccessIndex { base, index });
            append(function, as_kind(bits, kind))
        }
        TypeInner::Vector { size, scalar } => {
            let bits = Expression::Swizzle {
                size,
                vector: rows[0],
                pattern: SwizzleComponent::XYZW,
            };
            let bits = append(function, bits);
            append(function, as_kind(bits, scalar.kind))
        }
        TypeInner::Matrix { .. } => {
            let components = rows
                .iter()
                .map(|&row| append(function, as_kind(row, ScalarKind::Float)))
                .collect();
            append(function, Expression::Compose { ty, components })
        }
        ref other => panic!("{other:?} is not handed over"),
    }
}

fn append(function: &mut Function, expression: Expression) -> Handle<Expression> {
    function.expressions.append(expression, Span::UNDEFINED)
}

/// The outputs after the slice have the names of what they begin with; the rows of a matrix after its first have
/// others.
fn check(module: &Module, names: &[&str]) {
    let (_, _, members) = frame_of(module);
    let result = module.entry_points[0].function.result.as_ref();
    let result = result.expect("a vertex has a place");
    let TypeInner::Struct {
        members: outputs, ..
    } = &module.types[result.ty].inner
    else {
        panic!("a vertex is a struct")
    };
    let location_of = |output: &StructMember| match output.binding {
        Some(Binding::Location { location, .. }) => Some(location),
        _ => None,
    };
    for (location, row) in (1..).zip(rows_of(module, names, &members)) {
        let is_there = |output: &&StructMember| location_of(output) == Some(location);
        let output = outputs.iter().find(is_there);
        let name = output.and_then(|output| output.name.as_deref());
        let begins = |member: &&StructMember| member.offset / ROW_BYTES == row;
        let wanted = members
            .iter()
            .find(begins)
            .and_then(|member| member.name.as_deref());
        assert!(
            name.is_some() && (wanted.is_none() || name == wanted),
            "location {location} is {name:?} and not {wanted:?}"
        );
    }
}
