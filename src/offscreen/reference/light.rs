//! The light volume of a scene on the CPU: CPU reference of `src/offscreen/light.rs`.

use super::{Classifier, ReferenceRays, filtered, filtered_in_slice, moved};
use crate::offscreen::light::{light_plan_of, matter_volumes};
use crate::real::Real;
use crate::resident::TextureLayout;
use crate::scene::Scene;
use crate::technique::{Error, Filter, InPixel, LightField};
use crate::transfer::Points;
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
    let Some(plan) = light_plan_of(scene, &view)? else {
        return Ok(None);
    };
    let layout = view.texture_layout();
    let matter = matter_of::<R>(scene, read, gradients, grid)?;
    let has_own_grids = matter.volumes.iter().any(|volume| volume.grid() != *grid);
    let extinction_at = |p: [R; 3]| {
        let look = |volume: &Volume, filter, step: [i32; 3]| {
            let filter = match filter {
                Filter::Linear if !has_own_grids => Filter::Nearest,
                filter => filter,
            };
            match layout {
                TextureLayout::Texture3d => filtered(volume, filter, moved(p, step)),
                TextureLayout::Stack(axis) => {
                    let last = volume.dims[axis] as i32 - 1;
                    let slice = p[axis].floor().to_i32().clamp(0, last) + step[axis];
                    let slice = slice.clamp(0, last) as u32;
                    filtered_in_slice(volume, filter, axis, slice, moved(p, step))
                }
            }
        };
        // No light falls along no direction.
        let material = matter.mixed(look, p, [R::from_f64(0.0); 3])?;
        Some(material[3])
    };
    Ok(Some(LightField::new(&plan, &matter.frame, extinction_at)))
}

/// What is in the way of light, classified by points as `shaders/light_cells.wgsl` does.
fn matter_of<'a, R: Real>(
    scene: &'a Scene<'a>,
    read: Option<&'a Volume>,
    gradients: Option<&'a Volume>,
    grid: &'a Grid,
) -> Result<ReferenceRays<'a, R>, Error> {
    let mut matter = ReferenceRays::new(scene, read, None, None, grid, InPixel::CENTER)?;
    matter.gradients = gradients;
    let count = matter_volumes(scene).len();
    matter.volumes.truncate(count);
    matter.roles.truncate(count);
    let surfaces = scene.view(grid, [0.0; 2]).matter_of_surfaces();
    let functions = match &surfaces {
        Some(function) => {
            matter.widgets = None;
            vec![Some(function)]
        }
        None => scene.transfers(),
    };
    let by_points = |function: Option<_>| {
        let function = function.ok_or(Error::NoTransferFunction)?;
        let absorption = scene.absorption(function);
        let points = Points::new(function, absorption, scene.settings.color_space);
        Ok(Classifier::Points(points))
    };
    let classifiers = functions.into_iter().map(by_points);
    matter.classifiers = classifiers.collect::<Result<_, Error>>()?;
    Ok(matter)
}
