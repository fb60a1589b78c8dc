// There is much to do at each sample.

#import unroll_one
