// What rays of composites and surfaces leave that meet nothing.

#import nothing_images

const KEPT: f32 = 0.0;
