// Slices that are gathered in an image of our own: what the host has drawn ends their rays too.

#import host_depth
