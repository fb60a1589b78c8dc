// How much of its opacity a value keeps where it is so steep: a share s between 0 and 1, linear between points,
//
//     alpha' = s(|gradient| / steepest) alpha
//
// How the points lie in the buffer, and the CPU reference: src/transfer/widgets.rs.

#import frame
#import opacity
#import extinction
#import transfer_numbers

// An entry of what gradients make of the function: (1 / steepest, count of shares, count of widgets, 1 where second
// derivatives count), shares, five entries a widget, cells of images.
fn widget_entry(entry: u32) -> vec4<f32> {
    return transfer_numbers.d[frame.first_widget_entry + entry];
}

// What is left of an extinction; all of it where there is no point.
fn weighted_extinction(extinction: f32, steepness: f32) -> f32 {
    let count = u32(widget_entry(0).y);
    if count == 0u {
        return extinction;
    }
    let opacity = opacity_over(extinction, frame.reference_length);
    return extinction_of(opacity * share_at(count, steepness), frame.reference_length);
}

// Between the points that a steepness lies between, constant beyond them.
fn share_at(count: u32, steepness: f32) -> f32 {
    var share = widget_entry(1).y;
    for (var i = 1u; i <= count; i++) {
        let left = widget_entry(i);
        if left.x > steepness {
            break;
        }
        share = left.y;
        if i < count {
            let right = widget_entry(i + 1u);
            if right.x > steepness {
                share = left.y + (steepness - left.x) / (right.x - left.x) * (right.y - left.y);
            }
        }
    }
    return share;
}
