// Cut faces: where a ray enters through what has cut the volume (the crop box, a clip plane), what lies there is a
// sample of its own, before all others, and opaque wherever it is not transparent: its segment is longer than any
// extinction is short. CPU reference: src/technique/faces.rs.

#import enters_{cuts=cut}

// Exp of -1e30 times any extinction of a table is 0.
const FACE_LENGTH: f32 = 1e30;
// Greys of a window in place of the picture's own colours.
const FACES_GREY: u32 = 2u;
