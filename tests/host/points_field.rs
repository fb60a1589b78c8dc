//! The field of scattered points that rays are cast through: against closed forms, sums over all points, and the fields that
//! grids are made of.

use glam::{DVec3, dvec3};
use stratavox::points::interpolate::{GridSize, Interpolation, Method, Options};
use stratavox::points::{FieldKernel, PointField, Points, Quantity};

/// Numbers from 0 to 1 without a pattern.
fn random(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(2_654_435_761) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        f64::from(state) / f64::from(u32::MAX)
    }
}

/// Points of a box far from the origin, each seventh where the one before it is, with weights, some of them 0.
fn cloud(count: usize, seed: u32) -> Points {
    let mut unit = random(seed);
    let mut places: Vec<DVec3> = (0..count)
        .map(|_| dvec3(40.0, -30.0, 2.0) + dvec3(8.0, 5.0, 3.0) * dvec3(unit(), unit(), unit()))
        .collect();
    for i in (6..count).step_by(7) {
        places[i] = places[i - 1];
    }
    let values = (0..count).map(|_| unit() as f32).collect();
    let weights = (0..count).map(|i| if i % 9 == 0 { 0.0 } else { 2.0 * unit() as f32 });
    Points::new(places, values, None, Some(weights.collect())).expect("points")
}

fn one(place: DVec3) -> Points {
    Points::new(vec![place], vec![3.0], None, None).expect("a point")
}

fn field(points: &Points, radius: f64, quantity: Quantity) -> PointField {
    PointField::new(points, FieldKernel { radius, quantity })
}

/// Integral of the kernel of radius 1 along a line that passes the point at distance b: with J_n that of r^n,
/// J0 - 10 J2 + 20 J3 - 15 J4 + 4 J5.
fn along_line(b: f64) -> f64 {
    let half = (1.0 - b * b).max(0.0).sqrt();
    let below_first = if b > 0.0 {
        2.0 * (half / b).asinh()
    } else {
        0.0
    };
    let mut j = vec![2.0 * half, half + 0.5 * b * b * below_first];
    for n in 2..=5 {
        let order = n as f64;
        j.push((2.0 * half + order * b * b * j[n - 2]) / (order + 1.0));
    }
    j[0] - 10.0 * j[2] + 20.0 * j[3] - 15.0 * j[4] + 4.0 * j[5]
}

#[test]
fn the_x_ray_of_a_point_is_the_closed_form_and_the_midpoint_rule_is_of_order_four() {
    let (radius, place) = (2.5, dvec3(7.0, -3.0, 11.0));
    let field = field(&one(place), radius, Quantity::Density);
    let norm = 2.0 * std::f64::consts::PI / 21.0 * radius.powi(3);
    // Largest error over lines and over where steps begin, steps of R / n.
    let error = |n: u32| {
        let h = radius / f64::from(n);
        let mut worst = 0.0_f64;
        for i in 0..10 {
            let b = f64::from(i) / 10.0;
            let wanted = radius * along_line(b) / norm;
            for phase in 0..8 {
                let start = -radius - h * f64::from(phase) / 8.0;
                let samples = 0..2 * n + 2;
                let at = |k: u32| {
                    place
                        + dvec3(0.6, 0.8, 0.0) * (b * radius)
                        + DVec3::Z * (start + (f64::from(k) + 0.5) * h)
                };
                let sum: f64 = samples.map(|k| field.at(at(k)).unwrap_or(0.0) * h).sum();
                worst = worst.max((sum - wanted).abs() * norm / radius);
            }
        }
        worst
    };
    let errors = [10, 20, 40].map(error);
    for (error, n) in errors.into_iter().zip([10.0_f64, 20.0, 40.0]) {
        // h^4 / 4! times the largest Bernoulli polynomial of order 4, 1/30, times the variation of the third derivative: on the
        // line through the point 540, a jump of 240 there and 150 on either side.
        assert!(error <= 540.0 / 720.0 / n.powi(4), "{error}");
        // The jump alone.
        assert!(error >= 0.9 * 240.0 / 720.0 / n.powi(4), "{error}");
    }
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((ratio - 16.0).abs() < 0.5, "{ratio}");
    }
    assert!((errors[0] - 3.3e-5).abs() < 0.2e-5, "{errors:?}");
}

#[test]
fn a_field_is_that_of_the_grid_and_of_sums_over_all_points() {
    let wendland = |r: f64| (1.0 - r).max(0.0).powi(4) * (4.0 * r + 1.0);
    // Cells of R, cells that are wider because there would be too many, and one cell.
    for (radius, factor) in [(0.7, 1.0), (0.7, 3.0), (0.02, 1.0), (30.0, 1.0)] {
        let points = cloud(300, 5);
        let stretched = points.clone().stretched(factor);
        let methods = [
            (Method::Kernel, Quantity::Mean),
            (Method::Density, Quantity::Density),
        ];
        for (method, quantity) in methods {
            let field = field(&stretched, radius, quantity);
            let options = Options {
                method,
                reach: Some(radius),
                anisotropy: factor,
            };
            let other = Interpolation::new(&points, &options).expect("a field");
            let grid = other
                .grid(GridSize::Voxels([13, 12, 11]), 1 << 20)
                .expect("a grid");
            let mut seen = 0;
            let voxels = (0..13 * 12 * 11)
                .map(|i| dvec3((i % 13).into(), (i / 13 % 12).into(), (i / 156).into()));
            let centers = voxels.map(|voxel| grid.world_from_voxel.transform_point3(voxel + 0.5));
            // There is a point or two in the thinnest balls.
            let places =
                centers.chain(points.places().iter().map(|&p| p + 0.3 * radius * DVec3::X));
            for place in places {
                let drawn = place * dvec3(1.0, 1.0, factor);
                let (mut sum, mut weights) = (0.0, 0.0);
                for (i, p) in stretched.places().iter().enumerate() {
                    let w = f64::from(points.weight(i)) * wendland(p.distance(drawn) / radius);
                    sum += w * f64::from(points.values()[i]);
                    weights += w;
                }
                // A place is off by an ulp of 100, a kernel by as much of its slope, which is under 2.2 / R, of 300 points of
                // weight 2 at most; each sum rounds 300 times.
                let error = 600.0 * (2.2 * 3.0 * 1.5e-14 / radius + 1e-15);
                let found = field.at(drawn);
                if weights <= 1e3 * error {
                    continue;
                }
                seen += 1;
                let norm = 2.0 * std::f64::consts::PI / 21.0 * radius.powi(3) / factor;
                let (wanted, allowed) = match quantity {
                    Quantity::Mean => (sum / weights, 2.0 * error / (weights - error)),
                    Quantity::Density => (weights / norm, error / norm),
                };
                let found = found.expect("a point is near");
                assert!(
                    (found - wanted).abs() <= allowed,
                    "{found} {wanted} {allowed}"
                );
                let on_grid = other.at(place).expect("a point is near");
                assert!(
                    (found - on_grid).abs() <= 2.0 * allowed,
                    "{found} {on_grid}"
                );
            }
            assert!(seen > 250, "{seen}");
        }
    }
}

#[test]
fn there_are_no_data_where_no_point_is_near() {
    let place = dvec3(1.0, 2.0, 3.0);
    for quantity in [Quantity::Mean, Quantity::Density] {
        let field = field(&one(place), 0.5, quantity);
        assert_eq!(field.at(place + 0.5001 * DVec3::X), None);
        assert_eq!(field.at(place - 1e9 * DVec3::Y), None);
        assert!(field.at(place + 0.4999 * DVec3::Z).is_some());
    }
    assert_eq!(field(&one(place), 0.5, Quantity::Mean).at(place), Some(3.0));
}

#[test]
fn what_a_mean_is_off_from_a_quadratic_goes_with_the_square_of_the_radius() {
    let side = 33;
    let places = (0..side * side * side).map(|i| {
        dvec3(
            (i % side).into(),
            (i / side % side).into(),
            (i / (side * side)).into(),
        ) / 32.0
    });
    let places: Vec<DVec3> = places.collect();
    let values = places.iter().map(|p| (p.x * p.x) as f32).collect();
    let points = Points::new(places, values, None, None).expect("points");
    let middle = DVec3::splat(0.5);
    let error = |radius| {
        field(&points, radius, Quantity::Mean)
            .at(middle)
            .expect("points")
            - 0.25
    };
    let [wide, narrow] = [0.4, 0.2].map(error);
    assert!((wide / narrow - 4.0).abs() < 0.1, "{}", wide / narrow);
    // Of r^2 the kernel's mean is R^2 / 5, of its square along an axis a third of that; the lattice adds 2 %.
    assert!((wide * 15.0 / 0.16 - 1.0).abs() < 0.02, "{wide}");
}

#[test]
fn cells_know_how_far_the_next_point_is_and_how_many_are_near() {
    let points = cloud(60, 8);
    let field = field(&points, 0.3, Quantity::Mean);
    let [nx, ny, nz] = field.counts();
    let cells: Vec<[u32; 3]> = (0..nx * ny * nz)
        .map(|i| [i % nx, i / nx % ny, i / (nx * ny)])
        .collect();
    let starts = field.starts();
    assert_eq!(starts.len(), cells.len() + 1);
    let held = |cell: usize| starts[cell + 1] - starts[cell];
    let full: Vec<_> = (0..cells.len()).filter(|&cell| held(cell) > 0).collect();
    let between = |a: usize, b: usize| {
        let apart = |k: usize| cells[a][k].abs_diff(cells[b][k]);
        apart(0).max(apart(1)).max(apart(2))
    };
    let distances = field.distances();
    let mut most = 0;
    for cell in 0..cells.len() {
        let nearest = full.iter().map(|&other| between(cell, other)).min();
        assert_eq!(Some(distances[cell]), nearest, "{:?}", cells[cell]);
        let near = full.iter().filter(|&&other| between(cell, other) <= 1);
        most = most.max(near.map(|&other| held(other)).sum());
    }
    assert_eq!(field.most_near(), most);
    assert!(distances.iter().any(|&d| d > 2));
}
