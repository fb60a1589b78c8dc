//! What README and `--help` show runs: every `stratavox ...` line, in an empty folder, exits 0; and where
//! output is shown below a line, that is what comes.
//!
//! README says so in code blocks of `sh`. A comment at the end of a line is left out, `&&` runs one line after
//! the other. A pipe between `cat` and `stratavox` runs as it stands, in a shell; what stands behind a pipe into another
//! program is left out. A line with a word of capitals (`INPUT`,
//! `FILE`), `[` or words to choose from (`list|show`) shows a form, not an example. A block of `console` shows `$ `
//! lines with what they print below them.

use crate::person::{Folder, Ran, assert_begins};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A line to run, what it must print where that is shown, and where it stands.
#[derive(Debug, PartialEq)]
struct Example {
    line: String,
    output: Option<String>,
    place: String,
}

impl Example {
    fn new(line: &str, place: &str) -> Self {
        Self {
            line: line.to_owned(),
            output: None,
            place: place.to_owned(),
        }
    }

    /// Runs it and checks what comes.
    fn check(&self, folder: &Folder) {
        if self.line.contains(PIPE) {
            return self.check_output(&piped(&self.line, folder));
        }
        let mut printed = String::new();
        for words in self.line.split(" && ") {
            let words = words
                .trim()
                .strip_prefix("stratavox ")
                .unwrap_or_else(|| panic!("{self:?}"));
            let Ran { code, out, err } = folder.run(&words.replace('\'', ""));
            assert_eq!(code, 0, "{self:?}: {err}");
            printed.push_str(&out);
        }
        self.check_output(&printed);
    }

    fn check_output(&self, printed: &str) {
        if let Some(wanted) = &self.output {
            assert_eq!(printed.trim_end(), wanted.trim_end(), "{self:?}");
        }
    }
}

const PIPE: &str = " | ";

/// What a line with pipes prints, run by a shell that finds the program of the tests.
fn piped(line: &str, folder: &Folder) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_stratavox"));
    let here = program.parent().expect("a folder").to_owned();
    let others = std::env::var_os("PATH").unwrap_or_default();
    let others = std::env::split_paths(&others).collect::<Vec<PathBuf>>();
    let path = std::env::join_paths([vec![here], others].concat()).expect("folders");
    let ran = Command::new("sh")
        .args(["-c", line])
        .env("PATH", path)
        .current_dir(folder.path(""))
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{line}: {said}");
    String::from_utf8_lossy(&ran.stdout).into_owned()
}

/// The same with small pictures.
fn small(line: &str) -> String {
    let draws = ["stratavox render ", "stratavox animate "];
    if !draws.iter().any(|verb| line.starts_with(verb)) {
        return line.into();
    }
    let mut words: Vec<_> = line.split(' ').collect();
    let of = |wanted: &str| words.iter().position(|&word| word == wanted);
    match (of("--size"), of("-o")) {
        (Some(at), _) => words[at + 1] = "96x72",
        (None, Some(at)) => drop(words.splice(at..at, ["--size", "96x72"])),
        (None, None) => {}
    }
    words.join(" ")
}

/// The same of phantoms of few voxels.
fn of_few_voxels(line: &str) -> String {
    let is_large = |word: &str| word.starts_with("phantom:") && !word.contains("n=");
    let small = line.split(' ').map(|word| match is_large(word) {
        true => format!("{word},n=48"),
        false => word.to_owned(),
    });
    small.collect::<Vec<_>>().join(" ")
}

/// The line without its comment, if it is an example.
fn example_line(line: &str) -> Option<&str> {
    let line = line.split(" #").next().unwrap_or_default();
    let first = line.split(PIPE).next().unwrap_or_default();
    let programs = line.split(PIPE).map(|part| part.split_whitespace().next());
    let is_run = programs
        .clone()
        .all(|name| matches!(name, Some("stratavox" | "cat")))
        && programs.clone().any(|name| name == Some("stratavox"));
    let line = if is_run { line } else { first }.trim();
    let forms = line.replace(PIPE, " ");
    let is_form = |word: &str| {
        let word = word.trim_matches(|c: char| !c.is_alphanumeric());
        word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase())
    };
    let mut parts = forms.split([' ', '|', ',', '.', '=']);
    let is_ours = is_run || line.starts_with("stratavox ");
    let is_example = is_ours && !forms.contains(['[', '|']) && !parts.any(is_form);
    is_example.then_some(line)
}

/// The examples of a text in Markdown.
fn of_markdown(text: &str, place: &str) -> Vec<Example> {
    let mut examples: Vec<Example> = Vec::new();
    let mut fence: Option<&str> = None;
    for (number, line) in text.lines().enumerate() {
        let place = format!("{place}:{}", number + 1);
        match (fence, line.trim_start().strip_prefix("```")) {
            (None, Some(language)) => fence = Some(language),
            (Some(_), Some(_)) => fence = None,
            (Some("sh"), None) => {
                examples.extend(example_line(line).map(|line| Example::new(line, &place)))
            }
            (Some("console"), None) => match line.strip_prefix("$ ") {
                Some(line) => examples.push(Example {
                    output: Some(String::new()),
                    ..Example::new(line.trim(), &place)
                }),
                None => {
                    let last = examples
                        .last_mut()
                        .and_then(|example| example.output.as_mut());
                    let output = last.unwrap_or_else(|| panic!("{place}: output before a command"));
                    output.push_str(line);
                    output.push('\n');
                }
            },
            _ => {}
        }
    }
    examples
}

/// The examples at the end of a help.
fn of_help(help: &str, place: &str) -> Vec<Example> {
    let after = help.split_once("\nExample").map_or("", |(_, after)| after);
    let lines = after.lines().filter_map(example_line);
    lines.map(|line| Example::new(line, place)).collect()
}

/// The verbs that a help lists, `help` left out.
fn verbs(help: &str) -> Vec<String> {
    let Some((_, list)) = help.split_once("Commands:\n") else {
        return Vec::new();
    };
    let lines = list.lines().take_while(|line| !line.is_empty());
    let names = lines
        .filter(|line| !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next());
    names
        .filter(|&name| name != "help")
        .map(str::to_owned)
        .collect()
}

/// Files that examples begin with: what a person has.
fn given(folder: &Folder) {
    let tf = r#"[{"ColorSpace":"RGB","Name":"Own","RGBPoints":[0,0,0,0,1,1,1,1]}]"#;
    folder.file("colours.json", tf);
    let bone = r#"<MRML><VolumeProperty name="CT-Bone" scalarOpacity="4 0 0 1 1" colorTransfer="8 0 0 0 0 1 1 1 1"/>
        <VolumeProperty name="CT-Air" scalarOpacity="4 0 1 1 0" colorTransfer="8 0 0 0 0 1 1 1 1"/></MRML>"#;
    folder.file("presets.xml", bone);
    folder
        .run("render phantom:fog,n=8 --size 8x8 --device reference -o fog.npy")
        .assert_done();
}

#[test]
fn every_example_of_every_help_runs() {
    let start = Folder::new();
    let mut waiting = vec![String::new()];
    let mut run = 0;
    while let Some(verb) = waiting.pop() {
        let help = start.run(&format!("{verb} --help"));
        help.assert_done();
        waiting.extend(
            verbs(&help.out)
                .into_iter()
                .map(|below| format!("{verb} {below}")),
        );
        // It opens a window.
        if verb == " view" {
            assert!(help.out.contains("stratavox view FILE"), "{}", help.out);
            continue;
        }
        let examples = of_help(&help.out, &format!("stratavox{verb} --help"));
        assert!(
            !examples.is_empty(),
            "stratavox{verb} --help shows no example: {}",
            help.out
        );
        let folder = Folder::new();
        given(&folder);
        for mut example in examples {
            example.line = of_few_voxels(&small(&example.line));
            // What pictures cost on this machine is asked elsewhere, in less time.
            if verb == " bench" {
                continue;
            }
            // Examples of one help may write to the same names.
            let again = example
                .line
                .split_whitespace()
                .skip_while(|&word| word != "-o")
                .nth(1);
            if let Some(name) = again.filter(|&name| name != ".") {
                let _ = fs::remove_file(folder.path(name));
            }
            example.check(&folder);
            run += 1;
        }
    }
    println!("{run} examples");
    assert!(run >= 15, "only {run} examples");
}

#[test]
fn every_example_of_the_readme_runs_and_prints_what_is_shown() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/README.md");
    let text = fs::read_to_string(path).expect("the README");
    let examples = of_markdown(&text, "README.md");
    let folder = Folder::new();
    for example in &examples {
        example.check(&folder);
    }
    let shown = examples
        .iter()
        .filter(|example| example.output.is_some())
        .count();
    println!("{} examples, {shown} with their output", examples.len());
    assert!(examples.len() >= 3 && shown >= 1, "{examples:#?}");
}

/// Each block of `json` in `docs/transfer-functions.md` is a file that draws something, and each line of `sh` runs.
#[test]
fn every_transfer_function_of_the_docs_draws_something() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/transfer-functions.md");
    let text = fs::read_to_string(path).expect("the page");
    let folder = Folder::new();
    let blocks = text.split("```json\n").skip(1);
    let blocks = blocks.filter_map(|block| block.split("```").next());
    let mut drawn = 0;
    for block in blocks {
        folder.file("tf.json", block);
        let ran = folder.run(
            "render phantom:head,n=16 --tf tf.json --device reference --size 16x16 -o tf.npy --force",
        );
        ran.assert_done();
        assert!(!ran.err.contains("empty"), "{block}: {}", ran.err);
        drawn += 1;
    }
    assert!(drawn >= 3, "only {drawn} functions");
    let examples = of_markdown(&text, "docs/transfer-functions.md");
    assert!(examples.len() >= 2, "{examples:#?}");
    for example in &examples {
        example.check(&folder);
    }
}

/// Runs what a page shows with small pictures, and gives the folder that it ran in, and how many lines there were.
fn run_page(page: &str) -> (Folder, String, usize) {
    let path = format!("{}/{page}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).expect("the page");
    let mut examples = of_markdown(&text, page);
    let folder = Folder::new();
    for example in &mut examples {
        example.line = small(&example.line);
        example.check(&folder);
    }
    (folder, text, examples.len())
}

#[test]
fn every_command_of_the_page_of_annotation_runs() {
    let (_, _, lines) = run_page("docs/annotation.md");
    assert!(lines >= 4, "{lines} lines");
}

#[test]
fn every_command_of_the_page_of_weather_runs() {
    let (folder, _, lines) = run_page("docs/weather.md");
    assert_eq!(lines, 18);
    let pictures = [
        "particles.png",
        "vapor.png",
        "abc.png",
        "comets.png",
        "ribbons.png",
        "cloud.png",
        "wind.png",
        "barbs.png",
        "ground.png",
        "speed.png",
        "field.png",
        "density.png",
    ];
    for name in pictures
        .into_iter()
        .chain(["storm.gif", "updraft.vtp", "speed.nrrd", "values.csv"])
    {
        assert!(folder.path(name).exists(), "{name}");
    }
}

#[test]
fn every_command_of_the_page_of_path_tracing_runs() {
    let (folder, _, lines) = run_page("docs/pathtrace.md");
    assert_eq!(lines, 10);
    for name in [
        "layers.exr",
        "head.png",
        "bone.png",
        "point.png",
        "lit.png",
        "once.png",
        "near.png",
        "more.png",
        "head.samples",
        "single.png",
    ] {
        assert!(folder.path(name).exists(), "{name}");
    }
}

/// The page shows the file and what is printed of it.
#[test]
fn the_drawing_of_the_page_of_structure_has_the_addresses_that_are_shown() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/structure.md");
    let text = fs::read_to_string(&page).expect("the page");
    let drawing = fs::read_to_string(page.with_extension("nrrd")).expect("the drawing");
    let (_, voxels) = drawing.split_once("\n\n").expect("a header");
    assert!(
        text.contains(voxels.trim_end()),
        "another drawing: {voxels}"
    );
    let folder = Folder::new();
    folder.file("structure.nrrd", drawing);
    let examples = of_markdown(&text, "docs/structure.md");
    assert!(examples.iter().any(|example| example.output.is_some()));
    for example in &examples {
        example.check(&folder);
    }
}

/// No line of a recipe is passed over, and what the recipes are about is in their files.
#[cfg(unix)]
#[test]
fn every_recipe_runs_and_its_files_hold_what_it_says() {
    let (folder, text, lines) = run_page("docs/recipes.md");
    let blocks = text.split("```sh\n").skip(1);
    let blocks = blocks.filter_map(|block| block.split("```").next());
    let shown: Vec<usize> = blocks.map(|block| block.lines().count()).collect();
    assert_eq!(lines, shown.iter().sum::<usize>(), "lines that do not run");
    assert_eq!(shown.len(), RECIPES, "recipes");
    let info = folder.run("info storm.nii.gz --json");
    info.assert_done();
    assert!(info.out.contains("\"times\": 4"), "{info:?}");
    assert_begins(&folder.path("picture.png"), b"\x89PNG");
    let layers = fs::read(folder.path("layers.exr")).expect("layers");
    for channel in ["depth", "normal.X", "normal.Y", "normal.Z"] {
        let name = [channel.as_bytes(), &[0]].concat();
        let is_there = layers.windows(name.len()).any(|bytes| bytes == name);
        assert!(is_there, "no channel {channel}");
    }
    let mesh = fs::read(folder.path("bone.ply")).expect("a mesh");
    let mesh = String::from_utf8_lossy(&mesh[..400]).into_owned();
    assert!(
        mesh.contains("element face") && !mesh.contains("element face 0"),
        "{mesh}"
    );
}

/// Recipes of the page: the ten workflows that it must have, and two more.
const RECIPES: usize = 17;

#[test]
fn examples_are_told_from_forms_and_comments() {
    let text = "```sh\ncargo build\nstratavox info phantom:fog   # what\nstratavox info INPUT\n\
        stratavox render a -o OUT.png|.exr\n\
        stratavox render a -o - | display\ncat a | stratavox info - | cat\ncat a | other\n```\nstratavox not this\n```console\n$ stratavox preset list\na\nb\n```\n";
    let found = of_markdown(text, "x");
    let lines: Vec<_> = found
        .iter()
        .map(|example| (example.line.as_str(), example.output.as_deref()))
        .collect();
    assert_eq!(
        lines,
        [
            ("stratavox info phantom:fog", None),
            ("stratavox render a -o -", None),
            ("cat a | stratavox info - | cat", None),
            ("stratavox preset list", Some("a\nb\n"))
        ]
    );
    assert_eq!(found[0].place, "x:3");
    let help = "Usage: stratavox x\n\nExamples:\n  stratavox a b\n  stratavox c\n";
    assert_eq!(of_help(help, "y").len(), 2);
    assert_eq!(
        verbs("Commands:\n  render  Draw\n          more\n  help    Print\n\nOptions:\n  -h"),
        ["render"]
    );
}

#[test]
#[should_panic(expected = "stratavox x")]
fn an_example_that_prints_something_else_is_found() {
    let example = Example {
        output: Some("b\n".to_owned()),
        ..Example::new("stratavox x", "z")
    };
    example.check_output("b\n\n");
    example.check_output("a\n");
}
