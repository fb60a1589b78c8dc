//! The panel beside the picture, the help over it, and what the pointer does to the picture.

use crate::curve::Grip;
use crate::keys::{KEYS, POINTER};
use crate::look::{FILTERS, Look, MODES, TECHNIQUES};
use crate::view::{Picked, View, short};
use egui::{
    Align, Align2, CentralPanel, Color32, ComboBox, Context, DragValue, FontId, Frame, Grid, Key,
    Layout, Margin, Panel, PointerButton, RichText, ScrollArea, Sense, Slider, Stroke, Ui, vec2,
};
use stratavox::technique::{Filter, Mode, Technique};
use stratavox::transfer::{Preset, TransferFunction};

const WIDTH: f32 = 316.0;
const ACCENT: Color32 = Color32::from_rgb(236, 170, 96);

/// Fonts a little larger than egui's own, a dark panel, one warm colour.
pub fn set_style(context: &Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        for font in style.text_styles.values_mut() {
            font.size *= 1.08;
        }
        style.spacing.item_spacing = vec2(8.0, 6.0);
        style.spacing.slider_width = 118.0;
        style.spacing.interact_size.y = 22.0;
        let visuals = &mut style.visuals;
        visuals.panel_fill = Color32::from_rgb(27, 28, 31);
        visuals.window_fill = Color32::from_rgb(33, 34, 38);
        visuals.extreme_bg_color = Color32::from_gray(16);
        visuals.override_text_color = Some(Color32::from_gray(218));
        visuals.selection.bg_fill = Color32::from_rgb(122, 78, 34);
        visuals.selection.stroke = Stroke::new(1.0, Color32::WHITE);
        visuals.slider_trailing_fill = true;
    });
}

/// Lays out a frame.
pub fn show(ui: &mut Ui, view: &mut View) {
    let before = view.look.clone();
    view.is_moving = false;
    if view.has_panel {
        let frame = Frame::new()
            .fill(ui.visuals().panel_fill)
            .inner_margin(Margin::symmetric(14, 12));
        Panel::right("panel")
            .exact_size(WIDTH)
            .resizable(false)
            .show_separator_line(false)
            .frame(frame)
            .show(ui, |ui| {
                let below = Panel::bottom("status").frame(Frame::new());
                below
                    .show_separator_line(false)
                    .show(ui, |ui| status(ui, view));
                let above = CentralPanel::no_frame();
                above.show(ui, |ui| {
                    ScrollArea::vertical().show(ui, |ui| beside(ui, view));
                });
            });
    }
    CentralPanel::no_frame().show(ui, |ui| picture(ui, view));
    if view.has_help {
        help(ui.ctx(), view);
    }
    view.keep_look_possible(before);
}

/// The place of the picture, and what a hand does there.
fn picture(ui: &mut Ui, view: &mut View) {
    let rect = ui.max_rect();
    view.picture = rect;
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let per_point = ui.ctx().pixels_per_point();
    let pixels =
        [rect.width(), rect.height()].map(|side| (side * per_point).round().max(1.0) as u32);
    // From where the button went down: slow frames lose nothing of what the hand did.
    let pointer = response
        .interact_pointer_pos()
        .filter(|_| response.dragged());
    let from = view
        .held
        .or_else(|| ui.input(|input| input.pointer.press_origin()));
    if let (Some(to), Some(from)) = (pointer, from) {
        let (right, down) = (f64::from(to.x - from.x), f64::from(to.y - from.y));
        let has_shift = ui.input(|input| input.modifiers.shift);
        if response.dragged_by(PointerButton::Middle) || has_shift {
            let [right, down] = [right, down].map(|points| points * f64::from(per_point));
            view.eye.shift(right, down, pixels);
        } else if response.dragged_by(PointerButton::Primary) {
            view.eye.turn(right, down);
        }
        view.is_moving = true;
    }
    view.held = pointer;
    if let Some(pointer) = response.hover_pos() {
        let notches = ui.input(|input| input.smooth_scroll_delta().y / 50.0);
        if notches != 0.0 {
            let at = (pointer - rect.center()) * per_point;
            let at = [f64::from(at.x), f64::from(at.y)];
            view.eye.approach(1.2_f64.powf(notches.into()), at, pixels);
            view.is_moving = true;
        }
    }
    if response.double_clicked() {
        view.eye.reset();
    } else if response.clicked() {
        view.to_pick = response.interact_pointer_pos();
    }
    if let Some(message) = &view.message {
        let at = rect.left_bottom() + vec2(16.0, -14.0);
        let galley = ui.painter().layout(
            message.clone(),
            FontId::proportional(15.0),
            Color32::from_gray(235),
            rect.width() - 48.0,
        );
        let place = Align2::LEFT_BOTTOM.anchor_size(at, galley.size());
        ui.painter()
            .rect_filled(place.expand(7.0), 5.0, Color32::from_black_alpha(190));
        ui.painter().galley(place.min, galley, Color32::WHITE);
    }
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(8.0);
    ui.label(RichText::new(text).strong().color(ACCENT));
}

fn beside(ui: &mut Ui, view: &mut View) {
    subject(ui, view);
    heading(ui, "Picture");
    ways(ui, view);
    match view.look.mode {
        Mode::Iso => surfaces(ui, &mut view.look),
        _ => function(ui, view),
    }
    if view.times() > 1 {
        heading(ui, "Time");
        time(ui, view);
    }
    if let Some(picked) = &view.picked {
        heading(ui, "Under the pointer");
        let unit = view.subject.voxels.unit.clone().unwrap_or_default();
        pick(ui, picked, &unit);
    }
}

fn subject(ui: &mut Ui, view: &mut View) {
    let subject = &view.subject;
    ui.label(RichText::new(&subject.name).size(17.0).strong());
    let [x, y, z] = subject.voxels.dims;
    let spacing = subject.voxels.grid().spacing().map(short).join(" × ");
    let stored = subject.header().stored.name();
    let unit = subject.voxels.unit.as_deref().unwrap_or_default();
    let [low, high] = subject.voxels.value_range.map(short);
    ui.weak(format!("{x} × {y} × {z} voxels, {stored}"));
    ui.weak(format!("each {spacing}"));
    ui.weak(format!("values {low} to {high} {unit}"));
    if subject.way.height_factor != 1.0 {
        ui.weak(format!(
            "drawn {} times as high",
            short(subject.way.height_factor)
        ));
    }
    let variables = &subject.header().variables;
    if variables.len() > 1 {
        let mut chosen = variables[0].clone();
        let mut names = variables.clone();
        names.sort();
        ComboBox::from_id_salt("variable")
            .width(ui.available_width())
            .selected_text(chosen.clone())
            .show_ui(ui, |ui| {
                for name in names {
                    ui.selectable_value(&mut chosen, name.clone(), name);
                }
            });
        if chosen != variables[0] {
            view.wanted_variable = Some(chosen);
        }
    }
}

fn ways(ui: &mut Ui, view: &mut View) {
    ui.horizontal(|ui| {
        for technique in TECHNIQUES {
            let name = match technique {
                Technique::Raycast => "Rays",
                Technique::Slices3d => "3D slices",
                Technique::Slices2d => "2D slices",
            };
            ui.selectable_value(&mut view.look.technique, technique, name);
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
            let samples = Slider::new(&mut view.look.samples_per_voxel, 0.25..=4.0)
                .logarithmic(true)
                .max_decimals(2)
                .suffix(" a voxel");
            let response = ui.add_enabled(view.look.technique != Technique::Slices2d, samples);
            view.is_moving |= response.dragged();
            ui.end_row();
        });
    ui.horizontal(|ui| {
        ui.checkbox(&mut view.eye.is_parallel, "Parallel");
        let can_be_lit = matches!(view.look.mode, Mode::Composite | Mode::Mida);
        ui.add_enabled_ui(can_be_lit, |ui| ui.checkbox(&mut view.look.is_lit, "Light"));
        if ui.button("Reset view").clicked() {
            view.eye.reset();
        }
    });
}

fn function(ui: &mut Ui, view: &mut View) {
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
    if function.is_graded() {
        ui.weak("Opacity hangs on the gradient too.");
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
            crate::curve::set_opacity(function, i, point.value, point.opacity);
        }
        Some(Grip::Color(i)) if i < function.color.len() => {
            let mut value = function.color[i].value;
            let speed = 0.002 * (value.abs() + 1.0);
            ui.label("value");
            ui.add(DragValue::new(&mut value).speed(speed).max_decimals(4));
            crate::curve::set_color_value(function, i, value);
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

fn surfaces(ui: &mut Ui, look: &mut Look) {
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

fn time(ui: &mut Ui, view: &mut View) {
    let last = view.times() - 1;
    ui.horizontal(|ui| {
        let word = if view.is_playing { "Pause" } else { "Play" };
        if ui.button(word).clicked() {
            view.is_playing = !view.is_playing;
        }
        ui.add(Slider::new(&mut view.wanted_time, 0..=last));
    });
    let name = view.time_name(view.subject.time);
    if !name.is_empty() {
        ui.weak(name);
    }
}

fn pick(ui: &mut Ui, picked: &Picked, unit: &str) {
    match picked {
        Picked::Nothing => {
            ui.weak("nothing");
        }
        Picked::Something {
            position,
            value,
            is_label,
        } => {
            let word = if *is_label { "label" } else { "value" };
            let value = value.map_or("no data".to_owned(), |value| {
                format!("{} {unit}", short(value))
            });
            Grid::new("pick").num_columns(2).show(ui, |ui| {
                ui.weak(word);
                ui.label(RichText::new(value).strong());
                ui.end_row();
                ui.weak("place");
                ui.label(position.to_array().map(|x| format!("{x:.2}")).join(", "));
                ui.end_row();
            });
        }
    }
}

fn status(ui: &mut Ui, view: &View) {
    let status = &view.status;
    let [width, height] = status.extent;
    let megabytes = status.device_bytes as f64 / f64::from(1 << 20);
    ui.separator();
    ui.weak(&status.device);
    let took = status
        .picture_ms
        .map_or(String::new(), |ms| format!(" in {ms:.1} ms"));
    ui.weak(format!("{width} × {height}{took}, {}", status.present));
    ui.weak(format!("{megabytes:.0} MB, {} pipelines", status.pipelines));
    ui.label(RichText::new("H shows the keys").color(ACCENT));
}

fn help(context: &Context, view: &mut View) {
    let mut is_open = true;
    egui::Window::new("Keys")
        .open(&mut is_open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, vec2(-0.5 * WIDTH, 0.0))
        .show(context, |ui| {
            Grid::new("keys")
                .num_columns(2)
                .spacing([24.0, 4.0])
                .show(ui, |ui| {
                    let keys = KEYS.iter().map(|row| (row.name, row.what));
                    let named = keys.filter(|(name, _)| !name.is_empty());
                    for (name, what) in POINTER.into_iter().chain(named) {
                        ui.label(RichText::new(name).color(ACCENT));
                        ui.label(what);
                        ui.end_row();
                    }
                });
        });
    view.has_help = is_open && !context.input(|input| input.key_pressed(Key::Escape));
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
