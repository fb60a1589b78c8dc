// The value of the pixel of the slice that the position lies in.

#import stack_at_nearest

fn footprint_of(place: Place) -> Footprint {
    return nearest_footprint(place);
}

fn filtered(values: Values, coding: Coding, place: Place) -> f32 {
    return nearest(values, coding, place);
}
