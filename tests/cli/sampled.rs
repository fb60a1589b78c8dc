//! NetCDF files of samples, as points.

use crate::netcdf::{Variable, netcdf};
use crate::person::Folder;
use std::fs;

/// Six stations on two parallels.
fn stations() -> Vec<u8> {
    let variable = |name, texts, values| Variable {
        name,
        dimensions: &[0],
        texts,
        numbers: &[],
        values,
    };
    netcdf(
        &[("station", 6)],
        &[("featureType", "point")],
        &[
            variable(
                "lon",
                &[("units", "degrees_east")],
                vec![4.0, 6.0, 8.0, 4.0, 6.0, 8.0],
            ),
            variable(
                "lat",
                &[("units", "degrees_north")],
                vec![50.0, 50.0, 50.0, 52.0, 52.0, 52.0],
            ),
            variable(
                "rain",
                &[("units", "mm"), ("coordinates", "lon lat")],
                vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
            ),
            variable(
                "t",
                &[("units", "K"), ("coordinates", "lon lat")],
                vec![280.0; 6],
            ),
        ],
    )
}

#[test]
fn stations_are_drawn_as_the_same_table_is() {
    let folder = Folder::new();
    folder.file("a.nc", stations());
    let rows =
        "lon,lat,height_km,rain\n4,50,0,0\n6,50,0,1\n8,50,0,2\n4,52,0,3\n6,52,0,4\n8,52,0,5\n";
    folder.file("a.csv", rows);
    let view = "--points-as spheres --map graticule --view superior --size 60x40 --force";
    for (input, output) in [
        ("a.nc", "n.png"),
        ("a.nc --variable t", "t.png"),
        ("a.csv", "c.png"),
    ] {
        folder
            .run(&format!("render {input} {view} -o {output}"))
            .assert_done();
    }
    let bytes = |name: &str| fs::read(folder.path(name)).expect("a picture");
    assert_eq!(bytes("n.png"), bytes("c.png"));
    assert_ne!(bytes("n.png"), bytes("t.png"));
    let info = folder.run("info a.nc");
    info.assert_done();
    for word in ["6 points were read", "the samples have no heights", "rain"] {
        assert!((info.out.clone() + &info.err).contains(word), "{info:#?}");
    }
    let ran = folder.run("render a.nc --point-columns x=lon -o a.png");
    assert!(
        ran.code == 3 && ran.err.contains("coordinates are those of CF"),
        "{ran:#?}"
    );
}
