//! Renderers with one mistake each, and the exact answers that catch them.
//!
//! [`Naive`] is a renderer of a few lines on the geometry of `shared::PictureCase`. Without a mistake it passes what
//! the CPU references pass; with one it must fail where it is said to.

use crate::shared::oracle::{
    Gaussian, constant_color, gaussian_xray, homogeneous, linear_density, order_of_convergence,
    quadratic_density,
};
use crate::shared::{Chord, Matter, PictureCase, Way, inner_box, oblique_shots, sheared_affine};
use glam::{DAffine3, DVec3};
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::{Mode, Order, Settings, Technique};
use stratavox::volume::Grid;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mistake {
    None,
    /// Opacity as the transfer function says it, whatever a sample stands for.
    NoCorrection,
    /// Opacity times length over the reference length.
    LinearCorrection,
    /// The shorter segment at the end of a ray, or the last plane, is left out.
    NoLastSegment,
    /// Samples where segments begin.
    NoHalfStep,
    /// Colours blended as if the target wanted them straight.
    StraightColor,
    /// The pictures of a stack turned by a right angle.
    SwappedAxes,
    /// From front to back with the operator for the other way.
    WrongOrder,
    /// Texture coordinates without the half texel.
    HalfTexel,
}

struct Naive(Mistake);

/// What `Matter` is classified for: opacities per world length 1.
const REFERENCE_LENGTH: f64 = 1.0;

impl Naive {
    /// Position in voxel space, value and length of each sample, front to back.
    fn samples(&self, shot: &PictureCase, matter: &Matter, chord: &Chord) -> Vec<(f64, f64)> {
        let voxel_from_world = shot.grid.world_from_voxel.inverse();
        let value = |&(t, length): &(f64, f64)| {
            let back = if self.0 == Mistake::NoHalfStep {
                0.5 * length
            } else {
                0.0
            };
            let mut p = voxel_from_world.transform_point3(chord.at(t - back));
            match self.0 {
                Mistake::SwappedAxes => {
                    let k = stack_axis(&shot.view());
                    let [u, v] = [(k + 1) % 3, (k + 2) % 3];
                    (p[u], p[v]) = (p[v], p[u]);
                }
                Mistake::HalfTexel => p += 0.5,
                _ => {}
            }
            ((matter.value)(p), length)
        };
        let left_out = usize::from(self.0 == Mistake::NoLastSegment);
        let kept = chord.samples.len() - left_out.min(chord.samples.len());
        chord.samples[..kept].iter().map(value).collect()
    }

    fn opacity(&self, extinction: f64, length: f64) -> f64 {
        let corrected = |length: f64| -(-extinction * length).exp_m1();
        match self.0 {
            Mistake::NoCorrection => corrected(REFERENCE_LENGTH),
            Mistake::LinearCorrection => corrected(REFERENCE_LENGTH) * length / REFERENCE_LENGTH,
            _ => corrected(length),
        }
    }
}

impl Way for Naive {
    fn name(&self) -> String {
        format!("{:?}", self.0)
    }

    fn picture(&self, shot: &PictureCase, matter: &Matter) -> Vec<[f64; 4]> {
        let blended = |pixel| {
            let Some(chord) = Chord::of(shot, pixel) else {
                return [0.0; 4];
            };
            let samples = self.samples(shot, matter, &chord);
            let over = |target: [f64; 4], &(value, length): &(f64, f64)| {
                let alpha = self.opacity((matter.extinction)(value), length);
                let [r, g, b] = (matter.color)(value);
                let weight = if self.0 == Mistake::StraightColor {
                    1.0
                } else {
                    alpha
                };
                let source = [weight * r, weight * g, weight * b, alpha];
                [0, 1, 2, 3].map(|c: usize| source[c] + (1.0 - alpha) * target[c])
            };
            if self.0 == Mistake::WrongOrder {
                samples.iter().fold([0.0; 4], over)
            } else {
                samples.iter().rev().fold([0.0; 4], over)
            }
        };
        shot.pixels().map(blended).collect()
    }

    /// An X-ray.
    fn values(&self, shot: &PictureCase, matter: &Matter) -> Vec<f64> {
        assert_eq!(shot.settings.mode, Mode::Xray);
        let sum = |pixel| {
            let Some(chord) = Chord::of(shot, pixel) else {
                return f64::NAN;
            };
            let samples = self.samples(shot, matter, &chord);
            samples.iter().map(|(value, length)| value * length).sum()
        };
        shot.pixels().map(sum).collect()
    }
}

/// One picture of each technique in each projection.
fn shots(mode: Mode) -> Vec<PictureCase> {
    let grid = Grid {
        dims: [17, 21, 13],
        world_from_voxel: sheared_affine(),
    };
    let all = oblique_shots(grid, mode).into_iter();
    all.filter(|shot| shot.settings.order == Order::BackToFront)
        .map(|shot| PictureCase {
            settings: Settings {
                crop: Some(inner_box(&grid)),
                ..shot.settings
            },
            ..shot
        })
        .collect()
}

fn order_is_two(way: &dyn Way, shot: &PictureCase) -> bool {
    let [coarse, fine] = order_of_convergence(way, shot);
    let order = (coarse / fine).log2();
    println!("A4, {}, {}: order {order:.3}", way.name(), shot.what());
    (order - 2.0).abs() <= 0.1
}

fn gaussian() -> (Vec<PictureCase>, Gaussian) {
    let grid = Grid {
        dims: [40; 3],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let widths = DVec3::new(2.5, 3.5, 3.0);
    let gaussian = Gaussian {
        center: DVec3::new(19.0, 21.5, 20.5),
        m: glam::DMat3::from_diagonal(widths.powf(-2.0)),
        interpolation: 0.0,
    };
    (oblique_shots(grid, Mode::Xray), gaussian)
}

#[test]
fn a_renderer_without_a_mistake_passes() {
    let naive = Naive(Mistake::None);
    for shot in shots(Mode::Composite) {
        homogeneous(&naive, &shot).assert_holds();
        linear_density(&naive, &shot).assert_holds();
        quadratic_density(&naive, &shot).assert_holds();
        constant_color(&naive, &shot).assert_holds();
        let shot = PictureCase {
            settings: Settings {
                crop: None,
                ..shot.settings.clone()
            },
            ..shot
        };
        assert!(order_is_two(&naive, &shot));
    }
    let (shots, gaussian) = gaussian();
    for shot in shots {
        gaussian_xray(&naive, &shot, &gaussian).assert_holds();
    }
}

#[test]
fn missing_opacity_correction_is_caught_by_the_homogeneous_cube() {
    for shot in shots(Mode::Composite) {
        homogeneous(&Naive(Mistake::NoCorrection), &shot).assert_caught();
        linear_density(&Naive(Mistake::NoCorrection), &shot).assert_caught();
    }
}

#[test]
fn linear_opacity_correction_is_caught_by_the_homogeneous_cube() {
    for shot in shots(Mode::Composite) {
        homogeneous(&Naive(Mistake::LinearCorrection), &shot).assert_caught();
        linear_density(&Naive(Mistake::LinearCorrection), &shot).assert_caught();
    }
}

#[test]
fn a_missing_last_segment_is_caught_by_the_homogeneous_cube() {
    for shot in shots(Mode::Composite) {
        homogeneous(&Naive(Mistake::NoLastSegment), &shot).assert_caught();
        linear_density(&Naive(Mistake::NoLastSegment), &shot).assert_caught();
    }
}

#[test]
fn a_missing_half_step_is_caught_by_densities_and_by_the_order_of_convergence() {
    for shot in shots(Mode::Composite) {
        linear_density(&Naive(Mistake::NoHalfStep), &shot).assert_caught();
        quadratic_density(&Naive(Mistake::NoHalfStep), &shot).assert_caught();
        assert!(!order_is_two(&Naive(Mistake::NoHalfStep), &shot));
    }
}

#[test]
fn straight_color_in_a_premultiplied_blend_is_caught_by_the_constant_color() {
    for shot in shots(Mode::Composite) {
        constant_color(&Naive(Mistake::StraightColor), &shot).assert_caught();
        homogeneous(&Naive(Mistake::StraightColor), &shot).assert_caught();
    }
}

#[test]
fn swapped_axes_of_a_stack_are_caught_by_a_density_and_by_a_gaussian() {
    let is_stack = |shot: &PictureCase| shot.settings.technique == Technique::Slices2d;
    for shot in shots(Mode::Composite).into_iter().filter(is_stack) {
        linear_density(&Naive(Mistake::SwappedAxes), &shot).assert_caught();
    }
    let (shots, gaussian) = gaussian();
    for shot in shots.into_iter().filter(is_stack) {
        gaussian_xray(&Naive(Mistake::SwappedAxes), &shot, &gaussian).assert_caught();
    }
}

#[test]
fn over_from_front_to_back_is_caught_by_rising_light() {
    for shot in shots(Mode::Composite) {
        assert!(!order_is_two(&Naive(Mistake::WrongOrder), &shot));
    }
}

#[test]
fn a_shift_of_half_a_texel_is_caught_by_a_density_and_by_a_gaussian() {
    for shot in shots(Mode::Composite) {
        linear_density(&Naive(Mistake::HalfTexel), &shot).assert_caught();
    }
    let (shots, gaussian) = gaussian();
    for shot in shots {
        gaussian_xray(&Naive(Mistake::HalfTexel), &shot, &gaussian).assert_caught();
    }
}
