//! GIF (89a, CompuServe 1990): one palette for the whole film, so that colours do not flicker, played for ever.

use super::{Reel, palette::Palette};
use crate::cli::Error;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::{
    borrow::Cow,
    io::{self, Write},
};

/// Browsers show a shorter frame for a tenth of a second.
const SHORTEST_HUNDREDTHS: u64 = 2;

/// The whole film.
pub fn write(reel: &Reel, out: &mut impl Write) -> Result<(), Error> {
    let refused = |cause: EncodingError| {
        reel.wrote(match cause {
            EncodingError::Io(cause) => cause,
            other => io::Error::other(other.to_string()),
        })
    };
    let palette = Palette::of((0..reel.count).map(|number| {
        reel.progress
            .stage("choose colours", number as usize, reel.count as usize);
        reel.codes(number)
    }))?;
    let [width, height] = reel.extent_pixels.map(|side| side as u16);
    let mut encoder =
        Encoder::new(out, width, height, palette.colors.as_flattened()).map_err(refused)?;
    encoder.set_repeat(Repeat::Infinite).map_err(refused)?;
    let packed = |number| {
        let codes = reel.codes(number)?;
        let mut frame = Frame {
            width,
            height,
            delay: delay(reel, number),
            dispose: DisposalMethod::Keep,
            buffer: Cow::Owned(palette.indices(&codes, width.into())),
            ..Frame::default()
        };
        frame.make_lzw_pre_encoded();
        Ok(frame)
    };
    reel.in_order(packed, |frame| {
        encoder.write_lzw_pre_encoded_frame(&frame).map_err(refused)
    })
}

/// Hundredths of a second until the next frame; what rounding takes from one it gives to another.
fn delay(reel: &Reel, number: u32) -> u16 {
    let hundredths = reel.rate.begin_hundredths(number + 1) - reel.rate.begin_hundredths(number);
    hundredths.max(SHORTEST_HUNDREDTHS).min(u16::MAX.into()) as u16
}
