//! Presets, windows, and the transfer function that a volume gets when nothing is asked for.

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::transfer_shared;

#[cfg(feature = "files")]
use std::path::PathBuf;
use stratavox::transfer::{
    Classified, Interpolation, Kind, Preset, Quantity, TransferFunction, ValueSummary, Window,
    automatic,
};

use transfer_shared::Random;

fn summary(values: &[f64]) -> ValueSummary {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    ValueSummary::of(values.len(), [low, high], 512.0, false, |i| Some(values[i]))
}

/// Background with noise of `noise`, and a share of voxels between `low` and `high`.
fn object(random: &mut Random, share: f64, noise: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let values = (0..40_000).map(|_| {
        if random.unit() < share {
            low + (high - low) * random.unit()
        } else {
            noise * random.unit()
        }
    });
    values.map(f64::round).collect()
}

fn window(low: f64, high: f64) -> Window {
    Window::new(low, high).expect("low below high")
}

#[test]
fn quantiles_and_modes_are_those_of_the_values() {
    let values: Vec<f64> = (0..1000)
        .map(|i| f64::from(i % 100))
        .chain([7.0; 500])
        .collect();
    let summary = summary(&values);
    assert_eq!(summary.histogram.iter().sum::<u64>(), 1500);
    assert_eq!(summary.mode_below(1e9), 7.0);
    assert_eq!(summary.mode_below(5.0), 0.0);
    // 70 values lie below 7, 510 are 7.
    assert_eq!(summary.share_below(7.0), 70.0 / 1500.0);
    assert_eq!(summary.share_below(8.0), 580.0 / 1500.0);
    // A third of 1500 are 500: 430 of the 510 sevens, whose bin goes from 6.5 to 7.5.
    let third = summary.quantile(1.0 / 3.0);
    assert!((third - (6.5 + 430.0 / 510.0)).abs() < 1e-9, "{third}");
}

#[test]
fn the_threshold_lies_between_two_classes() {
    let mut random = Random(4);
    let values = object(&mut random, 0.3, 20.0, [100.0, 160.0]);
    let threshold = summary(&values).threshold(0.0, 160.0);
    assert!((20.0..=100.0).contains(&threshold), "{threshold}");
    // Half-way between two single values.
    let two = summary(&[0.0, 0.0, 10.0, 10.0]).threshold(0.0, 10.0);
    assert!((two - 5.0).abs() < 1.0, "{two}");
}

#[test]
fn each_kind_of_volume_is_known_for_what_it_is() {
    let mut random = Random(5);
    let mut noise = move |n: f64| n * random.unit();
    let tissue = object(&mut Random(6), 0.4, 12.0, [60.0, 220.0]);
    let sparse = object(&mut Random(7), 0.004, 6.0, [90.0, 250.0]);
    // Runs of 12 voxels of one label, any of 40, much background.
    let labels: Vec<f64> = (0..40_000_u32)
        .map(|i| (i / 12).wrapping_mul(2_654_435_761) >> 20)
        .map(|hash| {
            if hash % 2 == 0 {
                0.0
            } else {
                f64::from(hash % 40)
            }
        })
        .collect();
    let mask: Vec<f64> = (0..40_000)
        .map(|i| f64::from(u8::from(i / 100 % 3 == 0)) * 255.0)
        .collect();
    // An 8-bit field as smooth as can be: neighbours are mostly equal, and no labels.
    let smooth: Vec<f64> = (0..40_000)
        .map(|i| (127.5 + 127.5 * (f64::from(i) / 700.0).sin()).round())
        .collect();
    let ct: Vec<f64> = (0..40_000)
        .map(|i| match i % 10 {
            0..5 => -1000.0 + noise(30.0),
            5..9 => 40.0 + noise(60.0),
            _ => 300.0 + noise(1200.0),
        })
        .map(f64::round)
        .collect();
    let temperature: Vec<f64> = (0..40_000)
        .map(|i| 230.0 + 60.0 * (f64::from(i) / 5000.0).sin())
        .collect();
    // No CT for a little padding of -1000, nor for a range that happens to begin there.
    let padded: Vec<f64> = object(&mut Random(10), 0.4, 12.0, [60.0, 220.0])
        .into_iter()
        .enumerate()
        .map(|(i, value)| if i % 100 == 0 { -1000.0 } else { value })
        .collect();
    let mut third = {
        let mut random = Random(11);
        move || random.unit() * 2000.0 / 3.0
    };
    let bell: Vec<f64> = (0..40_000)
        .map(|_| (third() + third() + third() - 1000.0).round())
        .collect();
    let even: Vec<f64> = (0..40_000)
        .map(|i| f64::from(i * 7 % 2001 - 1000))
        .collect();
    let wave: Vec<f64> = (0..40_000)
        .map(|i| (f64::from(i) / 50.0).sin() * 3e4)
        .map(f64::round)
        .collect();
    let cases = [
        (Kind::Tissue, tissue),
        (Kind::Sparse, sparse),
        (Kind::Labels, labels),
        (Kind::Labels, mask),
        (Kind::Field, smooth),
        (Kind::Ct, ct),
        (Kind::Field, temperature),
        (Kind::Signed, wave),
        (Kind::Signed, bell),
        (Kind::Signed, even),
        (Kind::Signed, padded),
    ];
    for (n, (wanted, values)) in cases.into_iter().enumerate() {
        let summary = summary(&values);
        assert_eq!(
            Kind::of(&summary),
            wanted,
            "case {n}, range {:?}",
            summary.range
        );
    }
}

#[test]
fn known_hounsfield_units_need_no_guess() {
    let values: Vec<f64> = (0..1000).map(|i| f64::from(i % 400)).collect();
    let mut summary = summary(&values);
    assert_ne!(Kind::of(&summary), Kind::Ct);
    summary.hounsfield = true;
    assert_eq!(Kind::of(&summary), Kind::Ct);
}

#[test]
fn a_unit_says_what_values_alone_do_not() {
    let mut of = summary(&object(&mut Random(6), 0.4, 12.0, [60.0, 220.0]));
    assert_eq!(Kind::of(&of), Kind::Tissue);
    of.quantity = Quantity::Field;
    assert_eq!(Kind::of(&of), Kind::Field);
    of.quantity = Quantity::Uptake;
    assert_eq!(Kind::of(&of), Kind::Uptake);

    let function = automatic(&of, Classified::Samples, None);
    assert_eq!(
        function,
        Preset::Pet.function(&of, Classified::Samples, None)
    );
    let brightest = of.quantile(0.999);
    assert_eq!(function.opacity(0.03 * brightest), 0.0);
    assert!((function.opacity(brightest) - 0.7).abs() < 1e-12);
    let red_less_blue = |t: f64| function.srgb(t * brightest)[0] - function.srgb(t * brightest)[2];
    assert!(red_less_blue(0.06) < 0.0, "the body is bluish");
    assert!(
        red_less_blue(0.45) > 0.5,
        "what took up more is a glowing orange"
    );

    // Wind blows both ways, and little cloud in clear air stays what it is.
    let mut wind = summary(&[-10.0, -5.0, 0.0, 5.0, 10.0]);
    wind.quantity = Quantity::Field;
    assert_eq!(Kind::of(&wind), Kind::Signed);
    let mut cloud = summary(&object(&mut Random(7), 0.004, 6.0, [90.0, 250.0]));
    cloud.quantity = Quantity::Field;
    assert_eq!(Kind::of(&cloud), Kind::Sparse);
}

/// (file, how it is packed, bytes a voxel, kind)
#[cfg(feature = "files")]
const REAL: &[(&str, &str, usize, Kind)] = &[
    ("ct-cranium/cranium.nrrd", "gzip", 2, Kind::Ct),
    ("ct-cranium/cranium-label.nrrd", "gzip", 1, Kind::Labels),
    ("label-frog/frogtissue.zraw", "zlib", 1, Kind::Labels),
    ("ct-walnut/walnut.raw", "raw", 2, Kind::Tissue),
];

#[cfg(feature = "files")]
#[test]
fn real_volumes_are_known_for_what_they_are() {
    use std::io::Read;
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("STRATAVOX_DATA").map_or(here, PathBuf::from);
    for &(name, packed, bytes, wanted) in REAL {
        let Ok(file) = std::fs::read(folder.join(name)) else {
            println!("{name}: skipped: no data");
            continue;
        };
        let mut data = Vec::new();
        match packed {
            "gzip" => {
                let start = file.windows(2).position(|pair| pair == b"\n\n").unwrap() + 2;
                flate2::read::GzDecoder::new(&file[start..])
                    .read_to_end(&mut data)
                    .unwrap();
            }
            "zlib" => {
                flate2::read::ZlibDecoder::new(&file[..])
                    .read_to_end(&mut data)
                    .unwrap();
            }
            _ => data = file,
        }
        let values: Vec<f64> = if bytes == 2 {
            data.as_chunks::<2>()
                .0
                .iter()
                .map(|&x| i16::from_le_bytes(x).into())
                .collect()
        } else {
            data.into_iter().map(f64::from).collect()
        };
        let summary = summary(&values);
        assert_eq!(
            Kind::of(&summary),
            wanted,
            "{name}, range {:?}",
            summary.range
        );
        println!("{name}: {wanted:?}, {} voxels", values.len());
    }
}

#[test]
fn grey_is_what_the_command_line_promises() {
    let any = summary(&[-100.0, 0.0, 300.0]);
    for (given, low, high) in [
        (None, -100.0, 300.0),
        (Some(window(10.0, 20.0)), 10.0, 20.0),
    ] {
        for t in [-1.0, 0.0, 0.25, 1.0, 2.0] {
            let value = low + t * (high - low);
            let level: f64 = f64::clamp(t, 0.0, 1.0);
            let samples = Preset::Grey.function(&any, Classified::Samples, given);
            assert!((samples.srgb(value)[1] - level).abs() < 1e-12, "{t}");
            assert!((samples.opacity(value) - level / 20.0).abs() < 1e-12, "{t}");
            assert_eq!(samples.reference_length, None);
            let projected = Preset::Grey.function(&any, Classified::Projection, given);
            assert!((projected.srgb(value)[1] - level).abs() < 1e-12, "{t}");
            assert_eq!(projected.opacity(value), 1.0, "{t}");
        }
    }
}

#[test]
fn without_a_word_projections_are_grey_over_the_range_or_the_window() {
    let ct = ValueSummary {
        hounsfield: true,
        ..summary(&[-1000.0, 0.0, 2000.0])
    };
    let function = automatic(&ct, Classified::Projection, None);
    assert_eq!(
        function,
        window(-1000.0, 2000.0).grey(Classified::Projection)
    );
    let given = window(0.0, 80.0);
    let function = automatic(&ct, Classified::Projection, Some(given));
    assert_eq!(function, given.grey(Classified::Projection));
}

#[test]
fn a_window_spreads_a_function_from_its_first_to_its_last_point() {
    let any = summary(&[0.0, 1.0, 2.0]);
    let plain = Preset::CtBone.function(&any, Classified::Samples, None);
    let spread = Preset::CtBone.function(&any, Classified::Samples, Some(window(5.0, 7.0)));
    let values = |tf: &TransferFunction| tf.opacity.iter().map(|p| p.value).collect::<Vec<_>>();
    let (from, to) = (values(&plain), values(&spread));
    assert_eq!((to[0], *to.last().unwrap()), (5.0, 7.0));
    for (a, b) in from.iter().zip(&to) {
        let t = (a - from[0]) / (from.last().unwrap() - from[0]);
        assert!((b - (5.0 + 2.0 * t)).abs() < 1e-12, "{a} became {b}");
        assert_eq!(plain.opacity(*a), spread.opacity(*b));
    }
}

#[test]
fn a_window_has_a_low_end_below_its_high_end() {
    for (low, high) in [
        (1.0, 1.0),
        (2.0, 1.0),
        (f64::NAN, 1.0),
        (0.0, f64::INFINITY),
        (-1e308, 1e308),
    ] {
        assert_eq!(Window::new(low, high), None, "{low}, {high}");
    }
    for value in [0.0, -4.5, 1e20] {
        let around = Window::of_range([value, value]);
        assert!(around.low() < value && value < around.high(), "{around:?}");
    }
}

#[test]
fn backgrounds_are_transparent_and_objects_are_seen() {
    let volumes = [
        (
            object(&mut Random(8), 0.4, 12.0, [60.0, 220.0]),
            0.0..12.0,
            220.0,
        ),
        (
            object(&mut Random(9), 0.004, 6.0, [90.0, 250.0]),
            0.0..6.0,
            250.0,
        ),
        // CT: air, and bone.
        (
            object(&mut Random(1), 0.4, 20.0, [1000.0, 2500.0])
                .iter()
                .map(|v| v - 1000.0)
                .collect(),
            -1000.0..-980.0,
            900.0,
        ),
    ];
    for (values, background, bright) in volumes {
        let summary = summary(&values);
        let function = automatic(&summary, Classified::Samples, None);
        let kind = Kind::of(&summary);
        let (low, high) = (
            function.opacity(background.start),
            function.opacity(background.end),
        );
        assert_eq!((low, high), (0.0, 0.0), "{kind:?}");
        let seen = function.opacity(bright);
        assert!(seen > 0.3, "{kind:?}: {seen}");
    }
}

#[test]
fn a_volume_of_one_value_or_of_none_is_classified_all_the_same() {
    for value in [0.0, 1.5, -1000.0] {
        let same = summary(&[value; 64]);
        for classified in [Classified::Samples, Classified::Projection] {
            let function = automatic(&same, classified, None);
            assert!(
                function.opacity(value) > 0.0,
                "{value} {classified:?}: {function:?}"
            );
        }
    }
    let nothing = ValueSummary::of(64, [0.0, 0.0], 0.0, false, |_| None);
    let function = automatic(&nothing, Classified::Samples, None);
    assert!(function.opacity(0.0).is_finite());
    assert_eq!(function.reference_length, None);
}

#[test]
fn labels_have_colors_of_their_own_and_a_clear_background() {
    // In an order that jumps: a staircase of steps of 1 would be a field.
    let values: Vec<f64> = (0..10_000).map(|i| f64::from(i / 50 * 77 % 200)).collect();
    let summary = summary(&values);
    assert_eq!(Kind::of(&summary), Kind::Labels);
    let function = automatic(&summary, Classified::Samples, None);
    assert_eq!(function.interpolation, Interpolation::Step);
    assert_eq!(function.opacity(0.0), 0.0);
    for a in 1..200 {
        assert!(function.opacity(a.into()) > 0.0, "{a}");
        // What rounds to the label has its colour.
        assert_eq!(
            function.srgb(f64::from(a) + 0.49),
            function.srgb(f64::from(a) - 0.49)
        );
        for b in 1..a {
            let (a, b) = (function.srgb(a.into()), function.srgb(b.into()));
            let apart = (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max);
            assert!(apart > 0.004, "{a:?} and {b:?}");
        }
    }
}

#[test]
fn presets_are_found_by_name_and_hold_to_the_rules_of_functions() {
    let any = summary(&object(&mut Random(2), 0.4, 12.0, [60.0, 220.0]));
    for preset in Preset::ALL {
        assert_eq!(Preset::from_name(preset.name()), Some(preset));
        for given in [None, Some(window(-3.0, 9.0))] {
            let function = preset.function(&any, Classified::Samples, given);
            let ascending = function.color.is_sorted_by_key(|p| p.value)
                && function.opacity.is_sorted_by_key(|p| p.value);
            assert!(ascending && !function.color.is_empty(), "{}", preset.name());
            #[cfg(feature = "json")]
            {
                use stratavox::transfer::{transfer_function_from_json, transfer_function_to_json};
                let text = transfer_function_to_json(&function);
                let back = transfer_function_from_json(text.as_bytes());
                assert_eq!(back.unwrap(), function, "{}", preset.name());
            }
        }
    }
    assert_eq!(Preset::from_name("ct"), None);
}
