//! What is refused, by name.

use super::desc;
use crate::embed_shared::{Host, Stage, eyes};
use ash::vk;
use glam::DVec3;
use stratavox::camera::{Camera, DepthConvention};
use stratavox::embed::{Error, FrameInfo, Geometry, GeometryDesc};
use stratavox::geometry::{self, RoundCones, Vertex};
use stratavox::gpu::{self, Caps, TargetClass};
use stratavox::technique::Settings;

fn line(count: u32, radius: f64, place: DVec3) -> geometry::Geometry {
    let mut cones = RoundCones::default();
    cones.add_line((0..count).map(|i| Vertex {
        place: place * f64::from(i),
        radius,
        color: [0.5; 3],
    }));
    cones.into()
}

fn refused(host: &Host, shapes: &geometry::Geometry, desc: GeometryDesc) -> String {
    let made = Geometry::new(host.gpu(), shapes, desc).map(drop);
    assert!(host.gpu().live_objects().is_empty());
    made.expect_err("refused").to_string()
}

#[test]
fn shapes_and_targets_that_are_none_are_refused_by_name() {
    let host = Host::new();
    let right = desc(DepthConvention::Standard);
    for (radius, place, wanted) in [
        (
            0.0,
            DVec3::X,
            "vertex 0 of round cones: its radius: wanted a length over 0",
        ),
        (f64::NAN, DVec3::X, "found NaN"),
        (
            1.0,
            DVec3::splat(f64::NAN),
            "vertex 0 of round cones: its place: wanted a place",
        ),
        (1.0, DVec3::splat(1e200), "f32 can hold"),
    ] {
        let said = refused(&host, &line(3, radius, place), right);
        assert!(said.contains(wanted), "{said}");
    }
    let shapes = line(3, 1.0, DVec3::X);
    let without = GeometryDesc {
        target: TargetClass {
            depth: None,
            ..right.target
        },
        ..right
    };
    let said = refused(&host, &shapes, without);
    assert!(
        said.contains("a depth attachment in `GeometryDesc::target`"),
        "{said}"
    );
    let many = GeometryDesc {
        frames_in_flight: 65,
        ..right
    };
    let said = refused(&host, &shapes, many);
    assert!(said.contains("1 to 64 frames"), "{said}");
}

#[test]
fn buffers_beyond_a_limit_or_a_budget_are_refused_before_anything_is_made() {
    let host = Host::with_caps(Caps {
        max_storage_buffer_range: 1 << 16,
        ..Caps::UNLIMITED
    });
    let right = desc(DepthConvention::Standard);
    let said = refused(&host, &line(2049, 1.0, DVec3::X), right);
    assert!(
        said.contains("maxStorageBufferRange allows 65536, wanted 65568"),
        "{said}"
    );
    Geometry::new(host.gpu(), &line(2048, 1.0, DVec3::X), right).unwrap();
    let host = Host::new();
    // 32 bytes a vertex and 8 a cone, on the device and staged.
    let needed = 2 * (32 * 100 + 8 * 99);
    host.gpu().set_memory_budget(Some(needed - 1));
    let made = Geometry::new(host.gpu(), &line(100, 1.0, DVec3::X), right).map(drop);
    let Err(Error::Gpu(gpu::Error::Limit { doing, wanted, .. })) = made else {
        panic!("{made:?}");
    };
    assert_eq!(wanted, needed);
    assert_eq!(doing, "put 99 round cones and 0 triangles on the device");
}

#[test]
fn draws_out_of_their_order_are_refused_and_no_shape_draws_nothing() {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let [eye, ..] = eyes(&stage);
    let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
    let right = desc(DepthConvention::Standard);
    let mut made = Geometry::new(host.gpu(), &line(3, 1.0, DVec3::X), right).unwrap();
    let shot = FrameInfo {
        frame: 0,
        camera: &camera,
        depth: Some(depth),
    };
    let draw = |made: &Geometry, shot: &FrameInfo| {
        // SAFETY: refused before anything is recorded.
        unsafe { made.draw(vk::CommandBuffer::null(), shot, stage.extent) }
    };
    assert!(matches!(draw(&made, &shot), Err(Error::NotUploaded)));
    // SAFETY: outside rendering; `run` waits. The second is refused before anything is recorded.
    host.run(|cmd| unsafe {
        made.record_upload(cmd).unwrap();
        assert!(matches!(made.record_upload(cmd), Err(Error::Uploaded)));
    });
    let late = FrameInfo { frame: 1, ..shot };
    assert!(matches!(
        draw(&made, &late),
        Err(Error::NoFrame { found: 1, of: 1 })
    ));
    let blind = FrameInfo {
        depth: None,
        ..shot
    };
    assert!(matches!(draw(&made, &blind), Err(Error::HostDepth { .. })));
    let mut other = depth;
    other.nearer = DepthConvention::Reversed;
    let turned = FrameInfo {
        depth: Some(other),
        ..shot
    };
    assert!(matches!(draw(&made, &turned), Err(Error::HostDepth { .. })));
    let found = super::drawn(
        &host,
        &geometry::Geometry::default(),
        (&camera, &depth),
        stage.extent,
    );
    assert!(found.pixels.iter().all(|pixel| *pixel == [0.0; 4]));
}
