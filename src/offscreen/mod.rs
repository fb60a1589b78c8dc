//! A scene to a picture, on either side.

pub mod reference;
