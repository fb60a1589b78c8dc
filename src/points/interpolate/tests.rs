use super::*;
use glam::dvec3;

const METHODS: [Method; 5] = [
    Method::Shepard,
    Method::Idw,
    Method::Nearest,
    Method::Kernel,
    Method::Density,
];

/// Points in two clusters, with a gap that no reach spans.
fn points() -> Points {
    let mut state = 3_u32;
    let mut unit = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    let places: Vec<DVec3> = (0..300)
        .map(|i| dvec3(unit() + f64::from(i % 2) * 4.0, unit(), 0.3 * unit()))
        .collect();
    let values = places.iter().map(|p| (3.0 * p.x).sin() as f32).collect();
    Points::new(places, values, None, None).expect("points")
}

fn of(method: Method) -> Options {
    Options {
        method,
        anisotropy: 2.0,
        ..Options::default()
    }
}

#[test]
fn any_number_of_threads_makes_the_same_bytes() {
    for method in METHODS {
        let bits = |threads| {
            let field = Interpolation::by(&points(), &of(method), threads).expect("a field");
            let grid = field
                .grid(GridSize::Voxels([60, 9, 7]), 1 << 30)
                .expect("a grid");
            let values = field.values_by(&grid, threads, &|_| {});
            values
                .iter()
                .map(|value| value.to_bits())
                .collect::<Vec<_>>()
        };
        let one = bits(1);
        for threads in [2, 3, 16] {
            assert!(bits(threads) == one, "{method}, {threads} threads");
        }
    }
}

#[test]
fn a_voxel_has_the_value_of_its_centre_whatever_was_before_it() {
    for method in METHODS {
        let field = Interpolation::new(&points(), &of(method)).expect("a field");
        let grid = field
            .grid(GridSize::Voxels([90, 8, 7]), 1 << 30)
            .expect("a grid");
        let values = field.values_on(&grid);
        let mut holes = 0;
        for (i, value) in values.iter().enumerate() {
            let index = [i % 90, i / 90 % 8, i / 720].map(|n| n as f64 + 0.5);
            let center = grid.world_from_voxel.transform_point3(index.into());
            let wanted = field.at(center);
            holes += usize::from(wanted.is_none());
            let wanted = wanted.unwrap_or(f64::NAN);
            let is_same = value.is_nan() && wanted.is_nan()
                || (f64::from(*value) - wanted).abs() <= 1e-6 * (1.0 + wanted.abs());
            assert!(is_same, "{method}: {value} for {wanted}");
        }
        assert_eq!(holes > 0, method != Method::Density, "{method}: {holes}");
    }
}

#[test]
fn grids_hold_their_points_and_those_of_nobody_are_small() {
    let field = Interpolation::new(&points(), &of(Method::Idw)).expect("a field");
    let [low, high] = super::super::distances::bounds(points().places.iter().copied());
    for size in [
        GridSize::Auto,
        GridSize::Spacing(0.07),
        GridSize::Voxels([9, 5, 3]),
    ] {
        let grid = field.grid(size, 1 << 30).expect("a grid");
        let center = |corner: DVec3| grid.world_from_voxel.transform_point3(corner);
        let [first, last] = [center(DVec3::splat(0.5)), center(grid.far_corner() - 0.5)];
        assert!(
            first.cmple(low + 1e-9).all() && last.cmpge(high - 1e-9).all(),
            "{grid:?}"
        );
        match size {
            GridSize::Auto => {
                // 255 steps are as long as the box: finer steps would be asked for by the distances.
                let step = (0.5 * field.mean_distance()).max((high.x - low.x) / 255.0);
                assert!((grid.spacing()[0] / step - 1.0).abs() < 1e-9);
                assert!((grid.spacing()[2] * 2.0 / step - 1.0).abs() < 1e-9);
                assert!(grid.dims.into_iter().all(|n| n <= 256), "{grid:?}");
            }
            GridSize::Spacing(spacing) => {
                let wanted = [spacing, spacing, 0.5 * spacing];
                let apart = (0..3).map(|k| (grid.spacing()[k] / wanted[k] - 1.0).abs());
                assert!(apart.fold(0.0, f64::max) < 1e-12);
            }
            GridSize::Voxels(dims) => {
                assert_eq!(grid.dims, dims);
                assert!((last - high).abs().max_element() < 1e-9);
            }
        }
    }
    // One point so far away that half of the mean distance makes more voxels than there may be.
    let mut places = points().places;
    places.push(dvec3(900.0, 0.5, 0.1));
    let lone = Points::new(places, vec![1.0; 301], None, None).expect("points");
    let lone = Interpolation::new(&lone, &of(Method::Idw)).expect("a field");
    let grid = lone.grid(GridSize::Auto, 1 << 30).expect("a grid");
    assert_eq!(grid.dims[0], 256, "{}", lone.mean_distance());
    let far = Interpolation::new(&points(), &of(Method::Density)).expect("a field");
    let wide = far.grid(GridSize::Auto, 1 << 30).expect("a grid");
    let corner = wide.world_from_voxel.transform_point3(DVec3::splat(0.5));
    assert!(
        corner
            .cmple(low - far.reach() * dvec3(1.0, 1.0, 0.5) + 1e-9)
            .all()
    );
    let refused = |size| field.grid(size, 4000).expect_err("no grid");
    assert_eq!(
        refused(GridSize::Voxels([1000, 2, 1])).to_string(),
        "a grid of 1000 x 2 x 1 voxels takes 8000 bytes, and 4000 may be taken"
    );
    assert!(matches!(
        refused(GridSize::Spacing(1e-300)),
        NoField::TooLarge { .. }
    ));
    assert_eq!(refused(GridSize::Spacing(f64::NAN)), NoField::NoVoxel);
    assert_eq!(refused(GridSize::Voxels([4, 0, 4])), NoField::NoVoxel);
}
