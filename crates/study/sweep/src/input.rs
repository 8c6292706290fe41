//! Reads text files named by the user: definitions, goals and measured curves.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::Path;

/// Prefixes of paths of shell streams: standard input, and process substitution `<(...)`.
const STREAMS: [&str; 3] = ["/dev/stdin", "/dev/fd/", "/proc/self/fd/"];

/// Reads the text file at `path`, which may have at most `max_bytes` bytes.
///
/// Named pipes and devices are refused, because reading them may never end. Shell streams, such as
/// `/dev/stdin`, are accepted.
///
/// # Errors
/// If the file cannot be read, is too long or is not UTF-8.
pub fn read_input(path: &Path, max_bytes: u64) -> io::Result<String> {
    String::from_utf8(read_input_bytes(path, max_bytes)?).map_err(|_| {
        io::Error::new(io::ErrorKind::InvalidData, "stream did not contain valid UTF-8")
    })
}

/// Reads the bytes of the file at `path`, which may have at most `max_bytes` bytes.
///
/// Named pipes and devices are refused, as by [`read_input`].
///
/// # Errors
/// If the file cannot be read or is too long.
pub fn read_input_bytes(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let is_stream = STREAMS.iter().any(|stream| path.to_string_lossy().starts_with(stream));
    if !is_stream && !fs::metadata(path)?.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    let mut bytes = Vec::new();
    // Read one byte more than the limit, to detect a file that is too long.
    File::open(path)?.take(max_bytes + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > max_bytes {
        let limit = max_bytes >> 20;
        return Err(io::Error::other(format!("it has more than {limit} MiB")));
    }
    Ok(bytes)
}
