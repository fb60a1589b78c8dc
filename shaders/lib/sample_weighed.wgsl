// As where gradients count for more.

#import sample_graded
