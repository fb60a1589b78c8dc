//! The panel beside the picture, the help over it, and what the pointer does to the picture.

mod function;
mod ways;

use crate::keys::{KEYS, POINTER};
use crate::view::{Picked, View, short};
use egui::{
    Align2, CentralPanel, Color32, ComboBox, Context, FontId, Frame, Grid, Key, Margin, Panel,
    PointerButton, RichText, ScrollArea, Sense, Slider, Stroke, Ui, vec2,
};
use stratavox::technique::Mode;

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
        style.interaction.selectable_labels = false;
        // What fades in takes frames, which may be slow.
        style.animation_time = 0.0;
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
    if view.times() > 1 {
        heading(ui, "Time");
        time(ui, view);
    }
    heading(ui, "Picture");
    ways::ways(ui, view);
    match view.look.mode {
        Mode::Iso => ways::surfaces(ui, &mut view.look),
        _ => function::function(ui, view),
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
            name,
        } => {
            let word = if *is_label { "label" } else { "value" };
            let value = value.map_or("no data".to_owned(), |value| match name {
                Some(name) => format!("{} {name}", short(value)),
                None => format!("{} {unit}", short(value)),
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
    if let Some([traced, all]) = status.paths {
        let noise = status
            .noise
            .map(|noise| format!(", {:.1} % noise", 100.0 * noise));
        let noise = noise.unwrap_or_default();
        ui.weak(format!("{traced} of {all} paths a pixel{noise}"));
    }
    ui.weak(format!("{megabytes:.0} MB, {} pipelines", status.pipelines));
    ui.label(RichText::new("H shows the keys").color(ACCENT));
}

fn help(context: &Context, view: &mut View) {
    let mut is_open = true;
    egui::Window::new("Keys")
        .open(&mut is_open)
        .collapsible(false)
        .resizable(false)
        .vscroll(true)
        .default_height(0.9 * context.content_rect().height())
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
