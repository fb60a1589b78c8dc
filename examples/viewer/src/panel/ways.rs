//! The part of the panel on how the volume is drawn.

use super::heading;
use crate::look::{FILTERS, Look, MODES, TECHNIQUES};
use crate::view::View;
use egui::{ComboBox, Grid, Slider, Ui};
use stratavox::technique::{Filter, Mode, Technique};

pub fn ways(ui: &mut Ui, view: &mut View) {
    ui.horizontal(|ui| {
        for technique in TECHNIQUES {
            ui.selectable_value(&mut view.look.technique, technique, technique.to_string());
        }
    });
    Grid::new("ways")
        .num_columns(2)
        .spacing([12.0, 6.0])
        .show(ui, |ui| {
            ui.label("Mode");
            let mut mode = view.look.mode;
            let is_sliced = view.look.technique != Technique::Raycast;
            ComboBox::from_id_salt("mode")
                .width(170.0)
                .selected_text(mode_name(mode))
                .show_ui(ui, |ui| {
                    for one in MODES {
                        ui.add_enabled_ui(!(is_sliced && one.needs_rays()), |ui| {
                            ui.selectable_value(&mut mode, one, mode_name(one));
                        });
                    }
                });
            if mode != view.look.mode {
                view.look.set_mode(mode, &view.subject.voxels);
            }
            ui.end_row();
            ui.label("Filter");
            ComboBox::from_id_salt("filter")
                .width(170.0)
                .selected_text(filter_name(view.look.filter))
                .show_ui(ui, |ui| {
                    for one in FILTERS {
                        ui.selectable_value(&mut view.look.filter, one, filter_name(one));
                    }
                });
            ui.end_row();
            ui.label("Samples")
                .on_hover_text("along a ray, for each smallest spacing of voxels");
            let mut per_voxel = view.look.samples_per_voxel();
            let samples = Slider::new(&mut per_voxel, 0.25..=4.0)
                .logarithmic(true)
                .max_decimals(2)
                .suffix(" a voxel");
            let response = ui.add_enabled(view.look.technique != Technique::Slices2d, samples);
            view.is_moving |= response.dragged();
            if response.changed() {
                view.look.samples_by_hand = Some(per_voxel);
            }
            ui.end_row();
        });
    ui.horizontal(|ui| {
        ui.checkbox(&mut view.eye.is_parallel, "Parallel");
        let mut is_lit = view.look.wants_light();
        let can_be_lit = view.look.can_be_lit();
        let light = ui.add_enabled(can_be_lit, egui::Checkbox::new(&mut is_lit, "Light"));
        if light.changed() {
            view.look.light_by_hand = Some(is_lit);
        }
        if ui.button("Reset view").clicked() {
            view.eye.reset();
        }
    });
}

pub fn surfaces(ui: &mut Ui, look: &mut Look) {
    heading(ui, "Surfaces");
    let [low, high] = look.per_mode.unit_values;
    let mut is_gone = None;
    for (i, level) in look.per_mode.levels.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            let mut srgb = level.srgb.map(|c| (255.0 * c).round() as u8);
            if ui.color_edit_button_srgb(&mut srgb).changed() {
                level.srgb = srgb.map(|c| f64::from(c) / 255.0);
            }
            ui.add(Slider::new(&mut level.value, low..=high).max_decimals(3));
            if i > 0 && ui.small_button("×").clicked() {
                is_gone = Some(i);
            }
        });
        ui.horizontal(|ui| {
            ui.add_space(44.0);
            ui.add(
                Slider::new(&mut level.opacity, 0.0..=1.0)
                    .max_decimals(2)
                    .text("opacity"),
            );
        });
    }
    if let Some(i) = is_gone {
        look.per_mode.levels.remove(i);
    }
}

fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Composite => "composite",
        Mode::Mip => "maximum (MIP)",
        Mode::Minip => "minimum",
        Mode::Average => "average",
        Mode::Xray => "X-ray",
        Mode::Lmip => "first local maximum",
        Mode::AttenuatedMip => "attenuated maximum",
        Mode::Mida => "MIDA",
        Mode::Iso => "surfaces",
    }
}

fn filter_name(filter: Filter) -> &'static str {
    match filter {
        Filter::Nearest => "nearest",
        Filter::Linear => "linear",
        Filter::Cubic => "cubic B-spline",
        Filter::CatmullRom => "Catmull-Rom",
        Filter::CubicSmooth => "smoothing B-spline",
        Filter::Quadratic => "quadratic B-spline",
        Filter::QuadraticSmooth => "smoothing quadratic",
    }
}
