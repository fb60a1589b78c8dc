// As where gradients count for light alone: they are dear.

#import unroll_lit
