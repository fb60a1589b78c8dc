//! The light volume of a scene on the CPU: CPU reference of `src/offscreen/light.rs`.

use super::{filtered, filtered_in_slice, gradient_at, moved, steepness};
use crate::real::Real;
use crate::resident::TextureLayout;
use crate::scene::Scene;
use crate::technique::{Error, Filter, LightField};
use crate::transfer::{
    Absorption, PackedWidgets, Points, classify_by_gradient, classify_by_points,
};
use crate::volume::{Grid, Volume};

/// What comes through to the nodes of the light grid; `None` where the picture does not ask. `read` is what is
/// filtered in place of the scene's volume, `gradients` what gradients are made of, where that is not its values.
pub fn light_of<R: Real>(
    scene: &Scene,
    read: Option<&Volume>,
    gradients: Option<&Volume>,
    grid: &Grid,
) -> Result<Option<LightField<R>>, Error> {
    let view = scene.view(grid, [0.0; 2]);
    let Some(plan) = view.light_plan()? else {
        return Ok(None);
    };
    let surfaces = view.matter_of_surfaces();
    let function = surfaces.as_ref().or(scene.transfer);
    let function = function.ok_or(Error::NoTransferFunction)?;
    let (reference_length, space) = (scene.length_of(function), scene.settings.color_space);
    let points = Points::new(function, Absorption::Extinction { reference_length }, space);
    let uses_gradient = function.uses_gradient();
    let widgets = uses_gradient.then(|| PackedWidgets::new(function, reference_length, space));
    let frame = view.on_cpu()?.frame;
    let volume = read.unwrap_or(scene.volume);
    let filter = match scene.settings.filter {
        Filter::Linear => Filter::Nearest,
        filter => filter,
    };
    let operator = scene.settings.gradient_operator();
    let weighted = gradients.map(|source| (source, operator));
    let layout = view.texture_layout();
    let look = |p: [R; 3], step: [i32; 3]| match layout {
        TextureLayout::Texture3d => filtered(volume, filter, moved(p, step)),
        TextureLayout::Stack(axis) => {
            let last = volume.dims[axis] as i32 - 1;
            let slice = p[axis].floor().to_i32().clamp(0, last) + step[axis];
            let slice = slice.clamp(0, last) as u32;
            filtered_in_slice(volume, filter, axis, slice, moved(p, step))
        }
    };
    let extinction_at = |p| {
        let value = look(p, [0; 3])?;
        let mut material = classify_by_points(&points, value);
        if let Some(widgets) = &widgets {
            let gradient = gradient_at(&frame, weighted, p, |step| look(p, step));
            let steep = steepness(&frame, widgets, gradient, |step| look(p, step));
            material = classify_by_gradient(widgets, material, value, steep);
        }
        Some(material[3])
    };
    Ok(Some(LightField::new(&plan, &frame, extinction_at)))
}
