// As where gradients count for light alone: they are expensive.

#import unroll_shaded
