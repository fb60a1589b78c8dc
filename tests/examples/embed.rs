//! The example of a host draws what it says.

use crate::embed_example as example;
use stratavox::picture::read_image;

#[test]
fn the_example_writes_a_sphere_before_its_background() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sphere.png");
    example::run(&path).unwrap();
    let picture = read_image(&path).unwrap();
    let [width, height] = [picture.width as usize, picture.height as usize];
    let red = |x: usize, y: usize| picture.pixels[x + y * width][0];
    // The background has no red, the grey of the sphere has.
    for (x, y) in [
        (0, 0),
        (width - 1, 0),
        (0, height - 1),
        (width - 1, height - 1),
    ] {
        assert_eq!(red(x, y), 0.0, "the corner at ({x}, {y})");
    }
    let middle = red(width / 2, height / 2);
    assert!(middle > 0.5, "red in the middle is {middle}");
    // Round: as wide as it is high, with the area of a circle of that width.
    let lit = |(x, y): &(usize, usize)| red(*x, *y) > 0.0;
    let across = (0..width).map(|x| (x, height / 2)).filter(lit).count();
    let down = (0..height).map(|y| (width / 2, y)).filter(lit).count();
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let area = all.filter(lit).count() as f64;
    let circle = 0.25 * std::f64::consts::PI * (across as f64).powi(2);
    // A pixel at each end may go either way.
    assert!(across.abs_diff(down) <= 2, "{across} across, {down} down");
    let off = std::f64::consts::PI * across as f64;
    assert!((area - circle).abs() <= off, "area {area}, circle {circle}");
}
