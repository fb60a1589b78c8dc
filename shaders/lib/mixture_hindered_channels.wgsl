// Channels in what matter elsewhere leaves of the light.

#import mixture_surfaces_channels
#import light
