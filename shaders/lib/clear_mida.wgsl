// What rays of MIDA leave that meet nothing.

#import clear_images
#import no_value

fn kept() -> f32 {
    return NO_VALUE;
}
