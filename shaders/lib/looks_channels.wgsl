#import looks_one
