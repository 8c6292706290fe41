//! Partial files: the temporary form of atomic files.
//!
//! A partial file has a unique name, `.NAME.squama-PROCESS-COUNT.partial`, and must not exist
//! before. So its creation never overwrites a file of another process or the target of a link. A
//! partial file is locked as long as its process runs, so an unlocked partial file was left by a
//! killed process. A process that is stopped by a signal removes its own partial files.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Maximum number of names for one partial file.
///
/// If a file with one of these names exists, the next name is used.
const ATTEMPTS: usize = 100;

/// Number of names of partial files that this process has used.
static COUNT: AtomicU64 = AtomicU64::new(0);

/// Paths of the existing partial files of this process.
static PRESENT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Locks and returns the paths of the existing partial files of this process.
fn present() -> MutexGuard<'static, Vec<PathBuf>> {
    // Ignore a panic of another thread: it cannot leave a list of paths inconsistent.
    PRESENT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Temporary file that is removed when dropped, unless it was renamed to its final path.
#[derive(Debug)]
pub(crate) struct PartialFile {
    path: PathBuf,
    file: File,
}

impl PartialFile {
    /// Creates an empty partial file for the file `name` in `folder`.
    pub fn create(folder: &Path, name: &str) -> io::Result<Self> {
        let mut present = present();
        for _ in 0..ATTEMPTS {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!(".{name}.squama-{}-{count}.partial", process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => {
                    // Ignore errors: some file systems do not support locks.
                    let _ = file.lock();
                    // Before the lock, another process may have removed the file as abandoned.
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

    /// Returns the open file.
    pub fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Flushes the file to the disk and renames it to `path`.
    pub fn move_to(self, path: &Path) -> io::Result<()> {
        self.file.sync_all()?;
        fs::rename(&self.path, path)
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        let mut present = present();
        // Ignore errors: the file no longer exists if it was renamed.
        let _ = fs::remove_file(&self.path);
        present.retain(|path| *path != self.path);
    }
}

/// Removes the partial files of this process and exits with `code`.
pub fn exit_without_partial_files(code: i32) -> ! {
    let present = present();
    for path in present.iter() {
        let _ = fs::remove_file(path);
    }
    // Keep the list locked, so that no other thread can create a partial file.
    process::exit(code)
}

/// Removes the partial files that killed processes left in `folder`.
pub fn remove_abandoned_files(folder: &Path) {
    // An empty path is the current folder.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    paths.filter(|path| is_partial(path)).for_each(|path| remove_abandoned(&path));
}

/// Removes the partial file at `path` unless a running process has locked it.
fn remove_abandoned(path: &Path) {
    let is_file = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    let Some(file) = is_file.then(|| File::open(path).ok()).flatten() else { return };
    if file.try_lock().is_ok() {
        let _ = fs::remove_file(path);
    }
}

/// Returns true if the file at `path` has a name as created by [`PartialFile::create`].
fn is_partial(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let parts = name.strip_prefix('.').and_then(|name| name.strip_suffix(".partial"));
    let numbers = parts.and_then(|parts| parts.rsplit_once(".squama-"));
    let numbers = numbers.and_then(|(_, numbers)| numbers.split_once('-'));
    numbers.is_some_and(|(process, count)| {
        [process, count].iter().all(|number| number.parse::<u64>().is_ok())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_abandoned_partial_files_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let names = || {
            let entries = fs::read_dir(folder.path()).expect("a folder");
            let mut names: Vec<_> =
                entries.map(|entry| entry.expect("an entry").file_name()).collect();
            names.sort();
            names
        };
        let other_files = [".x.csv.squama-1.partial", ".x.partial", "x.squama-1-2.partial"];
        for name in other_files.iter().chain(&[".x.csv.squama-1-2.partial"]) {
            fs::write(folder.path().join(name), "x").expect("writable");
        }
        let ours = PartialFile::create(folder.path(), "x.csv").expect("writable");
        assert_eq!(names().len(), 5);
        remove_abandoned_files(folder.path());
        assert_eq!(names().len(), 4, "only the unlocked partial file is removed");
        drop(ours);
        assert_eq!(names(), other_files);
    }

    #[cfg(unix)]
    #[test]
    fn links_with_the_name_of_a_partial_file_are_not_followed() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("target");
        fs::write(&target, "a stranger's").expect("writable");
        // Create links with the names of the next partial files of this process.
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
