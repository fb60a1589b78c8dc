// Which slice (or plane, or slab between planes) an instance shows.
//
// Seen from inside, both halves of a stack run towards the eye: the instances from `slice_turn` on
// start again at the other end, so every pixel meets its slices in order.

#import frame

fn slice_of(instance: u32) -> i32 {
    if instance < frame.slice_turn {
        return frame.slice_first + i32(instance) * frame.slice_direction;
    }
    return frame.slice_first_after_turn - i32(instance - frame.slice_turn) * frame.slice_direction;
}
