//! Opens a place in the editor that the student has chosen by `VISUAL` or `EDITOR`.

use anyhow::{Context, Result, bail};
use std::path::Path;
use std::process::Command;

/// Opens `file` at `line`, and waits until the editor returns.
pub fn open(root: &Path, file: &str, line: u32) -> Result<()> {
    let chosen = ["VISUAL", "EDITOR"].iter().find_map(|name| std::env::var(name).ok());
    let Some(editor) = chosen.filter(|editor| !editor.trim().is_empty()) else {
        bail!("no editor is chosen: set the variable EDITOR, for example `export EDITOR=nano`");
    };
    let words = arguments(&editor, file, line);
    let (program, arguments) = words.split_first().context("no editor is chosen")?;
    let status = Command::new(program).args(arguments).current_dir(root).status();
    let status = status.with_context(|| format!("the editor `{program}` cannot be started"))?;
    if status.success() { Ok(()) } else { bail!("the editor `{program}` ended with {status}") }
}

/// The words of the command that opens `file` at `line`. Editors have three ways to be given the line.
fn arguments(editor: &str, file: &str, line: u32) -> Vec<String> {
    let mut words: Vec<String> = editor.split_whitespace().map(str::to_owned).collect();
    let program = words.first().map_or("", String::as_str);
    let name = Path::new(program).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    match name.as_str() {
        "code" | "code-insiders" | "codium" | "cursor" => {
            words.extend(["--goto".into(), format!("{file}:{line}")])
        }
        "subl" | "zed" | "hx" | "helix" => words.push(format!("{file}:{line}")),
        _ => words.extend([format!("+{line}"), file.to_owned()]),
    }
    words
}

#[cfg(test)]
mod tests {
    use super::arguments;

    #[test]
    fn each_editor_gets_the_line_in_its_way() {
        assert_eq!(arguments("vim", "a.rs", 7), ["vim", "+7", "a.rs"]);
        assert_eq!(arguments("emacs -nw", "a.rs", 7), ["emacs", "-nw", "+7", "a.rs"]);
        assert_eq!(
            arguments("/usr/bin/code --wait", "a.rs", 7),
            ["/usr/bin/code", "--wait", "--goto", "a.rs:7"]
        );
        assert_eq!(arguments("hx", "a.rs", 7), ["hx", "a.rs:7"]);
    }
}
