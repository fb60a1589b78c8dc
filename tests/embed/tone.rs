//! What a host gets of a toned picture is the CPU's tone of the picture without one, whatever has gathered it; and a tone is
//! refused where there is no light for it.

use crate::driver_faults::{TONE_FAULTS, alone, faulty, tell, told};
use crate::embed_shared::{Host, HostImage, Stage, offscreen};
use crate::formats::{Stored, drawn, renderer};
use ash::vk;
use stratavox::embed::SliceBlending;
use stratavox::picture::{ColorSpace, Picture, Tone, ToneCurve};
use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{Level, Light, Mode, Order, Settings, Technique};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

const TARGETS: [(vk::Format, Stored); 4] = [
    (FLOATS, Stored::Floats([23; 4])),
    (vk::Format::R16G16B16A16_SFLOAT, Stored::Floats([10; 4])),
    (vk::Format::R8G8B8A8_SRGB, Stored::SrgbCodes),
    (vk::Format::R8G8B8A8_UNORM, Stored::Codes([255.0; 4])),
];

/// Vulkan lets a division of f32 be 2.5 units in the last place off, and other operations half of one. Either curve has four
/// divisions and twenty other operations of numbers that count no more than 1, from the light on; Hable's is divided by .73 at
/// the end. Of exposed light without a curve it is one product.
const ROUNDED: f64 = (4.0 * 2.5 + 20.0 * 0.5) * 1.4 / (1 << 23) as f64;

fn tones() -> [Tone; 5] {
    let tone = |exposure, curve| Tone { exposure, curve };
    [
        tone(-1.5, ToneCurve::None),
        tone(0.0, ToneCurve::Neutral),
        tone(2.5, ToneCurve::Neutral),
        tone(0.0, ToneCurve::Filmic),
        tone(3.0, ToneCurve::Filmic),
    ]
}

/// Paths under a sky that is brighter than white.
fn bright() -> Settings {
    Settings {
        technique: Technique::Pathtrace,
        path: PathTracing {
            samples: 2,
            samples_per_frame: 2,
            lights: vec![Light::of_world(glam::dvec3(0.3, -0.5, 0.8), [1.0; 3])],
            sky: [2.0, 1.0, 0.5],
            ..PathTracing::default()
        },
        ..Settings::default()
    }
}

/// Each way in which light is gathered outside of the host's rendering.
fn ways() -> Vec<Settings> {
    let technique = |technique| Settings {
        technique,
        ..Settings::default()
    };
    let of = |mode| Settings {
        mode,
        ..Settings::default()
    };
    let mut surfaces = of(Mode::Iso);
    surfaces.per_mode.levels = vec![Level {
        value: 0.5,
        srgb: [0.9, 0.6, 0.3],
        opacity: 0.7,
    }];
    let mut all = vec![of(Mode::Composite), of(Mode::Mida), surfaces, bright()];
    all.extend(
        [
            Technique::ShearWarp,
            Technique::Splat,
            Technique::Slices3d,
            Technique::Slices2d,
        ]
        .map(technique),
    );
    all
}

fn stage(settings: Settings) -> Stage {
    let mut stage = Stage::new(settings);
    stage.settings.conformance = false;
    stage
}

/// What the CPU makes of a picture.
fn toned(pixels: &[[f64; 4]], extent: [u32; 2], tone: Tone) -> Vec<[f64; 4]> {
    let mut picture = Picture {
        width: extent[0],
        height: extent[1],
        pixels: pixels.iter().map(|p| p.map(|c| c as f32)).collect(),
        color_space: ColorSpace::Linear,
        layers: Vec::new(),
    };
    picture.apply_tone(tone);
    let pixels = picture.pixels.iter();
    pixels.map(|p| p.map(f64::from)).collect()
}

#[test]
fn the_target_gets_the_tone_of_the_cpu_whatever_gathers_the_light() {
    let host = Host::new();
    for settings in ways() {
        for target in TARGETS {
            assert_eq!(off(&host, settings.clone(), target), Ok(()));
        }
    }
}

#[test]
fn each_fault_of_tones_is_seen() {
    let _alone = alone();
    for (what, fault) in TONE_FAULTS {
        tell(Some(*fault));
        // SAFETY: its functions are Vulkan's, but for shaders that are others.
        let found = off(&unsafe { Host::through(faulty) }, bright(), TARGETS[0]);
        assert!(told() > 0, "{what}: no shader has it");
        tell(None);
        println!("{what}: {}", found.expect_err(what));
    }
}

/// The first number of toned pictures that is off, in words.
fn off(
    host: &Host,
    settings: Settings,
    (format, stored): (vk::Format, Stored),
) -> Result<(), String> {
    let mut stage = stage(settings);
    let what = format!("{} {}", stage.settings.technique, stage.settings.mode);
    if !host.gpu().format_features(format).blend {
        println!("skipped: this device does not blend {format:?}");
        return Ok(());
    }
    let untoned = offscreen(&stage);
    let mut renderer = renderer(host, &stage, format, SliceBlending::Float);
    let image = HostImage::new(host, format, stage.extent);
    for tone in tones() {
        stage.settings.tone = tone;
        renderer.set_settings(stage.settings.clone()).unwrap();
        drawn(host, &mut renderer, &stage, &image, 'B');
        let (found, wanted) = (image.numbers(), toned(&untoned, stage.extent, tone));
        let changed = wanted.iter().zip(&untoned).filter(|(a, b)| a != b).count();
        assert!(changed > 100, "{what}, {tone:?} changes {changed} pixels");
        for (k, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
            for (c, &found) in found.iter().enumerate() {
                let rounded = ROUNDED * wanted[c].abs().max(1.0);
                let [(low, below), (high, above)] =
                    [-rounded, rounded].map(|off| stored.of(c, wanted[c] + off));
                if found < low - below || found > high + above {
                    return Err(format!(
                        "{what} into {format:?}, {tone:?}, channel {c} of {k}: {found} for {low} to {high} +- {above}"
                    ));
                }
            }
        }
    }
    Ok(())
}

#[test]
fn no_tone_is_the_same_bytes_as_ever() {
    let host = Host::new();
    for settings in ways() {
        // Paths are rounded once more than offscreen: tests/embed/paths.rs.
        if settings.technique == Technique::Pathtrace {
            continue;
        }
        let mut stage = stage(settings);
        let wanted = offscreen(&stage);
        stage.settings.tone.exposure = 1.0;
        let mut renderer = renderer(&host, &stage, FLOATS, SliceBlending::Float);
        let image = HostImage::new(&host, FLOATS, stage.extent);
        drawn(&host, &mut renderer, &stage, &image, 'B');
        let exposed = image.numbers();
        stage.settings.tone = Tone::default();
        renderer.set_settings(stage.settings.clone()).unwrap();
        drawn(&host, &mut renderer, &stage, &image, 'B');
        let what = stage.settings.technique;
        assert!(image.numbers() == wanted, "{what}");
        assert!(exposed != wanted, "{what}");
    }
}

/// Paths go on under another tone, and what they have added up to is shown with it.
#[test]
fn another_tone_does_not_begin_paths_anew() {
    let host = Host::new();
    let mut settings = bright();
    settings.path.samples = 4;
    let mut stage = stage(settings);
    let mut renderer = renderer(&host, &stage, FLOATS, SliceBlending::Float);
    let image = HostImage::new(&host, FLOATS, stage.extent);
    drawn(&host, &mut renderer, &stage, &image, 'B');
    assert_eq!(renderer.paths_traced(), 2);
    stage.settings.tone.curve = ToneCurve::Neutral;
    renderer.set_settings(stage.settings.clone()).unwrap();
    drawn(&host, &mut renderer, &stage, &image, 'B');
    assert_eq!(renderer.paths_traced(), 4);
    stage.settings.path.seed = 9;
    renderer.set_settings(stage.settings.clone()).unwrap();
    drawn(&host, &mut renderer, &stage, &image, 'B');
    assert_eq!(renderer.paths_traced(), 2);
}

#[test]
fn a_tone_of_what_is_no_light_is_refused_by_name() {
    let exposed = |settings: Settings| Settings {
        tone: Tone {
            exposure: 1.0,
            curve: ToneCurve::None,
        },
        ..settings
    };
    let refused = |settings: Settings| {
        let found = exposed(settings).check().expect_err("refused");
        found.to_string()
    };
    for mode in [Mode::Mip, Mode::Average, Mode::Xray] {
        let found = refused(Settings {
            mode,
            ..Settings::default()
        });
        let wanted = format!("tone mapping is for composites and surfaces, not for mode {mode}");
        assert_eq!(found, wanted);
    }
    let found = refused(Settings {
        color_space: ColorSpace::Display,
        ..Settings::default()
    });
    assert_eq!(
        found,
        "tone mapping is for linear light, not for display numbers"
    );
    for exposure in [127.0, -127.0, f64::NAN] {
        let mut settings = Settings::default();
        settings.tone.exposure = exposure;
        let found = settings.check().expect_err("refused").to_string();
        assert!(found.contains("-126 to 126 stops"), "{found}");
    }
    // Slices that are blended in the target are no picture before they are there.
    let host = Host::new();
    let sliced = stage(exposed(Settings {
        technique: Technique::Slices3d,
        order: Order::BackToFront,
        ..Settings::default()
    }));
    let volume = stratavox::embed::Volume::new(host.gpu(), &sliced.volume, &sliced.settings);
    let desc = stratavox::embed::RendererDesc {
        settings: sliced.settings.clone(),
        target: FLOATS.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: SliceBlending::InTarget,
    };
    let (volume, function) = (volume.unwrap().into(), Some(&sliced.transfer));
    let made =
        stratavox::embed::Renderer::new(host.gpu(), &volume, function, desc, sliced.extent, &[]);
    let found = made.expect_err("refused").to_string();
    assert!(found.contains("tone mapping of slices"), "{found}");
}
