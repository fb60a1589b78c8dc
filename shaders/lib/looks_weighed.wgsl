// As where gradients count for light alone: they are dear.

#import looks_lit
