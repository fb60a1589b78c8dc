//! A picture as the mean of those that several stacks make: smooth 2D stacks where the eye changes from one to
//! another ([`crate::technique::slices_2d::stack_shares`]).

use super::{Error, Rendered, Renderer};
use crate::picture::{LayerKind, Picture};
use crate::scene::Scene;
use crate::technique::Settings;
use crate::technique::slices_2d::stack_shares;

/// The settings of each stack that is seen, and its share; none where one stack makes the picture.
pub fn stacks_of(scene: &Scene) -> Vec<(Settings, f64)> {
    if !scene.settings.technique.draws_stacks() {
        return Vec::new();
    }
    let shares = stack_shares(&scene.view(&scene.volume.grid(), [0.0; 2]));
    let one = |(stack, share)| {
        let settings = Settings {
            stack: Some(stack),
            ..scene.settings.clone()
        };
        (settings, share)
    };
    match shares.len() {
        1 => Vec::new(),
        _ => shares.into_iter().map(one).collect(),
    }
}

/// The pictures of several stacks on a device, each by its share.
pub fn render_faded(
    renderer: &mut Renderer,
    scene: &Scene,
    layers: &[LayerKind],
    stacks: &[(Settings, f64)],
) -> Result<Rendered, Error> {
    let mut gpu_ms = Some(0.0);
    let of = stacks.len();
    let of_stack = |(number, (settings, share)): (usize, &(Settings, f64))| {
        let span = renderer.slices.enter(number, of);
        let rendered = renderer.render(&Scene { settings, ..*scene }, layers);
        renderer.slices.leave(span);
        let rendered = rendered?;
        gpu_ms = gpu_ms.zip(rendered.gpu_ms).map(|(sum, ms)| sum + ms);
        Ok::<_, Error>((rendered.picture, *share))
    };
    let picture = faded(stacks.iter().enumerate().map(of_stack))?;
    Ok(Rendered { picture, gpu_ms })
}

/// The mean of pictures by their shares. Premultiplied colours and transmittances are weighted; samples were taken
/// in all of them.
pub fn faded<E>(
    pictures: impl IntoIterator<Item = Result<(Picture, f64), E>>,
) -> Result<Picture, E> {
    let mut whole: Option<Picture> = None;
    for found in pictures {
        let (mut picture, share) = found?;
        let share = share as f32;
        for number in picture.pixels.as_flattened_mut() {
            *number *= share;
        }
        for layer in &mut picture.layers {
            if layer.kind != LayerKind::Samples {
                layer.values.iter_mut().for_each(|value| *value *= share);
            }
        }
        let Some(whole) = &mut whole else {
            whole = Some(picture);
            continue;
        };
        let numbers = picture.pixels.as_flattened();
        for (sum, number) in whole.pixels.as_flattened_mut().iter_mut().zip(numbers) {
            *sum += number;
        }
        for (sum, layer) in whole.layers.iter_mut().zip(&picture.layers) {
            for (sum, value) in sum.values.iter_mut().zip(&layer.values) {
                *sum += value;
            }
        }
    }
    Ok(whole.expect("at least one stack is seen"))
}
