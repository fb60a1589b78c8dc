//! The part of the panel on colours and opacity.

use super::heading;
use crate::curve::{Grip, set_color_value, set_opacity};
use crate::view::{View, short};
use egui::{Align, ComboBox, DragValue, Layout, Ui};
use stratavox::technique::Mode;
use stratavox::transfer::{Preset, TransferFunction};

pub fn function(ui: &mut Ui, view: &mut View) {
    heading(ui, "Transfer function");
    if matches!(view.look.mode, Mode::Composite | Mode::Mida) {
        let mut preset = view.look.preset;
        let name = |preset: Option<Preset>| preset.map_or("automatic", Preset::name);
        ui.horizontal(|ui| {
            ComboBox::from_id_salt("preset")
                .width(190.0)
                .selected_text(name(preset))
                .show_ui(ui, |ui| {
                    let all = Preset::ALL.into_iter().map(Some);
                    for one in [None].into_iter().chain(all) {
                        let text = one.map_or("what suits the values", Preset::description);
                        ui.selectable_value(&mut preset, one, name(one))
                            .on_hover_text(text);
                    }
                });
            if ui.button("Undo edits").clicked() || preset != view.look.preset {
                view.look.set_preset(preset, &view.subject);
                view.curve.chosen = None;
            }
        });
    }
    let is_integral = view.look.mode == Mode::Xray;
    let summary = &view.subject.summary;
    let Some(function) = view.look.function_mut() else {
        return;
    };
    let shown = [0.0005, 0.9995].map(|share| summary.quantile(share));
    let values = domain(function, if is_integral { None } else { Some(shown) });
    let histogram = (!is_integral).then_some(&view.subject.histogram);
    let before = function.clone();
    view.curve.show(ui, function, histogram, values);
    ends(ui, values);
    chosen(ui, view.curve.chosen, function);
    view.is_moving |= *function != before;
    if function.uses_gradient() {
        ui.weak("Opacity depends on the gradient too.");
    }
}

/// The values that the curve is drawn over: most of the voxels, and all of the points.
fn domain(function: &TransferFunction, shown: Option<[f64; 2]>) -> [f64; 2] {
    let opacity = function.opacity.iter().map(|point| point.value);
    let points = opacity.chain(function.color.iter().map(|point| point.value));
    let all = points.chain(shown.into_iter().flatten());
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    let [low, high] = all.fold(ends, |[low, high], v| [low.min(v), high.max(v)]);
    match low < high {
        true => [low, high],
        false => [low - 0.5, low + 0.5],
    }
}

fn ends(ui: &mut Ui, values: [f64; 2]) {
    ui.horizontal(|ui| {
        ui.weak(short(values[0]));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.weak(short(values[1]));
        });
    });
}

/// The chosen point in numbers.
fn chosen(ui: &mut Ui, grip: Option<Grip>, function: &mut TransferFunction) {
    ui.horizontal(|ui| match grip {
        Some(Grip::Opacity(i)) if i < function.opacity.len() => {
            let mut point = function.opacity[i];
            let speed = 0.002 * (point.value.abs() + 1.0);
            ui.label("value");
            ui.add(
                DragValue::new(&mut point.value)
                    .speed(speed)
                    .max_decimals(4),
            );
            ui.label("opacity");
            ui.add(
                DragValue::new(&mut point.opacity)
                    .speed(0.001)
                    .range(0.0..=1.0)
                    .max_decimals(4),
            );
            set_opacity(function, i, point.value, point.opacity);
        }
        Some(Grip::Color(i)) if i < function.color.len() => {
            let mut value = function.color[i].value;
            let speed = 0.002 * (value.abs() + 1.0);
            ui.label("value");
            ui.add(DragValue::new(&mut value).speed(speed).max_decimals(4));
            set_color_value(function, i, value);
            let mut srgb = function.color[i].srgb.map(|c| (255.0 * c).round() as u8);
            ui.label("colour");
            if ui.color_edit_button_srgb(&mut srgb).changed() {
                function.color[i].srgb = srgb.map(|c| f64::from(c) / 255.0);
            }
        }
        _ => {
            ui.weak("drag points, double click adds one");
        }
    });
}
