// What a sample is made of, where steps adapt.

#import material_scalar
