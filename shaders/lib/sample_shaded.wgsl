// As where gradients count for more than light.

#import sample_scalar_gradient
