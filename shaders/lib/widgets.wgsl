// Opacity by value and gradient magnitude: the function of the value, weighted by how steep it is, and widgets
// beside it, emitters of their own that add up their extinction,
//
//     alpha = 1 - (1 - opacity(f) share(s)) product of (1 - a_n shape_n(f, s))
//
// which is Levoy's way to put contours together (1988, section 3). Shapes and their sources: src/transfer/gradient_transfer.rs;
// how they lie in the buffer, and the CPU reference: src/transfer/widgets.rs.

#import frame
#import extinction
#import gradient_opacity
#import transfer_{transfer}

const WIDGET_ENTRIES: u32 = 5u;

// False where the gradient makes nothing of the value.
fn are_widgets() -> bool {
    let head = widget_entry(0);
    return head.y + head.z > 0.0;
}

// True where some widget is weighted by the second derivative.
fn wants_second() -> bool {
    return widget_entry(0).w != 0.0;
}

// What a value is made of where it rises by `magnitude` per world length, and that by `second`; `material` is what it
// is made of anyway.
fn classify_by_gradient(material: Classified, value: f32, magnitude: f32, second: f32) -> Classified {
    let head = widget_entry(0);
    let share_count = u32(head.y);
    let steepness = magnitude * head.x;
    var sum = weighted_extinction(material.extinction, steepness);
    // A mean of one is that one, to the bit: `material_gradient_opacity.wgsl` makes none.
    if head.z == 0.0 {
        return Classified(material.color, sum);
    }
    var light = sum * material.color;
    for (var i = 0u; i < u32(head.z); i++) {
        let first = 1u + share_count + WIDGET_ENTRIES * i;
        let widget = widget_entry(first);
        var share = widget_share(first, value, magnitude, steepness);
        let painted = widget_entry(first + 2u);
        var color = select(material.color, painted.xyz, widget.z != 0.0);
        if widget.z == 2.0 {
            color = image_color(first, value, steepness);
        }
        if painted.w != 0.0 {
            let bends = second * frame.smallest_spacing * head.x;
            share *= second_share(painted.w, widget_entry(first + 4u), bends);
        }
        let own = extinction_of(widget.y * share, frame.reference_length);
        light += own * color;
        sum += own;
    }
    if sum == 0.0 {
        return Classified(vec3(0.0), 0.0);
    }
    return Classified(light / sum, sum);
}

// What is opaque of the widget that begins at entry `first`.
fn widget_share(first: u32, value: f32, magnitude: f32, steepness: f32) -> f32 {
    let widget = widget_entry(first);
    let n = widget_entry(first + 1u);
    switch u32(widget.x) {
        // Contour: value, half-width in smallest spacings.
        case 0u: {
            return tent(abs(value - n.x), n.y * frame.smallest_spacing * magnitude);
        }
        // One piece of a region: its values, its opacities.
        case 1u: {
            if !(n.x <= value && (value < n.y || (widget.w != 0.0 && value <= n.y))) {
                return 0.0;
            }
            var part = 1.0;
            if n.y > n.x {
                part = (value - n.x) / (n.y - n.x);
            }
            return min(steepness, 1.0) * (n.z + part * (n.w - n.z));
        }
        // Triangle: value, half-width at the top, threshold, top.
        case 2u: {
            if !(n.z <= steepness && steepness <= n.w) {
                return 0.0;
            }
            return tent(abs(value - n.x), n.y * steepness / n.w);
        }
        // Rectangle.
        case 3u: {
            return select(0.0, 1.0, is_in_rectangle(n, value, steepness));
        }
        // Gaussian: its middle, one over its deviations.
        case 4u: {
            let x = (value - n.x) * n.z;
            let y = (steepness - n.y) * n.w;
            return exp(-0.5 * (x * x + y * y));
        }
        // Image.
        case 5u: {
            if !is_in_rectangle(n, value, steepness) {
                return 0.0;
            }
            return image_at(first, value, steepness).x;
        }
        default: {
            return 0.0;
        }
    }
}

// (from value, to value, from gradient, to gradient), ends included.
fn is_in_rectangle(sides: vec4<f32>, value: f32, steepness: f32) -> bool {
    return sides.x <= value && value <= sides.y && sides.z <= steepness && steepness <= sides.w;
}

// 1 at no distance, 0 at `reach`.
fn tent(distance: f32, reach: f32) -> f32 {
    if distance == 0.0 {
        return 1.0;
    }
    if distance <= reach {
        return 1.0 - distance / reach;
    }
    return 0.0;
}

// What the second derivative leaves: of a bell its middle and one over its deviation, else the corners of a trapezoid.
fn second_share(kind: f32, n: vec4<f32>, second: f32) -> f32 {
    if kind == 2.0 {
        let x = (second - n.x) * n.y;
        return exp(-0.5 * x * x);
    }
    if second < n.x || second > n.w {
        return 0.0;
    }
    if second < n.y {
        return (second - n.x) / (n.y - n.x);
    }
    if second > n.z {
        return (n.w - second) / (n.w - n.z);
    }
    return 1.0;
}

// The colour that the cells of an image have.
fn image_color(first: u32, value: f32, steepness: f32) -> vec3<f32> {
    let cell = image_at(first, value, steepness);
    if cell.x > 0.0 {
        return cell.yzw / cell.x;
    }
    return vec3(0.0);
}

// Between the middles of the cells of an image (first entry, columns, rows) in its rectangle.
fn image_at(first: u32, value: f32, steepness: f32) -> vec4<f32> {
    let n = widget_entry(first + 1u);
    let image = widget_entry(first + 3u).xyz;
    let at = vec2((value - n.x) / (n.y - n.x), (steepness - n.z) / (n.w - n.z));
    let last = vec2<i32>(image.yz) - 1;
    let cell = at * image.yz - 0.5;
    let below = floor(cell);
    let part = cell - below;
    let low = clamp(vec2<i32>(below), vec2(0), last);
    let high = clamp(vec2<i32>(below) + 1, vec2(0), last);
    let start = i32(image.x);
    let columns = last.x + 1;
    let bottom = between(cell_at(start + low.y * columns + low.x), cell_at(start + low.y * columns + high.x), part.x);
    let top = between(cell_at(start + high.y * columns + low.x), cell_at(start + high.y * columns + high.x), part.x);
    return between(bottom, top, part.y);
}

fn cell_at(entry: i32) -> vec4<f32> {
    return widget_entry(u32(entry));
}

fn between(a: vec4<f32>, b: vec4<f32>, part: f32) -> vec4<f32> {
    return a + part * (b - a);
}
