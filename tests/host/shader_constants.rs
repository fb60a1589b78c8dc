//! Variants in one module: what the build makes of files that stand for words of a constant, of overrides, and of copies
//! of parameters.

#[path = "../../shaders/alternatives.rs"]
mod alternatives;
#[path = "../../shaders/compose.rs"]
#[allow(dead_code, reason = "the build asks for more")]
mod compose;
#[path = "../../shaders/constants.rs"]
#[allow(dead_code, reason = "the build asks for more")]
mod constants;
#[path = "../../src/shaders/fold.rs"]
mod fold;
#[path = "../../shaders/uniform_loads.rs"]
mod uniform_loads;
#[path = "../../shaders/variants.rs"]
#[allow(dead_code, reason = "the build asks for more")]
mod variants;

use crate::no_contraction::pass as no_contraction;
use crate::spirv_words::{SpirvVal, count};
use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use spirv::Op;
use std::collections::BTreeMap;
use variants::Slot;

const FILTER: Slot = Slot {
    name: "filter",
    words: &["low", "high"],
    is_constant: true,
};

const MAIN: &str = "#import of_{filter}
@group(0) @binding(0) var<storage, read_write> out: Numbers;
@compute @workgroup_size(8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    out.d[id.x] = end_of(f32(id.x));
}
";
const LOW: &str = "struct Numbers { d: array<f32> }
// Of this file alone.
const SCALE: f32 = 2.0;
fn end_of(x: f32) -> f32 {
    return scaled(x, SCALE);
}
fn scaled(x: f32, by: f32) -> f32 {
    return x / by;
}
";
const HIGH: &str = "struct Numbers { d: array<f32> }
const SCALE: f32 = 3.0;
fn end_of(y: f32) -> f32 {
    return scaled(y);
}
fn scaled(y: f32) -> f32 {
    return y * SCALE;
}
";

fn merged(main: &str, low: &str, high: &str) -> String {
    let read = |path: &str| {
        let text = match path {
            "main.wgsl" => main,
            "lib/of_low.wgsl" => low,
            "lib/of_high.wgsl" => high,
            other => panic!("{other}"),
        };
        text.to_owned()
    };
    alternatives::merged("main", &[FILTER], &BTreeMap::new(), &read).text
}

fn module(text: &str) -> naga::Module {
    naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)))
}

fn words(module: &naga::Module) -> Vec<u32> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(module).expect("a valid module");
    let options = spv::Options {
        lang_version: (1, 5),
        force_loop_bounding: false,
        ..Default::default()
    };
    spv::write_vec(module, &info, &options, None).expect("SPIR-V")
}

#[test]
fn files_of_both_words_keep_their_functions_and_one_chooses() {
    let text = merged(MAIN, LOW, HIGH);
    for wanted in [
        "override FILTER: u32",
        "fn end_of_of_of_low(x: f32)",
        "fn end_of_of_of_high(y: f32)",
        "switch FILTER {",
        "x / by",
        "y * SCALEOf_of_high",
    ] {
        assert!(text.contains(wanted), "no {wanted:?} in\n{text}");
    }
    assert_eq!(text.matches("struct Numbers").count(), 1, "{text}");
    assert_eq!(text.matches("fn scaled(").count(), 0, "{text}");
    assert!(
        module(&text)
            .overrides
            .iter()
            .any(|(_, one)| one.id.is_some())
    );
}

#[test]
#[should_panic(expected = "has other parameters")]
fn a_function_of_other_parameters_is_not_for_other_files() {
    merged(&MAIN.replace("end_of(", "scaled("), LOW, HIGH);
}

#[test]
#[should_panic(expected = "is no function")]
fn a_structure_that_differs_is_not_for_other_files() {
    merged(MAIN, LOW, &HIGH.replace("d: array", "e: u32, d: array"));
}

#[test]
fn an_override_becomes_a_specialization_constant() {
    let mut module = module(&merged(MAIN, LOW, HIGH));
    constants::mark(&mut module);
    let plain = words(&module);
    let (words, ids) = constants::specialized(&plain);
    assert_eq!(ids, [alternatives::id_of("filter") as u32]);
    assert_eq!(count(&words, Op::SpecConstant), 1);
    assert_eq!(count(&words, Op::Switch), count(&plain, Op::Switch));
    assert_eq!(words.len(), plain.len() + 4, "one decoration more");
}

#[test]
#[should_panic(expected = "computed with")]
fn a_specialization_constant_is_not_computed_with() {
    let text = merged(MAIN, LOW, HIGH).replace("f32(id.x)", "f32(id.x + FILTER)");
    let mut module = module(&text);
    constants::mark(&mut module);
    constants::specialized(&words(&module));
}

#[test]
fn copies_of_parameters_are_chosen_against_their_buffers() {
    let text = "struct Frame { scale: f32, offset: vec4<f32> }
        struct Numbers { d: array<f32> }
        @id(0) override SOFTWARE: u32 = 0u;
        @group(0) @binding(0) var<uniform> frame: Frame;
        @group(0) @binding(1) var<storage, read_write> out: Numbers;
        var<private> copy: Frame;
        @compute @workgroup_size(8)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            copy.scale = frame.scale;
            copy.offset = frame.offset;
            out.d[id.x] = select(copy.scale, copy.offset.y, SOFTWARE == 7u);
        }";
    let mut module = module(text);
    constants::mark(&mut module);
    let (plain, ids) = constants::specialized(&words(&module));
    assert_eq!(ids, [0]);
    let chosen = uniform_loads::read_directly(0, &plain);
    // Each read of the copy is one of the buffer more.
    assert_eq!(count(&chosen, Op::Select), count(&plain, Op::Select) + 2);
    assert_eq!(count(&chosen, Op::Load), count(&plain, Op::Load) + 2);
    assert_eq!(count(&chosen, Op::SpecConstantOp), 1);
    assert_eq!(
        uniform_loads::read_directly(3, &plain),
        plain,
        "another constant"
    );
}

/// Constants choose a branch, one of two loops, a case that breaks out of its switch early, and one that returns.
const CHOOSING: &str = "struct Numbers { d: array<f32> }
    @id(1) override WAY: u32 = 0u;
    @id(2) override TURNS: u32 = 0u;
    @group(0) @binding(0) var<storage, read_write> out: Numbers;
    fn of_way(x: f32) -> f32 {
        switch WAY {
            case 0u: { return fast(x); }
            default: { return slow(x); }
        }
    }
    fn fast(x: f32) -> f32 { return x + x; }
    fn slow(x: f32) -> f32 {
        var sum = 0.0;
        for (var k = 0u; k < 8u; k += 1u) {
            if TURNS == 1u && sum > x { break; }
            if TURNS == 2u { return sum; }
            sum += out.d[k];
        }
        return sum;
    }
    @compute @workgroup_size(8)
    fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        var x = f32(id.x);
        switch WAY {
            case 0u: { x = 1.0; }
            default: {
                if x > 3.0 { break; }
                x = 2.0 * x;
            }
        }
        out.d[id.x] = of_way(x);
    }";

fn folded(way: u32, turns: u32) -> Vec<u32> {
    let mut module = module(CHOOSING);
    constants::mark(&mut module);
    let (words, _) = constants::specialized(&words(&module));
    fold::folded(&words, &[(1, way), (2, turns), (9, 9)])
}

#[test]
fn folding_leaves_what_the_constants_choose() {
    let fast = folded(0, 0);
    let counts = |words: &[u32]| {
        [Op::Function, Op::Switch, Op::LoopMerge, Op::SelectionMerge].map(|op| count(words, op))
    };
    assert_eq!(
        counts(&fast)[..3],
        [3, 1, 0],
        "main with its switch, of_way, fast"
    );
    let slow = folded(1, 0);
    assert_eq!(counts(&slow)[0], 3, "main, of_way, slow");
    assert_eq!(counts(&slow)[2], 1, "a loop");
    let leaves_early = folded(1, 1);
    let compared = [&slow, &leaves_early].map(|words| count(words, Op::FOrdGreaterThan));
    assert_eq!(compared, [1, 2], "x with 3, and the sum with x");
    assert_eq!(
        counts(&folded(1, 2))[2],
        1,
        "the loop is there, its end is not reached"
    );
    assert_eq!(count(&fast, Op::SpecConstant), 0);
}

#[test]
fn what_folding_leaves_is_valid() {
    let Some(validator) = SpirvVal::new() else {
        return;
    };
    for (way, turns) in [(0, 0), (1, 0), (1, 1), (1, 2), (7, 7)] {
        validator.assert_valid(&format!("{way} {turns}"), &folded(way, turns));
    }
}

#[test]
#[should_panic(expected = "constant 2 has no value")]
fn a_constant_without_a_value_is_no_variant() {
    let mut module = module(CHOOSING);
    constants::mark(&mut module);
    fold::folded(&constants::specialized(&words(&module)).0, &[(1, 0)]);
}
