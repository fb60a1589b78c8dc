// Values without a unit: 0 and 1 are the ends of a window, or of the volume's range.

#import frame

fn unit_from_value(value: f32) -> f32 {
    return clamp((value - frame.value_low) * frame.value_scale, 0.0, 1.0);
}

fn value_from_unit(unit: f32) -> f32 {
    return frame.value_low + unit / frame.value_scale;
}
