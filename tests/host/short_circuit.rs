//! What the build makes of `&&` and `||`: no branch where the second side costs nothing, and a branch where it does.

#[path = "../../shaders/short_circuit.rs"]
mod pass;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Block, Module, Statement};

/// A shader of one pass that asks `question`, which may use the words below.
fn module(question: &str) -> Module {
    let text = format!(
        "struct Frame {{ limit: f32, count: u32 }}
        struct Points {{ d: array<f32> }}
        @group(0) @binding(0) var<uniform> frame: Frame;
        @group(0) @binding(1) var<storage, read> points: Points;
        @group(0) @binding(2) var<storage, read_write> out: Points;
        @group(0) @binding(3) var volume: texture_3d<f32>;
        fn is_far(x: f32) -> bool {{ return x > 8.0; }}
        @compute @workgroup_size(8)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
            let k = id.x;
            let x = f32(k);
            var y = 0.0;
            var is_so = false;
            {question}
            out.d[k] = select(y, 1.0, is_so);
        }}"
    );
    naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)))
}

fn branches(block: &Block) -> usize {
    let of = |statement: &Statement| match statement {
        Statement::If { accept, reject, .. } => 1 + branches(accept) + branches(reject),
        Statement::Block(inner) => branches(inner),
        Statement::Loop {
            body, continuing, ..
        } => branches(body) + branches(continuing),
        Statement::Switch { cases, .. } => cases.iter().map(|case| branches(&case.body)).sum(),
        _ => 0,
    };
    block.iter().map(of).sum()
}

/// How many branches there are, before and after.
fn counts(question: &str) -> [usize; 2] {
    let mut module = module(question);
    let before = branches(&module.entry_points[0].function.body);
    pass::evaluate_both_operands(&mut module);
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{question}: {e:?}"));
    [before, branches(&module.entry_points[0].function.body)]
}

#[test]
fn a_second_side_that_costs_nothing_is_asked_without_a_branch() {
    for (question, before) in [
        ("is_so = x > 1.0 && x < frame.limit;", 1),
        ("is_so = x > 1.0 || x < frame.limit;", 1),
        ("is_so = x > 1.0 && (x < 2.0 || (x > 3.0 && x < 4.0));", 3),
        ("while y < x && y < 9.0 { y += 1.0; }", 2),
    ] {
        let is_loop = question.starts_with("while");
        assert_eq!(
            counts(question),
            [before, usize::from(is_loop)],
            "{question}"
        );
    }
}

#[test]
fn a_second_side_that_the_first_has_to_allow_stays_behind_its_branch() {
    for question in [
        "is_so = k < frame.count && points.d[k] > 1.0;",
        "is_so = k < 4u || textureLoad(volume, vec3<i32>(0), 0).x > 1.0;",
        "is_so = x > 1.0 && is_far(x);",
        // What has a name is read elsewhere.
        "if x > 1.0 { is_so = x > 2.0; } else { is_so = false; }",
        "if x > 1.0 { y = 2.0; is_so = x > 2.0; } else { is_so = false; }",
    ] {
        assert_eq!(counts(question), [1, 1], "{question}");
    }
}
