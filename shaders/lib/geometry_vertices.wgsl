// Vertices of geometry, and which of them make a shape.

struct GeometryVertex {
    place: vec3<f32>,
    radius: f32,
    // Linear.
    color: vec3<f32>,
}

struct GeometryVertices {
    all: array<GeometryVertex>,
}

// Two a round cone, three a triangle.
struct GeometryNumbers {
    all: array<u32>,
}

@group(0) @binding(1) var<storage, read> vertices: GeometryVertices;
@group(0) @binding(2) var<storage, read> numbers: GeometryNumbers;
