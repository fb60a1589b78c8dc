//! Images: as volumes, and as the pictures that `compare` reads.

use crate::Bombs;
use crate::streams::long_zlib;
use crate::tiff::{Page, Value, file};

pub fn add(bombs: &mut Bombs) {
    tiff(bombs);
    pictures(bombs);
}

fn tiff(bombs: &mut Bombs) {
    let gray = || Page::gray(4, 4, vec![0; 16]);
    let long = |n| Value::Long(n);
    let all = u32::MAX;
    bombs.volume(
        "sides.tif",
        file(&[Page::gray(all, all, vec![0; 16])], None),
        "",
    );
    let strip = gray().with(256, long(60_000)).with(257, long(60_000));
    bombs.volume(
        "strip.tif",
        file(&[strip.with(278, long(60_000))], None),
        "",
    );
    let tiles = gray()
        .without(278)
        .without(279)
        .with(322, long(1 << 30))
        .with(323, long(1 << 30))
        .with(324, long(8))
        .with(325, long(16));
    bombs.volume("tile.tif", file(&[tiles], None), "");
    bombs.volume("loop.tif", file(&[gray(), gray()], Some(0)), "");
    let count = gray().with(279, long(all));
    bombs.harmless("count.tif", file(&[count], None));
    // As many offsets as the field can say.
    let mut offsets = file(&[gray().with(273, Value::Longs(vec![8, 8]))], None);
    let at = offsets
        .windows(4)
        .position(|part| part == [0x11, 1, 4, 0])
        .expect("an entry");
    offsets[at + 4..at + 8].copy_from_slice(&all.to_le_bytes());
    bombs.volume("offsets.tif", offsets, "");
    let samples = gray().with(277, Value::Short(u16::MAX));
    bombs.volume("samples.tif", file(&[samples], None), "");
    let mut big = b"II\x2b\0\x08\0\0\0\x10\0\0\0\0\0\0\0".to_vec();
    big.extend((1_u64 << 60).to_le_bytes());
    bombs.volume("entries.tif", big, "");
    ome(bombs);
}

fn ome(bombs: &mut Bombs) {
    let gray = |text: &str| file(&[Page::gray(4, 4, vec![0; 16]).described(text)], None);
    let pixels = |sizes: &str, inside: &str| {
        let space = "http://www.openmicroscopy.org/Schemas/OME/2016-06";
        format!(
            "<?xml version=\"1.0\"?><OME xmlns=\"{space}\"><Image ID=\"Image:0\"><Pixels ID=\"Pixels:0\" \
             DimensionOrder=\"XYZCT\" Type=\"uint8\" SizeX=\"4\" SizeY=\"4\" {sizes}>{inside}</Pixels></Image></OME>"
        )
    };
    let sizes = "SizeZ=\"2147483647\" SizeC=\"2147483647\" SizeT=\"2147483647\"";
    bombs.volume("sizes.ome.tif", gray(&pixels(sizes, "<TiffData/>")), "");
    let planes = "<TiffData IFD=\"0\" PlaneCount=\"2147483647\"/>";
    let one = "SizeZ=\"2147483647\" SizeC=\"1\" SizeT=\"1\"";
    bombs.volume("planes.ome.tif", gray(&pixels(one, planes)), "");
    let deep = format!("{}{}", "<a>".repeat(20_000), "</a>".repeat(20_000));
    bombs.volume(
        "deep.ome.tif",
        gray(&pixels("SizeZ=\"1\" SizeC=\"1\" SizeT=\"1\"", &deep)),
        "",
    );
}

/// Chunks of a PNG.
fn png(side: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    let sides = [side.to_be_bytes(), side.to_be_bytes()].concat();
    for (name, data) in [
        (b"IHDR", [&sides[..], &[8, 6, 0, 0, 0]].concat()),
        (b"IDAT", data.to_vec()),
        (b"IEND", Vec::new()),
    ] {
        bytes.extend((data.len() as u32).to_be_bytes());
        let mut sum = flate2::Crc::new();
        sum.update(name);
        sum.update(&data);
        bytes.extend(name);
        bytes.extend(&data);
        bytes.extend(sum.sum().to_be_bytes());
    }
    bytes
}

fn pictures(bombs: &mut Bombs) {
    let good = png(1, &crate::encode::zlib(&[0; 5]));
    bombs.folder.write("good.png", good);
    let mut picture = |name: &str, bytes: Vec<u8>| {
        bombs.folder.write(name, bytes);
        bombs.run(name, &format!("compare {name} good.png"), "");
    };
    picture("sides.png", png(0x7fff_ffff, &crate::encode::zlib(&[0; 5])));
    picture("large.png", png(20_000, &long_zlib()));
    let mut npy = b"\x93NUMPY\x01\0\x76\0".to_vec();
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2147483647, 2147483647, 4)}";
    npy.extend(format!("{header:<117}\n").as_bytes());
    picture("sides.npy", npy);
    let mut exr = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        exr.extend(name.as_bytes());
        exr.push(0);
        exr.extend(kind.as_bytes());
        exr.push(0);
        exr.extend((value.len() as u32).to_le_bytes());
        exr.extend(value);
    };
    let channel = [
        &b"R\0"[..],
        &[1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0],
    ]
    .concat();
    attribute("channels", "chlist", &channel);
    attribute("compression", "compression", &[3]);
    let window: Vec<u8> = [0_i32, 0, 0x3fff_ffff, 0x3fff_ffff]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1_f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1_f32.to_le_bytes());
    exr.push(0);
    picture("sides.exr", exr);
}
