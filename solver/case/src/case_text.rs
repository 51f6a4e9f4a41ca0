//! `CaseText`: the text of a case, by the path of its file or by the name of a shipped one.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::diagnostic::CaseError;
use super::library;
use super::nearest::nearest;
use super::source::Source;

/// The text of a case before it is understood.
pub struct CaseText {
    /// Name of the case.
    pub name: String,
    /// Where relative paths start; a shipped case has none.
    pub directory: Option<PathBuf>,
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
    let Some((case, variant)) = argument.rsplit_once('/') else {
        return Err(no_such_case(argument));
    };
    let text = if is_path(case) {
        read_file(Path::new(case))?
    } else if let Some(shipped) = library::find(case) {
        shipped_text(shipped)
    } else if Path::new(case).join("case.toml").is_file() {
        read_file(&Path::new(case).join("case.toml"))?
    } else {
        return Err(no_such_case(case));
    };
    Ok(Located { text, variant: Some(variant.to_owned()) })
}

/// There is no case of that name.
pub fn no_such_case(name: &str) -> CaseError {
    let known: Vec<&str> = library::list().iter().map(|case| case.name).collect();
    let mut help = match nearest(name, &known) {
        Some(word) => format!("did you mean `{word}`? "),
        None => String::new(),
    };
    help += &format!("shipped cases: {}; a file of your own ends in .toml", known.join(", "));
    CaseError::NotFound { what: format!("there is no case `{name}`"), help }
}

/// The text of a shipped case.
pub fn shipped_text(case: &library::Shipped) -> CaseText {
    let source = Source { name: case.file.to_owned(), text: case.text.to_owned() };
    CaseText { name: case.name.to_owned(), directory: None, source: Arc::new(source) }
}

/// The text of a file.
///
/// # Errors
/// When there is no such file, or it cannot be read.
pub fn read_file(path: &Path) -> Result<CaseText, CaseError> {
    let text = fs::read_to_string(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => CaseError::NotFound {
            what: format!("there is no file {}", path.display()),
            help: "give the path of a case file, or a name from `alewife list`".to_owned(),
        },
        _ => CaseError::Unreadable { path: path.to_owned(), source: error },
    })?;
    let name = path.display().to_string();
    Ok(CaseText {
        name: stem(&path.canonicalize().unwrap_or_else(|_| path.to_owned()).to_string_lossy()),
        directory: Some(path.parent().unwrap_or(Path::new("")).to_owned()),
        source: Arc::new(Source { name, text }),
    })
}
