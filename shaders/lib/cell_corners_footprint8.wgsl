// The corners of a cell, of 8-bit voxels.

#import cell_corners_faces
#import filter_footprint8
