// What rays of composites and surfaces leave that meet nothing.

#import clear_images

fn kept() -> f32 {
    return 0.0;
}
