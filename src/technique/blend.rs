//! What a blending unit does with the fragments of one pixel, and its CPU reference.
//!
//! ```text
//! over    back to front   C = s + (1 - alpha_s) C
//! under   front to back   C = C + (1 - alpha_C) s
//! max, min, add           channel by channel
//! ```
//!
//! All colours are premultiplied (Porter and Duff 1984); `sampling.md` 5.

use super::{DepthAccess, Fold, Mode, Order, SampleKind, ShaderVariant};
use crate::gpu::{Blend, Gpu};
use crate::real::Real;
use crate::shaders::{Shader, find, shader};
use crate::transfer::opacity_over;

/// One sample on a slice: its value (or, of several volumes, what they are together) and the world length that it
/// stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct Fragment<R, V = R> {
    pub value: V,
    pub length: R,
}

impl<R, V> Fragment<R, V> {
    /// The same with something else in place of its value.
    pub fn map<W>(self, of_value: impl FnOnce(V) -> W) -> Fragment<R, W> {
        Fragment {
            value: of_value(self.value),
            length: self.length,
        }
    }
}

/// What slices are drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Drawn {
    /// The picture of a mode.
    Picture(Mode),
    /// How many samples each pixel took.
    Count,
}

impl Drawn {
    /// The vertex and the fragment shader of a slicer. Where there is a variant of both in which the vertices hand over
    /// the parameters (`shaders/flat_varyings.rs`), drivers on which fragments are slow to ask for them have that one, and all
    /// drivers where there is no other.
    pub(super) fn shaders(
        self,
        gpu: &Gpu,
        [cover, slicer]: [&str; 2],
        variant: &ShaderVariant,
        depth_access: DepthAccess,
    ) -> [&'static Shader; 2] {
        let name = self.fragment_name(slicer, variant, depth_access);
        let of = match slicer {
            "slices_3d" => "planes",
            _ => "stack",
        };
        let cuts = if variant.is_whole { ".whole" } else { "" };
        let handed = find(&format!("{name}.{of}{cuts}"));
        match (handed, find(&name)) {
            (Some(fragment), asked) if gpu.has_slow_parameters() || asked.is_none() => {
                [shader(&format!("{cover}.{of}")), fragment]
            }
            _ => [shader(cover), shader(&name)],
        }
    }

    fn fragment_name(
        self,
        slicer: &str,
        variant: &ShaderVariant,
        depth_access: DepthAccess,
    ) -> String {
        let ShaderVariant {
            filter,
            holes,
            transfer,
            mix,
            take,
            ..
        } = variant;
        let mix = mix.general().word();
        let depth_access = match depth_access {
            DepthAccess::None | DepthAccess::Tested => "",
            DepthAccess::Sampled => ".host_depth",
        };
        let slicer = format!("{slicer}{}", take.word());
        match self {
            Self::Picture(Mode::Composite) if *take == SampleKind::Preintegrated => {
                let light = variant.light_and_grids();
                format!("{slicer}.composite{depth_access}.{filter}.{holes}{light}")
            }
            // Modes that need rays are refused where parameters are made: nothing is drawn by these.
            Self::Picture(Mode::Composite | Mode::Mida | Mode::Iso) => {
                let light = variant.light_and_grids();
                format!("{slicer}.composite{mix}.{filter}.{holes}.{transfer}{light}")
            }
            Self::Picture(_) => format!("{slicer}.number{depth_access}.{filter}.{holes}"),
            Self::Count => format!("{slicer}.count{depth_access}.nearest.none"),
        }
    }
}

/// The fixed-function operator.
pub fn operator(drawn: Drawn, order: Order) -> Blend {
    let Drawn::Picture(mode) = drawn else {
        return Blend::Add;
    };
    match (mode.fold(), order) {
        (Fold::Material, Order::BackToFront) => Blend::Over,
        (Fold::Material, Order::FrontToBack) => Blend::Under,
        (Fold::Max, _) => Blend::Max,
        (Fold::Min, _) => Blend::Min,
        (Fold::Sum, _) => Blend::Add,
    }
}

/// What the target holds before the first fragment: where nothing is drawn, the second number of a
/// projection stays 0.
pub fn clear_color(mode: Mode) -> [f32; 4] {
    match mode.fold() {
        Fold::Max => [-f32::MAX, 0.0, 0.0, 0.0],
        Fold::Min => [f32::MAX, 0.0, 0.0, 0.0],
        Fold::Material | Fold::Sum => [0.0; 4],
    }
}

/// +1 where a mode looks for the largest, -1 where for the smallest value, 0 where values are added up.
pub fn extreme_sign(mode: Mode) -> f32 {
    match mode.fold() {
        Fold::Min => -1.0,
        Fold::Sum => 0.0,
        Fold::Max | Fold::Material => 1.0,
    }
}

/// The target after one more fragment. `classify` gives (red, green, blue, extinction).
pub fn blend<R: Real>(
    mode: Mode,
    order: Order,
    target: [R; 4],
    fragment: Fragment<R>,
    classify: impl Fn(R) -> [R; 4],
) -> [R; 4] {
    let zero = R::from_f64(0.0);
    let sign = R::from_f32(extreme_sign(mode));
    match mode.fold() {
        Fold::Material => blend_material(order, target, classify(fragment.value), fragment.length),
        Fold::Max => each([fragment.value, sign, zero, zero], target, R::max),
        Fold::Min => each([fragment.value, sign, zero, zero], target, R::min),
        Fold::Sum => {
            let Fragment { value, length } = fragment;
            each([value * length, length, zero, zero], target, |s, c| s + c)
        }
    }
}

/// The target after one more segment of `length`, of a material (red, green, blue, extinction).
pub fn blend_material<R: Real>(
    order: Order,
    target: [R; 4],
    [r, g, b, extinction]: [R; 4],
    length: R,
) -> [R; 4] {
    let one = R::from_f64(1.0);
    let opacity = opacity_over(extinction, length);
    let source = [opacity * r, opacity * g, opacity * b, opacity].map(R::in_target);
    let opacity = match order {
        Order::BackToFront => source[3],
        Order::FrontToBack => target[3],
    };
    let left = (one - opacity).in_target();
    let [r, g, b, _] = match order {
        Order::BackToFront => each(source, target, |s, c| {
            (s + (left * c).in_target()).in_target()
        }),
        Order::FrontToBack => each(source, target, |s, c| {
            ((left * s).in_target() + c).in_target()
        }),
    };
    let alpha = match order {
        Order::BackToFront => source[3].over(target[3]),
        Order::FrontToBack => target[3].over(source[3]),
    };
    [r, g, b, alpha]
}

/// What batches before have left, after one more: CPU reference of `shaders/merge.wgsl`.
pub(crate) fn merge<R: Real>(order: Order, before: [R; 4], batch: [R; 4]) -> [R; 4] {
    let one = R::from_f64(1.0);
    match order {
        Order::BackToFront => each(batch, before, |b, c| b + (one - batch[3]) * c),
        Order::FrontToBack => each(batch, before, |b, c| c + (one - before[3]) * b),
    }
}

fn each<R: Real>(source: [R; 4], target: [R; 4], operator: impl Fn(R, R) -> R) -> [R; 4] {
    std::array::from_fn(|channel| operator(source[channel], target[channel]))
}
