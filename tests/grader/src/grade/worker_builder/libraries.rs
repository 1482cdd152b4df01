//! Builds the libraries against which submissions are compiled.

use super::hex;
use crate::kits;
use anyhow::{Context, Result};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Builds the scaffold with the crates that it needs, and copies the compiled libraries into a separate folder.
pub fn build(root: &Path) -> Result<PathBuf> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root).args(["build", "--package", "raykata", "--lib", "--message-format=json"]);
    let messages = kits::run_cargo(cargo, "the libraries for submissions")?;
    let artifacts: Vec<Value> = String::from_utf8_lossy(&messages)
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter(|message| message["reason"] == "compiler-artifact")
        .collect();
    // Collect the compiled libraries and compute their fingerprint.
    let files: BTreeSet<(String, PathBuf)> = artifacts
        .iter()
        .flat_map(|artifact| {
            let name = artifact["target"]["name"].as_str().unwrap_or_default().replace('-', "_");
            let files = artifact["filenames"].as_array().into_iter().flatten().filter_map(Value::as_str);
            files.map(move |file| (name.clone(), PathBuf::from(file))).collect::<Vec<_>>()
        })
        .filter(|(_, file)| file.extension().is_some_and(|ending| ending == "rlib" || ending == "so"))
        .collect();
    let mut hash = Sha256::new();
    for (_, file) in &files {
        hash.update(fs::read(file).with_context(|| file.display().to_string())?);
    }
    let folder = root.join("target/grade").join(format!("libraries-{}", &hex(&hash.finalize())[..16]));
    if !folder.exists() {
        fs::create_dir_all(root.join("target/grade"))?;
        // Write a draft and rename it, so that the folder is complete even if two graders make it at the same time.
        let draft = tempfile::tempdir_in(root.join("target/grade"))?;
        for (name, file) in &files {
            let direct = ["raykata", "glam"].contains(&name.as_str());
            let to = if direct {
                format!("lib{name}.rlib").into()
            } else {
                file.file_name().unwrap_or_default().to_owned()
            };
            fs::copy(file, draft.path().join(to))?;
        }
        if let Err(error) = fs::rename(draft.keep(), &folder)
            && !folder.exists()
        {
            return Err(error).with_context(|| format!("cannot make {}", folder.display()));
        }
    }
    Ok(folder)
}
