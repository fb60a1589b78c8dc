//! GRIB: edition 2 with the feature `grib`; what is not read is refused by name.
//!
//! The files of `fixtures/grib` are ecCodes', and so are the sums of what it reads from them (`expected.json`).

use crate::files::Folder;

#[test]
fn an_edition_is_refused_by_its_number_and_other_bytes_by_what_they_are() {
    let folder = Folder::new();
    let message = |edition: u8| {
        let bytes = [&b"GRIB\0\0\x34"[..], &[edition], &[0; 44]].concat();
        folder.refused("a.grib2", bytes)
    };
    assert!(
        message(1).contains("edition 1 (a NetCDF file is read:"),
        "{}",
        message(1)
    );
    #[cfg(not(feature = "grib"))]
    assert!(
        message(2).contains("edition 2 in a build without `--features grib`"),
        "{}",
        message(2)
    );
    assert!(
        message(3).contains("`edition`: wanted 1 or 2, found `3`"),
        "{}",
        message(3)
    );
    for bytes in [&b"GRI"[..], b"GRIB\0\0\x34", b"no grib at all"] {
        let message = folder.refused("a.grib", bytes);
        assert!(
            message.contains("`section 0`: wanted the letters GRIB"),
            "{message}"
        );
    }
}

#[cfg(feature = "grib")]
mod second {
    use crate::files::{Folder, numbers};
    use crate::survive::survive;
    use serde_json::Value;
    use std::path::PathBuf;
    use stratavox::format;
    use stratavox::volume::{Header, Limits, Source, TimeComponent, VolumeSelection};

    fn fixture(name: &str) -> PathBuf {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/grib");
        folder.join(name)
    }

    fn bytes(name: &str) -> Vec<u8> {
        std::fs::read(fixture(name)).unwrap()
    }

    fn open(name: &str, variable: Option<&str>, as_stored: bool) -> Box<dyn Source> {
        let wanted = VolumeSelection {
            variable: variable.map(str::to_owned),
            as_stored,
            ..VolumeSelection::default()
        };
        format::open(&fixture(name), &wanted, &Limits::default())
            .unwrap_or_else(|error| panic!("{name}: {}", crate::files::message(&error)))
    }

    fn header(name: &str) -> Header {
        open(name, None, true).header().clone()
    }

    fn expected() -> serde_json::Map<String, Value> {
        let text = std::fs::read_to_string(fixture("expected.json")).unwrap();
        let Value::Object(files) = serde_json::from_str(&text).unwrap() else {
            panic!("an object");
        };
        files
    }

    /// How many numbers a field has, their sum, and their sum weighted by place: all exact in f64.
    fn sums(field: &[f32]) -> (u64, f64, f64) {
        let there = field.iter().enumerate().filter(|(_, n)| !n.is_nan());
        there.fold((0, 0.0, 0.0), |(count, sum, weighted), (place, &n)| {
            let n = f64::from(n);
            (count + 1, sum + n, weighted + place as f64 * n)
        })
    }

    fn expected_sums(field: &Value) -> (u64, f64, f64) {
        let number = |name: &str| field[name].as_f64().unwrap();
        (
            field["numbers"].as_u64().unwrap(),
            number("sum"),
            number("weighted"),
        )
    }

    /// Rows of 12 points back in the order of the message.
    fn as_in_message(name: &str, rows: Vec<f32>) -> Vec<f32> {
        match name {
            "columns.grib2" => (0..12)
                .flat_map(|x| rows.iter().skip(x).step_by(12).copied().collect::<Vec<_>>())
                .collect(),
            "west.grib2" => {
                let mut rows = rows;
                rows.chunks_mut(12)
                    .skip(1)
                    .step_by(2)
                    .for_each(<[f32]>::reverse);
                rows
            }
            _ => rows,
        }
    }

    #[test]
    fn every_packing_order_and_bitmap_gives_the_numbers_that_eccodes_reads() {
        let mut packings = std::collections::BTreeSet::new();
        for (name, fields) in expected() {
            let fields = fields.as_array().unwrap();
            if fields.len() > 1 {
                continue;
            }
            let source = open(&name, None, true);
            assert_eq!(source.header().dims, [12, 7, 1], "{name}");
            let piece = source
                .read(TimeComponent::default(), source.header().whole())
                .unwrap();
            let found = sums(&as_in_message(&name, numbers(&piece.voxels)));
            assert_eq!(found, expected_sums(&fields[0]), "{name}");
            packings.insert(fields[0]["packing"].as_str().unwrap().to_owned());
        }
        assert_eq!(packings.len(), 6, "{packings:?}");
    }

    #[test]
    fn levels_and_times_out_of_order_are_sorted_into_one_variable() {
        let source = open("levels.grib2", None, true);
        let header = source.header();
        assert_eq!((header.dims, header.times), ([12, 7, 4], 2));
        assert_eq!(header.variables, ["t"]);
        assert_eq!(header.unit.as_deref(), Some("K"));
        assert!(header.is_earth);
        let starts = ["2024-02-29T18:00", "2024-03-01T00:00"];
        for (name, start) in header.time_names.iter().zip(starts) {
            assert!(name.starts_with(start), "{:?}", header.time_names);
        }
        let all = expected();
        for field in all["levels.grib2"].as_array().unwrap() {
            let level = field["level"].as_u64().unwrap();
            let z = [300, 500, 850, 1000]
                .iter()
                .position(|l| *l == level)
                .unwrap();
            let time = u32::from(field["time"].as_str().unwrap().starts_with("202403"));
            let piece = source
                .read(TimeComponent { time, component: 0 }, header.whole())
                .unwrap();
            let layer = &numbers(&piece.voxels)[z * 84..][..84];
            assert_eq!(
                sums(layer),
                expected_sums(field),
                "{level} hPa, time {time}"
            );
        }
        // Drawn, the levels are even, as those of a NetCDF file are.
        let even = open("levels.grib2", None, false);
        assert!(even.header().dims[2] > 4, "{:?}", even.header());
    }

    #[test]
    fn a_box_of_a_stack_is_the_part_of_the_whole() {
        let source = open("levels.grib2", None, true);
        let whole = source.header().whole();
        let pick = TimeComponent {
            time: 1,
            component: 0,
        };
        let all = numbers(&source.read(pick, whole).unwrap().voxels);
        let mut part = whole;
        (part.min, part.max) = ([3, 2, 1], [7, 5, 3]);
        let found = numbers(&source.read(pick, part).unwrap().voxels);
        let mut wanted = Vec::new();
        for z in 1..3 {
            for y in 2..5 {
                wanted.extend_from_slice(&all[(z * 7 + y) * 12 + 3..][..4]);
            }
        }
        assert_eq!(found, wanted);
    }

    #[test]
    fn variables_are_named_by_parameter_and_what_is_on_several_levels_comes_first() {
        let names = header("mixed.grib2").variables;
        let mut sorted = names.clone();
        sorted.sort();
        assert_eq!(sorted, ["gh", "prmsl", "t", "u"], "{names:?}");
        assert!(["gh", "u"].contains(&names[0].as_str()), "{names:?}");
        let pressure = open("mixed.grib2", Some("prmsl"), true);
        assert_eq!(pressure.header().unit.as_deref(), Some("Pa"));
        let piece = pressure
            .read(TimeComponent::default(), pressure.header().whole())
            .unwrap();
        let all = expected();
        let fields = all["mixed.grib2"].as_array().unwrap();
        let field = fields
            .iter()
            .find(|field| field["name"] == "prmsl")
            .unwrap();
        assert_eq!(sums(&numbers(&piece.voxels)), expected_sums(field));
    }

    #[test]
    fn members_of_an_ensemble_are_chosen_by_their_number() {
        for (variable, member) in [("t", 0), ("t[number=1]", 1)] {
            let source = open("members.grib2", Some(variable), true);
            let piece = source
                .read(TimeComponent::default(), source.header().whole())
                .unwrap();
            let all = expected();
            let fields = all["members.grib2"].as_array().unwrap();
            let of = |field: &&Value| field["member"] == member && field["level"] == 850;
            let field = fields.iter().find(of).unwrap();
            let found = sums(&numbers(&piece.voxels)[84..]);
            assert_eq!(found, expected_sums(field), "{variable}");
        }
    }

    #[test]
    fn a_level_that_a_time_lacks_has_no_data_and_a_note() {
        let folder = Folder::new();
        let whole = bytes("levels.grib2");
        // Eight messages of one length: the last is taken off.
        let path = folder.write("a.grib2", &whole[..whole.len() / 8 * 7]);
        let wanted = VolumeSelection {
            as_stored: true,
            ..VolumeSelection::default()
        };
        let source = format::open(&path, &wanted, &Limits::default()).unwrap();
        let header = source.header();
        let notes = header.notes.join("\n");
        assert!(notes.contains("7 of 8 fields"), "{notes}");
        let piece = source
            .read(TimeComponent::default(), header.whole())
            .unwrap();
        let holes = numbers(&piece.voxels).iter().filter(|n| n.is_nan()).count();
        assert_eq!(holes, 84);
    }

    /// Where a section of a message of one field begins.
    fn section(message: &[u8], number: u8) -> usize {
        let mut at = 16;
        while message[at + 4] != number {
            at += u32::from_be_bytes(message[at..at + 4].try_into().unwrap()) as usize;
        }
        at
    }

    #[test]
    fn grids_products_and_packings_that_are_not_read_are_refused_by_name() {
        let folder = Folder::new();
        for (number, octet, template, word) in [
            (3, 14, 30, "3.30 (Lambert conformal)"),
            (3, 14, 1, "3.1 (rotated latitudes and longitudes)"),
            (3, 72, 0x08, "rows are shifted"),
            (4, 9, 40, "products of template 4.40"),
            (5, 11, 200, "5.200 (run lengths)"),
            (5, 11, 50, "5.50 (spherical harmonics)"),
        ] {
            let mut message = bytes("north.grib2");
            let at = section(&message, number) + octet - 1;
            message[at] = template;
            let refused = folder.refused("a.grib2", &message);
            assert!(refused.contains(word), "{refused}");
        }
    }

    #[test]
    fn a_file_cut_anywhere_is_refused() {
        let folder = Folder::new();
        for name in ["holes.grib2", "ccsds_12.grib2", "jpeg_16.grib2"] {
            let whole = bytes(name);
            for length in 1..whole.len() {
                folder.refused("a.grib2", &whole[..length]);
            }
        }
    }

    #[test]
    fn a_section_that_lies_about_its_length_is_refused() {
        let folder = Folder::new();
        let whole = bytes("north.grib2");
        for number in [1, 3, 4, 5, 6, 7] {
            let at = section(&whole, number);
            let told = u32::from_be_bytes(whole[at..at + 4].try_into().unwrap());
            for lie in [0, 4, told - 1, told + 1, told + 4, 1 << 20, u32::MAX] {
                let mut message = whole.clone();
                message[at..at + 4].copy_from_slice(&lie.to_be_bytes());
                folder.refused("a.grib2", &message);
            }
        }
        for lie in [
            0_u64,
            15,
            20,
            whole.len() as u64 - 1,
            whole.len() as u64 + 1,
            u64::MAX,
        ] {
            let mut message = whole.clone();
            message[8..16].copy_from_slice(&lie.to_be_bytes());
            folder.refused("a.grib2", &message);
        }
    }

    #[test]
    fn a_small_file_that_promises_a_large_field_takes_no_memory() {
        let folder = Folder::new();
        let names = [
            "constant",
            "complex_12",
            "ccsds_12",
            "jpeg_16",
            "complex_spatial_differencing_16",
        ];
        for name in names {
            let mut message = bytes(&format!("{name}.grib2"));
            let points = 60_000_u32 * 60_000;
            let three = section(&message, 3);
            message[three + 6..three + 10].copy_from_slice(&points.to_be_bytes());
            for octet in [31, 35] {
                let at = three + octet - 1;
                message[at..at + 4].copy_from_slice(&60_000_u32.to_be_bytes());
            }
            let five = section(&message, 5);
            message[five + 5..five + 9].copy_from_slice(&points.to_be_bytes());
            crate::memory::start();
            let refused = folder.refused("a.grib2", &message);
            let peak = crate::memory::peak_since_start();
            assert!(
                refused.contains("limit") || refused.contains("memory"),
                "{refused}"
            );
            assert!(peak < 1 << 20, "{name}: {peak} bytes");
        }
        // A group of complex packing that says it is as long as nothing is.
        let mut message = bytes("complex_12.grib2");
        let at = section(&message, 5) + 43 - 1;
        message[at..at + 4].copy_from_slice(&u32::MAX.to_be_bytes());
        let refused = folder.refused("a.grib2", &message);
        assert!(refused.contains("groups of complex packing"), "{refused}");
    }

    #[test]
    fn grib_survives_mutations() {
        let one = |name: &'static str| vec![(name, bytes(name))];
        survive(
            "grib",
            &[
                one("holes.grib2"),
                one("ieee_32.grib2"),
                one("complex_12_holes.grib2"),
                one("complex_spatial_differencing_16.grib2"),
                one("jpeg_16.grib2"),
                one("ccsds_12_holes.grib2"),
                one("columns.grib2"),
            ],
        );
    }
}
