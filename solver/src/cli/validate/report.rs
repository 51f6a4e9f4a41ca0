//! The file of the page of a validation, written again after each case.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::super::exit::{Exit, Failure};
use crate::case::{CaseFile, library};
use crate::observer::{directory_of, write_atomic};
use crate::validation::{CaseReport, Links, ReportPage};

/// The page in the project.
const DEFAULT: &str = "docs/validation.md";

/// The file of a page.
pub struct ReportFile {
    path: PathBuf,
}

impl ReportFile {
    /// The file at a path, which need not be there yet, or that of the project.
    ///
    /// # Errors
    /// When there is another file, or no place for it, so that this is known before anything is run.
    pub fn open(path: Option<&Path>) -> Result<Self, Failure> {
        let path = path.map_or_else(of_project, |path| Ok(path.to_owned()))?;
        let file = Self { path };
        file.read()?;
        if !directory_of(&file.path).is_dir() {
            return Err(file.refused(Exit::NoInput, "there is no such directory"));
        }
        Ok(file)
    }

    fn refused(&self, exit: Exit, reason: &str) -> Failure {
        Failure::new(exit, format!("--report: {}: {reason}", self.path.display()))
    }

    fn read(&self) -> Result<ReportPage, Failure> {
        match std::fs::read_to_string(&self.path) {
            Ok(text) => ReportPage::read(&text).map_err(|reason| {
                self.refused(Exit::Usage, &format!("{reason}; name another file, or remove it"))
            }),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(ReportPage::default()),
            Err(error) => Err(self.refused(Exit::InputOutput, &error.to_string())),
        }
    }

    /// Writes the section of a case to the page as it is by now.
    pub fn write(&self, case: &CaseReport) -> Result<(), Failure> {
        let mut page = self.read()?;
        page.set(&CaseReport { links: self.links(&case.name), ..case.clone() });
        // That of the project is about all shipped cases
        let is_of_project = self.path.ends_with(DEFAULT);
        let shipped: Vec<&str> = library::list().iter().map(|case| case.name).collect();
        let cases = if is_of_project { &shipped[..] } else { &[] };
        write_atomic(&self.path, page.text(cases).as_bytes())?;
        Ok(())
    }

    /// What there is of a case, seen from the page.
    fn links(&self, name: &str) -> Links {
        let is_there = |link: &String| directory_of(&self.path).join(link).is_file();
        let page = Some(format!("../cases/{name}/README.md")).filter(is_there);
        let pictures = [format!("pictures/{name}.png"), format!("pictures/curves/{name}.png")];
        Links { page, pictures: pictures.into_iter().filter(is_there).collect() }
    }
}

fn of_project() -> Result<PathBuf, Failure> {
    let here = std::env::current_dir()?;
    let found = here.ancestors().map(|above| above.join(DEFAULT)).find(|path| path.is_file());
    found.ok_or_else(|| {
        let reason = format!("there is no {DEFAULT} here or above; write --report=FILE");
        Failure::new(Exit::NoInput, format!("--report: {reason}"))
    })
}

/// What the page says of a case before its runs.
pub fn case_report(file: &CaseFile) -> CaseReport {
    let case = file.case();
    CaseReport {
        name: file.name.clone(),
        title: case.title.clone(),
        gist: case.gist(),
        links: Links::default(),
        members: Vec::new(),
    }
}
