//! Makes submissions that are archives.

use super::{Maker, SOURCES};
use crate::attacks::pack::{self, ArchiveEntry, Format};
use crate::attacks::step::{Packed, Step, bytes_of, need};
use anyhow::{Context, Result, bail};
use std::ffi::OsString;
use std::fs;

impl Maker<'_> {
    pub(super) fn pack(&mut self, step: &mut Step) -> Result<()> {
        let format = need(step.format.take(), "format")?;
        let prefix = step.prefix.take().unwrap_or_default();
        let mut entries = Vec::new();
        if !step.alone.take().unwrap_or_default() {
            let folder = self.submission.join(SOURCES);
            let mut names: Vec<OsString> =
                fs::read_dir(&folder)?.map(|entry| Ok(entry?.file_name())).collect::<Result<_>>()?;
            names.sort();
            for name in names {
                let content = fs::read(folder.join(&name))?;
                let name = [prefix.as_bytes(), SOURCES.as_bytes(), b"/", name.as_encoded_bytes()].concat();
                entries.push(ArchiveEntry { name, content, ..ArchiveEntry::default() });
            }
        }
        for packed in step.entries.take().unwrap_or_default() {
            entries.extend(self.entries(packed)?);
        }
        let mut bytes = Vec::new();
        pack::write(format, &entries, &mut bytes)?;
        bytes.truncate(bytes.len() - step.cut.take().unwrap_or_default());
        self.become_archive(format, &bytes)
    }

    fn entries(&self, packed: Packed) -> Result<Vec<ArchiveEntry>> {
        let content = match packed.to {
            Some(to) => self.filled(&to).into_bytes(),
            None => self.bytes(packed.content)?,
        };
        let name = |index: usize| match (&packed.name, &packed.name_hex) {
            (Some(name), None) => Ok(self.filled(name).replace("@n@", &index.to_string()).into_bytes()),
            (None, Some(hex)) => bytes_of(hex),
            _ => bail!("an entry needs either a `name` or a `name_hex`"),
        };
        let entry = |index: usize| {
            Ok(ArchiveEntry {
                name: name(index)?,
                kind: packed.kind,
                content: content.clone(),
                zeros: packed.zeros.unwrap_or_default() << 20,
                stated: packed.stated,
                encrypted: packed.encrypted,
            })
        };
        (0..packed.times.unwrap_or(1)).map(entry).collect()
    }

    /// Replaces the folder of the submission by an archive.
    pub(super) fn become_archive(&mut self, format: Format, bytes: &[u8]) -> Result<()> {
        fs::remove_dir_all(&self.submission)?;
        self.submission.as_mut_os_string().push(format.ending());
        fs::write(&self.submission, bytes).context("the archive cannot be written")
    }
}
