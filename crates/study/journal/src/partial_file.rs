//! Partial files: what an atomic file is until it is complete.
//!
//! The name of a partial file is its own, `.NAME.squama-PROCESS-COUNT.partial`, and the file is made anew: neither another
//! process nor a link that stands there can be written to. It is locked as long as its process lives, so that what a killed
//! process has left can be told from what is being written. What a signal ends removes its own.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The names that are tried before a folder is said not to take a new file.
const ATTEMPTS: usize = 100;

/// The count of partial files of this process.
static COUNT: AtomicU64 = AtomicU64::new(0);

/// The partial files of this process that are there now.
static PRESENT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn present() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths is whole whoever panicked over it.
    PRESENT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that is removed unless it is moved to its place.
#[derive(Debug)]
pub(crate) struct PartialFile {
    path: PathBuf,
    file: File,
}

impl PartialFile {
    /// A new partial file of the file `name` in `folder`.
    pub fn create(folder: &Path, name: &str) -> io::Result<Self> {
        let mut present = present();
        for _ in 0..ATTEMPTS {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!(".{name}.squama-{}-{count}.partial", process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => {
                    // A file system without locks has files all the same.
                    let _ = file.lock();
                    // Whoever cleans up may have taken it for abandoned before it was locked.
                    if path.exists() {
                        present.push(path.clone());
                        return Ok(Self { path, file });
                    }
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// The open file.
    pub fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Forces it to the disk and moves it to `path`.
    pub fn move_to(self, path: &Path) -> io::Result<()> {
        self.file.sync_all()?;
        fs::rename(&self.path, path)
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        let mut present = present();
        // There is none if it was moved to its place.
        let _ = fs::remove_file(&self.path);
        present.retain(|path| *path != self.path);
    }
}

/// Removes the partial files of this process and then ends it with the exit code `code`.
pub fn exit_without_partial_files(code: i32) -> ! {
    let present = present();
    for path in present.iter() {
        let _ = fs::remove_file(path);
    }
    // Nobody makes another one, because the list stays locked.
    process::exit(code)
}

/// Removes the partial files in `folder` that killed processes have left.
pub fn remove_abandoned_files(folder: &Path) {
    // A file without a folder in its path is in the one that we are in.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    paths.filter(|path| is_partial(path)).for_each(|path| remove_abandoned(&path));
}

fn remove_abandoned(path: &Path) {
    let is_file = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    let Some(file) = is_file.then(|| File::open(path).ok()).flatten() else { return };
    if file.try_lock().is_ok() {
        let _ = fs::remove_file(path);
    }
}

/// Whether the name of a file is one that [`PartialFile::create`] gives.
fn is_partial(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let parts = name.strip_prefix('.').and_then(|name| name.strip_suffix(".partial"));
    let numbers = parts.and_then(|parts| parts.rsplit_once(".squama-"));
    let numbers = numbers.and_then(|(_, numbers)| numbers.split_once('-'));
    let is_number = |text: &str| text.parse::<u64>().is_ok();
    numbers.is_some_and(|(process, count)| is_number(process) && is_number(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nobody_writes_is_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let names = || {
            let entries = fs::read_dir(folder.path()).expect("a folder");
            let name = |entry: io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
            let mut names: Vec<_> = entries.map(name).collect();
            names.sort();
            names
        };
        let strangers = [".x.csv.squama-1.partial", ".x.partial", "x.squama-1-2.partial"];
        for name in strangers.iter().chain(&[".x.csv.squama-1-2.partial"]) {
            fs::write(folder.path().join(name), "x").expect("writable");
        }
        let ours = PartialFile::create(folder.path(), "x.csv").expect("writable");
        assert_eq!(names().len(), 5);
        remove_abandoned_files(folder.path());
        assert_eq!(names().len(), 4, "one was abandoned");
        drop(ours);
        assert_eq!(names(), strangers);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_of_that_name_is_not_followed() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("target");
        fs::write(&target, "a stranger's").expect("writable");
        // The names of the next partial files of this process.
        let next = COUNT.load(Ordering::Relaxed);
        for count in next..next + 50 {
            let name = format!(".x.squama-{}-{count}.partial", process::id());
            std::os::unix::fs::symlink(&target, folder.path().join(name)).expect("a link");
        }
        let mut file = PartialFile::create(folder.path(), "x").expect("writable");
        io::Write::write_all(file.file(), b"ours").expect("writable");
        file.move_to(&folder.path().join("x")).expect("writable");
        assert_eq!(fs::read_to_string(target).expect("text"), "a stranger's");
    }
}
