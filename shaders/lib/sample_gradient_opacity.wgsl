// As where gradients count for more.

#import sample_scalar_gradient
