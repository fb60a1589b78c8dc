//! No driver may contract the float arithmetic of the renderer's shaders: `shaders/no_contraction.rs`.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use spirv::{BuiltIn, Decoration, GlslStd450Op, Op};
use std::collections::BTreeMap;
use stratavox::shaders::{SHADERS, Shader, Stage};

#[path = "../../shaders/no_contraction.rs"]
pub mod pass;

use pass::{forbid_contraction, instructions, is_float_arithmetic};

/// Every float operation that WGSL has, and some that are exact or of whole numbers.
const OPERATIONS: &str = "
    struct Numbers { f: f32, v: vec3<f32>, m: mat3x3<f32>, i: vec3<i32> }
    @group(0) @binding(0) var<storage, read_write> n: Numbers;

    @compute @workgroup_size(1)
    fn main() {
        n.f = n.f + 1.5 - n.f * n.f / (n.f % 2.5);
        n.f += dot(n.v, n.v);
        n.v = n.f * (n.v * n.m + n.m * n.v);
        n.m = n.f * (n.m * n.m);
        n.i = n.i + n.i * n.i;
        n.f = -max(n.f, 0.0);
    }
";

/// As naga writes it.
fn compiled(source: &str) -> Vec<u32> {
    let module = naga::front::wgsl::parse_str(source).unwrap();
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap();
    spv::write_vec(&module, &info, &spv::Options::default(), None).unwrap()
}

/// How often each result carries a decoration.
fn decorated(words: &[u32], decoration: Decoration) -> BTreeMap<u32, usize> {
    let mut found = BTreeMap::new();
    for (_, instruction) in instructions(words) {
        if instruction[0] & 0xffff == Op::Decorate as u32 && instruction[2] == decoration as u32 {
            *found.entry(instruction[1]).or_insert(0) += 1;
        }
    }
    found
}

/// The results of float arithmetic, each expected to be decorated once.
fn arithmetic(words: &[u32]) -> BTreeMap<u32, usize> {
    let results = instructions(words).filter(|(_, instruction)| is_float_arithmetic(instruction));
    results
        .map(|(_, instruction)| (instruction[2], 1))
        .collect()
}

/// Those of the renderer, and those of conformance.
fn shaders(are_probes: bool) -> impl Iterator<Item = &'static Shader> {
    SHADERS
        .iter()
        .filter(move |shader| shader.name.starts_with("probe/") == are_probes)
}

#[test]
fn each_result_of_float_arithmetic_is_decorated_once_and_nothing_else_changes() {
    let before = compiled(OPERATIONS);
    let after = forbid_contraction(&before);
    let found = decorated(&after, Decoration::NoContraction);
    assert_eq!(found, arithmetic(&before));
    // + - * / % +=, dot, and * of a vector with a number and a matrix on both sides, of matrices, and their sum.
    assert_eq!(found.len(), 13);
    let is_new = |instruction: &[u32]| {
        instruction[0] & 0xffff == Op::Decorate as u32
            && instruction[2] == Decoration::NoContraction as u32
    };
    let others = instructions(&after).filter(|(_, instruction)| !is_new(instruction));
    let others: Vec<u32> = others.flat_map(|(_, all)| all).copied().collect();
    assert_eq!(
        others,
        before[5..],
        "the other instructions, in their order"
    );
    assert_eq!(after[..5], before[..5], "the header");
}

#[test]
fn no_shader_of_the_renderer_may_be_contracted() {
    let mut count = 0;
    for shader in shaders(false) {
        let wanted = arithmetic(shader.spirv());
        count += wanted.len();
        let found = decorated(shader.spirv(), Decoration::NoContraction);
        assert!(found == wanted, "{}", shader.name);
    }
    assert!(count > 10_000, "{count} results of float arithmetic");
}

/// `length`, `mix` and others would be arithmetic of the driver's own, which no decoration reaches.
#[test]
fn no_shader_of_the_renderer_calls_a_function_that_is_more_than_one_operation() {
    use GlslStd450Op as G;
    let single = [
        // Exact.
        G::RoundEven,
        G::Floor,
        G::Ceil,
        G::Fract,
        G::FAbs,
        G::SAbs,
        G::FMin,
        G::FMax,
        G::FClamp,
        G::UMin,
        G::UMax,
        G::SMin,
        G::SMax,
        G::FindILsb,
        G::FindUMsb,
        // As near as Vulkan's precision rules say.
        G::Exp,
        G::Log,
        G::Pow,
        G::Sqrt,
        G::InverseSqrt,
    ];
    for shader in shaders(false) {
        for (_, instruction) in instructions(shader.spirv()) {
            if instruction[0] & 0xffff == Op::ExtInst as u32 {
                let called = instruction[4];
                let is_single = single.iter().any(|op| *op as u32 == called);
                assert!(is_single, "{}: GLSL.std.450 {called}", shader.name);
            }
        }
    }
}

#[test]
fn the_positions_of_slices_are_invariant() {
    let mut count = 0;
    for shader in shaders(false).filter(|s| s.stage == Stage::Vertex && s.name.contains("slice")) {
        let position = instructions(shader.spirv()).find_map(|(_, instruction)| {
            let is_position = instruction[0] & 0xffff == Op::Decorate as u32
                && instruction[2..] == [Decoration::BuiltIn as u32, BuiltIn::Position as u32];
            is_position.then(|| instruction[1])
        });
        let invariant = decorated(shader.spirv(), Decoration::Invariant);
        assert!(
            invariant.contains_key(&position.unwrap()),
            "{}",
            shader.name
        );
        count += 1;
    }
    assert_eq!(count, 10);
}

#[test]
fn probes_of_conformance_are_left_to_the_driver() {
    for shader in shaders(true) {
        let found = decorated(shader.spirv(), Decoration::NoContraction);
        assert!(found.is_empty(), "{}", shader.name);
    }
}
