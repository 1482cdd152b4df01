//! Writes archives byte by byte, because the attacks need malformed archives that no archiver makes.

use anyhow::{Context, Result};
use flate2::{Compression, CrcWriter, write::DeflateEncoder, write::GzEncoder};
use serde::Deserialize;
use std::io::{self, Write};

/// The format of an archive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Format {
    /// Deflated entries, with a directory at the end.
    #[serde(rename = "zip")]
    Zip,
    /// Blocks of 512 bytes.
    #[serde(rename = "tar")]
    Tar,
    /// A tar file, compressed as a whole.
    #[serde(rename = "tar.gz")]
    TarGz,
}

impl Format {
    /// Returns the file extension.
    pub(super) fn ending(self) -> &'static str {
        match self {
            Format::Zip => ".zip",
            Format::Tar => ".tar",
            Format::TarGz => ".tar.gz",
        }
    }
}

/// The kind that an entry of an archive claims to have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A file.
    #[default]
    File,
    /// A link to a path.
    Symlink,
    /// Another name of a file that came before (tar).
    Hardlink,
    /// The device with the numbers of /dev/zero (tar).
    Device,
    /// A named pipe (tar).
    Fifo,
    /// A file whose content is the name of the next entry (tar).
    LongName,
}

/// An entry of an archive.
#[derive(Clone, Debug, Default)]
pub(super) struct ArchiveEntry {
    /// Its name, as any bytes.
    pub name: Vec<u8>,
    /// The kind that it claims to have.
    pub kind: Kind,
    /// Its content, or the target of a link.
    pub content: Vec<u8>,
    /// The number of zero bytes after the content.
    pub zeros: u64,
    /// The stated size, if it differs from the real one.
    pub stated: Option<u64>,
    /// Whether it claims to need a password.
    pub encrypted: bool,
}

impl ArchiveEntry {
    fn size(&self) -> u64 {
        self.content.len() as u64 + self.zeros
    }

    fn stated(&self) -> u64 {
        self.stated.unwrap_or_else(|| self.size())
    }

    fn write_content(&self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&self.content)?;
        // Write the zeros block by block: `io::repeat` makes them one by one.
        static BLOCK: [u8; 1 << 16] = [0; 1 << 16];
        let mut left = self.zeros;
        while left > 0 {
            let now = left.min(BLOCK.len() as u64);
            out.write_all(&BLOCK[..now as usize])?;
            left -= now;
        }
        Ok(())
    }
}

/// Writes an archive.
pub(super) fn write(format: Format, entries: &[ArchiveEntry], out: impl Write) -> Result<()> {
    let written = match format {
        Format::Zip => zip(entries, out),
        Format::Tar => tar(entries, out),
        Format::TarGz => {
            let mut gzip = GzEncoder::new(out, Compression::fast());
            tar(entries, &mut gzip).and_then(|()| gzip.finish().map(|_| ()))
        }
    };
    written.context("the archive cannot be written")
}

/// Fields of a header, in little-endian order.
#[derive(Default)]
struct Header(Vec<u8>);

impl Header {
    fn two(mut self, values: &[u16]) -> Self {
        values.iter().for_each(|value| self.0.extend(value.to_le_bytes()));
        self
    }

    fn four(mut self, values: &[u32]) -> Self {
        values.iter().for_each(|value| self.0.extend(value.to_le_bytes()));
        self
    }
}

fn zip(entries: &[ArchiveEntry], mut out: impl Write) -> io::Result<()> {
    const DEFLATED: u16 = 8;
    // Midnight of 1 January 1980, the date of zip entries without a time.
    const DATE: u16 = 0x21;
    let (mut offset, mut directory) = (0u32, Vec::new());
    for entry in entries {
        let mut deflated = DeflateEncoder::new(Vec::new(), Compression::fast());
        entry.write_content(&mut deflated)?;
        let mut data = deflated.finish()?;
        let mut checksum = CrcWriter::new(io::sink());
        entry.write_content(&mut checksum)?;
        let flags = u16::from(entry.encrypted);
        if entry.encrypted {
            data.splice(0..0, *b"no password!");
        }
        let sizes = [checksum.crc().sum(), data.len() as u32, entry.stated() as u32];
        let name = entry.name.len() as u16;
        let common =
            |header: Header| header.two(&[20, flags, DEFLATED, 0, DATE]).four(&sizes).two(&[name, 0]);
        let local = common(Header::default().four(&[0x0403_4b50])).0;
        out.write_all(&local)?;
        out.write_all(&entry.name)?;
        out.write_all(&data)?;
        let mode: u32 = if entry.kind == Kind::Symlink { 0o120_777 } else { 0o100_644 };
        // Entries from Unix have the mode in the upper half of the attributes.
        let central = common(Header::default().four(&[0x0201_4b50]).two(&[3 << 8 | 20]));
        directory.extend(central.two(&[0, 0, 0]).four(&[mode << 16, offset]).0);
        directory.extend(&entry.name);
        offset += (local.len() + entry.name.len() + data.len()) as u32;
    }
    out.write_all(&directory)?;
    let n = entries.len() as u16;
    let end = Header::default().four(&[0x0605_4b50]).two(&[0, 0, n, n]);
    out.write_all(&end.four(&[directory.len() as u32, offset]).two(&[0]).0)
}

fn tar(entries: &[ArchiveEntry], mut out: impl Write) -> io::Result<()> {
    const BLOCK: u64 = 512;
    for entry in entries {
        let (letter, target, holds) = match entry.kind {
            Kind::File => (b'0', &[][..], true),
            Kind::Hardlink => (b'1', &entry.content[..], false),
            Kind::Symlink => (b'2', &entry.content[..], false),
            Kind::Device => (b'3', &[][..], false),
            Kind::Fifo => (b'6', &[][..], false),
            Kind::LongName => (b'L', &[][..], true),
        };
        let size = if holds { entry.stated() } else { 0 };
        let mut header = [0; BLOCK as usize];
        let mut put = |at: usize, most: usize, bytes: &[u8]| {
            let length = bytes.len().min(most);
            header[at..at + length].copy_from_slice(&bytes[..length]);
        };
        put(0, 100, &entry.name);
        put(100, 8, b"0000644\0");
        put(108, 8, b"0000000\0");
        put(116, 8, b"0000000\0");
        put(124, 12, &tar_number(size));
        put(136, 12, b"00000000000\0");
        put(148, 8, b"        ");
        put(156, 1, &[letter]);
        put(157, 100, target);
        put(257, 8, b"ustar\x0000");
        put(329, 8, b"0000001\0");
        put(337, 8, b"0000005\0");
        let sum: u32 = header.iter().map(|byte| u32::from(*byte)).sum();
        header[148..156].copy_from_slice(format!("{sum:06o}\0 ").as_bytes());
        out.write_all(&header)?;
        if holds {
            entry.write_content(&mut out)?;
            let rest = entry.size().next_multiple_of(BLOCK) - entry.size();
            out.write_all(&vec![0; rest as usize])?;
        }
    }
    out.write_all(&[0; 2 * BLOCK as usize])
}

/// Encodes a number in octal if it fits, otherwise in binary with the highest bit set, as GNU tar does.
fn tar_number(number: u64) -> Vec<u8> {
    if number < 1 << 33 {
        return format!("{number:011o}\0").into_bytes();
    }
    let mut bytes = vec![0x80, 0, 0, 0];
    bytes.extend(number.to_be_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    fn entries() -> Vec<ArchiveEntry> {
        let file = ArchiveEntry {
            name: b"../a.rs".to_vec(),
            content: b"one".to_vec(),
            zeros: 600,
            ..ArchiveEntry::default()
        };
        let link = ArchiveEntry {
            name: b"b".to_vec(),
            kind: Kind::Symlink,
            content: b"/etc/passwd".to_vec(),
            ..ArchiveEntry::default()
        };
        vec![file, link]
    }

    #[test]
    fn a_zip_can_be_read_with_its_names_as_they_are() {
        let mut bytes = Vec::new();
        write(Format::Zip, &entries(), &mut bytes).unwrap();
        let mut archive = zip::ZipArchive::new(io::Cursor::new(bytes)).unwrap();
        let mut text = Vec::new();
        let mut file = archive.by_index(0).unwrap();
        assert_eq!((file.name(), file.size()), ("../a.rs", 603));
        file.read_to_end(&mut text).unwrap();
        assert!(text.starts_with(b"one\0") && text.len() == 603);
        drop(file);
        assert!(archive.by_index(1).unwrap().is_symlink());
    }

    #[test]
    fn an_encrypted_entry_cannot() {
        let entry = ArchiveEntry { encrypted: true, ..entries().remove(0) };
        let mut bytes = Vec::new();
        write(Format::Zip, &[entry], &mut bytes).unwrap();
        assert!(zip::ZipArchive::new(io::Cursor::new(bytes)).unwrap().by_index(0).is_err());
    }

    #[test]
    fn a_tar_can_be_read_with_its_names_as_they_are() {
        for format in [Format::Tar, Format::TarGz] {
            let mut bytes = Vec::new();
            write(format, &entries(), &mut bytes).unwrap();
            let stream: Box<dyn Read> = match format {
                Format::TarGz => Box::new(flate2::read::GzDecoder::new(io::Cursor::new(bytes))),
                _ => Box::new(io::Cursor::new(bytes)),
            };
            let mut archive = tar::Archive::new(stream);
            let seen: Vec<(String, u64, bool)> = archive
                .entries()
                .unwrap()
                .map(|entry| {
                    let entry = entry.unwrap();
                    let name = String::from_utf8(entry.path_bytes().into_owned()).unwrap();
                    (name, entry.size(), entry.header().entry_type().is_symlink())
                })
                .collect();
            assert_eq!(seen, [("../a.rs".into(), 603, false), ("b".into(), 0, true)]);
        }
    }

    #[test]
    fn sizes_beyond_octal_are_written_in_binary() {
        assert_eq!(tar_number(8), b"00000000010\0");
        assert_eq!(tar_number(1 << 40), [0x80, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0]);
    }
}
