//! Reads zip files of submissions. Nothing is unpacked to disk, and names in a zip file are never
//! used as paths, so a malicious zip file cannot overwrite files.

use std::{
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    path::Path,
    sync::{
        Arc, Mutex,
        atomic::{AtomicU64, Ordering},
    },
};

use zip::{DateTime, ZipArchive, result::ZipError};

use crate::{files, lock::lock};

/// Maximum length, in bytes, of a file that is unpacked from a zip file or compared with the files
/// of other students. A longer file is an error. The value is the maximum length of a picture
/// without `--large`, so a smaller limit would reject pictures that are accepted outside of zip
/// files.
pub const FILE_LIMIT: u64 = 256 << 20;

/// Maximum number of entries of a zip file. A zip file with more is rejected. Chosen without
/// measurement: a class of some hundred students hands in far fewer files.
const MOST_ENTRIES: usize = 10_000;

/// Maximum number of bytes that are read from a zip file to list its entries. The list stores 46
/// bytes and a name for each entry, so 16 MiB suffice for [`MOST_ENTRIES`] entries with names of a
/// thousand letters. Without a limit, a damaged file could fill the memory.
const LIST_LIMIT: u64 = 16 << 20;

/// Maximum number of bytes, in total, that are unpacked from all zip files of a class. It stops zip
/// bombs, i.e. small files that unpack to very large ones. A larger limit would let a zip bomb run
/// longer. If a class exceeds the limit, its zip files can be unpacked beforehand.
const WHOLE_LIMIT: u64 = 4 << 30;

/// Number of bytes that may still be unpacked from the zip files of a class. The unpacked bytes are
/// counted, since the lengths in zip headers may be wrong.
#[derive(Debug)]
pub struct UnpackBudget(AtomicU64);

impl Default for UnpackBudget {
    fn default() -> Self {
        Self(AtomicU64::new(WHOLE_LIMIT))
    }
}

impl UnpackBudget {
    fn take(&self, bytes: u64) -> Result<(), String> {
        let less = |left: u64| left.checked_sub(bytes);
        match self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, less)
        {
            Ok(_) => Ok(()),
            Err(_) => Err(
                "all zip files together unpack to more than 4 GiB: unpack them, and name the folder"
                    .to_owned(),
            ),
        }
    }
}

/// A file from which at most `left` more bytes can be read. The zip library reads the whole list of
/// entries into memory, so the limit bounds this memory.
#[derive(Debug)]
struct Bounded {
    file: BufReader<File>,
    left: Arc<AtomicU64>,
}

impl Read for Bounded {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.left.load(Ordering::Relaxed);
        if left == 0 {
            return Err(io::Error::other("it is too long"));
        }
        let most = usize::try_from(left)
            .unwrap_or(usize::MAX)
            .min(buffer.len());
        let read = self.file.read(&mut buffer[..most])?;
        self.left.store(left - read as u64, Ordering::Relaxed);
        Ok(read)
    }
}

impl Seek for Bounded {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// An open zip file.
#[derive(Debug)]
pub struct Archive(Mutex<ZipArchive<Bounded>>);

/// An entry of a zip file.
#[derive(Debug)]
pub struct ArchiveEntry {
    pub index: usize,
    /// Name of the entry: a path with `/` between folders.
    pub name: String,
    pub is_folder: bool,
    /// Modification time, in seconds since 1970. It is even, since zip files store times in units
    /// of two seconds.
    pub time: Option<i64>,
    /// Unpacked length, in bytes, according to the header, which may be wrong.
    pub length: u64,
    /// CRC-32 checksum of the unpacked bytes. It is verified when they are unpacked.
    pub sum: u32,
    /// Reason why the entry cannot be read, for example because it is encrypted or a link. `None`
    /// if it can be read.
    pub refused: Option<&'static str>,
}

impl Archive {
    /// Opens a zip file and lists its entries.
    ///
    /// # Errors
    ///
    /// Returns a message that says why if the file cannot be read.
    pub fn open(path: &Path) -> Result<(Self, Vec<ArchiveEntry>), String> {
        let file = files::open_argument(path).map_err(|error| error.to_string())?;
        let left = Arc::new(AtomicU64::new(LIST_LIMIT));
        let file = Bounded {
            file: BufReader::new(file),
            left: left.clone(),
        };
        let mut zip = ZipArchive::new(file).map_err(|error| match left.load(Ordering::Relaxed) {
            0 => format!("it is no zip file, or lists more than {MOST_ENTRIES} entries, and at most that many are read"),
            _ => in_words(&error),
        })?;
        // The list of entries has been read, so its limit is lifted. From now on, [`UnpackBudget`]
        // limits how much is unpacked.
        left.store(u64::MAX, Ordering::Relaxed);
        if zip.len() > MOST_ENTRIES {
            let count = zip.len();
            return Err(format!(
                "it has {count} entries, and at most {MOST_ENTRIES} are read"
            ));
        }
        let mut entries = Vec::new();
        for index in 0..zip.len() {
            let entry = zip.by_index_raw(index).map_err(|error| in_words(&error))?;
            let refused = match () {
                () if entry.encrypted() => Some("encrypted"),
                () if entry.is_symlink() => Some("a link"),
                () => None,
            };
            let name = name(entry.name_raw(), entry.name().ok().as_deref());
            entries.push(ArchiveEntry {
                index,
                is_folder: name.ends_with('/'),
                name,
                time: entry.last_modified().map(seconds),
                length: entry.size(),
                sum: entry.crc32(),
                refused,
            });
        }
        Ok((Self(Mutex::new(zip)), entries))
    }

    /// Unpacks an entry and returns its bytes.
    ///
    /// # Errors
    ///
    /// Returns a message if the entry is damaged or too large.
    pub fn read(&self, index: usize, budget: &UnpackBudget) -> Result<Vec<u8>, String> {
        /// Number of bytes that are unpacked before the limits are checked again: [`FILE_LIMIT`],
        /// and the budget of the whole class. At most this many bytes are unpacked beyond a limit.
        /// The value is an ordinary buffer size.
        const PIECE: u64 = 1 << 16;
        let mut zip = lock(&self.0);
        let mut entry = zip.by_index(index).map_err(|error| in_words(&error))?;
        let mut bytes = Vec::new();
        loop {
            let read = entry.by_ref().take(PIECE).read_to_end(&mut bytes);
            match read.map_err(|error| format!("it is damaged: {error}"))? {
                0 => return Ok(bytes),
                read => budget.take(read as u64)?,
            }
            if bytes.len() as u64 > FILE_LIMIT {
                return Err("it unpacks to more than 256 MiB".to_owned());
            }
        }
    }
}

/// Returns an entry's name. Bytes that are valid UTF-8 are decoded as such, even if the entry's
/// UTF-8 flag is not set; others are decoded as code page 437, the original encoding of zip files.
fn name(raw: &[u8], decoded: Option<&str>) -> String {
    let name = match (str::from_utf8(raw), decoded) {
        (Ok(name), _) | (_, Some(name)) => name.to_owned(),
        _ => String::from_utf8_lossy(raw).into_owned(),
    };
    // Some programs on Windows write `\` between folders.
    name.replace('\\', "/")
}

/// Converts a time from a zip file to seconds since 1970. Zip files store no time zone, so the time
/// is taken as UTC.
fn seconds(time: DateTime) -> i64 {
    // The formula lets years begin in March, so that a leap day is the last day of its year. It is
    // `days_from_civil` in Howard Hinnant, "chrono-Compatible Low-Level Date Algorithms".
    let month = (i64::from(time.month()) + 9) % 12;
    let year = i64::from(time.year()) - i64::from(month >= 10);
    let leaps = year / 4 - year / 100 + year / 400;
    let days = 365 * year + leaps + (153 * month + 2) / 5 + i64::from(time.day()) - 1 - 719_468;
    let minutes = (days * 24 + i64::from(time.hour())) * 60 + i64::from(time.minute());
    60 * minutes + i64::from(time.second())
}

fn in_words(error: &ZipError) -> String {
    match error {
        ZipError::Io(error) => format!("it is no zip file, or damaged: {error}"),
        ZipError::UnsupportedArchive(what) => format!("it is packed as is not read here: {what}"),
        _ => "it is no zip file, or damaged or cut off".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_seconds_since_1970() {
        for (date, expected) in [
            ([1980, 1, 1], 315_532_800),
            ([2000, 2, 29], 951_782_400),
            ([2026, 11, 28], 1_795_824_000),
            ([2028, 12, 31], 1_861_833_600),
        ] {
            let [year, month, day] = date;
            let time = DateTime::from_date_and_time(year, month as u8, day as u8, 0, 0, 0);
            assert_eq!(seconds(time.unwrap()), expected, "{date:?}");
        }
    }
}
