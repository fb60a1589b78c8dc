//! World gradients against closed forms (`sampling.md` 7 and A19).

#[path = "../../examples/quality/marschner_lobb.rs"]
mod marschner_lobb;
#[path = "../../examples/quality/normals.rs"]
mod normals;

use crate::shared::{device, oblique_shots, sheared_affine, volume_of, waves};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::offscreen::Renderer;
use stratavox::shaders::Frame;
use stratavox::technique::gradient::gradient_of;
use stratavox::technique::gradient_taps::weighted_gradient;
use stratavox::technique::{GradientFilter, Mode, Operator, Settings};
use stratavox::volume::kernel::{Kernel, convolved};
use stratavox::volume::sample::{linear, nearest};
use stratavox::volume::{Coefficients, Grid, Spline, Volume};

const DIMS: [u32; 3] = [16, 14, 12];

/// Parameters of a picture on the grid: the gradient reads where voxels lie.
fn frame_on(grid: Grid) -> Frame {
    oblique_shots(grid, Mode::Composite)[0].parameters().0
}

/// The gradient at a position in voxel space, in f64, trilinear.
fn gradient_at(volume: &Volume, frame: &Frame, p: DVec3) -> DVec3 {
    let moved = |step: [i32; 3]| (p + DVec3::from_array(step.map(f64::from))).to_array();
    gradient_of::<f64>(frame, |step| linear(volume, moved(step))).into()
}

const KERNELS: [Kernel; 3] = [Kernel::Quadratic, Kernel::Cubic, Kernel::CatmullRom];
const OPERATORS: [Operator; 5] = [
    Operator::Linear,
    Operator::Sobel,
    Operator::Kernel(KERNELS[0]),
    Operator::Kernel(KERNELS[1]),
    Operator::Kernel(KERNELS[2]),
];

/// The same by weights of voxels.
fn weighted_at(volume: &Volume, frame: &Frame, operator: Operator, p: DVec3) -> DVec3 {
    weighted_gradient::<f64>(frame, volume, operator, p.to_array()).into()
}

/// Voxel centres, this many voxels off the edge.
fn centers(dims: [u32; 3], edge: u32) -> impl Iterator<Item = DVec3> {
    let along = move |k: usize| edge..dims[k] - edge;
    along(2).flat_map(move |z| {
        along(1).flat_map(move |y| along(0).map(move |x| dvec3(x.into(), y.into(), z.into()) + 0.5))
    })
}

/// Grids that are oblique, sheared, mirrored, and not isotropic; the entries of all but the first are exact in f32
/// neither as they are nor inverted.
fn affines() -> Vec<DAffine3> {
    let turned = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.1);
    let scaled = turned * DMat3::from_diagonal(dvec3(0.7, -1.3, 3.1));
    let linear = DAffine3::from_mat3_translation(scaled, dvec3(9.0, -200.0, 35.0));
    vec![DAffine3::IDENTITY, sheared_affine(), linear]
}

#[test]
fn a_linear_field_has_its_slope_on_every_grid() {
    let slope = dvec3(0.3, -0.7, 1.1);
    for affine in affines() {
        let center = affine.transform_point3(dvec3(8.0, 7.0, 6.0));
        let value = |p| slope.dot(affine.transform_point3(p) - center);
        let volume = volume_of(DIMS, affine, value);
        let frame = frame_on(volume.grid());
        for p in centers(DIMS, 2).map(|p| p + dvec3(0.21, -0.37, 0.45)) {
            let weighted = OPERATORS.map(|operator| weighted_at(&volume, &frame, operator, p));
            for found in [gradient_at(&volume, &frame, p)]
                .into_iter()
                .chain(weighted)
            {
                // Values of at most 60 are stored in f32, off by 2e-6 each; the matrix is in f32 too.
                let error = (found - slope).length();
                assert!(error < 1e-5, "{affine}: {found} at {p}");
            }
            // What is wrong on such a grid: directions instead of covectors, or no matrix at all.
            if affine != DAffine3::IDENTITY {
                let m = affine.matrix3;
                let voxel = m.transpose() * slope;
                for wrong in [voxel, m * voxel, m.inverse() * voxel] {
                    assert!((wrong - slope).length() > 0.1, "{affine} tells nothing");
                }
            }
        }
    }
}

#[test]
fn a_quadratic_field_has_its_exact_gradient_at_voxel_centres() {
    let value = |p: DVec3| {
        3.0 + p.x * p.x - 2.0 * p.y * p.y + 0.5 * p.z * p.z + p.x * p.y - 4.0 * p.y * p.z + p.z
    };
    let slope = |p: DVec3| {
        dvec3(
            2.0 * p.x + p.y,
            -4.0 * p.y + p.x - 4.0 * p.z,
            p.z - 4.0 * p.y + 1.0,
        )
    };
    let volume = volume_of(DIMS, DAffine3::IDENTITY, value);
    let frame = frame_on(volume.grid());
    for p in centers(DIMS, 1) {
        let found = gradient_at(&volume, &frame, p);
        assert_eq!(found, slope(p), "at {p}");
    }
}

#[test]
fn the_central_difference_of_a_cube_is_off_by_the_square_of_the_spacing() {
    let h = 0.5;
    let affine = DAffine3::from_scale(DVec3::splat(h));
    for axis in 0..3 {
        let volume = volume_of(DIMS, affine, |p| (h * p[axis]).powi(3));
        let frame = frame_on(volume.grid());
        for p in centers(DIMS, 1) {
            let found = gradient_at(&volume, &frame, p);
            let x = h * p[axis];
            let wanted = DVec3::AXES[axis] * (3.0 * x * x + h * h);
            let error = (found - wanted).length() / wanted.length();
            assert!(error < 1e-5, "{found} at {p}, not {wanted}");
        }
    }
}

#[test]
fn the_derivative_of_the_cubic_spline_through_a_cube_is_exact() {
    let h = 0.5;
    let volume = volume_of([48, 5, 5], DAffine3::from_scale(DVec3::splat(h)), |p| {
        (h * (p.x - 24.0)).powi(3)
    });
    let coefficients = Coefficients::new(&volume, Spline::Cubic, [true; 3]);
    let frame = frame_on(volume.grid());
    let cubic = Operator::Kernel(Kernel::Cubic);
    for i in 0..160 {
        let p = dvec3(16.0 + 0.1 * f64::from(i), 2.6, 2.2);
        let x = h * (p.x - 24.0);
        let wanted = DVec3::X * 3.0 * x * x;
        let error = |found: DVec3| (found - wanted).length();
        // Coefficients of at most 100 in f32 are off by 4e-6 each, their difference over two voxels by 8e-6; what the
        // ends make is under 0.27^16 of the largest value, 1e-6.
        let found = weighted_at(coefficients.volume(), &frame, cubic, p);
        assert!(error(found) < 2e-5, "{found} at {p}, not {wanted}");
        assert!(
            error(gradient_at(&volume, &frame, p)) > 0.1,
            "differences at {p}"
        );
    }
}

#[test]
fn the_derivative_of_a_kernel_is_how_its_values_rise() {
    let volume = volume_of(DIMS, DAffine3::IDENTITY, waves);
    let frame = frame_on(volume.grid());
    for kernel in KERNELS {
        for p in centers(DIMS, 0).map(|p| p + dvec3(0.31, -0.24, 0.08)) {
            const STEP: f64 = 1e-4;
            let at = |p: DVec3| convolved::<f64>(&volume, kernel, p.to_array()).unwrap();
            // Beyond the outermost centres values stay; there the slope is that at the edge.
            let far = volume.grid().far_corner();
            let p = p.clamp(DVec3::splat(0.6), far - 0.6);
            let rise = |axis: DVec3| (at(p + STEP * axis) - at(p - STEP * axis)) / (2.0 * STEP);
            let wanted = DVec3::from_array(DVec3::AXES.map(rise));
            let found = weighted_at(&volume, &frame, Operator::Kernel(kernel), p);
            // The third derivative of a piece is under 10, and STEP^2 / 6 of it is the error of a difference.
            let error = (found - wanted).length();
            assert!(error < 2e-8, "{kernel:?}: {found} at {p}, not {wanted}");
        }
    }
}

#[test]
fn weights_of_voxels_make_the_central_difference_of_the_trilinear_field() {
    let mut volume = volume_of(DIMS, DAffine3::IDENTITY, waves);
    let count = volume.dims.iter().product::<u32>();
    volume.validity = Some((0..count).map(|i| u8::from(i % 397 != 5)).collect());
    let frame = frame_on(volume.grid());
    let mut dark = 0;
    for offset in [dvec3(0.31, -0.24, 0.08), dvec3(-0.5, 0.0, 0.2), DVec3::ZERO] {
        for p in centers(DIMS, 0).map(|p| p + offset) {
            let wanted = gradient_at(&volume, &frame, p);
            let found = weighted_at(&volume, &frame, Operator::Linear, p);
            assert!(
                (found - wanted).length() < 1e-14,
                "{found} at {p}, not {wanted}"
            );
            dark += u32::from(wanted == DVec3::ZERO);
        }
    }
    assert!(dark > 100, "{dark} gradients beside holes");
}

#[test]
fn sobels_operator_smooths_across_each_difference() {
    let volume = volume_of(DIMS, DAffine3::IDENTITY, |p| p.x * p.y * p.y);
    let frame = frame_on(volume.grid());
    for p in centers(DIMS, 1) {
        // A quarter, a half and a quarter of y^2 is y^2 + 1/2.
        let wanted = dvec3(p.y * p.y + 0.5, 2.0 * p.x * p.y, 0.0);
        let found = weighted_at(&volume, &frame, Operator::Sobel, p);
        assert_eq!(found, wanted, "at {p}");
    }
}

#[test]
fn normals_on_the_device_are_as_good_as_known_of_each_operator() {
    let signal = marschner_lobb::signal();
    let mut renderer = Renderer::new(device(), &signal).unwrap();
    let mut angle = |gradient_filter, conformance| {
        let settings = Settings {
            gradient_filter,
            conformance,
            ..Settings::default()
        };
        let points = [2, normals::POINTS[1]];
        normals::mean_angle_degrees(&mut renderer, &signal, &settings, points).unwrap()
    };
    // 11.1 and 29.3 degrees by an independent program.
    for conformance in [true, false] {
        let cubic = angle(GradientFilter::Cubic, conformance);
        assert!(cubic <= 12.0, "cubic: {cubic} degrees");
        let central = angle(GradientFilter::Central, conformance);
        assert!(
            (25.0..33.0).contains(&central),
            "central: {central} degrees"
        );
    }
}

#[test]
fn the_normals_of_a_ball_point_away_from_its_centre() {
    for affine in [
        DAffine3::IDENTITY,
        DAffine3::from_scale(dvec3(0.7, 0.9, 1.3)) * DAffine3::from_rotation_y(0.5),
    ] {
        let center = affine.transform_point3(dvec3(16.3, 15.8, 16.1));
        let radius = 9.0;
        let distance = |p: DVec3| affine.transform_point3(p).distance(center) - radius;
        let volume = volume_of([32; 3], affine, distance);
        let frame = frame_on(volume.grid());
        let (mut count, mut worst) = (0, 0.0f64);
        for p in centers([32; 3], 2).map(|p| p + dvec3(0.3, -0.2, 0.4)) {
            if distance(p).abs() > 1.0 {
                continue;
            }
            let wanted = affine.transform_point3(p) - center;
            worst = worst.max(gradient_at(&volume, &frame, p).angle_between(wanted));
            count += 1;
        }
        let degrees = worst.to_degrees();
        assert!(count > 500, "{count} points");
        assert!(degrees <= 0.5, "off by {degrees} degrees");
    }
}

#[test]
fn a_difference_on_the_fly_is_the_interpolation_of_differences_made_beforehand() {
    // Whole numbers, whose half differences are exact.
    let value = |p: DVec3| {
        (p * dvec3(37.0, 59.0, 83.0))
            .element_sum()
            .rem_euclid(251.0) as i64
    };
    let volume = volume_of(DIMS, DAffine3::IDENTITY, |p| value(p) as f64);
    let frame = frame_on(volume.grid());
    let beforehand = [0, 1, 2].map(|axis: usize| {
        volume_of(DIMS, DAffine3::IDENTITY, |p| {
            gradient_at(&volume, &frame, p)[axis]
        })
    });
    for p in centers(DIMS, 1).map(|p| p + dvec3(0.3, -0.41, 0.12)) {
        let wanted = DVec3::from_array(
            [0, 1, 2].map(|k| linear::<f64>(&beforehand[k], p.to_array()).unwrap()),
        );
        let error = (gradient_at(&volume, &frame, p) - wanted).length();
        assert!(error < 1e-11, "off by {error} at {p}");
    }
}

#[test]
fn a_tap_without_data_makes_the_gradient_zero() {
    let mut volume = volume_of(DIMS, DAffine3::IDENTITY, |p| p.x);
    let [nx, ny, _] = DIMS;
    let hole = [7, 6, 5];
    let mut mask = vec![1; volume.dims.iter().product::<u32>() as usize];
    mask[((hole[2] * ny + hole[1]) * nx + hole[0]) as usize] = 0;
    volume.validity = Some(mask);
    let frame = frame_on(volume.grid());
    for p in centers(DIMS, 1) {
        let steps = (p - 0.5 - DVec3::from_array(hole.map(f64::from))).abs();
        let at_hole = steps == DVec3::ZERO;
        let beside = steps.element_sum() == 1.0;
        let wanted = if beside { DVec3::ZERO } else { DVec3::X };
        // In the hole itself no sample is taken.
        if !at_hole {
            assert_eq!(gradient_at(&volume, &frame, p), wanted, "at {p}");
        }
    }
}

#[test]
fn outside_the_outermost_centres_taps_are_those_of_the_edge() {
    let volume = volume_of(DIMS, DAffine3::IDENTITY, |p| 2.0 * p.y);
    let frame = frame_on(volume.grid());
    let at = |y| gradient_at(&volume, &frame, dvec3(8.0, y, 6.0)).y;
    assert_eq!(at(2.5), 2.0, "inside");
    assert_eq!(at(0.5), 1.0, "one of two taps is the edge's own voxel");
    assert_eq!(at(13.5), 1.0, "on the other side too");
    let of_nearest = gradient_of::<f64>(&frame, |[x, y, z]| {
        let p = [8, 0, 6].map(f64::from);
        nearest(
            &volume,
            [p[0] + f64::from(x), 0.2 + f64::from(y), p[2] + f64::from(z)],
        )
    });
    assert_eq!(of_nearest, [0.0, 1.0, 0.0], "by the nearest voxel");
}
