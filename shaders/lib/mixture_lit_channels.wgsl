// Channels in a light that nothing takes away.

#import mixture_surfaces_channels
#import light_unhindered
