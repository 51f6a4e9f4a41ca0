//! `manual`: the pages of the manual, one a command, in the format of `man`.

use std::fs;
use std::io;
use std::path::Path;

use clap::Command;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

use super::exit::{Exit, Failure};
use super::style::say;
use crate::observer::write_atomic;

/// The end of names of pages: the section of commands.
const SECTION: &str = "1";

/// A page of the manual.
struct Page {
    /// Name of its file, such as `alewife-sweep-run.1`.
    file: String,
    text: Vec<u8>,
}

/// Writes all pages of a command into a directory, which is made if it is absent.
pub fn manual(directory: &Path, command: Command) -> Result<Exit, Failure> {
    let mut command = command.disable_help_subcommand(true);
    let version = command.get_version().unwrap_or_default().to_owned();
    command.build();
    let mut pages = Vec::new();
    collect(&command, &format!("alewife {version}"), &mut pages)?;
    fs::create_dir_all(directory).map_err(|error| {
        Failure::new(Exit::InputOutput, format!("{}: {error}", directory.display()))
    })?;
    for page in &pages {
        write_atomic(&directory.join(&page.file), &page.text)?;
    }
    say(&format!("{} pages in {}", pages.len(), directory.display()));
    Ok(Exit::Done)
}

/// The pages of a command and all those under it.
fn collect(command: &Command, source: &str, pages: &mut Vec<Page>) -> io::Result<()> {
    let man = Man::new(command.clone()).section(SECTION).source(source).manual("alewife");
    let mut text = Vec::new();
    man.render_title(&mut text)?;
    man.render_name_section(&mut text)?;
    man.render_synopsis_section(&mut text)?;
    man.render_description_section(&mut text)?;
    man.render_options_section(&mut text)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut text)?;
    }
    if let Some(after) = command.get_after_help() {
        closing(&after.to_string()).to_writer(&mut text)?;
    }
    pages.push(Page { file: man.get_filename(), text });
    let shown = command.get_subcommands().filter(|one| !one.is_hide_set());
    shown.into_iter().try_for_each(|one| collect(one, source, pages))
}

/// The text below the options: its examples line by line, its paragraphs as text.
fn closing(text: &str) -> Roff {
    let mut roff = Roff::new();
    let mut has_notes = false;
    for paragraph in text.split("\n\n") {
        if let Some(examples) = paragraph.strip_prefix("Examples:\n") {
            roff.control("SH", ["EXAMPLES"]).control("nf", []);
            for line in examples.lines() {
                roff.text([roman(line.trim_start())]);
            }
            roff.control("fi", []);
        } else {
            match has_notes {
                false => roff.control("SH", ["NOTES"]),
                true => roff.control("PP", []),
            };
            has_notes = true;
            roff.text([roman(paragraph.replace('\n', " "))]);
        }
    }
    roff
}
