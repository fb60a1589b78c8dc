//! Widgets in files, moved with their values, and found by themselves.

#![cfg(feature = "json")]

use glam::{DAffine3, DVec3};
use stratavox::transfer::{
    Cells, ColorPoint, FileProblem, Interpolation, JointCounts, OpacityPoint, SecondDerivative,
    Shape, TransferFunction, Window, boundaries, transfer_function_from_json,
    transfer_function_to_json,
};
use stratavox::volume::{JointHistogram, Rescale, Volume, Voxels, steepest_gradient};

const ALL: &str = r#"{"stratavox_transfer_function": 1,
    "color": [[0, 0, 0, 0], [100, 1, 1, 1]], "opacity": [[0, 0], [100, 0.5]],
    "gradient_opacity": [[0.1, 0], [0.5, 1]], "steepest": 40,
    "widgets": [
    {"shape": "contour", "value": 50, "half_width": 1.5, "opacity": 0.2, "color": [1, 0.5, 0]},
    {"shape": "region", "points": [[10, 0.1], [20, 0.3], [60, 0]]},
    {"shape": "triangle", "value": 30, "half_width": 12, "threshold": 0.1, "top": 0.9, "opacity": 0.4},
    {"shape": "rectangle", "values": [5, 15], "gradients": [0.2, 0.4], "opacity": 1},
    {"shape": "gaussian", "value": 70, "gradient": 0.3, "sigma_value": 8, "sigma_gradient": 0.1, "opacity": 0.6,
     "second": 0.1, "sigma_second": 0.05},
    {"shape": "image", "values": [0, 80], "gradients": [0, 1], "rows": [[0, 1], [0.5, 0.25], [1, 0]], "opacity": 0.7,
     "second": [-0.5, -0.2, 0, 0.3]},
    {"shape": "image", "values": [0, 60], "gradients": [0, 2], "rows": ["ff000080ffFFff00", "0102030405060708"],
     "opacity": 0.9, "second": [-1, 1]}
    ]}"#;

fn all() -> TransferFunction {
    transfer_function_from_json(ALL.as_bytes()).expect("a good file")
}

#[test]
fn every_shape_is_read_and_comes_back_as_it_was_written() {
    let function = all();
    let gradient_transfer = function.gradient_transfer.as_ref().expect("widgets");
    assert_eq!(gradient_transfer.widgets.len(), 7);
    assert_eq!(gradient_transfer.steepest, Some(40.0));
    assert_eq!(gradient_transfer.widgets[0].srgb, Some([1.0, 0.5, 0.0]));
    let cells = Cells::Shares(vec![0.0, 1.0, 0.5, 0.25, 1.0, 0.0]);
    let image = Shape::Image {
        values: [0.0, 80.0],
        gradients: [0.0, 1.0],
        columns: 2,
        cells,
    };
    assert_eq!(gradient_transfer.widgets[5].shape, image);
    let (middle, sigma) = (0.1, 0.05);
    let bell = SecondDerivative::Bell { middle, sigma };
    assert_eq!(gradient_transfer.widgets[4].second, Some(bell));
    let corners = SecondDerivative::Trapezoid([-0.5, -0.2, 0.0, 0.3]);
    assert_eq!(gradient_transfer.widgets[5].second, Some(corners));
    let box_shaped = SecondDerivative::Trapezoid([-1.0, -1.0, 1.0, 1.0]);
    assert_eq!(gradient_transfer.widgets[6].second, Some(box_shaped));
    let colors = [
        [255, 0, 0, 128],
        [255, 255, 255, 0],
        [1, 2, 3, 4],
        [5, 6, 7, 8],
    ];
    let Shape::Image { columns, cells, .. } = &gradient_transfer.widgets[6].shape else {
        panic!("no image");
    };
    assert_eq!((*columns, cells), (2, &Cells::Rgba(colors.into())));
    let text = transfer_function_to_json(&function);
    let back = transfer_function_from_json(text.as_bytes()).expect(&text);
    assert_eq!(back, function, "{text}");
}

#[test]
fn widgets_in_colours_of_their_own_need_no_points() {
    let widget = r#"{"shape": "contour", "value": 5, "opacity": 1, "color": [1, 0, 0]}"#;
    let text = format!(r#"{{"stratavox_transfer_function": 1, "widgets": [{widget}]}}"#);
    let function = transfer_function_from_json(text.as_bytes()).expect("a good file");
    assert_eq!(function.opacity(5.0), 0.0);
    let Some(Shape::Contour { half_width, .. }) = function
        .gradient_transfer
        .map(|gradient_transfer| gradient_transfer.widgets[0].shape.clone())
    else {
        panic!("no contour");
    };
    assert_eq!(half_width, 2.0, "what is left out");
    let without = text.replace(r#", "color": [1, 0, 0]"#, "");
    let error = transfer_function_from_json(without.as_bytes()).expect_err("no colour at all");
    assert!(error.to_string().contains("color"), "{error}");
}

#[test]
fn wrong_fields_of_widgets_are_named_with_what_was_wanted_and_found() {
    for (from, to, field, found) in [
        (
            "\"contour\"",
            "\"cone\"",
            "`widgets[0].shape`",
            "found \"cone\"",
        ),
        ("\"value\": 50,", "", "`widgets[0].value`", "no such key"),
        (
            "\"value\": 50",
            "\"value\": \"x\"",
            "`widgets[0].value`",
            "found \"x\"",
        ),
        ("1.5", "0", "`widgets[0].half_width`", "found 0"),
        (
            "\"opacity\": 0.2",
            "\"opacity\": 1.2",
            "`widgets[0].opacity`",
            "found 1.2",
        ),
        (
            "[1, 0.5, 0]",
            "[1, 0.5]",
            "`widgets[0].color`",
            "found [1,0.5]",
        ),
        (
            "[1, 0.5, 0]",
            "[1, 0.5, 9]",
            "`widgets[0].color[2]`",
            "found 9",
        ),
        (
            "[20, 0.3]",
            "[20, 3]",
            "`widgets[1].points[1][1]`",
            "found 3",
        ),
        (
            "[20, 0.3]",
            "[2, 0.3]",
            "`widgets[1].points[1][0]`",
            "found 2",
        ),
        (
            "[[10, 0.1], [20, 0.3], [60, 0]]",
            "[[10, 0.1]]",
            "`widgets[1].points`",
            "2 to 64",
        ),
        (
            "\"top\": 0.9",
            "\"top\": -1",
            "`widgets[2].top`",
            "found -1",
        ),
        (
            "[5, 15]",
            "[15, 5]",
            "`widgets[3].values`",
            "found [15.0,5.0]",
        ),
        (
            "[0.2, 0.4]",
            "[0.2]",
            "`widgets[3].gradients`",
            "found [0.2]",
        ),
        (
            "\"sigma_value\": 8",
            "\"sigma_value\": 0",
            "`widgets[4].sigma_value`",
            "found 0",
        ),
        (
            "\"sigma_second\": 0.05",
            "\"sigma_second\": 0",
            "`widgets[4].sigma_second`",
            "found 0",
        ),
        (
            "[-0.5, -0.2, 0, 0.3]",
            "[-0.5, -0.7, 0, 0.3]",
            "`widgets[5].second`",
            "found [-0.5,-0.7,0,0.3]",
        ),
        (
            "\"second\": [-1, 1]",
            "\"second\": [-1]",
            "`widgets[6].second`",
            "found [-1]",
        ),
        (
            "0102030405060708",
            "01020304050607x8",
            "`widgets[6].rows[1]`",
            "found \"01020304050607x8\"",
        ),
        (
            "0102030405060708",
            "01020304",
            "`widgets[6].rows[1]`",
            "found \"01020304\"",
        ),
        (
            "\"opacity\": 0.9,",
            "\"opacity\": 0.9, \"color\": [1, 0, 0],",
            "`widgets[6].color`",
            "have colours",
        ),
        (
            "\"rows\": [\"ff000080ffFFff00\", \"0102030405060708\"]",
            "\"file\": \"a.png\"",
            "`widgets[6].file`",
            "found a.png",
        ),
        (
            "[0.5, 0.25]",
            "[0.5]",
            "`widgets[5].rows[1]`",
            "found [0.5]",
        ),
        (
            "[0.5, 0.25]",
            "[0.5, 7]",
            "`widgets[5].rows[1][1]`",
            "found 7",
        ),
        (
            "\"steepest\": 40",
            "\"steepest\": -4",
            "`steepest`",
            "found -4",
        ),
        (
            "[0.5, 1]]",
            "[0.5, 2]]",
            "`gradient_opacity[1][1]`",
            "found 2",
        ),
        (
            "\"threshold\"",
            "\"treshold\"",
            "`widgets[2].treshold`",
            "no such key",
        ),
        (
            "\"shape\": \"rectangle\"",
            "\"shape\": 4",
            "`widgets[3].shape`",
            "found 4",
        ),
    ] {
        let text = ALL.replacen(from, to, 1);
        assert_ne!(text, ALL, "{from} is not there");
        let error = transfer_function_from_json(text.as_bytes()).expect_err(to);
        let said = error.to_string();
        assert!(matches!(error, FileProblem::Field { .. }), "{to}: {said}");
        assert!(said.contains(field) && said.contains(found), "{to}: {said}");
    }
    let alone =
        r#"{"stratavox_transfer_function":1,"color":[[0,0,0,0]],"opacity":[[0,1]],"steepest":3}"#;
    let said = transfer_function_from_json(alone.as_bytes())
        .expect_err("alone")
        .to_string();
    assert!(said.contains("`steepest`"), "{said}");
}

#[test]
fn a_window_moves_widgets_with_the_points_and_gradients_with_the_values() {
    // 0 to 100 onto 1000 to 1200: twice as steep.
    let moved = all().spread_over(Window::new(1000.0, 1200.0).expect("a window"));
    let gradient_transfer = moved.gradient_transfer.expect("widgets");
    assert_eq!(gradient_transfer.steepest, Some(80.0));
    let shapes: Vec<_> = gradient_transfer
        .widgets
        .into_iter()
        .map(|w| w.shape)
        .collect();
    let contour = Shape::Contour {
        value: 1100.0,
        half_width: 1.5,
    };
    assert_eq!(shapes[0], contour);
    let Shape::Triangle {
        value,
        half_width,
        top,
        ..
    } = shapes[2]
    else {
        panic!("{:?}", shapes[2]);
    };
    assert_eq!((value, half_width, top), (1060.0, 24.0, 0.9));
    let Shape::Rectangle { values, gradients } = shapes[3] else {
        panic!("{:?}", shapes[3]);
    };
    assert_eq!((values, gradients), ([1010.0, 1030.0], [0.2, 0.4]));
    let Shape::Gaussian {
        value, sigma_value, ..
    } = shapes[4]
    else {
        panic!("{:?}", shapes[4]);
    };
    assert_eq!((value, sigma_value), (1140.0, 16.0));
}

#[test]
fn colour_of_one_file_and_opacity_of_another_keep_their_own_laws() {
    let color = |value, level| ColorPoint {
        value,
        srgb: [level; 3],
    };
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    let steps = TransferFunction {
        color: vec![color(0.0, 0.2), color(10.0, 0.8), color(20.0, 0.4)],
        opacity: vec![opacity(0.0, 1.0)],
        reference_length: Some(3.0),
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    };
    let lines = all();
    for (both, own_length) in [
        (lines.with_color_of(&steps), None),
        (steps.with_opacity_of(&lines), None),
        (
            lines.with_opacity_of(&steps).with_color_of(&lines),
            Some(3.0),
        ),
    ] {
        assert_eq!(both.reference_length, own_length);
        let [of_color, of_opacity] = match own_length {
            None => [&steps, &lines],
            Some(_) => [&lines, &steps],
        };
        assert_eq!(both.gradient_transfer, of_opacity.gradient_transfer);
        for value in [-5.0, 0.0, 3.0, 9.999, 10.0, 15.0, 20.0, 99.0] {
            assert_eq!(both.srgb(value), of_color.srgb(value), "at {value}");
            assert_eq!(both.opacity(value), of_opacity.opacity(value), "at {value}");
        }
    }
}

/// Balls in one another, of these values from the outside in, each edge blurred over a few voxels.
fn balls(values: [f64; 3]) -> Volume {
    let at = |x: u32, y: u32, z: u32| {
        let r = (DVec3::new(x.into(), y.into(), z.into()) - 23.5).length();
        let inside = |radius: f64| 1.0 / (1.0 + ((r - radius) / 1.2).exp());
        let value = values[0]
            + (values[1] - values[0]) * inside(19.0)
            + (values[2] - values[1]) * inside(10.0);
        value as f32
    };
    let voxels = (0..48).flat_map(|z| (0..48).flat_map(move |y| (0..48).map(move |x| (x, y, z))));
    let values: Vec<f32> = voxels.map(|(x, y, z)| at(x, y, z)).collect();
    let affine = DAffine3::from_scale(DVec3::splat(0.5));
    Volume::from_voxels(
        [48; 3],
        affine,
        Voxels::F32(values),
        Rescale::default(),
        None,
    )
    .expect("a right volume")
}

#[test]
fn boundaries_are_found_half_way_between_substances() {
    for values in [[0.0, 400.0, 1000.0], [-1000.0, 40.0, 900.0]] {
        let volume = balls(values);
        let joint = JointHistogram::of(&volume, 256, 192);
        let counts = JointCounts {
            value_range: joint.value_range,
            steepest: steepest_gradient(&volume),
            smallest_spacing: 0.5,
            columns: joint.columns,
            counts: &joint.counts,
        };
        let function = boundaries(&counts, Some(1.0)).expect("boundaries");
        let widgets = function.gradient_transfer.expect("widgets").widgets;
        let found = widgets.iter().map(|widget| match widget.shape {
            Shape::Contour { value, .. } => (value, widget.opacity),
            ref other => panic!("{other:?}"),
        });
        let found: Vec<_> = found.collect();
        assert_eq!(found.len(), 2, "{found:?}");
        // An edge is steepest half way; columns are smoothed over three of a hundred to both sides.
        let blur = 0.05 * (values[2] - values[0]);
        for (i, (value, _)) in found.iter().enumerate() {
            let half_way = 0.5 * (values[i] + values[i + 1]);
            assert!((value - half_way).abs() <= blur, "{value}, not {half_way}");
        }
        assert!(
            found[0].1 < found[1].1,
            "what is outside is fainter: {found:?}"
        );
    }
}

#[test]
fn a_volume_without_boundaries_has_none() {
    let counts = JointCounts {
        value_range: [3.0, 4.0],
        steepest: 1.0,
        smallest_spacing: 1.0,
        columns: 1,
        counts: &[0, 0, 0],
    };
    assert_eq!(boundaries(&counts, None), None);
}

#[test]
fn the_steepest_gradient_of_a_ramp_is_its_slope() {
    let values: Vec<f32> = (0..216).map(|i| (3 * (i % 6)) as f32).collect();
    let affine = DAffine3::from_scale(DVec3::new(0.5, 1.0, 2.0));
    let volume = Volume::from_voxels(
        [6; 3],
        affine,
        Voxels::F32(values),
        Rescale::default(),
        None,
    );
    let slope = steepest_gradient(&volume.expect("a right volume"));
    assert!((slope - 6.0).abs() < 1e-12, "{slope}");
}

/// Red over half of blue in a PNG: the lower row is that of the smaller gradients.
#[cfg(feature = "png")]
#[test]
fn an_image_is_read_from_a_png_beside_the_file_and_stands_in_what_is_written() {
    use stratavox::transfer::read_transfer_function;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("tf.json");
    let text = r#"{"stratavox_transfer_function": 1, "widgets": [{"shape": "image", "values": [0, 9],
        "gradients": [0, 1], "file": "NAME", "opacity": 0.5}]}"#;
    let png =
        |name: &str, kind: png::ColorType, depth: png::BitDepth, size: [u32; 2], data: &[u8]| {
            let mut bytes = Vec::new();
            let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
            encoder.set_color(kind);
            encoder.set_depth(depth);
            let mut writer = encoder.write_header().expect("a header");
            writer.write_image_data(data).expect("rows");
            writer.finish().expect("an end");
            std::fs::write(folder.path().join(name), bytes).expect("a file");
            std::fs::write(&path, text.replace("NAME", name)).expect("a file");
            read_transfer_function(&path)
        };
    let (rgba, eight) = (png::ColorType::Rgba, png::BitDepth::Eight);
    let (red, blue) = ([255, 0, 0, 255], [0, 0, 255, 128]);
    let function = png("two.png", rgba, eight, [1, 2], &[red, blue].concat()).expect("an image");
    let widgets = &function
        .gradient_transfer
        .as_ref()
        .expect("widgets")
        .widgets;
    let wanted = Shape::Image {
        values: [0.0, 9.0],
        gradients: [0.0, 1.0],
        columns: 1,
        cells: Cells::Rgba(vec![blue, red]),
    };
    assert_eq!(widgets[0].shape, wanted);
    let back = transfer_function_to_json(&function);
    assert!(back.contains("0000ff80"), "{back}");
    let again = transfer_function_from_json(back.as_bytes()).expect(&back);
    assert_eq!(again, function);
    let grey = png("grey.png", png::ColorType::Grayscale, eight, [1, 1], &[7]).expect("an image");
    let Shape::Image { cells, .. } = &grey.gradient_transfer.expect("widgets").widgets[0].shape
    else {
        panic!("no image");
    };
    assert_eq!(
        cells,
        &Cells::Rgba(vec![[7, 7, 7, 255]]),
        "without alpha all of it"
    );

    let refused = |result: Result<TransferFunction, _>, wanted: [&str; 2]| {
        let error: stratavox::transfer::FileError = result.expect_err("refused");
        let said = error.to_string();
        for word in ["tf.json", "`widgets[0].file`", wanted[0], wanted[1]] {
            assert!(said.contains(word), "no {word:?}: {said}");
        }
    };
    let deep = png(
        "deep.png",
        png::ColorType::Grayscale,
        png::BitDepth::Sixteen,
        [1, 1],
        &[1, 2],
    );
    refused(deep, ["8 bits a channel", "16 bits"]);
    let wide = png(
        "wide.png",
        png::ColorType::Grayscale,
        eight,
        [70_000, 1],
        &[0; 70_000],
    );
    refused(wide, ["65536 pixels", "70000 x 1"]);
    let read = |name: &str| {
        std::fs::write(&path, text.replace("NAME", name)).expect("a file");
        read_transfer_function(&path)
    };
    std::fs::write(folder.path().join("no.png"), "no picture").expect("a file");
    refused(read("no.png"), ["a PNG file", "found"]);
    refused(read("none.png"), ["a PNG file", "none.png"]);
    refused(
        read("../two.png"),
        ["in the folder of this one", "../two.png"],
    );
    refused(read("/two.png"), ["in the folder of this one", "/two.png"]);
}
