//! Built-in volumes: their formulas, their words, and that the head looks like one.

use glam::DVec3;
use stratavox::volume::field::{Ball, Field, Fog, Gaussian, Linear, MarschnerLobb};
use stratavox::volume::{Limits, Problem, Source, TimeComponent, Volume, VoxelType, phantom};

fn open(spec: &str) -> Box<dyn Source> {
    phantom::open(spec, &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn volume(spec: &str) -> Volume {
    let source = open(spec);
    Volume::read(
        &*source,
        TimeComponent::default(),
        source.header().whole(),
        &Limits::default(),
    )
    .unwrap()
}

/// Value of the voxel that a point of the world lies in.
fn value_at(volume: &Volume, world: DVec3) -> f64 {
    let p = volume.world_from_voxel.inverse().transform_point3(world);
    stratavox::volume::sample::nearest(volume, p.to_array()).expect("phantoms have no holes")
}

#[test]
fn a_voxel_holds_the_field_at_its_center() {
    let gauss = Gaussian {
        center: DVec3::new(6.0, -4.0, 3.0),
        deviation: 8.0,
    };
    let volume = volume("phantom:gauss,n=20");
    for (x, y, z) in [(0, 0, 0), (11, 9, 10), (12, 8, 10), (19, 3, 5)] {
        let center = DVec3::new(x.into(), y.into(), z.into()) * 5.0 - 50.0 + 2.5;
        let found = volume
            .voxels
            .stored((z * 20 + y) as usize * 20 + x as usize);
        assert_eq!(found, gauss.value(center) as f32, "voxel {x} {y} {z}");
    }
}

#[test]
fn the_line_integral_of_the_gaussian_is_the_one_of_the_books() {
    // A10: sqrt(2 pi) s exp(-b^2 / 2 s^2) at distance b; a sum of steps h errs by 2 exp(-2 pi^2 s^2 / h^2).
    let gauss = Gaussian {
        center: DVec3::new(1.0, -2.0, 0.5),
        deviation: 3.0,
    };
    let direction = DVec3::new(0.3, -0.8, 0.5).normalize();
    let origin = DVec3::new(2.0, 1.0, -1.0);
    let h = 1.5;
    let sum: f64 = (-40..40)
        .map(|k| gauss.value(origin + direction * h * f64::from(k)) * h)
        .sum();
    let b = direction.cross(gauss.center - origin).length();
    let exact = (std::f64::consts::TAU).sqrt() * 3.0 * (-b * b / 18.0).exp();
    assert!((sum - exact).abs() < 1e-12 * exact, "{sum}, not {exact}");
}

#[test]
fn the_test_signal_has_the_values_of_its_formula() {
    let signal = MarschnerLobb::default();
    // At the origin cos(12 pi) = 1: (1 + 2 alpha) / (2 (1 + alpha)).
    assert!((signal.value(DVec3::ZERO) - 0.6).abs() < 1e-12);
    // At r = 1 the inner cosine is 0 and the outer 1; z = 1 takes the sine's 1 away: 0.5 / 2.5.
    assert!((signal.value(DVec3::new(0.6, 0.8, 1.0)) - 0.2).abs() < 1e-12);
    // At z = -1: (1 + 1 + 0.5) / 2.5, the maximum.
    assert!((signal.value(DVec3::new(0.0, 0.0, -1.0)) - 1.0).abs() < 1e-12);
}

#[test]
fn closed_form_gradients_are_those_of_the_values() {
    let h = 1e-5;
    let fields: [(&str, Box<dyn Field>); 5] = [
        (
            "linear",
            Box::new(Linear {
                offset: 2.0,
                slope: DVec3::new(1.0, -2.0, 0.5),
            }),
        ),
        (
            "gauss",
            Box::new(Gaussian {
                center: DVec3::new(0.1, 0.2, 0.0),
                deviation: 0.7,
            }),
        ),
        ("marschner-lobb", Box::new(MarschnerLobb::default())),
        (
            "exponential fog",
            Box::new(Fog::Exponential { height: 2.0 }),
        ),
        ("linear fog", Box::new(Fog::Linear { height: 2.0 })),
    ];
    for (name, field) in fields {
        for p in [
            DVec3::new(0.3, -0.2, 0.4),
            DVec3::new(-0.7, 0.1, -0.6),
            DVec3::new(0.0, 0.0, 0.2),
        ] {
            let difference =
                |axis| (field.value(p + h * axis) - field.value(p - h * axis)) / (2.0 * h);
            let wanted = DVec3::new(
                difference(DVec3::X),
                difference(DVec3::Y),
                difference(DVec3::Z),
            );
            let found = field.gradient(p).expect("a closed form");
            // h^2 / 6 times the third derivative, at most (12 pi^2 / 2)^3 / 10 here, and rounding 1e-16 / h.
            let error = (found - wanted).length();
            assert!(error < 1e-6, "{name} at {p}: {found}, not {wanted}");
        }
    }
}

#[test]
fn a_soft_ball_is_half_at_its_radius_and_a_hard_one_has_two_values() {
    let soft = Ball {
        center: DVec3::ZERO,
        radius: 2.0,
        edge: 0.5,
    };
    for (r, wanted) in [
        (0.0, 1.0),
        (1.75, 1.0),
        (2.0, 0.5),
        (2.125, 0.25),
        (2.25, 0.0),
        (9.0, 0.0),
    ] {
        assert_eq!(soft.value(DVec3::new(r, 0.0, 0.0)), wanted, "at {r}");
    }
    let volume = volume("sphere,n=30,edge=0,type=u8");
    assert!((0..volume.voxels.len()).all(|i| [0.0, 255.0].contains(&volume.voxels.stored(i))));
    assert_eq!(volume.value_range, [0.0, 1.0]);
}

#[test]
fn every_type_holds_the_same_values_to_half_a_code() {
    for (name, span) in [
        ("shells", 1.0),
        ("fog,profile=linear", 1.0),
        ("storm,variable=w", 70.0),
    ] {
        let exact = volume(&format!("{name},n=16"));
        for (word, codes) in [("u8", 255.0), ("u16", 65535.0)] {
            let rounded = volume(&format!("{name},n=16,type={word}"));
            assert_eq!(rounded.voxels.voxel_type().name(), word);
            let half_a_code = 0.5 * span / codes;
            for i in 0..exact.voxels.len() {
                let value = |v: &Volume| {
                    f64::from(v.voxels.stored(i)) * v.rescale.slope + v.rescale.intercept
                };
                let error = (value(&exact) - value(&rounded)).abs();
                assert!(
                    error <= half_a_code * 1.0001,
                    "{name} as {word}: voxel {i} off by {error}"
                );
            }
        }
    }
}

#[test]
fn the_head_is_in_hounsfield_units_of_whole_numbers() {
    let source = open("phantom:head,n=16");
    assert!(source.header().hounsfield);
    assert_eq!(source.header().stored, VoxelType::U16);
    assert_eq!(
        [
            source.header().rescale.slope,
            source.header().rescale.intercept
        ],
        [1.0, -1024.0]
    );
    let bytes = open("phantom:head,n=16,type=u8");
    assert_eq!(
        [
            bytes.header().rescale.slope,
            bytes.header().rescale.intercept
        ],
        [16.0, -1024.0]
    );
}

#[test]
fn the_head_has_its_parts_where_they_belong() {
    let head = volume("phantom:head,n=128");
    let parts = [
        ("air around", [110.0, 110.0, 0.0], -1000.0..=-999.0),
        ("skull at the top", [0.0, -22.0, 103.5], 300.0..=1400.0),
        ("skull at the back", [0.0, -96.5, 38.0], 300.0..=1400.0),
        ("white matter", [30.0, -10.0, 60.0], 20.0..=45.0),
        ("ventricle, right", [12.0, -8.0, 45.5], 2.0..=20.0),
        ("ventricle, left", [-12.0, -8.0, 45.5], 2.0..=20.0),
        ("vitreous, right eye", [32.0, 66.0, 7.0], 5.0..=25.0),
        ("windpipe", [0.0, 5.0, -115.0], -1000.0..=-900.0),
        ("sinus of the cheek", [25.0, 44.0, -18.0], -1000.0..=-900.0),
        ("tongue", [0.0, 40.0, -56.0], 40.0..=80.0),
        ("body of a vertebra", [0.0, -12.0, -74.5], 150.0..=700.0),
        ("tip of the nose", [0.0, 100.0, -19.0], -120.0..=60.0),
        ("muscle of the nape", [16.0, -64.0, -90.0], 40.0..=75.0),
    ];
    for (part, [x, y, z], wanted) in parts {
        let found = value_at(&head, DVec3::new(x, y, z));
        assert!(
            wanted.contains(&found),
            "{part}: {found} HU, not in {wanted:?}"
        );
    }
    let teeth = DVec3::new(3.0, 75.0, -46.0);
    assert!(
        value_at(&head, teeth) > 1500.0,
        "front tooth: {}",
        value_at(&head, teeth)
    );
    assert!(
        value_at(&head, DVec3::new(0.0, -108.0, -19.0)) < -900.0,
        "no nose at the back"
    );
}

#[test]
fn no_bone_of_the_head_lies_bare() {
    let head = volume("phantom:head,n=96");
    let n = 96;
    let value =
        |x: usize, y: usize, z: usize| f64::from(head.voxels.stored((z * n + y) * n + x)) - 1024.0;
    let mut rays = 0;
    for a in 0..n {
        for z in 4..n {
            let from_left: Vec<f64> = (0..n).map(|x| value(x, a, z)).collect();
            let from_back: Vec<f64> = (0..n).map(|y| value(a, y, z)).collect();
            for (side, mut ray) in [("left", from_left), ("back", from_back)] {
                for _ in 0..2 {
                    if let Some(&first) = ray.iter().find(|&&hu| hu > -300.0) {
                        rays += 1;
                        assert!(
                            first < 300.0,
                            "{first} HU from {side} or against it at {a}, {z}"
                        );
                    }
                    ray.reverse();
                }
            }
        }
    }
    assert!(rays > 10_000, "only {rays} rays met the head");
}

#[test]
fn the_two_sides_of_the_head_are_not_the_same() {
    // A picture turned left to right must not look right.
    let head = volume("phantom:head,n=64");
    let value = |x: usize, yz: usize| head.voxels.stored(yz * 64 + x);
    let different = (0..64 * 64).flat_map(|yz| (0..32).map(move |x| (x, yz)));
    let different = different
        .filter(|&(x, yz)| (value(x, yz) - value(63 - x, yz)).abs() > 10.0)
        .count();
    assert!(
        different > 200,
        "{different} voxels differ from their mirror image"
    );
}

#[test]
fn the_storm_has_variables_and_times_that_differ_and_stay_in_their_range() {
    let names = ["cloud", "vapor", "temperature", "u", "v", "w"];
    let ranges = [
        [0.0, 4.0],
        [0.0, 20.0],
        [200.0, 320.0],
        [-80.0, 80.0],
        [-80.0, 80.0],
        [-20.0, 50.0],
    ];
    assert_eq!(open("storm,n=8").header().variables, names);
    for (name, [low, high]) in names.into_iter().zip(ranges) {
        let source = open(&format!("storm,n=32,times=3,variable={name}"));
        assert_eq!(source.header().variables[0], name);
        assert_eq!(source.header().variables.len(), names.len());
        let at = |time| {
            let pick = TimeComponent { time, component: 0 };
            Volume::read(&*source, pick, source.header().whole(), &Limits::default()).unwrap()
        };
        for time in 0..3 {
            let [min, max] = at(time).value_range;
            assert!(
                low <= min && min < max && max <= high,
                "{name} at {time}: {min} to {max}"
            );
        }
        assert_ne!(at(0).voxels, at(2).voxels, "{name} does not change");
    }
}

#[test]
fn the_storm_is_of_the_earth_and_has_hours_and_units() {
    for (words, hours) in [
        ("times=1", &["24 h"] as &[_]),
        ("times=3", &["0 h", "12 h", "24 h"]),
        ("times=4", &["0 h", "8 h", "16 h", "24 h"]),
    ] {
        let source = open(&format!("storm,n=8,{words}"));
        assert_eq!(source.header().time_names, hours);
    }
    let eight = open("storm,n=8").header().time_names.clone();
    assert_eq!(
        (eight.len(), eight[1].as_str(), eight[7].as_str()),
        (8, "3.43 h", "24 h")
    );
    for (name, unit, standard_name) in [
        ("cloud", "g kg-1", None),
        ("vapor", "g kg-1", Some("humidity_mixing_ratio")),
        ("temperature", "K", Some("air_temperature")),
        ("u", "m s-1", Some("eastward_wind")),
        ("v", "m s-1", Some("northward_wind")),
        ("w", "m s-1", Some("upward_air_velocity")),
    ] {
        let header = open(&format!("storm,n=8,variable={name}")).header().clone();
        assert_eq!(header.unit.as_deref(), Some(unit), "{name}");
        assert_eq!(header.standard_name.as_deref(), standard_name, "{name}");
        assert!(header.is_earth);
        // It lies nowhere on the globe.
        assert_eq!((header.degree_lengths, header.map), ([None; 2], None));
        assert_eq!(header.length_metres, Some(1e3));
    }
    let header = open("head,n=8").header().clone();
    assert!(!header.is_earth && header.unit.is_none() && header.time_names.is_empty());
}

#[test]
fn a_phantom_has_the_same_bytes_each_time() {
    let source = open("storm,n=24,times=2");
    let whole = source
        .read(TimeComponent::default(), source.header().whole())
        .unwrap();
    assert_eq!(
        whole,
        source
            .read(TimeComponent::default(), source.header().whole())
            .unwrap()
    );
}

#[test]
fn a_wrong_word_is_answered_with_the_right_ones() {
    let cases = [
        (
            "phantom:heart",
            "wanted one of sphere, gauss, marschner-lobb, fog, shells, storm, flow, cells, head, found `heart`",
        ),
        ("phantom:", "found ``"),
        (
            "phantom:head,n=0",
            "`n`: wanted a whole number from 1 to 4096, found `0`",
        ),
        ("phantom:head,n=4097", "`n`: wanted"),
        ("phantom:head,n=-3", "`n`: wanted"),
        ("phantom:head,n=1e3", "`n`: wanted"),
        ("phantom:head,type=i16", "`type`: wanted one of"),
        (
            "phantom:head,edge=1",
            "field `edge`: wanted one of n, type, found `edge`",
        ),
        ("phantom:head,n", "wanted words such as n=128, found `n`"),
        ("phantom:head,n=8,n=9", "the word once"),
        (
            "phantom:storm,variable=hail",
            "wanted one of cloud, vapor, temperature, u, v, w, found `hail`",
        ),
        ("phantom:storm,times=0", "`times`"),
        (
            "phantom:flow,kind=jet",
            "wanted one of helix, saddle, taylor-green, abc, found `jet`",
        ),
        ("phantom:sphere,edge=-1", "a length of 0 or more"),
        ("phantom:sphere,edge=NaN", "a length of 0 or more"),
        ("phantom:fog,profile=\u{1b}[31m", "found `\\u{1b}[31m`"),
    ];
    for (spec, wanted) in cases {
        let error = phantom::open(spec, &Limits::default())
            .err()
            .expect(spec)
            .to_string();
        assert!(error.contains(wanted), "{spec}: {error}");
    }
}

#[test]
fn a_phantom_over_the_limits_is_refused_at_once() {
    let limits = Limits {
        max_bytes: 1 << 20,
        ..Limits::default()
    };
    let error = phantom::open("phantom:gauss,n=65", &limits)
        .err()
        .expect("65^3 f32");
    assert!(
        matches!(
            error.problem,
            Problem::Limit {
                wanted_bytes: 1_098_500,
                ..
            }
        ),
        "{error}"
    );
    assert!(phantom::open("phantom:gauss,n=64", &limits).is_ok());
}
