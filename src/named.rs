//! Enumerations by the names that people write. One table an enumeration: options, scene files, messages and the numbers
//! of C come from it.

/// An enumeration with a table of names.
#[cfg_attr(
    not(feature = "cli"),
    allow(dead_code, reason = "options and their help want all of the table")
)]
pub(crate) trait Named: Copy + 'static {
    /// All values, in the order of their numbers in C.
    const ALL: &'static [Self];
    /// As it is written.
    fn name(self) -> &'static str;
    /// What it is, for help; empty where the name says it.
    fn about(self) -> &'static str;
}

/// `named!(Mode { Mip "mip" "The maximum along each ray", .. })`: the compiler finds what the table lacks.
macro_rules! named {
    ($of:ident { $($value:ident $name:literal $about:literal,)* }) => {
        impl $crate::named::Named for $of {
            const ALL: &'static [Self] = &[$(Self::$value),*];

            fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $name,)*
                }
            }

            fn about(self) -> &'static str {
                match self {
                    $(Self::$value => $about,)*
                }
            }
        }

        impl std::fmt::Display for $of {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str($crate::named::Named::name(*self))
            }
        }
    };
}

pub(crate) use named;
