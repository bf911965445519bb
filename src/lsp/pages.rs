//! The pages of `explain` as files: what a diagnostic's code links to, for an editor to open.
//!
//! A page is looked at when its code is first told, and then no more; it is written only if it is not there as it should be.

use std::{
    cell::RefCell,
    collections::HashMap,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use gen_lsp_types as lsp;
use tempfile::NamedTempFile;

use super::uri;
use crate::explain;

/// The pages of `explain` in a folder.
#[derive(Debug, Default)]
pub struct Pages {
    /// Where they are kept; if nowhere, nothing is linked.
    folder: Option<PathBuf>,
    /// The addresses of those that were asked for; none if a page could not be kept.
    known: RefCell<HashMap<&'static str, Option<lsp::Uri>>>,
}

impl Pages {
    /// Pages that are kept in a folder, which need not be there yet.
    pub fn new(folder: Option<PathBuf>) -> Self {
        Self {
            folder,
            known: RefCell::default(),
        }
    }

    /// The address of a code's page. None if it cannot be kept: a link is a help, and nothing is wrong without it.
    pub fn uri(&self, code: &str) -> Option<lsp::Uri> {
        let folder = self.folder.as_deref()?;
        let mut known = self.known.borrow_mut();
        if let Some(uri) = known.get(explain::short(code)) {
            return uri.clone();
        }
        let page = explain::page(code)?;
        let path = folder.join(page.code).with_extension("md");
        let uri = uri::file(&path).filter(|_| keep(&path, page.text).is_ok());
        known.entry(page.code).or_insert(uri.map(lsp::Uri)).clone()
    }
}

/// Sees to it that a file has this text; others see the whole of it or what was there before.
fn keep(path: &Path, text: &str) -> io::Result<()> {
    // What is no file, as a pipe, which nobody may ever write to, gives way to one.
    let is_file = fs::symlink_metadata(path).is_ok_and(|found| found.is_file());
    if is_file && fs::read(path).is_ok_and(|found| found == text.as_bytes()) {
        return Ok(());
    }
    let folder = path.parent().ok_or(io::ErrorKind::NotFound)?;
    fs::create_dir_all(folder)?;
    let mut file = NamedTempFile::new_in(folder)?;
    file.write_all(text.as_bytes())?;
    // That it outlives a crash of the system is not waited for: the next server finds it as it should be, or writes it again.
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_written_where_it_is_missing_or_different() {
        let folder = tempfile::tempdir().expect("a folder");
        let pages = || Pages::new(Some(folder.path().join("a b/pages")));
        let file = folder.path().join("a b/pages/bare_angle.md");
        let page = explain::page("bare_angle").expect("it is explained").text;
        let read = || fs::read_to_string(&file).expect("it is there");

        let first = pages();
        let uri = first.uri("pinhole::bare_angle").expect("it is kept");
        assert!(uri.0.ends_with("/a%20b/pages/bare_angle.md"), "{}", uri.0);
        assert_eq!(read(), page);

        // The same server does not look again.
        fs::write(&file, "changed").expect("it is a file");
        assert_eq!(first.uri("bare_angle"), Some(uri.clone()));
        assert_eq!(read(), "changed");
        // The next one does, and leaves alone what is right.
        assert_eq!(pages().uri("bare_angle"), Some(uri.clone()));
        assert_eq!(read(), page);
        let written = || fs::metadata(&file).and_then(|found| found.modified());
        let before = written().expect("a time");
        assert_eq!(pages().uri("bare_angle"), Some(uri));
        assert_eq!(written().expect("a time"), before);
        // A pipe gives way.
        #[cfg(unix)]
        {
            fs::remove_file(&file).expect("it is there");
            let made = std::process::Command::new("mkfifo").arg(&file).status();
            assert!(made.is_ok_and(|status| status.success()));
            pages().uri("pinhole::bare_angle").expect("it is kept");
            assert_eq!(read(), page);
        }
        let files = fs::read_dir(file.with_file_name("")).expect("a folder");
        assert_eq!(files.count(), 1);
    }

    #[test]
    fn without_a_folder_nothing_is_linked() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, "").expect("a folder");
        for place in [None, Some(file), Some("relative".into())] {
            let pages = Pages::new(place);
            assert_eq!(pages.uri("bare_angle"), None);
            assert_eq!(pages.uri("bare_angle"), None);
        }
        assert!(!Path::new("relative").exists());
        let pages = Pages::new(Some(folder.path().to_owned()));
        assert_eq!(pages.uri("no_such_code"), None);
    }
}
