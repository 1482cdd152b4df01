//! The port and the token of the page. They stay the same when the program is started again, so that an open page finds it.

use anyhow::{Context, Result};
use raykata::film::write_atomically;
use std::hash::{BuildHasher, RandomState};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The number of hexadecimal digits of a token.
const DIGITS: usize = 32;

/// What only the user of this machine knows.
pub struct Secret {
    /// The port; 0 takes any.
    pub port: u16,
    /// A part of the path of each request.
    pub token: String,
}

impl Secret {
    /// That of the previous start, or a new one.
    pub fn of(root: &Path) -> Result<Secret> {
        let text = std::fs::read_to_string(file(root)).unwrap_or_default();
        let known = text.trim().split_once(' ').and_then(|(port, token)| {
            let is_token = token.len() == DIGITS && token.bytes().all(|byte| byte.is_ascii_hexdigit());
            Some(Secret { port: port.parse().ok()?, token: token.to_owned() }).filter(|_| is_token)
        });
        Ok(known.unwrap_or_else(|| Secret { port: 0, token: token() }))
    }

    /// Keeps the token for the next start, readable for this user alone.
    pub fn keep(&self, root: &Path, port: u16) -> Result<()> {
        let file = file(root);
        raykata_cli::report::make_folder_of(&file)?;
        write_atomically(&file, |out| {
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt;
                out.get_ref().set_permissions(std::fs::Permissions::from_mode(0o600))?;
            }
            writeln!(out, "{port} {}", self.token)
        })
        .with_context(|| format!("cannot write {}", file.display()))
    }
}

fn file(root: &Path) -> PathBuf {
    root.join("out/.view")
}

/// A new token. The keys of a `RandomState` come from the random numbers of the operating system.
fn token() -> String {
    let half = || RandomState::new().hash_one(std::process::id());
    format!("{:016x}{:016x}", half(), half())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_token_is_random_and_survives_a_restart() {
        let root = tempfile::tempdir().unwrap();
        let [first, second] = [(); 2].map(|()| Secret::of(root.path()).unwrap());
        assert_ne!(first.token, second.token);
        assert_eq!(first.token.len(), DIGITS);
        first.keep(root.path(), 4711).unwrap();
        let again = Secret::of(root.path()).unwrap();
        assert_eq!((again.port, again.token), (4711, first.token));
        std::fs::write(file(root.path()), "4711 ../../etc\n").unwrap();
        assert_eq!(Secret::of(root.path()).unwrap().port, 0, "a damaged file is not used");
    }
}
