//! `CaseText`: the text of a case, by the path of its file or by the name of a shipped one.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use super::library::{self, Beside};
use crate::text::diagnostic::CaseError;
use crate::text::nearest::several_nearest;
use crate::text::source::{Origin, Source};

/// The text of a case before it is understood.
pub struct CaseText {
    /// Name of the case.
    pub name: String,
    /// The text, and the file it is from.
    pub source: Arc<Source>,
}

/// Name of a case by its file: `cases/jets/case.toml` is `jets`, `mine.toml` is `mine`.
pub fn stem(file: &str) -> String {
    let path = Path::new(file);
    let of = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    match of(path) {
        Some(stem) if stem == "case" => path.parent().and_then(of).unwrap_or(stem),
        Some(stem) => stem,
        None => "case".to_owned(),
    }
}

/// The text an argument means, and the variant, if it names one.
pub struct Located {
    /// The text of the case.
    pub text: CaseText,
    /// The variant after the name of the case.
    pub variant: Option<String>,
}

/// Finds the text and the variant an argument means.
///
/// # Errors
/// When there is no such case, or its file cannot be read.
pub fn locate(argument: &str) -> Result<Located, CaseError> {
    let without_variant = |text| Located { text, variant: None };
    let is_path = |text: &str| text.ends_with(".toml");
    if is_path(argument) || Path::new(argument).is_file() {
        return read_file(Path::new(argument)).map(without_variant);
    }
    if let Some(shipped) = library::find(argument) {
        return Ok(without_variant(shipped_text(shipped)));
    }
    let directory = Path::new(argument).join("case.toml");
    if directory.is_file() {
        return read_file(&directory).map(without_variant);
    }
    // A pipe or a device is refused with the reason; a directory may be named like case and variant
    if Path::new(argument).exists() && !Path::new(argument).is_dir() {
        return read_file(Path::new(argument)).map(without_variant);
    }
    let Some((case, variant)) = argument.rsplit_once('/') else {
        let is_directory = Path::new(argument).is_dir();
        return Err(if is_directory { no_case_in(argument) } else { no_such_case(argument) });
    };
    let text = if is_path(case) {
        read_file(Path::new(case))?
    } else if let Some(shipped) = library::find(case) {
        shipped_text(shipped)
    } else if Path::new(case).join("case.toml").is_file() {
        read_file(&Path::new(case).join("case.toml"))?
    } else if Path::new(argument).is_dir() {
        return Err(no_case_in(argument));
    } else {
        return Err(no_such_case(case));
    };
    Ok(Located { text, variant: Some(variant.to_owned()) })
}

/// There is no case in a directory.
fn no_case_in(directory: &str) -> CaseError {
    CaseError::NotFound {
        what: format!("the directory {directory} holds no case.toml"),
        help: "give the path of a case file, or a name from `alewife list`".to_owned(),
    }
}

/// There is no case of that name.
pub fn no_such_case(name: &str) -> CaseError {
    let all = library::list().iter().chain(library::soft());
    let known: Vec<&str> = all.map(|case| case.name).collect();
    let near = several_nearest(name, &known);
    let mut help = match near.len() {
        0 => String::new(),
        1 => format!("did you mean `{}`? ", near[0]),
        _ => format!("did you mean one of `{}`? ", near.join("`, `")),
    };
    let with_ending = format!("{name}.toml");
    if !name.is_empty() && Path::new(&with_ending).is_file() {
        help = format!("did you mean the file `{with_ending}`? ");
    }
    help += "`alewife list` lists the shipped cases; a file of your own ends in .toml";
    CaseError::NotFound { what: format!("there is no case `{name}`"), help }
}

/// The text of a shipped case.
pub fn shipped_text(case: &library::Shipped) -> CaseText {
    let (name, text) = (case.file.to_owned(), case.text.to_owned());
    let source = Source { name, directory: None, text };
    CaseText { name: case.name.to_owned(), source: Arc::new(source) }
}

/// The text of a file that another one names, beside it on the disk or among the shipped ones.
///
/// # Errors
/// Why it cannot be read.
pub fn source_beside(file: &str, origin: &Origin) -> Result<Source, String> {
    let path = match library::beside(&origin.source, file) {
        Some(Beside::Shipped(bytes)) => {
            let folder = origin.source.name.strip_suffix("case.toml").unwrap_or_default();
            let text = String::from_utf8_lossy(bytes).into_owned();
            return Ok(Source { name: format!("{folder}{file}"), directory: None, text });
        }
        Some(Beside::OnDisk(path)) => path,
        None => return Err(format!("`{file}` cannot be reached from here")),
    };
    let text = read_text(&path).map_err(|error| match error {
        CaseError::NotFound { what, .. } => what,
        CaseError::Wrong(mut all) if !all.is_empty() => all.swap_remove(0).message,
        other => other.to_string(),
    })?;
    let text = text.trim_start_matches('\u{feff}').to_owned();
    Ok(Source { name: path.display().to_string(), directory: None, text })
}

/// Whether two paths are those of one file.
pub fn is_same_file(one: &str, other: &str) -> bool {
    let [one, other] = [one, other].map(fs::canonicalize);
    one.is_ok_and(|one| other.is_ok_and(|other| one == other))
}

/// Largest file that is read (bytes); the largest shipped case has a thousandth of it.
const LARGEST_FILE: u64 = 16_000_000;

/// The text of a file.
///
/// # Errors
/// When there is no such file, or it cannot be read, is no text, or gives the case no usable name.
pub fn read_file(path: &Path) -> Result<CaseText, CaseError> {
    let text = read_text(path)?;
    let name = stem(&path.canonicalize().unwrap_or_else(|_| path.to_owned()).to_string_lossy());
    let is_dots = name.is_empty() || name.chars().all(|c| c == '.');
    if is_dots || name.chars().any(char::is_control) {
        return Err(CaseError::at(
            "",
            format!(
                "{} gives its case the name {name:?}, which no directory can have",
                path.display()
            ),
            "rename the file: the run gets a directory of its name, such as runs/mine for mine.toml",
        ));
    }
    Ok(CaseText {
        name,
        source: Arc::new(Source {
            name: path.display().to_string(),
            directory: Some(path.parent().unwrap_or(Path::new("")).to_owned()),
            text,
        }),
    })
}

/// The text of a file that is one: no pipe or device, of a size a case can have, and in UTF-8.
pub fn read_text(path: &Path) -> Result<String, CaseError> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => CaseError::NotFound {
            what: format!("there is no file {}", path.display()),
            help: "give the path of a case file, or a name from `alewife list`".to_owned(),
        },
        _ => CaseError::Unreadable { path: path.to_owned(), source: error },
    };
    // Asked before it is opened: opening a pipe waits for somebody to write into it
    let metadata = fs::metadata(path).map_err(failed)?;
    let refused = |what: String, help: &str| CaseError::at("", what, help);
    if !metadata.is_file() {
        let kind = if metadata.is_dir() { "a directory" } else { "a pipe or a device" };
        return Err(refused(
            format!("{} is {kind}, not a file", path.display()),
            "give the path of a case file, or of a directory with a case.toml",
        ));
    }
    if metadata.len() > LARGEST_FILE {
        return Err(refused(
            format!(
                "{} has {:.1} MB, more than the {} MB a case may have",
                path.display(),
                metadata.len() as f64 / 1e6,
                LARGEST_FILE / 1_000_000
            ),
            "is it a case file? A table of that length can be thinned out",
        ));
    }
    let bytes = fs::read(path).map_err(failed)?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let line = bytes[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
        refused(
            format!(
                "{} is not text in UTF-8: byte {} (in line {line}) is 0x{:02X}",
                path.display(),
                at + 1,
                bytes[at]
            ),
            &format!(
                "save it as UTF-8 in your editor, or convert it: iconv -f {} -t utf-8",
                encoding(bytes)
            ),
        )
    })
}

/// The encoding that bytes which are not UTF-8 are most likely in, as `iconv` calls it.
fn encoding(bytes: &[u8]) -> &'static str {
    match bytes {
        // By the byte order mark
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "utf-16",
        _ => "latin1",
    }
}
