//! Files that the program writes: looked at before the work begins, and whole or not there at the end.

use super::{Error, error::visible, signals::Gate};
use crate::picture::write_file;
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Refuses, before any work is done, outputs that cannot be written or would take the place of something.
pub fn check(outputs: &[PathBuf], inputs: &[PathBuf], force: bool) -> Result<(), Error> {
    for (at, path) in outputs.iter().enumerate() {
        if outputs[..at]
            .iter()
            .any(|other| place(other) == place(path))
        {
            return Err(Error::usage(
                format!("{} is to be written twice", path.display()),
                "give each output a name of its own",
            ));
        }
        check_one(path, inputs, force)?;
    }
    Ok(())
}

fn check_one(path: &Path, inputs: &[PathBuf], force: bool) -> Result<(), Error> {
    let refuse = |problem: String, hint| Error::Output {
        path: path.to_owned(),
        problem,
        hint,
    };
    let folder = folder_of(path);
    if !folder.is_dir() {
        let problem = format!("there is no folder {}", folder.display());
        return Err(refuse(problem, Some("make the folder first")));
    }
    if let Ok(found) = path.canonicalize() {
        let is_found = |input: &PathBuf| input.canonicalize().is_ok_and(|input| input == found);
        if inputs.iter().any(is_found) {
            return Err(refuse(
                "it is an input".to_owned(),
                Some("choose another name"),
            ));
        }
    }
    match path.symlink_metadata() {
        Ok(found) if found.is_dir() => Err(refuse("it is a folder".to_owned(), None)),
        Ok(_) if !force => Err(refuse("it exists".to_owned(), Some("--force replaces it"))),
        // Renaming over a device or a pipe would take it away from everybody.
        Ok(found) if !found.is_file() && !found.is_symlink() => {
            Err(refuse("it is not an ordinary file".to_owned(), None))
        }
        Ok(_) | Err(_) => tempfile::tempfile_in(folder)
            .map(drop)
            .map_err(|cause| Error::output(path, &cause)),
    }
}

/// Puts a file with these bytes at `path`, whole or not at all. Only `force` replaces one.
pub fn write_whole(path: &Path, bytes: &[u8], force: bool, gate: &Gate) -> Result<(), Error> {
    Ok(gate.whole(|| write_file(path, bytes, force))?)
}

/// Where a file lies or will lie, whichever way its name goes there.
fn place(path: &Path) -> PathBuf {
    let folder = folder_of(path);
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    folder.join(path.file_name().unwrap_or_default())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// Writes `text` to the standard output; a closed one is an error of its own exit code, not a panic.
pub fn say(text: &str) -> Result<(), Error> {
    write_out(text.as_bytes())
}

/// Writes bytes to the standard output, as [`say`] does.
pub fn write_out(bytes: &[u8]) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)
        .and_then(|()| out.flush())
        .map_err(|cause| Error::output("the standard output", &cause))
}

/// Says one line on stderr. Where stderr is closed there is nobody to tell.
pub fn say_aside(text: &str) {
    let line = format!("stratavox: {}\n", visible(text));
    let _ = io::stderr().write_all(line.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn refusal(outputs: &[&Path], inputs: &[&Path], force: bool) -> (u8, String) {
        let owned = |paths: &[&Path]| paths.iter().map(|p| p.to_path_buf()).collect::<Vec<_>>();
        let error = check(&owned(outputs), &owned(inputs), force).expect_err("refused");
        (error.exit_code(), error.to_string())
    }

    #[test]
    fn an_output_that_exists_is_kept_unless_forced() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        fs::write(&path, "before").expect("a file");
        let (code, text) = refusal(&[&path], &[], false);
        assert!(code == 4 && text.contains("it exists"), "{code}: {text}");
        check(std::slice::from_ref(&path), &[], true).expect("allowed by force");

        let gate = Gate::default();
        let error = write_whole(&path, b"after", false, &gate).expect_err("refused again");
        assert_eq!(error.exit_code(), 4, "{error}");
        assert_eq!(fs::read(&path).expect("a file"), b"before");
        write_whole(&path, b"after", true, &gate).expect("written");
        assert_eq!(fs::read(&path).expect("a file"), b"after");
        let names = fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(names, 1, "a temporary file is left");
    }

    #[test]
    fn an_input_is_never_an_output_even_by_force_and_another_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let input = folder.path().join("a.npy");
        fs::write(&input, "").expect("a file");
        let by_another_way = folder.path().join(".").join("a.npy");
        let (code, text) = refusal(&[&by_another_way], &[&input], true);
        assert!(
            code == 4 && text.contains("it is an input"),
            "{code}: {text}"
        );
    }

    #[test]
    fn a_missing_folder_a_folder_and_a_reference_are_refused_before_the_work() {
        let folder = tempfile::tempdir().expect("a folder");
        let nowhere = folder.path().join("no").join("a.png");
        let (code, text) = refusal(&[&nowhere], &[], true);
        assert!(
            code == 4 && text.contains("there is no folder"),
            "{code}: {text}"
        );
        let (code, text) = refusal(&[folder.path()], &[], true);
        assert!(
            code == 4 && text.contains("it is a folder"),
            "{code}: {text}"
        );
        let path = folder.path().join("a.png");
        let (code, text) = refusal(&[&path, &path], &[], false);
        assert!(code == 2 && text.contains("twice"), "{code}: {text}");
        let by_another_way = folder
            .path()
            .join(".")
            .join("..")
            .join(folder.path().file_name().expect("a name"));
        let (code, text) = refusal(&[&path, &by_another_way.join("a.png")], &[], true);
        assert!(code == 2 && text.contains("twice"), "{code}: {text}");
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_never_replaced_by_a_file() {
        let (code, text) = refusal(&[Path::new("/dev/null")], &[], true);
        assert!(
            code == 4 && text.contains("not an ordinary file"),
            "{code}: {text}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn an_output_may_be_read_by_whom_the_process_says() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let (ours, plain) = (folder.path().join("a"), folder.path().join("b"));
        write_whole(&ours, b"", false, &Gate::default()).expect("written");
        fs::write(&plain, "").expect("a file");
        let mode = |path| fs::metadata(path).expect("a file").permissions().mode();
        assert_eq!(
            mode(&ours),
            mode(&plain),
            "{:o} {:o}",
            mode(&ours),
            mode(&plain)
        );
    }
}
