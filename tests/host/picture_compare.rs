//! Numbers that `compare` gives, against small cases by hand and against the authors' FLIP.

use stratavox::color::{ColorSpace, encode_srgb};
use stratavox::picture::Picture;
use stratavox::picture::compare::{
    Comparison, Image, NotComparable, Numbers, PIXELS_PER_DEGREE, flip_map,
};

fn image(width: u32, pixels: Vec<[f32; 4]>) -> Image {
    Image {
        width,
        height: pixels.len() as u32 / width,
        pixels,
        numbers: Numbers::StraightSrgb,
    }
}

/// `width` x `height` opaque pixels.
fn drawn(width: u32, height: u32, color: impl Fn(u32, u32) -> [f32; 3]) -> Image {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = pixels.map(|(x, y)| {
        let [r, g, b] = color(x, y);
        [r, g, b, 1.0]
    });
    image(width, pixels.collect())
}

fn noisy(x: u32, y: u32) -> [f32; 3] {
    [
        ((x * 5 + y * 3) % 32) as f32 / 31.0,
        ((x * x + y) % 17) as f32 / 16.0,
        ((x * y) % 23) as f32 / 22.0,
    ]
}

fn comparison(wanted: &Image, found: &Image) -> Comparison {
    Comparison::of(wanted, found).expect("pictures of one size")
}

#[test]
fn a_picture_is_not_apart_from_itself() {
    let a = drawn(48, 32, noisy);
    let same = comparison(&a, &a);
    assert_eq!((same.max(), same.rmse(), same.differing()), (0.0, 0.0, 0));
    assert_eq!(same.psnr(), f64::INFINITY);
    assert_eq!(same.flip(), Some(0.0));
    let ssim = same.ssim().unwrap();
    assert!((ssim - 1.0).abs() < 1e-12, "{ssim}");
    assert_eq!(same.pixels(), 48 * 32);
    same.at_most(0.0).unwrap();
}

#[test]
fn one_wrong_number_is_found_measured_and_named() {
    let mut pixels = vec![[0.5, 0.5, 0.5, 1.0]; 12];
    let wanted = image(4, pixels.clone());
    pixels[6][2] = 0.25;
    let comparison = comparison(&wanted, &image(4, pixels));
    assert_eq!(comparison.max(), 0.25);
    assert_eq!(comparison.worst_pixel(), [2, 1]);
    assert_eq!(comparison.differing(), 1);
    // One of 48 numbers is off by a quarter.
    let rmse = (0.0625_f64 / 48.0).sqrt();
    assert!(
        (comparison.rmse() - rmse).abs() < 1e-15,
        "{}",
        comparison.rmse()
    );
    // 10 log10(48 / 0.0625)
    let psnr = 28.853_612_2;
    assert!(
        (comparison.psnr() - psnr).abs() < 1e-6,
        "{}",
        comparison.psnr()
    );
    assert!(comparison.at_most(0.25).is_ok());
    let refused = comparison.at_most(0.249).unwrap_err().to_string();
    assert!(
        refused.contains("(2, 1)") && refused.contains("0.25"),
        "{refused}"
    );
}

#[test]
fn of_equal_errors_the_first_is_named() {
    let wanted = image(3, vec![[0.0; 4]; 6]);
    let mut found = wanted.clone();
    found.pixels[1][3] = 0.5;
    found.pixels[5][0] = 0.5;
    assert_eq!(comparison(&wanted, &found).worst_pixel(), [1, 0]);
}

#[test]
fn half_covered_white_looks_like_half_the_light() {
    let half = encode_srgb(0.5_f32);
    let (thin, grey) = ([1.0, 1.0, 1.0, 0.5], [half, half, half, 1.0]);
    let comparison = comparison(&image(4, vec![thin; 12]), &image(4, vec![grey; 12]));
    assert_eq!(comparison.max(), 0.5);
    let (flip, ssim) = (comparison.flip().unwrap(), comparison.ssim().unwrap());
    // FLIP rises with the 0.7th power of f32's rounding.
    assert!(flip < 1e-4 && ssim > 1.0 - 1e-6, "flip {flip}, ssim {ssim}");
}

#[test]
fn nan_matches_nan_only() {
    let with = |x: f32| image(2, vec![[0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0, 1.0]]);
    let same = comparison(&with(f32::NAN), &with(f32::NAN));
    assert_eq!((same.max(), same.nan_mismatches()), (0.0, 0));
    for other in [0.0, f32::INFINITY] {
        for (a, b) in [(f32::NAN, other), (other, f32::NAN)] {
            let apart = comparison(&with(a), &with(b));
            assert_eq!(apart.max(), f64::INFINITY, "{a} and {b}");
            assert_eq!(apart.worst_pixel(), [1, 0]);
            assert_eq!(apart.nan_mismatches(), 1);
            assert!(apart.at_most(f64::MAX).is_err());
        }
    }
    let same = comparison(&with(f32::INFINITY), &with(f32::INFINITY));
    assert_eq!(same.max(), 0.0);
}

#[test]
fn a_limit_that_is_no_number_lets_nothing_pass() {
    let a = drawn(3, 3, noisy);
    assert!(comparison(&a, &a).at_most(f64::NAN).is_err());
}

#[test]
fn pictures_of_other_sizes_and_empty_ones_are_not_compared() {
    let (wide, tall) = (drawn(4, 2, noisy), drawn(2, 4, noisy));
    let error = Comparison::of(&wide, &tall).unwrap_err();
    assert_eq!(
        error.to_string(),
        "wanted a picture of 4x2, found one of 2x4"
    );
    let empty = Image {
        width: 0,
        height: 0,
        ..image(1, vec![])
    };
    assert!(matches!(
        Comparison::of(&empty, &empty),
        Err(NotComparable::Pixels { .. })
    ));
    let short = Image {
        height: 3,
        ..drawn(4, 2, noisy)
    };
    assert!(matches!(
        Comparison::of(&short, &short),
        Err(NotComparable::Pixels { .. })
    ));
    let plain = Image {
        numbers: Numbers::Plain,
        ..drawn(4, 2, noisy)
    };
    assert!(matches!(
        Comparison::of(&plain, &wide),
        Err(NotComparable::Channels { .. })
    ));
}

#[test]
fn plain_numbers_are_compared_alone() {
    let with = |x: f32| Image {
        numbers: Numbers::Plain,
        ..image(2, vec![[1e6, 0.0, 0.0, 0.0], [x, 9.0, 9.0, 9.0]])
    };
    let comparison = comparison(&with(3.0), &with(7.0));
    assert_eq!(comparison.max(), 4.0);
    // Two numbers, not eight.
    assert!(
        (comparison.rmse() - 8_f64.sqrt()).abs() < 1e-15,
        "{}",
        comparison.rmse()
    );
    assert_eq!((comparison.ssim(), comparison.flip()), (None, None));
}

#[test]
fn light_is_made_into_srgb_numbers_where_the_other_picture_has_those() {
    // Half covered by linear 0.214041: straight sRGB 0.5 and alpha 0.5.
    let light = Picture {
        width: 1,
        height: 1,
        pixels: vec![[0.107_020_57, 0.0, 0.0, 0.5]],
        color_space: ColorSpace::Linear,
        layers: vec![],
    };
    let straight = image(1, vec![[0.5, 0.0, 0.0, 0.5]]);
    let found = comparison(&straight, &Image::from(&light)).max();
    assert!(found < 1e-6, "{found}");
}

#[test]
fn ssim_of_two_flat_pictures_is_its_luminance_term() {
    let (a, b) = (
        drawn(16, 16, |_, _| [0.25; 3]),
        drawn(16, 16, |_, _| [0.75; 3]),
    );
    // (2 ma mb + 1e-4) / (ma^2 + mb^2 + 1e-4)
    let wanted = (2.0 * 0.25 * 0.75 + 1e-4) / (0.0625 + 0.5625 + 1e-4);
    for size in [16, 3] {
        let crop = |image: &Image| drawn(size, size, |_, _| [image.pixels[0][0]; 3]);
        let found = comparison(&crop(&a), &crop(&b)).ssim().unwrap();
        assert!((found - wanted).abs() < 1e-9, "{found}, not {wanted}");
    }
}

#[test]
fn ssim_of_opposite_patterns_is_negative_and_the_same_both_ways() {
    let board = |x: u32, y: u32| [((x + y) % 2) as f32; 3];
    let (a, b) = (drawn(24, 24, board), drawn(24, 24, |x, y| board(x + 1, y)));
    let there = comparison(&a, &b).ssim().unwrap();
    let back = comparison(&b, &a).ssim().unwrap();
    // Means are equal; covariance is minus the variance v = 1/4 (the blurred board is 1/2 to 1e-6):
    // (C2 - 2v) / (C2 + 2v).
    let wanted = (9e-4 - 0.5) / (9e-4 + 0.5);
    assert!((there - wanted).abs() < 1e-4, "{there}, not {wanted}");
    assert!((there - back).abs() < 1e-14, "{there} and {back}");
}

#[test]
fn flip_agrees_with_its_authors_program() {
    // flip_evaluator 1.x (NVIDIA's C++, single precision) on the same pictures: the mean, and the map at
    // (0, 0), (20, 10), (47, 31), (24, 16).
    type Draw = fn(u32, u32) -> [f32; 3];
    let ramp: Draw = |x, _| [x as f32 / 47.0; 3];
    let bluish: Draw = |x, _| {
        let level = x as f32 / 47.0;
        [level, level, (level + 0.05).min(1.0)]
    };
    let flat: Draw = |_, _| [0.2, 0.3, 0.4];
    let dot: Draw = |x, y| {
        if (x, y) == (20, 10) {
            [1.0; 3]
        } else {
            [0.2, 0.3, 0.4]
        }
    };
    let edge: Draw = |x, _| {
        if x >= 24 {
            [0.9, 0.5, 0.1]
        } else {
            [0.1, 0.1, 0.2]
        }
    };
    let moved: Draw = |x, _| {
        if x >= 25 {
            [0.9, 0.5, 0.1]
        } else {
            [0.1, 0.1, 0.2]
        }
    };
    let noisy2: Draw = |x, y| {
        let red = ((x * 5 + y * 3 + x / 8) % 32) as f32 / 31.0;
        [red, noisy(x, y)[1], ((x * y + 2) % 23) as f32 / 22.0]
    };
    let cases: [(&str, Draw, Draw, [f64; 5]); 7] = [
        (
            "noise",
            noisy,
            noisy2,
            [
                0.187_286_600_5,
                0.036_985_892_8,
                0.125_640_109_2,
                0.205_147_415_4,
                0.196_174_025_5,
            ],
        ),
        (
            "black, white",
            |_, _| [0.0; 3],
            |_, _| [1.0; 3],
            [
                0.967_399_120_3,
                0.967_388_331_9,
                0.967_388_331_9,
                0.967_388_331_9,
                0.967_388_331_9,
            ],
        ),
        (
            "green, blue",
            |_, _| [0.0, 1.0, 0.0],
            |_, _| [0.0, 0.0, 1.0],
            [1.0; 5],
        ),
        (
            "ramps",
            ramp,
            bluish,
            [
                0.151_114_776_7,
                0.027_794_301_5,
                0.157_829_314_5,
                0.071_947_090_3,
                0.171_588_346_2,
            ],
        ),
        (
            "dot",
            flat,
            dot,
            [0.005_205_068_3, 0.0, 0.571_492_850_8, 0.0, 0.001_786_209_8],
        ),
        (
            "no dot",
            dot,
            flat,
            [0.005_205_068_3, 0.0, 0.571_492_850_8, 0.0, 0.001_786_209_8],
        ),
        (
            "edge",
            edge,
            moved,
            [0.079_155_571_8, 0.0, 0.156_984_612_3, 0.0, 0.499_031_245_7],
        ),
    ];
    for (name, a, b, wanted) in cases {
        let numbers = |draw: Draw| -> Vec<[f64; 3]> {
            let pixels = drawn(48, 32, draw).pixels;
            pixels
                .iter()
                .map(|p| [p[0].into(), p[1].into(), p[2].into()])
                .collect()
        };
        let map = flip_map(&numbers(a), &numbers(b), 48, PIXELS_PER_DEGREE);
        let mean = map.iter().sum::<f64>() / map.len() as f64;
        let found = [
            mean,
            map[0],
            map[10 * 48 + 20],
            map[31 * 48 + 47],
            map[16 * 48 + 24],
        ];
        for (found, wanted) in found.into_iter().zip(wanted) {
            // Their f32 sums of some 400 terms.
            assert!(
                (found - wanted).abs() < 3e-4,
                "{name}: {found}, not {wanted}"
            );
        }
        let through = comparison(&drawn(48, 32, a), &drawn(48, 32, b))
            .flip()
            .unwrap();
        assert!(
            (through - mean).abs() < 1e-12,
            "{name}: {through}, not {mean}"
        );
    }
}

#[test]
fn the_difference_picture_shows_where_and_marks_what_is_missing() {
    let wanted = image(3, vec![[0.0, 0.0, 0.0, 1.0]; 3]);
    let mut found = wanted.clone();
    found.pixels[1][0] = 0.5;
    found.pixels[2][1] = f32::NAN;
    let picture = comparison(&wanted, &found).picture();
    assert_eq!(
        picture.pixels,
        [[0.0, 0.0, 0.0, 1.0], [1.0; 4], [1.0, 0.0, 1.0, 1.0]]
    );
}
