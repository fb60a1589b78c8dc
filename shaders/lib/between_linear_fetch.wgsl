// As with the device's own filtering.

#import between_linear
