// Colours in a light that nothing takes away.

#import mixture_surfaces_colors
#import light_unhindered
