//! A renderer whose view is fitted: what `render`, `sheet` and `thumbnails` draw with.

use super::{Framing, View, short};
use crate::cli::Error;
use crate::cli::flags::FocusWord;
use crate::cli::renderer::{Device, Job, Renderer};
use crate::cli::scene_inputs::Parts;
use crate::picture::LayerKind;
use crate::technique::pathtrace::Lens;
use std::cell::OnceCell;

/// Where a renderer's views live: the one it is made with, and the fitted one.
#[derive(Debug, Default)]
pub struct Views {
    first: OnceCell<View>,
    fitted: OnceCell<View>,
}

/// A renderer of what `framing` shows, and the view that it is to draw.
pub fn prepared<'a>(
    framing: &Framing<'a>,
    parts: &'a Parts<'a>,
    layers: &'a [LayerKind],
    mut device: Device,
    views: &'a Views,
) -> Result<(Renderer<'a>, &'a View), Error> {
    let shown = framing.shown();
    let job = Job {
        volume: &shown.volume,
        classification: &shown.classification,
        stream: shown.stream(),
        beside: parts.beside(),
        lines: shown.lines(),
        settings: &keep(&views.first, framing.view()?).settings,
        extent_pixels: framing.extent_pixels(),
        layers,
    };
    let first = views.first.get().expect("kept above");
    if shown.stream().is_none() {
        let mut renderer = Renderer::new(job, &first.camera, device)?;
        let fitted = framing.fit(&mut |camera, settings, extent_pixels| {
            renderer.draw_other(camera, settings, extent_pixels)
        })?;
        let fitted = focused(fitted, &mut renderer)?;
        let fitted = keep(&views.fitted, fitted);
        renderer.change(&shown.classification, &fitted.settings);
        return Ok((renderer, fitted));
    }
    // Small frames of a volume in bricks are those of its overview.
    let fitted = if framing.draws() {
        let job = Job {
            volume: shown.looked_at(),
            stream: None,
            layers: &[],
            ..job
        };
        let mut renderer = Renderer::new(job, &first.camera, device)?;
        let fitted = framing.fit(&mut |camera, settings, extent_pixels| {
            renderer.draw_other(camera, settings, extent_pixels)
        })?;
        device = renderer.into_device();
        fitted
    } else {
        first.clone()
    };
    let fitted = keep(&views.fitted, fitted);
    let job = Job {
        settings: &fitted.settings,
        ..job
    };
    Ok((Renderer::new(job, &fitted.camera, device)?, fitted))
}

/// The view with a lens that is sharp where `--focus-distance auto` finds matter.
fn focused(mut view: View, renderer: &mut Renderer) -> Result<View, Error> {
    let lens = view.settings.path.lens;
    let (Some(lens), true) = (lens, view.scene.path.finds_focus()) else {
        return Ok(view);
    };
    let found = renderer.distance_ahead(&view.camera, &view.settings)?;
    let (word, note) = match found.map(short) {
        Some(ahead) => (
            FocusWord::Length(ahead),
            format!("focused on what the middle shows: --focus-distance {ahead}"),
        ),
        None => (
            FocusWord::Target,
            "focused on where the camera is turned to, because the middle shows nothing: --focus-distance target".to_owned(),
        ),
    };
    view.scene.path.focus_distance = Some(word);
    view.settings.path.lens = Some(Lens {
        focus: word.length(),
        ..lens
    });
    view.notes.push(note);
    Ok(view)
}

fn keep(cell: &OnceCell<View>, view: View) -> &View {
    cell.get_or_init(|| view)
}
