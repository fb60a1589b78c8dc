// As where gradients count: where a sample was taken and along which ray.

#import sample_scalar_gradient
