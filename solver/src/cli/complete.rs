//! Completion in shells: commands and options, names of cases and variants, keys, quantities.
//!
//! The lines a shell reads at its start call the program again, with the words typed so far, each time
//! something is to be completed.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use clap::{Command, CommandFactory};
use clap_complete::engine::{
    ArgValueCandidates, ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter,
};
use clap_complete::env::Shells;
use clap_complete::{CompleteEnv, Shell};
use serde_json::{Map, Value};

use super::exit::{Exit, Failure};
use super::facts::one_line;
use super::style::say;
use crate::case::{Case, collect_keys, library};

/// The variable by which a shell asks for completions.
const VARIABLE: &str = "ALEWIFE_COMPLETE";

/// Tables of a case that nobody sets from the command line.
const NOT_SET: [&str; 3] = ["reference", "variant", "description"];

/// Answers a shell that asks for completions, and ends the process then.
pub fn answer<C: CommandFactory>() {
    CompleteEnv::with_factory(C::command).var(VARIABLE).complete();
}

/// Prints what a shell reads at its start.
pub fn completions(shell: Shell, command: &Command) -> Result<Exit, Failure> {
    let shell = shell.to_string();
    let shells = Shells::builtins();
    let completer = shells.completer(&shell).ok_or_else(|| {
        Failure::new(Exit::Usage, format!("there are no completions for {shell}"))
    })?;
    let mut text = Vec::new();
    let (name, program) = (command.get_name(), own_path()?);
    completer.write_registration(VARIABLE, name, name, &program.to_string_lossy(), &mut text)?;
    say(String::from_utf8_lossy(&text).trim());
    Ok(Exit::Done)
}

/// How the program is called, from any directory: by its name where it is on the path.
fn own_path() -> io::Result<PathBuf> {
    let typed = std::env::args_os().next().map(PathBuf::from).unwrap_or_default();
    match typed.components().count() {
        0 => Ok(PathBuf::from("alewife")),
        1 => Ok(typed),
        _ => std::path::absolute(typed),
    }
}

/// Completes the name of a shipped case, one with a variant, or the path of a case file.
pub fn case() -> ArgValueCompleter {
    ArgValueCompleter::new(|typed: &OsStr| {
        let mut found = shipped(&typed.to_string_lossy());
        let files = PathCompleter::file().filter(|path| path.extension() == Some("toml".as_ref()));
        found.extend(files.complete(typed));
        found
    })
}

/// Shipped cases whose names begin so, and variants of one that is named in full.
fn shipped(typed: &str) -> Vec<CompletionCandidate> {
    let name = typed.split('/').next().unwrap_or(typed);
    let mut found = Vec::new();
    for entry in
        library::list().iter().chain(library::soft()).filter(|entry| entry.name.starts_with(name))
    {
        if entry.name.starts_with(typed) {
            // Much quicker than to read all of the case
            let table = entry.text.parse::<toml::Table>().unwrap_or_default();
            let title = table.get("title").and_then(toml::Value::as_str).unwrap_or_default();
            found.push(CompletionCandidate::new(entry.name).help(Some(one_line(title).into())));
        }
        if entry.name == name {
            let Ok(file) = Case::read(name, &[]) else { continue };
            let variants = file.variants.iter().map(|variant| format!("{name}/{variant}"));
            found.extend(variants.filter(|it| it.starts_with(typed)).map(CompletionCandidate::new));
        }
    }
    found
}

/// Completes a key of the case that is named in the same line.
pub fn key() -> ArgValueCandidates {
    ArgValueCandidates::new(|| {
        let case = words().into_iter().find_map(|word| Case::read(word.to_str()?, &[]).ok());
        let text = case.and_then(|file| file.case().to_toml().ok());
        let table = text.and_then(|text| toml::from_str::<Map<String, Value>>(&text).ok());
        let mut keys = BTreeMap::new();
        for (key, value) in table.unwrap_or_default() {
            if !NOT_SET.contains(&key.as_str()) {
                collect_keys(key, &value, &mut keys);
            }
        }
        keys.into_keys().map(|key| CompletionCandidate::new(format!("{key}="))).collect()
    })
}

/// Completes a column of the series of the run that is named in the same line.
pub fn quantity() -> ArgValueCandidates {
    ArgValueCandidates::new(|| {
        let header = words().into_iter().find_map(|word| header(Path::new(&word)).ok());
        let header = header.unwrap_or_default();
        header.trim_end().split(',').skip(1).map(CompletionCandidate::new).collect()
    })
}

/// The first line of the series of a run.
fn header(run: &Path) -> io::Result<String> {
    let mut line = String::new();
    BufReader::new(File::open(run.join("series.csv"))?).read_line(&mut line)?;
    Ok(line)
}

/// The words that are typed behind the name of the program.
fn words() -> Vec<OsString> {
    std::env::args_os().skip_while(|word| word != "--").skip(2).collect()
}
