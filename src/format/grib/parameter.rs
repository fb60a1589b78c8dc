//! Names and units of common parameters: code table 4.2 of the Manual on Codes, with the short names that weather
//! services give them.

/// Short name and unit of a discipline, category and number; `d.c.n` for others.
pub(super) fn parameter(numbers: [u8; 3]) -> (String, Option<&'static str>) {
    let (name, unit) = match numbers {
        [0, 0, 0] => ("t", "K"),
        [0, 0, 1] => ("vtmp", "K"),
        [0, 0, 2] => ("pt", "K"),
        [0, 0, 4] => ("tmax", "K"),
        [0, 0, 5] => ("tmin", "K"),
        [0, 0, 6] => ("dpt", "K"),
        [0, 1, 0] => ("q", "kg kg-1"),
        [0, 1, 1] => ("r", "%"),
        [0, 1, 3] => ("pwat", "kg m-2"),
        [0, 1, 7] => ("prate", "kg m-2 s-1"),
        [0, 1, 8] => ("tp", "kg m-2"),
        [0, 1, 22] => ("clwmr", "kg kg-1"),
        [0, 1, 23] => ("icmr", "kg kg-1"),
        [0, 1, 24] => ("rwmr", "kg kg-1"),
        [0, 1, 25] => ("snmr", "kg kg-1"),
        [0, 1, 32] => ("grle", "kg kg-1"),
        [0, 2, 0] => ("wdir", "degree"),
        [0, 2, 1] => ("ws", "m s-1"),
        [0, 2, 2] => ("u", "m s-1"),
        [0, 2, 3] => ("v", "m s-1"),
        [0, 2, 8] => ("w", "Pa s-1"),
        [0, 2, 9] => ("wz", "m s-1"),
        [0, 2, 10] => ("absv", "s-1"),
        [0, 2, 12] => ("vo", "s-1"),
        [0, 2, 13] => ("d", "s-1"),
        [0, 2, 22] => ("gust", "m s-1"),
        [0, 3, 0] => ("pres", "Pa"),
        [0, 3, 1] => ("prmsl", "Pa"),
        [0, 3, 4] => ("z", "m2 s-2"),
        [0, 3, 5] => ("gh", "gpm"),
        [0, 3, 6] => ("h", "m"),
        [0, 6, 1] => ("tcc", "%"),
        [0, 6, 32] => ("cc", "1"),
        [0, 7, 6] => ("cape", "J kg-1"),
        [0, 7, 7] => ("cin", "J kg-1"),
        [0, 14, 1] => ("o3mr", "kg kg-1"),
        [0, 16, 4] => ("refd", "dB"),
        [2, 0, 0] => ("lsm", "1"),
        [10, 1, 2] => ("uo", "m s-1"),
        [10, 1, 3] => ("vo", "m s-1"),
        [10, 3, 0] => ("wtmp", "K"),
        _ => {
            let [discipline, category, number] = numbers;
            return (format!("{discipline}.{category}.{number}"), None);
        }
    };
    (name.to_owned(), Some(unit))
}
