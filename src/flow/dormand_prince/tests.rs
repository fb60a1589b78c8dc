//! The formula against its laws, and each of its numbers against a wrong one.

use super::{DORMAND_PRINCE, Dense, STAGES, Step, Tableau, step_by};
use glam::DVec3;
use std::convert::Infallible;
use std::f64::consts::TAU;

/// v = (-y, x, 0.3): helices of radius 1 about z.
fn helix(_: f64, p: DVec3) -> Result<DVec3, Infallible> {
    Ok(DVec3::new(-p.y, p.x, 0.3))
}

/// Steps along one turn, each given to `see` with its number.
fn turn(table: &Tableau, steps: u32, mut see: impl FnMut(u32, &Step)) -> DVec3 {
    let duration = TAU / f64::from(steps);
    let mut place = DVec3::X;
    let Ok(mut velocity) = helix(0.0, place);
    for i in 0..steps {
        let time = f64::from(i) * duration;
        let Ok(step) = step_by(table, helix, time, place, duration, velocity);
        see(i, &step);
        (place, velocity) = (step.end, step.last_velocity());
    }
    place
}

/// What a turn is off by: at its end, and at most in between.
fn errors(steps: u32, dense_at: impl Fn(&Step, f64) -> DVec3) -> [f64; 2] {
    let mut between: f64 = 0.0;
    let end = turn(&DORMAND_PRINCE, steps, |i, step| {
        for part in [0.25, 0.5, 0.75] {
            let angle = (f64::from(i) + part) * TAU / f64::from(steps);
            let exact = DVec3::new(angle.cos(), angle.sin(), 0.3 * angle);
            let off = (dense_at(step, part) - exact).abs().max_element();
            between = between.max(off);
        }
    });
    [end.distance(DVec3::new(1.0, 0.0, 0.3 * TAU)), between]
}

/// How fast errors fall from 32 to 64 steps a turn, as a power of the step.
fn orders(dense_at: impl Fn(&Step, f64) -> DVec3) -> [f64; 2] {
    let [coarse, fine] = [32, 64].map(|steps| errors(steps, &dense_at));
    [0, 1].map(|i| (coarse[i] / fine[i]).log2())
}

#[test]
fn the_formula_is_of_order_five_and_its_polynomial_of_order_four_to_five() {
    let [end, between] = orders(|step, part| step.dense().at(part));
    // Measured with numpy: 5.01 and 4.89.
    assert!((end - 5.0).abs() < 0.1, "order {end}");
    assert!((4.8..5.2).contains(&between), "dense order {between}");
    // A cubic through both ends with both velocities is of order 4: the test tells it apart.
    let [_, cubic] = orders(|step, s| {
        let rest = 1.0 - s;
        let [first, last] = [step.stages[0], step.last_velocity()].map(|v| step.duration * v);
        (1.0 + 2.0 * s) * rest * rest * step.start
            + s * rest * rest * first
            + s * s * (3.0 - 2.0 * s) * step.end
            - s * s * rest * last
    });
    assert!(cubic < 4.3, "order of the cubic {cubic}");
}

/// |1 + z + z²/2 + z³/6 + z⁴/24 + z⁵/120 + z⁶/600|, z = i h: what one step does to the radius of a circle.
fn radius_factor(h: f64) -> f64 {
    let real = 1.0 - h.powi(2) / 2.0 + h.powi(4) / 24.0 - h.powi(6) / 600.0;
    let imaginary = h - h.powi(3) / 6.0 + h.powi(5) / 120.0;
    real.hypot(imaginary)
}

/// How far the radius after a turn is from the law.
fn off_the_helix_law(table: &Tableau, steps: u32) -> f64 {
    let end = turn(table, steps, |_, _| ());
    let law = radius_factor(TAU / f64::from(steps)).powi(steps as i32);
    (end.x.hypot(end.y) - law).abs()
}

#[test]
fn the_radius_of_a_helix_follows_the_stability_function_to_rounding() {
    for steps in [8, 16, 32, 64] {
        let off = off_the_helix_law(&DORMAND_PRINCE, steps);
        // A step rounds its sum, a stage and a product, each once in 2^53, and the power of the law rounds as often.
        let rounding = f64::from(steps) * 4.0 * f64::EPSILON / 2.0;
        assert!(off <= rounding, "{steps} steps: {off:e}, {rounding:e}");
    }
}

/// Nonlinear, and of time.
fn golden_field(t: f64, p: DVec3) -> Result<DVec3, Infallible> {
    Ok(DVec3::new(
        p.y.sin() + t * p.x,
        p.x * p.x - t.cos(),
        0.1 * p.z * p.x,
    ))
}

/// The end of one step of it, its error, and its polynomial at 0.4.
fn golden_step(table: &Tableau) -> [DVec3; 3] {
    let (time, start, duration) = (0.3, DVec3::new(0.7, -0.4, 1.1), 0.37);
    let Ok(first) = golden_field(time, start);
    let Ok(step) = step_by(table, golden_field, time, start, duration, first);
    let dense: Dense = step.dense_by(table);
    [step.end, step.error_by(table), dense.at(0.4)]
}

/// By `p40_mutants.py` of the design, in numpy.
const GOLDEN: [DVec3; 3] = [
    DVec3::new(
        0.648_489_271_421_800_8,
        -0.558_446_613_231_069_3,
        1.127_680_700_311_720_4,
    ),
    DVec3::new(
        -1.629_448_197_593_315_3e-6,
        -3.372_722_244_897_354e-6,
        -2.861_776_886_452_986e-7,
    ),
    DVec3::new(
        0.675_775_126_469_885_2,
        -0.467_682_577_719_640_7,
        1.111_249_735_490_826_6,
    ),
];

/// The tests that a table does not pass.
fn failures(table: &Tableau) -> Vec<&'static str> {
    let mut failed = Vec::new();
    if off_the_helix_law(table, 16) > 1e-12 {
        failed.push("helix law");
    }
    let golden = golden_step(table).into_iter().zip(GOLDEN);
    if golden
        .map(|(a, b)| (a - b).abs().max_element())
        .fold(0.0, f64::max)
        > 1e-11
    {
        failed.push("golden step");
    }
    let rows = table.a.iter().zip(table.c);
    if rows
        .map(|(row, c)| (row.iter().sum::<f64>() - c).abs())
        .fold(0.0, f64::max)
        > 1e-13
    {
        failed.push("row sums");
    }
    if table.e.iter().sum::<f64>().abs() > 1e-13 {
        failed.push("sum of errors");
    }
    failed
}

#[test]
fn each_wrong_number_of_the_table_is_found() {
    assert_eq!(failures(&DORMAND_PRINCE), [""; 0]);
    let mut survivors = Vec::new();
    let mut count = 0;
    let mut change = |name: &str, number: fn(&mut Tableau, usize) -> &mut f64, indices: usize| {
        for i in 0..indices {
            let mut table = DORMAND_PRINCE;
            let number = number(&mut table, i);
            *number += if *number == 0.0 { 1e-6 } else { *number * 1e-6 };
            if failures(&table).is_empty() {
                survivors.push(format!("{name}{i}"));
            }
            count += 1;
        }
    };
    // Row i of the triangle begins at i (i - 1) / 2.
    change(
        "a",
        |table, at| {
            let row = (1..STAGES).rfind(|i| i * (i - 1) / 2 <= at).unwrap_or(1);
            &mut table.a[row][at - row * (row - 1) / 2]
        },
        21,
    );
    change("c", |table, i| &mut table.c[i], STAGES);
    change("e", |table, i| &mut table.e[i], STAGES);
    change("d", |table, i| &mut table.d[i], STAGES);
    assert_eq!(count, 42);
    assert_eq!(survivors, [""; 0]);
}
