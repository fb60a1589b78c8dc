//! What the picture of each volume is called.
//!
//! A volume's name without its ending, and behind it that of a part and of a view; where two would be called the same,
//! both keep their ending, and where that is not enough, the folder they lie in goes before it.

use super::parts::Part;
use crate::{
    cli::{Error, flags::ViewWord},
    format,
};
use std::{
    collections::HashMap,
    path::{Path, PathBuf},
};

/// Each volume once for every view, which stands in its name behind that of the part.
pub fn with_views(volumes: &[(String, Part)], views: &[Option<ViewWord>]) -> Vec<(String, Part)> {
    let seen = |(input, part): &(String, Part), view: &Option<ViewWord>| {
        let words = [part.name.as_str(), view.map_or("", ViewWord::name)];
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        let part = Part {
            name: words.join("-"),
            ..part.clone()
        };
        (input.clone(), part)
    };
    let of_volume = |volume| views.iter().map(move |view| seen(volume, view));
    volumes.iter().flat_map(of_volume).collect()
}

/// A name for each input, no two alike, also where small and capital letters are one.
pub fn pictures_of(inputs: &[(String, Part)]) -> Result<Vec<PathBuf>, Error> {
    let mut lengths = vec![0; inputs.len()];
    loop {
        let names: Vec<String> = inputs
            .iter()
            .zip(&lengths)
            .map(|((input, part), &length)| match part.name.as_str() {
                "" => name_of(input, length),
                part => plain(&format!("{}-{part}", name_of(input, length))),
            })
            .collect();
        let mut alike: HashMap<String, Vec<usize>> = HashMap::new();
        for (at, name) in names.iter().enumerate() {
            alike.entry(name.to_lowercase()).or_default().push(at);
        }
        let mut is_done = true;
        for at in alike.into_values().filter(|at| at.len() > 1).flatten() {
            is_done = false;
            lengths[at] += 1;
            if lengths[at] > LONGEST {
                let other = names.iter().enumerate().position(|(other, name)| {
                    other != at && name.to_lowercase() == names[at].to_lowercase()
                });
                let other = other.map_or("", |other| &inputs[other].0);
                return Err(Error::usage(
                    format!(
                        "{} and {other} would both be drawn into {}.png",
                        inputs[at].0, names[at]
                    ),
                    "draw them into folders of their own",
                ));
            }
        }
        if is_done {
            let picture = |name: String| PathBuf::from(name + ".png");
            return Ok(names.into_iter().map(picture).collect());
        }
    }
}

/// Name alone, with its ending, with the folder before it.
const LONGEST: usize = 2;

fn name_of(input: &str, length: usize) -> String {
    let path = Path::new(input.trim_end_matches('/'));
    let whole = |path: &Path| {
        let name = path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    };
    let name = match length {
        0 => format::stem(path).to_owned(),
        1 => whole(path),
        _ => {
            let folder = path.parent().map(whole).unwrap_or_default();
            format!("{folder}-{}", whole(path))
        }
    };
    let name = match name.as_str() {
        // The folder that we are in, or one that ends in `..`.
        "" => "volume",
        name => name,
    };
    plain(name)
}

/// The words of a phantom, and what a file's name may hold and no other system likes.
fn plain(name: &str) -> String {
    name.replace(
        [':', ',', '=', '/', '\\', '*', '?', '"', '<', '>', '|'],
        "-",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pictures(inputs: &[&str]) -> Vec<String> {
        let whole = |&input: &&str| (input.to_owned(), Part::default());
        let inputs: Vec<_> = inputs.iter().map(whole).collect();
        let names = pictures_of(&inputs).expect("names");
        names
            .iter()
            .map(|name| name.display().to_string())
            .collect()
    }

    #[test]
    fn a_picture_is_called_as_its_volume_is_and_endings_keep_two_apart() {
        assert_eq!(
            pictures(&[
                "a/brain.nii.gz",
                "a/b.c.raw",
                "x.zarr/",
                "phantom:head,n=8",
                "one"
            ]),
            [
                "brain.png",
                "b.c.png",
                "x.png",
                "phantom-head-n-8.png",
                "one.png"
            ]
        );
        assert_eq!(
            pictures(&["a/ct.nrrd", "a/CT.nii", "a/pet.nii"]),
            ["ct.nrrd.png", "CT.nii.png", "pet.png"]
        );
        assert_eq!(
            pictures(&["a/ct.nii", "b/ct.nii", "b/ct.mha"]),
            ["a-ct.nii.png", "b-ct.nii.png", "ct.mha.png"]
        );
    }

    #[test]
    fn a_part_stands_behind_the_name() {
        let part = |name: &str| Part {
            name: name.to_owned(),
            ..Part::default()
        };
        let inputs = [("scan", "T1/axial"), ("scan", "T2"), ("one.nc", "T")];
        let inputs = inputs.map(|(input, name)| (input.to_owned(), part(name)));
        let names = pictures_of(&inputs).expect("names");
        let wanted = ["scan-T1-axial.png", "scan-T2.png", "one-T.png"];
        assert_eq!(names, wanted.map(PathBuf::from));
    }

    #[test]
    fn a_view_stands_behind_the_part_and_one_without_a_word_changes_no_name() {
        let part = |name: &str| Part {
            name: name.to_owned(),
            ..Part::default()
        };
        let volumes = [
            ("a.nii".to_owned(), part("T1")),
            ("b.nii".to_owned(), part("")),
        ];
        let views = [Some(ViewWord::Left), Some(ViewWord::Superior)];
        let names = pictures_of(&with_views(&volumes, &views)).expect("names");
        let wanted = [
            "a-T1-left.png",
            "a-T1-superior.png",
            "b-left.png",
            "b-superior.png",
        ];
        assert_eq!(names, wanted.map(PathBuf::from));
        assert_eq!(with_views(&volumes, &[None]), volumes);
    }

    #[test]
    fn names_that_cannot_be_kept_apart_are_refused() {
        let inputs = ["x/a/ct.nii", "y/a/ct.nii"].map(|input| (input.to_owned(), Part::default()));
        let error = pictures_of(&inputs).expect_err("refused");
        assert!(
            error.exit_code() == 2 && error.to_string().contains("y/a/ct.nii"),
            "{error}"
        );
    }
}
