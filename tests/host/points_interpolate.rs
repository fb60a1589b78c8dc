//! Scattered points to a field: what each method reproduces, how near it comes to a smooth field, and where it says nothing.

use glam::{DVec3, dvec3};
use stratavox::points::Points;
use stratavox::points::interpolate::{GridSize, Interpolation, Method, NoField, Options};

const MEANS: [Method; 4] = [
    Method::Shepard,
    Method::Idw,
    Method::Nearest,
    Method::Kernel,
];

/// Numbers from 0 to 1 in steps of 1/1024: quadratics of them have no more digits than f32.
struct Units(u32);

impl Units {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 22) / 1024.0
    }

    fn place(&mut self) -> DVec3 {
        dvec3(self.unit(), self.unit(), self.unit())
    }
}

/// Points of the unit cube.
fn places(count: usize) -> Vec<DVec3> {
    let mut units = Units(7);
    (0..count).map(|_| units.place()).collect()
}

/// Well inside of it.
fn queries() -> impl Iterator<Item = DVec3> {
    let mut units = Units(99);
    (0..2000).map(move |_| 0.2 + 0.6 * units.place())
}

fn points(places: &[DVec3], of: impl Fn(DVec3) -> f64) -> Points {
    let values = places.iter().map(|&place| of(place) as f32).collect();
    Points::new(places.to_vec(), values, None, None).expect("points")
}

fn field(points: &Points, method: Method) -> Interpolation {
    let options = Options {
        method,
        ..Options::default()
    };
    Interpolation::new(points, &options).expect("a field")
}

/// The largest error and the root of the mean square one.
fn errors(field: &Interpolation, of: impl Fn(DVec3) -> f64) -> [f64; 2] {
    let (mut largest, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for query in queries() {
        let error = field.at(query).expect("inside of the points") - of(query);
        largest = largest.max(error.abs());
        sum += error * error;
        count += 1;
    }
    [largest, (sum / f64::from(count)).sqrt()]
}

fn smooth(p: DVec3) -> f64 {
    (4.0 * p.x).sin() * (3.0 * p.y).cos() + p.z.powi(3)
}

fn quadratic(p: DVec3) -> f64 {
    p.x * p.x - 2.0 * p.y * p.z + 0.5 * p.x * p.y + 0.25 * p.x * p.z - p.z * p.z + p.z + 1.0
}

#[test]
fn constants_are_reproduced_and_values_at_points() {
    let places = places(600);
    let constant = points(&places, |_| 3.25);
    let varied = points(&places, smooth);
    for method in MEANS {
        let [largest, _] = errors(&field(&constant, method), |_| 3.25);
        assert!(largest <= 1e-14, "{method}: {largest}");
        if method == Method::Kernel {
            continue;
        }
        let field = field(&varied, method);
        for (place, &value) in places.iter().zip(varied.values()) {
            assert_eq!(
                field.at(*place),
                Some(f64::from(value)),
                "{method} at {place}"
            );
            // And next to it.
            let near = field.at(*place + 1e-9).expect("near a point");
            assert!(
                (near - f64::from(value)).abs() < 1e-6,
                "{method}: {near} {value}"
            );
        }
    }
}

#[test]
fn quadratics_are_reproduced_by_shepard() {
    let places = places(600);
    let [largest, _] = errors(
        &field(&points(&places, quadratic), Method::Shepard),
        quadratic,
    );
    assert!(largest <= 1e-9, "{largest}");
    // In a plane, level or not, and where heights are another unit.
    let level = |p: DVec3| dvec3(p.x, p.y, 7.0);
    let oblique = |p: DVec3| dvec3(p.x, p.y, 0.5 * p.x + 0.25 * p.y);
    let flat = |p: DVec3| dvec3(p.x, p.y, p.z / 64.0);
    for (name, to, anisotropy) in [
        ("level", &level as &dyn Fn(DVec3) -> DVec3, 1.0),
        ("oblique", &oblique, 2.0),
        ("flat", &flat, 64.0),
        ("flat, heights as they are", &flat, 1.0),
    ] {
        let places: Vec<DVec3> = places.iter().map(|&p| to(p)).collect();
        let of = |p: DVec3| p.x * p.x - 2.0 * p.x * p.y + 0.5 * p.y + p.z;
        let options = Options {
            anisotropy,
            reach: Some(1.0),
            ..Options::default()
        };
        let field = Interpolation::new(&points(&places, of), &options).expect("a field");
        assert_eq!(field.is_plane(), !name.starts_with("flat"), "{name}");
        for query in queries().map(to) {
            let found = field.at(query).expect("near");
            // Heights have more digits than f32 where they are divided or multiplied.
            let tolerance = if name == "level" { 1e-9 } else { 1e-5 };
            assert!(
                (found - of(query)).abs() < tolerance,
                "{name}: {found} for {}",
                of(query)
            );
        }
    }
}

#[test]
fn points_on_a_lattice_and_fewer_than_neighbours_make_a_field_too() {
    let steps = || (0..6).map(f64::from);
    let lattice: Vec<DVec3> = steps()
        .flat_map(|x| steps().flat_map(move |y| steps().map(move |z| dvec3(x, y, z) / 8.0)))
        .collect();
    let layers: Vec<DVec3> = lattice.iter().filter(|p| p.z < 0.2).copied().collect();
    let linear = |p: DVec3| 1.0 + 2.0 * p.x - p.y + 0.5 * p.z;
    for (name, places) in [
        ("cube", lattice),
        ("two layers", layers),
        ("few", places(11)),
    ] {
        let field = field(&points(&places, linear), Method::Shepard);
        for place in &places {
            let query = *place * 0.9 + 0.03;
            let found = field.at(query).expect("near");
            assert!(
                (found - linear(query)).abs() < 1e-9,
                "{name}: {found} {}",
                linear(query)
            );
        }
    }
}

#[test]
fn noise_does_not_send_shepard_astray_outside_of_its_points() {
    let mut units = Units(3);
    // Clusters a hundredth as wide as they are apart.
    let places: Vec<DVec3> = (0..400)
        .map(|i| dvec3(f64::from(i % 4), f64::from(i % 2), 0.0) + 0.01 * units.place())
        .collect();
    let values: Vec<f32> = (0..400).map(|_| units.unit() as f32).collect();
    let points = Points::new(places, values, None, None).expect("points");
    let options = Options {
        reach: Some(9.0),
        ..Options::default()
    };
    let field = Interpolation::new(&points, &options).expect("a field");
    for query in queries().map(|p| 3.0 * p) {
        let found = field.at(query).expect("within reach");
        assert!(
            (-2.0..=3.0).contains(&found),
            "{found} of values from 0 to 1"
        );
    }
}

#[test]
fn what_lies_in_a_plane_to_a_millionth_is_a_field_in_it() {
    let mut units = Units(8);
    let values: Vec<f32> = (0..200).map(|_| units.unit() as f32).collect();
    let by = |thickness: f64| {
        let mut units = Units(21);
        let place = |_| units.place() * dvec3(1.0, 1.0, thickness);
        let places = (0..200).map(place).collect();
        let points = Points::new(places, values.clone(), None, None).expect("points");
        field(&points, Method::Shepard)
    };
    let (exact, rough) = (by(0.0), by(5e-7));
    assert!(rough.is_plane() && !by(2e-6).is_plane());
    for query in queries().map(|p| dvec3(p.x, p.y, 0.0)) {
        let [a, b] = [&exact, &rough].map(|field| field.at(query).expect("near"));
        assert!((a - b).abs() < 1e-4, "{a} {b}");
    }
}

#[test]
fn a_smooth_field_of_600_points_is_as_near_as_the_table_says() {
    let points = points(&places(600), smooth);
    // Of 60 queries and other points, a fifth more.
    for (method, table) in [
        (Method::Nearest, 1.1e-1),
        (Method::Idw, 6.5e-2),
        (Method::Shepard, 4.8e-3),
    ] {
        let [_, rms] = errors(&field(&points, method), smooth);
        println!("{method}: rms {rms:.2e}, table {table:.1e}");
        assert!(rms <= 1.2 * table, "{method}: {rms}");
        assert!(
            rms >= 0.5 * table,
            "{method}: {rms} is better than it can be"
        );
    }
}

#[test]
fn the_integral_of_a_density_is_the_weight_of_the_points() {
    let places = places(200);
    let weights: Vec<f32> = (0..200).map(|i| (i % 5) as f32).collect();
    let heavy = Points::new(places.clone(), vec![1.0; 200], None, Some(weights));
    let heavy = heavy.expect("points");
    let light = points(&places, |_| 9.0);
    let oblique: Vec<DVec3> = places
        .iter()
        .map(|p| dvec3(p.x, p.y, 2.0 * p.x - p.y))
        .collect();
    let oblique = points(&oblique, |_| 9.0);
    for (points, wanted, anisotropy) in [
        (&light, 200.0, 1.0),
        (&heavy, 400.0, 3.0),
        (&oblique, 200.0, 2.5),
    ] {
        let options = Options {
            method: Method::Density,
            anisotropy,
            ..Options::default()
        };
        let field = Interpolation::new(points, &options).expect("a field");
        let grid = field.grid(GridSize::Auto, 1 << 30).expect("a grid");
        let values = field.values_on(&grid);
        assert!(values.iter().all(|value| *value >= 0.0));
        let sum: f64 = values.iter().copied().map(f64::from).sum();
        let axes = grid.world_from_voxel.matrix3;
        let voxel = match field.is_plane() {
            false => axes.determinant().abs(),
            true => axes.x_axis.cross(axes.y_axis).length(),
        };
        let integral = sum * voxel;
        assert!(
            (integral / wanted - 1.0).abs() < 2e-3,
            "{integral} {wanted}"
        );
    }
    // One point alone has the kernel's peak, 21 / (2 pi R^3).
    let far = [
        DVec3::ZERO,
        DVec3::X * 50.0,
        DVec3::Y * 50.0,
        DVec3::Z * 50.0,
    ];
    let options = Options {
        method: Method::Density,
        reach: Some(2.0),
        ..Options::default()
    };
    let field = Interpolation::new(&points(&far, |_| 1.0), &options).expect("a field");
    let peak = field.at(DVec3::ZERO).expect("a density");
    let wanted = 21.0 / (16.0 * std::f64::consts::PI);
    assert!((peak - wanted).abs() < 1e-14, "{peak} {wanted}");
    let half = field.at(DVec3::X).expect("a density");
    assert!((half / peak - 3.0 / 16.0).abs() < 1e-14, "{half}");
    assert_eq!(field.at(DVec3::splat(20.0)), Some(0.0));
}

#[test]
fn beyond_the_reach_there_are_no_data() {
    let points = points(&places(100), smooth);
    for method in MEANS {
        let default = field(&points, method);
        assert!((default.reach() - 3.0 * default.mean_distance()).abs() < 1e-15);
        let options = Options {
            method,
            reach: Some(0.25),
            ..Options::default()
        };
        let field = Interpolation::new(&points, &options).expect("a field");
        let places = points.places();
        let (mut inside, mut outside) = (0, 0);
        let mut units = Units(5);
        for _ in 0..3000 {
            let query = units.place() * 2.0 - 0.5;
            let nearest = places
                .iter()
                .map(|p| p.distance(query))
                .fold(f64::INFINITY, f64::min);
            assert_eq!(
                field.at(query).is_some(),
                nearest < 0.25,
                "{method} at {query}: {nearest}"
            );
            inside += usize::from(nearest < 0.25);
            outside += usize::from(nearest >= 0.25);
        }
        assert!(inside > 500 && outside > 500);
        let grid = field
            .grid(GridSize::Voxels([20, 20, 20]), 1 << 30)
            .expect("a grid");
        let volume = field.volume_on(&grid).expect("a volume");
        let valid = volume
            .validity
            .map_or(8000, |mask| mask.iter().filter(|&&v| v == 1).count());
        let values = field.values_on(&grid);
        assert_eq!(valid, values.iter().filter(|value| !value.is_nan()).count());
    }
    // As nobody says it: as far as that, and not farther.
    let near = field(&points, Method::Idw);
    let beside = points
        .places()
        .iter()
        .fold(DVec3::ZERO, |far, p| if p.x > far.x { *p } else { far });
    assert!(near.at(beside + DVec3::X * near.reach() * 0.999).is_some());
    assert!(near.at(beside + DVec3::X * (1.0 + near.reach())).is_none());
}

#[test]
fn distances_along_z_count_as_often_as_is_said() {
    let places = [
        DVec3::ZERO,
        dvec3(3.0, 0.0, 0.6),
        dvec3(0.0, 9.0, 0.0),
        dvec3(0.0, 0.0, 1.0),
    ];
    let points = Points::new(places.to_vec(), vec![0.0, 1.0, 2.0, 3.0], None, None);
    let points = points.expect("points");
    let value = |anisotropy| {
        let options = Options {
            method: Method::Nearest,
            anisotropy,
            ..Options::default()
        };
        let field = Interpolation::new(&points, &options).expect("a field");
        // As high as the second point, nearer to the last along x.
        field.at(dvec3(1.4, 0.0, 0.6)).expect("a value")
    };
    assert_eq!(value(1.0), 3.0);
    assert_eq!(value(5.0), 1.0);
}

#[test]
fn points_at_one_place_are_their_mean() {
    let mut places = places(20);
    places[7] = places[3];
    let mut values = vec![1.0; 20];
    (values[3], values[7]) = (2.0, 6.0);
    let points = Points::new(places.clone(), values, None, None).expect("points");
    for method in [Method::Shepard, Method::Idw, Method::Nearest] {
        let field = field(&points, method);
        assert_eq!(field.at(places[3]), Some(4.0), "{method}");
        assert_eq!(field.merged_places(), 1);
    }
}

#[test]
fn what_makes_no_field_is_refused() {
    let refused = |places: &[DVec3], options: Options| {
        let error = Interpolation::new(&points(places, |_| 1.0), &options);
        error.expect_err("no field")
    };
    let by = |method| Options {
        method,
        ..Options::default()
    };
    let three = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let few = refused(&three, by(Method::Shepard));
    assert_eq!(few.to_string(), "3 points: wanted at least 11 for shepard");
    // Of one place ten times there is one.
    let again: Vec<DVec3> = (0..30).map(|i| three[i % 3]).collect();
    assert_eq!(refused(&again, by(Method::Shepard)), few);
    assert!(Interpolation::new(&points(&three, |_| 1.0), &by(Method::Idw)).is_ok());
    let line: Vec<DVec3> = (0..30)
        .map(|i| dvec3(1.0, 2.0, 3.0) * f64::from(i))
        .collect();
    for method in [
        Method::Shepard,
        Method::Idw,
        Method::Nearest,
        Method::Kernel,
        Method::Density,
    ] {
        assert_eq!(refused(&line, by(method)), NoField::OnOneLine, "{method}");
    }
    assert_eq!(
        refused(&[DVec3::ONE; 12], by(Method::Idw)),
        NoField::OnOneLine
    );
    for reach in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let reach = Some(reach);
        let options = Options {
            reach,
            ..by(Method::Idw)
        };
        assert_eq!(refused(&three, options), NoField::NoLength);
    }
    let options = Options {
        anisotropy: 0.0,
        ..by(Method::Idw)
    };
    assert_eq!(refused(&three, options), NoField::NoLength);
    let huge: Vec<DVec3> = places(20).iter().map(|p| *p * 1e200).collect();
    assert_eq!(refused(&huge, by(Method::Idw)), NoField::NoLength);
}
