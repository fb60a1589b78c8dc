// As where gradients count for light alone: what is scattered is expensive.

#import unroll_shaded
