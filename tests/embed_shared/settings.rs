//! What is drawn in all the ways of a host.

use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{Level, Light, Mode, Order, Settings, SingleScattering, Technique};

/// Every way into a host's frame.
pub fn all_settings() -> Vec<Settings> {
    let modes = [
        Mode::Composite,
        Mode::Mip,
        Mode::Average,
        Mode::Mida,
        Mode::Iso,
    ];
    let rays = modes.map(|mode| Settings {
        mode,
        ..Settings::default()
    });
    let sliced = [Technique::Slices3d, Technique::Slices2d].into_iter();
    let slices = sliced.flat_map(|technique| {
        [Mode::Composite, Mode::Mip, Mode::Xray].map(|mode| Settings {
            technique,
            mode,
            order: Order::BackToFront,
            ..Settings::default()
        })
    });
    let front_to_back = [Technique::Slices3d, Technique::Slices2d].map(|technique| Settings {
        technique,
        order: Order::FrontToBack,
        ..Settings::default()
    });
    let filters = [
        stratavox::technique::Filter::Nearest,
        stratavox::technique::Filter::Cubic,
    ];
    let filtered = filters.map(|filter| Settings {
        filter,
        ..Settings::default()
    });
    let slabs = Settings {
        preintegrated: true,
        ..Settings::default()
    };
    // What the light has left comes slice by slice.
    let shaded = stratavox::technique::Shading {
        shadows: stratavox::technique::Shadows::HalfAngle,
        ..Default::default()
    };
    let in_light = Settings {
        technique: Technique::Slices3d,
        shading: Some(shaded),
        ..Settings::default()
    };
    let scattered = [SingleScattering::March, SingleScattering::Open].map(|scattering| Settings {
        single_scattering: Some(scattering),
        path: PathTracing {
            lights: vec![Light::of_world(glam::dvec3(0.3, -0.5, 0.8), [1.0; 3])],
            density: 0.5,
            ..PathTracing::default()
        },
        ..Settings::default()
    });
    let all = rays
        .into_iter()
        .chain(slices)
        .chain(front_to_back)
        .chain(filtered)
        .chain([slabs, in_light])
        .chain(scattered);
    all.map(|mut settings| {
        if settings.mode == Mode::Iso {
            settings.per_mode.levels = vec![Level {
                value: 0.5,
                srgb: [0.9, 0.6, 0.3],
                opacity: 1.0,
            }];
        }
        settings
    })
    .collect()
}
