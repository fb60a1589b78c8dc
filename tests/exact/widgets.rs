//! Opacity by value and gradient: closed forms on ramps and edges, and the device against its CPU reference.

mod gradient_opacity;
mod second;

use crate::shared::{
    Chord, PictureCase, compare, device, oblique_shots, placements, ramps, sheared_affine,
    volume_of, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::Picture;
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::{Filter, Mode, Role, Settings, Shading};
use stratavox::transfer::{
    Cells, ColorPoint, GradientTransfer, Interpolation, OpacityPoint, Shape, TransferFunction,
    Widget,
};
use stratavox::volume::{Grid, Volume};

fn contour(value: f64, half_width: f64, opacity: f64) -> Widget {
    let shape = Shape::Contour { value, half_width };
    widget(opacity, shape)
}

fn widget(opacity: f64, shape: Shape) -> Widget {
    Widget {
        srgb: None,
        opacity,
        shape,
        second: None,
    }
}

fn points(points: &[(f64, f64)]) -> Vec<OpacityPoint> {
    let point = |&(value, opacity)| OpacityPoint { value, opacity };
    points.iter().map(point).collect()
}

/// White, and nothing but what the gradient makes of it.
fn only(gradient_transfer: GradientTransfer) -> TransferFunction {
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: points(&[(0.0, 0.0)]),
        reference_length: None,
        interpolation: Interpolation::Linear,
        medium: None,
        gradient_transfer: Some(gradient_transfer),
    }
}

fn of_widgets(steepest: f64, widgets: Vec<Widget>) -> TransferFunction {
    only(GradientTransfer {
        steepest: Some(steepest),
        share: Vec::new(),
        widgets,
    })
}

/// A box of voxels of these sides.
fn grid(dims: [u32; 3], sides: DVec3) -> Grid {
    Grid {
        dims,
        world_from_voxel: DAffine3::from_scale(sides),
    }
}

/// Straight along z, in every placement: a ray meets one value only where the field does not change along z.
fn along_z(grid: Grid) -> Vec<PictureCase> {
    let size = grid.world_from_voxel.matrix3 * grid.far_corner();
    let camera = Camera {
        eye: grid.center() - dvec3(0.0, 0.0, 2.0 * size.z),
        target: grid.center(),
        up: DVec3::Y,
        projection: Projection::Orthographic {
            view_height: size.y,
        },
        zoom: 1.0,
    };
    let height = 6;
    let width = (f64::from(height) * size.x / size.y).round() as u32;
    let shot = |settings| PictureCase {
        grid,
        camera,
        extent: [width, height],
        settings,
    };
    placements().into_iter().map(shot).collect()
}

/// Opacity per smallest spacing of each ray that meets the volume at least one and a half voxels inside, where no
/// difference is one-sided, and the world x that it runs along.
fn opacities(shot: &PictureCase, picture: &Picture) -> Vec<(f64, f64)> {
    let spacing = shot.grid.smallest_spacing();
    let voxel = shot.grid.world_from_voxel.inverse();
    let opacity = |[x, y]: [u32; 2]| {
        let chord = Chord::of(shot, [x, y])?;
        let inside = voxel.transform_point3(chord.origin).x;
        let last = f64::from(shot.grid.dims[0]);
        if !(1.5..=last - 1.5).contains(&inside) {
            return None;
        }
        let alpha = f64::from(picture.pixels[(y * shot.extent[0] + x) as usize][3]);
        let sigma = -(1.0 - alpha).ln() / chord.length();
        Some((chord.origin.x, 1.0 - (-sigma * spacing).exp()))
    };
    shot.pixels().filter_map(opacity).collect()
}

/// Draws a field that changes along world x only, by the CPU reference and, if wanted, on the device, and compares the
/// opacity with what `wanted` says of x.
fn assert_opacity(
    (volume, function): (&Volume, &TransferFunction),
    on_device: bool,
    wanted: impl Fn(f64) -> f64,
    tolerance: f64,
    what: &str,
) {
    let mut renderer = on_device.then(|| Renderer::new(device(), volume).unwrap());
    let mut opaque = 0;
    for shot in along_z(volume.grid()) {
        let scene = shot.scene(volume, Some(function));
        let mut found = opacities(&shot, &reference::render::<f64>(&scene).unwrap());
        if let Some(renderer) = &mut renderer {
            let drawn = renderer.render(&scene, &[]).unwrap().picture;
            found.extend(opacities(&shot, &drawn));
        }
        for (x, opacity) in found {
            let wanted = wanted(x);
            opaque += u32::from(wanted > 0.01);
            assert!(
                (opacity - wanted).abs() <= tolerance,
                "{what}, {}: at x = {x} opacity {opacity}, not {wanted}",
                shot.what()
            );
        }
    }
    assert!(opaque > 30, "{what}: only {opaque} rays meet anything");
}

/// Slopes per world length, and sides of voxels: the smallest along x, across it, and along the ray.
fn ramps_and_sides() -> Vec<(f64, DVec3)> {
    let sides = [
        dvec3(0.5, 1.0, 1.5),
        dvec3(1.5, 0.5, 1.0),
        dvec3(1.0, 1.5, 0.5),
    ];
    let slopes = [0.1, -0.7, 1.0, 10.0];
    let all = sides.into_iter();
    all.flat_map(|sides| slopes.map(|slope| (slope, sides)))
        .collect()
}

/// A field of world x on a grid of voxels of such sides, zero in its middle.
fn of_x(sides: DVec3, field: impl Fn(f64) -> f64) -> (Volume, f64) {
    let grid = grid([24, 4, 4], sides);
    let middle = grid.center().x;
    let field = |p: DVec3| field(sides.x * p.x - middle);
    (volume_of(grid.dims, grid.world_from_voxel, field), middle)
}

/// Max(0, 1 - |distance| / half_width).
fn tent(distance: f64, half_width: f64) -> f64 {
    (1.0 - distance.abs() / half_width).max(0.0)
}

/// A17 of the table of exact answers: Levoy's contour is as thick everywhere.
#[test]
fn a_contour_on_a_ramp_is_a_tent_of_so_many_voxels_whatever_the_slope() {
    for (i, (slope, sides)) in ramps_and_sides().into_iter().enumerate() {
        // Each slope and each shape of voxels once.
        let on_device = i % 5 == 0;
        let (volume, middle) = of_x(sides, |x| slope * x);
        let at = 0.3;
        let function = of_widgets(1.0, vec![contour(slope * at, 2.5, 0.1)]);
        let half_width = 2.5 * sides.min_element();
        let wanted = |x: f64| 0.1 * tent(x - middle - at, half_width);
        let what = format!("slope {slope}, voxels of {sides}");
        assert_opacity((&volume, &function), on_device, wanted, 1e-5 * 0.1, &what);
    }
}

#[test]
fn contours_that_meet_let_through_what_each_lets_through() {
    let (volume, middle) = of_x(DVec3::ONE, |x| 3.0 * x);
    let widgets = [(-2.0, 3.0, 0.1), (0.0, 2.0, 0.15), (1.5, 4.0, 0.08)];
    let all = widgets.map(|(at, half_width, opacity)| contour(3.0 * at, half_width, opacity));
    let function = of_widgets(1.0, all.into());
    let wanted = |x: f64| {
        let through = |(at, half_width, opacity)| 1.0 - opacity * tent(x - middle - at, half_width);
        1.0 - widgets.map(through).iter().product::<f64>()
    };
    assert_opacity((&volume, &function), true, wanted, 1e-6, "three contours");
}

#[test]
fn a_region_on_a_ramp_is_its_line_of_opacities_times_how_steep_the_ramp_is() {
    for slope in [0.5, -2.0] {
        let (volume, middle) = of_x(DVec3::ONE, |x| slope * x);
        let at = |x: f64| slope * x;
        let mut corners = [(at(-6.05), 0.02), (at(-1.0), 0.1), (at(5.05), 0.04)];
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let region = Shape::Region {
            points: points(&corners),
        };
        // Half as steep as the steepest, and as steep as can be.
        for (steepest, share) in [(2.0 * slope.abs(), 0.5), (0.1, 1.0)] {
            let function = of_widgets(steepest, vec![widget(1.0, region.clone())]);
            let wanted = |x: f64| {
                let x = x - middle;
                let line = match x {
                    x if (-6.05..=-1.0).contains(&x) => 0.02 + 0.08 * (x + 6.05) / 5.05,
                    x if (-1.0..=5.05).contains(&x) => 0.1 - 0.06 * (x + 1.0) / 6.05,
                    _ => 0.0,
                };
                share * line
            };
            assert_opacity((&volume, &function), share == 0.5, wanted, 1e-6, "a region");
        }
    }
}

/// Abramowitz and Stegun 7.1.26 would do for 1.5e-7; the series of erf, all positive terms, does for f64.
fn erf(x: f64) -> f64 {
    let mut term = x;
    let mut sum = x;
    for n in 1..200 {
        term *= 2.0 * x * x / f64::from(2 * n + 1);
        sum += term;
    }
    2.0 / std::f64::consts::PI.sqrt() * (-x * x).exp() * sum
}

/// A14-like: an edge blurred by a Gaussian has an arch over the values, f'(f) (Kindlmann and Durkin 1998).
#[test]
fn opacity_by_gradient_alone_draws_the_arch_of_a_blurred_edge() {
    let sigma = 3.0;
    let edge = |x: f64| 0.5 * (1.0 + erf(x / (sigma * 2f64.sqrt())));
    let (volume, middle) = of_x(DVec3::ONE, edge);
    let top = 1.0 / (sigma * (2.0 * std::f64::consts::PI).sqrt());
    let function = TransferFunction {
        opacity: points(&[(0.0, 0.1)]),
        ..only(GradientTransfer {
            steepest: Some(top),
            share: points(&[(0.0, 0.0), (1.0, 1.0)]),
            widgets: Vec::new(),
        })
    };
    // Central differences at voxel centres, a straight line between them.
    let difference = |x: f64| 0.5 * (edge(x + 1.0) - edge(x - 1.0));
    let drawn = |x: f64| {
        let centre = (x - 0.5).floor() + 0.5;
        let part = x - centre;
        (1.0 - part) * difference(centre) + part * difference(centre + 1.0)
    };
    // |f'''| is 1/sigma^2 of the top at most: h^2/6 of it by the differences, h^2/8 by the line between them.
    let bound = top / (sigma * sigma) * (1.0 / 6.0 + 1.0 / 8.0);
    for x in (-80..80).map(|i| f64::from(i) * 0.1) {
        let arch = top * (-x * x / (2.0 * sigma * sigma)).exp();
        assert!((drawn(x) - arch).abs() <= bound, "at {x}");
    }
    let wanted = |x: f64| 0.1 * drawn(x - middle) / top;
    assert_opacity((&volume, &function), true, wanted, 1e-6, "an edge");
}

/// One of each shape, in colours of their own or of the value; gradients of the waves reach about 0.3.
fn one_of_each() -> TransferFunction {
    let shapes = [
        Shape::Contour {
            value: 0.55,
            half_width: 1.5,
        },
        Shape::Region {
            points: points(&[(0.2, 0.0), (0.4, 0.3), (0.7, 0.1)]),
        },
        Shape::Triangle {
            value: 0.4,
            half_width: 0.3,
            threshold: 0.1,
            top: 0.9,
        },
        Shape::Rectangle {
            values: [0.6, 0.8],
            gradients: [0.2, 0.5],
        },
        Shape::Gaussian {
            value: 0.7,
            gradient: 0.5,
            sigma_value: 0.1,
            sigma_gradient: 0.2,
        },
        Shape::Image {
            values: [0.1, 0.9],
            gradients: [0.05, 0.8],
            columns: 4,
            cells: Cells::Shares(vec![
                0.0, 0.2, 0.5, 0.1, 1.0, 0.3, 0.0, 0.9, 0.4, 0.1, 0.6, 0.2,
            ]),
        },
    ];
    let widgets = shapes.into_iter().enumerate().map(|(i, shape)| Widget {
        srgb: (i % 2 == 0).then_some([0.9, 0.2 * i as f64, 0.1]),
        opacity: 0.05 + 0.03 * i as f64,
        shape,
        second: None,
    });
    TransferFunction {
        medium: None,
        gradient_transfer: Some(GradientTransfer {
            steepest: Some(0.3),
            share: points(&[(0.1, 0.2), (0.4, 1.0), (0.4, 0.5), (0.9, 0.0)]),
            widgets: widgets.collect(),
        }),
        ..ramps()
    }
}

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

fn assert_drawn_as_computed(renderer: &mut Renderer, scene: &Scene, what: &str) -> Picture {
    let found = renderer.render(scene, &[]).unwrap().picture;
    let double = reference::render::<f64>(scene).unwrap();
    let single = reference::render::<f32>(scene).unwrap();
    let all = [&double, &single, &found].map(|p| p.pixels.as_flattened());
    compare(what, 4 * found.width, all, 1.0);
    found
}

#[test]
fn every_technique_filter_and_light_draws_widgets_as_its_reference_does() {
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    let function = one_of_each();
    let flat = TransferFunction {
        gradient_transfer: None,
        medium: None,
        ..function.clone()
    };
    for holes in [false, true] {
        let count = volume.dims.iter().product::<u32>();
        let mask = (0..count).map(|i| u8::from(i % 53 != 7));
        volume.validity = holes.then(|| mask.collect());
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        let shots = oblique_shots(GRID(), Mode::Composite).into_iter();
        for (i, shot) in shots.enumerate().skip(usize::from(holes)).step_by(2) {
            let shot = shot.with(|settings| {
                settings.filter = [Filter::Linear, Filter::Nearest][i / 6 % 2];
                settings.shading = (i / 2 % 2 == 0).then(Shading::default);
                // Pictures look into the table of the function of the value.
                settings.conformance = i % 3 != 0;
            });
            let what = format!("holes {holes}, {}", shot.what());
            let scene = shot.scene(&volume, Some(&function));
            let found = renderer.render(&scene, &[]).unwrap().picture;
            if shot.settings.conformance || shot.settings.filter == Filter::Nearest {
                assert_drawn_as_computed(&mut renderer, &scene, &what);
            }
            let flat = shot.scene(&volume, Some(&flat));
            let flat = renderer.render(&flat, &[]).unwrap().picture;
            let changed = flat.pixels.iter().zip(&found.pixels);
            let changed = changed.filter(|(a, b)| (a[3] - b[3]).abs() > 0.01).count();
            assert!(changed > 100, "{what}: widgets change {changed} pixels");
        }
    }
}

#[test]
fn each_shape_alone_is_drawn_as_its_reference_draws_it() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let shot = oblique_shots(GRID(), Mode::Composite).remove(0);
    for widget in one_of_each().gradient_transfer.unwrap().widgets {
        let what = format!("{:?}", widget.shape);
        let function = of_widgets(0.3, vec![widget]);
        let scene = shot.scene(&volume, Some(&function));
        let found = assert_drawn_as_computed(&mut renderer, &scene, &what);
        let drawn = found.pixels.iter().filter(|p| p[3] > 0.01).count();
        assert!(drawn > 50, "{what}: only {drawn} pixels are drawn");
    }
}

#[test]
fn what_projects_or_mixes_refuses_gradients_by_name() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let function = one_of_each();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let shot = oblique_shots(GRID(), Mode::Mip).remove(0);
    let scene = shot.scene(&volume, Some(&function));
    let said = renderer.render(&scene, &[]).unwrap_err().to_string();
    assert!(
        said.contains("mode mip") && said.contains("widgets"),
        "{said}"
    );
    assert!(reference::render::<f64>(&scene).is_err());
    let settings = Settings {
        mode: Mode::Composite,
        ..shot.settings.clone()
    };
    let channels = [Channel {
        volume: &volume,
        transfer: Some(&function),
        role: Role::Numbers,
    }];
    let plain = ramps();
    let scene = Scene {
        beside: Beside::Channels(&channels),
        transfer: Some(&plain),
        settings: &settings,
        ..scene
    };
    let said = reference::render::<f64>(&scene).unwrap_err().to_string();
    assert!(said.contains("several that are mixed"), "{said}");
}
