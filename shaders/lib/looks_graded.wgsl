// There is much to do at each sample.

#import looks_one
