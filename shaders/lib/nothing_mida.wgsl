// What rays of MIDA leave that meet nothing.

#import nothing_images
#import no_value

const KEPT: f32 = NO_VALUE;
