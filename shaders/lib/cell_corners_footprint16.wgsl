// The corners of a cell, of 16-bit voxels.

#import cell_corners_faces
#import filter_footprint16
