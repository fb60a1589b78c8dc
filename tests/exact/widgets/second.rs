//! The second derivative along the gradient as a third axis, and images in colour.

use super::*;
use glam::DMat3;
use stratavox::shaders::Frame;
use stratavox::technique::gradient::gradient_of;
use stratavox::technique::second_derivative::second_derivative_of;
use stratavox::transfer::SecondDerivative;
use stratavox::volume::sample::linear;

/// Gradient and second derivative at a position in voxel space, in f64, trilinear.
fn derivatives(volume: &Volume, frame: &Frame, p: DVec3) -> (DVec3, f64) {
    let moved = |step: [i32; 3]| (p + DVec3::from_array(step.map(f64::from))).to_array();
    let tap = |step| linear(volume, moved(step));
    let gradient = gradient_of::<f64>(frame, tap);
    let second = second_derivative_of(frame, gradient, tap);
    (gradient.into(), second)
}

/// Of f = x^T Q x + b x both differences are exact between voxel centres too, because they are linear and constant:
/// with g = 2 Q x + b, f'' is 2 g^T Q g / |g|^2 whatever the grid.
#[test]
fn a_quadratic_field_bends_as_its_matrix_says_on_every_grid() {
    let turned = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.1);
    let scaled = turned * DMat3::from_diagonal(dvec3(0.7, -1.3, 3.1));
    let skewed = DAffine3::from_mat3(sheared_affine().matrix3);
    let q = DMat3::from_cols(
        dvec3(0.02, 0.01, -0.015),
        dvec3(0.01, -0.03, 0.005),
        dvec3(-0.015, 0.005, 0.01),
    );
    let b = dvec3(0.5, -0.2, 0.3);
    for affine in [DAffine3::IDENTITY, DAffine3::from_mat3(scaled), skewed] {
        let center = affine.transform_point3(dvec3(8.0, 7.0, 6.0));
        let field = |p: DVec3| {
            let x = affine.transform_point3(p) - center;
            x.dot(q * x) + b.dot(x)
        };
        let volume = volume_of([16, 14, 12], affine, field);
        let frame = oblique_shots(volume.grid(), Mode::Composite)[0]
            .parameters()
            .0;
        let mut compared = 0;
        for i in 0..200 {
            let part = |k: i32| f64::from(i * k % 101) / 101.0;
            let p = dvec3(
                2.0 + 12.0 * part(7),
                2.0 + 10.0 * part(31),
                2.0 + 8.0 * part(57),
            );
            let (_, found) = derivatives(&volume, &frame, p);
            let g = 2.0 * (q * (affine.transform_point3(p) - center)) + b;
            let wanted = 2.0 * g.dot(q * g) / g.length_squared();
            // Values of at most 30, stored in f32, are off by 2e-6; nineteen of them are summed, weighted by 1/h^2 < 3.
            assert!(
                (found - wanted).abs() < 1e-4,
                "{affine}: {found}, not {wanted} at {p}"
            );
            compared += usize::from(g.length() > 0.05 && wanted.abs() > 1e-3);
        }
        assert!(compared > 100, "{affine} tells nothing: {compared}");
    }
}

/// Kindlmann & Durkin 1998: of an edge blurred by a Gaussian, -s^2 f'' / f' is the distance to its middle.
#[test]
fn the_second_derivative_of_a_blurred_edge_tells_how_far_its_middle_is() {
    let s = 4.0;
    let edge = |x: f64| 0.5 * (1.0 + erf(x / (s * 2f64.sqrt())));
    let (volume, middle) = of_x(DVec3::ONE, edge);
    let frame = oblique_shots(volume.grid(), Mode::Composite)[0]
        .parameters()
        .0;
    let top = 1.0 / (s * (2.0 * std::f64::consts::PI).sqrt());
    for i in -12..12 {
        let x = f64::from(i) * 0.5;
        let (gradient, second) = derivatives(&volume, &frame, dvec3(x + middle, 2.0, 2.0));
        let found = -s * s * second / gradient.x;
        // By differences (h^2 / 12) and by lines between voxel centres (h^2 / 8) f'' is off by the fourth derivative,
        // at most 1.4 f'max / s^3; f' by h^2 / 6 and h^2 / 8 of the third, at most f'max / s^2.
        let of_second = (1.0 / 12.0 + 1.0 / 8.0) * 1.4 * top / s.powi(3);
        let of_first = (1.0 / 6.0 + 1.0 / 8.0) * top / (s * s);
        let slope = top * (-x * x / (2.0 * s * s)).exp();
        let allowed = (s * s * of_second + x.abs() * of_first) / (slope - of_first) + 1e-4;
        assert!(
            (found - x).abs() <= allowed,
            "{found} at {x}, {allowed} is allowed"
        );
        assert!(
            allowed < 0.6 && (x == 0.0 || found.signum() == x.signum()),
            "{found} at {x}"
        );
    }
}

/// Of x^3 the second difference is 6 x exactly, and the line between two of them too.
#[test]
fn widgets_weigh_by_the_second_derivative_as_they_say() {
    let corners = [-0.4, -0.1, 0.15, 0.5];
    let trapezoid = |x: f64| {
        let [a, b, c, d] = corners;
        (((x - a) / (b - a)).min((d - x) / (d - c))).clamp(0.0, 1.0)
    };
    let (bell_at, sigma) = (0.2, 0.15);
    let bell = |x: f64| (-0.5 * ((x - bell_at) / sigma).powi(2)).exp();
    let everywhere = Shape::Rectangle {
        values: [-1e6, 1e6],
        gradients: [0.0, 1e6],
    };
    for (i, sides) in [dvec3(0.5, 1.0, 1.5), dvec3(1.5, 0.5, 1.0)]
        .into_iter()
        .enumerate()
    {
        let (volume, middle) = of_x(sides, |x| x.powi(3) + 40.0 * x);
        let (steepest, h) = (300.0 * sides.x, sides.min_element());
        let weighted = |opacity: f64, second: SecondDerivative| Widget {
            second: Some(second),
            ..widget(opacity, everywhere.clone())
        };
        let function = of_widgets(
            steepest * h / 2.0,
            vec![
                weighted(0.1, SecondDerivative::Trapezoid(corners)),
                weighted(
                    0.05,
                    SecondDerivative::Bell {
                        middle: bell_at,
                        sigma,
                    },
                ),
            ],
        );
        let wanted = |x: f64| {
            let second = 6.0 * (x - middle) * h / (steepest * h / 2.0);
            1.0 - (1.0 - 0.1 * trapezoid(second)) * (1.0 - 0.05 * bell(second))
        };
        let what = format!("voxels of {sides}");
        // Values of up to 5000 are stored in f32, off by 2.5e-4, and differences of four of them are divided by h^2
        // and by the steepest: 1e-3 / (h steepest) of the axis, along which opacity rises by at most 0.3.
        let tolerance = 0.3 * 1e-3 / (sides.x * sides.x * steepest / 2.0) + 1e-6;
        assert_opacity((&volume, &function), i == 0, wanted, tolerance, &what);
    }
}

/// Weighted shapes and an image in colour.
fn weighted() -> TransferFunction {
    let ramp = [-0.6, -0.2, 0.1, 0.5];
    let widgets = vec![
        Widget {
            second: Some(SecondDerivative::Trapezoid(ramp)),
            srgb: Some([0.9, 0.3, 0.1]),
            ..contour(0.5, 2.0, 0.2)
        },
        Widget {
            second: Some(SecondDerivative::Bell {
                middle: 0.2,
                sigma: 0.3,
            }),
            ..widget(
                0.3,
                Shape::Gaussian {
                    value: 0.6,
                    gradient: 0.4,
                    sigma_value: 0.15,
                    sigma_gradient: 0.3,
                },
            )
        },
        widget(
            0.25,
            Shape::Image {
                values: [0.1, 0.9],
                gradients: [0.0, 1.2],
                columns: 3,
                cells: Cells::Rgba(vec![
                    [255, 0, 0, 20],
                    [0, 255, 0, 128],
                    [0, 0, 255, 0],
                    [255, 128, 0, 255],
                    [20, 30, 200, 90],
                    [255, 255, 255, 60],
                ]),
            },
        ),
    ];
    TransferFunction {
        medium: None,
        gradient_transfer: Some(GradientTransfer {
            steepest: Some(0.3),
            share: Vec::new(),
            widgets,
        }),
        ..ramps()
    }
}

#[test]
fn every_technique_draws_second_derivatives_and_images_as_its_reference_does() {
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    let function = weighted();
    let mut unweighted = function.clone();
    for widget in &mut unweighted.gradient_transfer.as_mut().unwrap().widgets {
        widget.second = None;
    }
    for holes in [false, true] {
        let count = volume.dims.iter().product::<u32>();
        let mask = (0..count).map(|i| u8::from(i % 97 != 7));
        volume.validity = holes.then(|| mask.collect());
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        let shots = oblique_shots(GRID(), Mode::Composite).into_iter();
        for shot in shots.skip(usize::from(holes)).step_by(4) {
            let shot = PictureCase {
                extent: [24, 20],
                ..shot
            };
            let what = format!("holes {holes}, {}", shot.what());
            let scene = shot.scene(&volume, Some(&function));
            let found = assert_drawn_as_computed(&mut renderer, &scene, &what);
            let scene = shot.scene(&volume, Some(&unweighted));
            let other = reference::render::<f32>(&scene).unwrap();
            let pairs = other.pixels.iter().zip(&found.pixels);
            let changed = pairs.filter(|(a, b)| (a[3] - b[3]).abs() > 0.01).count();
            assert!(changed > 50, "{what}: the weights change {changed} pixels");
        }
    }
}

/// The widget covers everything with one colour a row of gradients: what a ramp of that slope is drawn in.
#[test]
fn an_image_gives_its_colours_where_its_cells_lie() {
    let (volume, _) = of_x(DVec3::ONE, |x| 0.5 * x);
    let image = |cells: Vec<[u8; 4]>| Shape::Image {
        values: [-20.0, 20.0],
        gradients: [0.0, 2.0],
        columns: 1,
        cells: Cells::Rgba(cells),
    };
    // The gradient is half of the steepest, a quarter of the image's height: in the middle of the first of two rows.
    let shape = image(vec![[255, 0, 51, 102], [0, 255, 0, 255]]);
    let function = of_widgets(1.0, vec![widget(0.5, shape)]);
    let wanted = |_: f64| 0.5 * 102.0 / 255.0;
    assert_opacity((&volume, &function), true, wanted, 1e-6, "an image");
    for shot in along_z(volume.grid()) {
        let scene = shot.scene(&volume, Some(&function));
        let picture = reference::render::<f64>(&scene).unwrap();
        let mut drawn = 0;
        for [r, g, b, a] in picture.pixels.iter().copied().filter(|p| p[3] > 0.1) {
            let blue = stratavox::color::decode_srgb(0.2_f64) as f32;
            let off = [r - a, g, b - blue * a].map(f32::abs);
            // The edge of the volume is less steep: there the other row is not reached either.
            assert!(off.iter().all(|&off| off < 1e-5), "{:?}", [r, g, b, a]);
            drawn += 1;
        }
        assert!(drawn > 50, "only {drawn} pixels are drawn");
    }
}
