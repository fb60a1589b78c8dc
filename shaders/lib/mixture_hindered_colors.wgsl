// Colours in what matter elsewhere leaves of the light.

#import mixture_surfaces_colors
#import light
