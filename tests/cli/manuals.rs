//! Shells and manuals know every verb.

use crate::person::Folder;
use std::fs;

/// The verbs that `--help` lists.
fn verbs(folder: &Folder) -> Vec<String> {
    let help = folder.run("--help").out;
    let list = help.split("Commands:").nth(1).expect("a list of verbs");
    let list = list.split("Options:").next().expect("the list alone");
    let verbs = list.lines().filter_map(|line| line.strip_prefix("  "));
    let verbs = verbs.filter(|line| !line.starts_with(' '));
    let verbs = verbs.filter_map(|line| line.split_whitespace().next());
    let verbs: Vec<String> = verbs
        .filter(|&verb| verb != "help")
        .map(str::to_owned)
        .collect();
    assert!(verbs.len() >= 9, "{verbs:?}");
    verbs
}

#[test]
fn every_shell_is_told_every_verb_and_its_flags() {
    let folder = Folder::new();
    let verbs = verbs(&folder);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let ran = folder.run(&format!("completions {shell}"));
        ran.assert_done();
        assert!(ran.err.is_empty(), "{shell}: {}", ran.err);
        let flags = ["samples-per-voxel", "joint"];
        for word in verbs.iter().map(String::as_str).chain(flags) {
            assert!(ran.out.contains(word), "{shell} does not know {word}");
        }
    }
}

#[cfg(unix)]
#[test]
fn bash_completes_a_verb_from_its_first_letters() {
    let folder = Folder::new();
    fs::write(folder.path("complete"), folder.run("completions bash").out).expect("a file");
    let script = "source ./complete && COMP_WORDS=(stratavox his) COMP_CWORD=1 && \
        _stratavox stratavox his stratavox && echo ${COMPREPLY[@]}";
    let shell = std::process::Command::new("bash")
        .args(["-c", script])
        .current_dir(folder.path(""))
        .output();
    let Ok(output) = shell else {
        println!("skipped: there is no bash");
        return;
    };
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(said.trim(), "histogram", "{output:?}");
}

#[test]
fn there_is_a_manual_page_for_every_verb() {
    let folder = Folder::new();
    let ran = folder.run("man");
    ran.assert_done();
    for verb in verbs(&folder) {
        assert!(
            ran.out.contains(&format!("stratavox\\-{verb}(1)")),
            "{verb}: {}",
            ran.out
        );
    }
    folder.run("man -o .").assert_done();
    let names = folder.names();
    for verb in verbs(&folder) {
        let name = format!("stratavox-{verb}.1");
        assert!(names.contains(&name), "{name}: {names:?}");
        let page = fs::read_to_string(folder.path(&name)).expect("a page");
        assert!(page.contains(&format!(".TH stratavox-{verb} 1")), "{page}");
    }
    for name in ["stratavox.1", "stratavox-preset-import.1"] {
        assert!(names.iter().any(|found| found == name), "{name}: {names:?}");
    }
    let page = fs::read_to_string(folder.path("stratavox-render.1")).expect("a page");
    assert!(
        page.contains("samples\\-per\\-voxel") && page.contains("Example"),
        "{page}"
    );
    // A second time they are kept.
    folder
        .run("man -o .")
        .assert_refused(4, &["stratavox.1", "--force"]);
    folder.run("man -o . --force").assert_done();
    folder
        .run("man -o nowhere")
        .assert_refused(4, &["there is no folder"]);
}

/// Defaults that depend on the look say so.
#[test]
fn the_help_of_render_says_what_holds_under_auto_and_the_root_how_a_file_is_drawn() {
    let folder = Folder::new();
    let help = folder.run("render --help").out;
    for flag in [
        "--background",
        "--shading",
        "--material",
        "--light <",
        "--half-gradient",
        "--samples-per-voxel",
        "--zoom",
        "--view <",
        "--frame",
    ] {
        let at = help.find(&format!("\n      {flag}"));
        let at = at.unwrap_or_else(|| panic!("no {flag}: {help}"));
        // Up to the next flag.
        let about = help[at + 1..]
            .split("\n      --")
            .next()
            .unwrap_or_default();
        let words: Vec<_> = about.split_whitespace().collect();
        let about = words.join(" ");
        assert!(about.contains("--look auto"), "{flag}: {about}");
    }
    let root = folder.run("--help").out;
    assert!(root.contains("Usage: stratavox FILE"), "{root}");
}
