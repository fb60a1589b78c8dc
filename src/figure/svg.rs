//! A figure as SVG 1.1 text: the same figure gives the same text.

use super::{Anchor, Figure, Mark, Point, raster::encode_rgb};
use std::fmt::Write;

/// The text of an SVG file.
pub fn svg(figure: &Figure) -> String {
    let [width, height] = figure.size.map(number);
    let title = escaped(&figure.title);
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"Helvetica, Arial, sans-serif\">\n\
         <title>{title}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for mark in &figure.marks {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}", element(mark));
    }
    text.push_str("</svg>\n");
    text
}

fn element(mark: &Mark) -> String {
    match mark {
        Mark::Area { points, fill } => format!(
            "<polygon points=\"{}\" {}/>",
            list(points),
            paint("fill", *fill)
        ),
        Mark::Line {
            points,
            color,
            width,
        } => format!(
            "<polyline points=\"{}\" fill=\"none\" {} stroke-width=\"{}\" \
             stroke-linecap=\"round\" stroke-linejoin=\"round\"/>",
            list(points),
            paint("stroke", *color),
            number(*width)
        ),
        Mark::Text {
            at,
            text,
            size,
            anchor,
            upward,
            color,
        } => {
            let [x, y] = at.map(number);
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let turn = match upward {
                true => format!(" transform=\"rotate(-90 {x} {y})\""),
                false => String::new(),
            };
            format!(
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" {}{turn}>{}</text>",
                number(*size),
                paint("fill", *color),
                escaped(text)
            )
        }
        Mark::Cells {
            at,
            size,
            columns,
            colors,
        } => {
            let [[x, y], [width, height]] = [*at, *size].map(|pair| pair.map(number));
            let rows = colors.len().checked_div(*columns).unwrap_or(0);
            let png = encode_rgb([*columns as u32, rows as u32], colors.as_flattened());
            format!(
                "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
                 preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
                 xlink:href=\"data:image/png;base64,{}\"/>",
                base64(&png)
            )
        }
    }
}

fn paint(what: &str, [r, g, b, a]: [u8; 4]) -> String {
    let color = format!("{what}=\"#{r:02x}{g:02x}{b:02x}\"");
    match a {
        255 => color,
        _ => format!(
            "{color} {what}-opacity=\"{}\"",
            number(f64::from(a) / 255.0)
        ),
    }
}

fn list(points: &[Point]) -> String {
    let words = points.iter().map(|point| {
        let [x, y] = point.map(number);
        format!("{x},{y}")
    });
    words.collect::<Vec<_>>().join(" ")
}

/// Two digits behind the point are a hundredth of a pixel.
fn number(number: f64) -> String {
    let text = format!("{number:.2}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" {
        "0".to_owned()
    } else {
        short.to_owned()
    }
}

/// Text between tags: what XML 1.0 has no character for becomes the replacement character.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let group = (0..3).fold(0_u32, |group, i| {
            group << 8 | u32::from(chunk.get(i).copied().unwrap_or(0))
        });
        for digit in 0..4 {
            if digit <= chunk.len() {
                let six_bits = group >> (18 - 6 * digit) & 63;
                text.push(char::from(DIGITS[six_bits as usize]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_the_same_text_every_time_to_the_letter() {
        let mut figure = Figure::new([20.0, 10.5], "a < b".to_owned());
        figure.line([0.0, 1.0 / 3.0], [2.0, -0.001], [0, 128, 255, 255], 1.5);
        figure.upward([3.0, 4.0], "µ & \u{1b}", 9.0, [1, 2, 3, 51]);
        figure.marks.push(Mark::Area {
            points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            fill: [255, 0, 0, 255],
        });
        let wanted = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
            <svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
            width=\"20\" height=\"10.5\" viewBox=\"0 0 20 10.5\" font-family=\"Helvetica, Arial, sans-serif\">\n\
            <title>a &lt; b</title>\n\
            <rect width=\"20\" height=\"10.5\" fill=\"#ffffff\"/>\n\
            <polyline points=\"0,0.33 2,0\" fill=\"none\" stroke=\"#0080ff\" stroke-width=\"1.5\" \
            stroke-linecap=\"round\" stroke-linejoin=\"round\"/>\n\
            <text x=\"3\" y=\"4\" font-size=\"9\" text-anchor=\"middle\" fill=\"#010203\" fill-opacity=\"0.2\" \
            transform=\"rotate(-90 3 4)\">µ &amp; \u{fffd}</text>\n\
            <polygon points=\"0,0 1,0 1,1\" fill=\"#ff0000\"/>\n</svg>\n";
        assert_eq!(svg(&figure), wanted);
    }

    #[test]
    fn base64_is_that_of_the_rfc() {
        for (bytes, wanted) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), wanted);
        }
    }
}
