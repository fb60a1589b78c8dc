// The corners of a cell, where fetches filter.

#import cell_corners_texels
