// The corners of a cell, where the sampler filters.

#import cell_corners_texels
