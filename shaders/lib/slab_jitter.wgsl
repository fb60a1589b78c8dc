// Slabs of one step each, of which the first is cut short.

#import lattice_jitter
