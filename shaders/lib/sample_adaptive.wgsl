// One number a sample, in steps that adapt to it.

#import sample_scalar
