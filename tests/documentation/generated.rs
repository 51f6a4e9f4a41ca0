//! The pages that are made of the cases and of the schema are up to date.

use std::fmt::Write;
use std::fs;

use alewife_core::case::soft::{self, SoftFile};
use alewife_core::case::{library, schema};
use serde_json::Value;

use super::{CASES, root};

/// Compares a page with what it should be, or writes it where `ALEWIFE_UPDATE` is set.
fn up_to_date(page: &str, wanted: &str) {
    if std::env::var_os("ALEWIFE_UPDATE").is_some() {
        fs::write(root().join(page), wanted).expect("the page can be written");
        return;
    }
    let found = fs::read_to_string(root().join(page)).unwrap_or_default();
    assert!(
        found == wanted,
        "{page} is not up to date; to write it again:\n\
         ALEWIFE_UPDATE=1 cargo test --release -p tests --test whole generated"
    );
}

#[test]
fn the_gallery_shows_every_case() {
    let mut page = String::from(
        "# Gallery\n\nAll shipped cases; [the table of cases](../cases/README.md) lists what each \
         is compared with. `alewife show NAME`\ndescribes one, and \
         `alewife show NAME --source > my.toml` starts a file of your own from it.\n",
    );
    for (name, file) in CASES.iter() {
        let case = file.case();
        // A case whose values are all of its variants is run by one of them.
        let variant = match case.variant.first() {
            Some(variant) if case.reference.is_empty() => format!("/{}", variant.name),
            _ => String::new(),
        };
        let title = &case.title;
        write!(page, "\n## {name}\n\n[{title}](../cases/{name}/README.md): ").unwrap();
        if case.environment.is_some() {
            // A run by itself is refused: somebody has to decide
            writeln!(page, "[`Environment(\"{name}\")`](python.md#environments)").unwrap();
        } else {
            writeln!(page, "`alewife run {name}{variant}`").unwrap();
        }
        let picture = format!("pictures/{name}.png");
        if root().join("docs").join(&picture).is_file() {
            writeln!(page, "\n![picture]({picture})").unwrap();
        }
    }
    for entry in library::soft() {
        let name = entry.name;
        let file = SoftFile::declared(name).unwrap_or_else(|error| panic!("{name}\n{error}"));
        let file = file.expect("it is a soft case");
        let title = &file.case.title;
        write!(page, "\n## {name}\n\n[{title}](../cases/{name}/README.md): ").unwrap();
        writeln!(page, "`alewife run {name}`").unwrap();
        let picture = format!("pictures/{name}.png");
        if root().join("docs").join(&picture).is_file() {
            writeln!(page, "\n![picture]({picture})").unwrap();
        }
    }
    up_to_date("docs/gallery.md", &page);
}

/// The words of a type of the schema, a link where it has a section of its own.
fn type_of(value: &Value) -> String {
    if let Some(target) = value["$ref"].as_str() {
        let name = target.rsplit('/').next().unwrap_or(target);
        return format!("[{name}](#{})", name.to_lowercase());
    }
    for key in ["anyOf", "oneOf"] {
        if let Some(choices) = value[key].as_array() {
            let mut kinds: Vec<String> = choices.iter().map(type_of).collect();
            kinds.retain(|kind| kind != "null" && !kind.is_empty());
            kinds.dedup();
            return kinds.join(" or ");
        }
    }
    let word = |word: &Value| format!("`{}`", word.to_string().replace('|', "\\|"));
    if let Some(words) = value["enum"].as_array() {
        return words.iter().map(word).collect::<Vec<_>>().join(", ");
    }
    if !value["const"].is_null() {
        return word(&value["const"]);
    }
    let kind = |kind: &str| match kind {
        "array" => match type_of(&value["items"]) {
            items if items.is_empty() => "list".to_owned(),
            items => format!("list of {items}"),
        },
        "object" => "table".to_owned(),
        "string" => "text".to_owned(),
        "integer" => "whole number".to_owned(),
        "boolean" => "true or false".to_owned(),
        kind => kind.to_owned(),
    };
    let kinds = match &value["type"] {
        Value::String(name) => kind(name),
        Value::Array(names) => {
            let names = names.iter().filter_map(Value::as_str).filter(|name| *name != "null");
            names.map(kind).collect::<Vec<_>>().join(" or ")
        }
        _ => String::new(),
    };
    kinds + &range(value)
}

/// The range of a number, behind its type.
fn range(value: &Value) -> String {
    let bound = |key: &str, sign: &str| value[key].as_f64().map(|bound| format!("{sign} {bound}"));
    let bounds = [
        bound("exclusiveMinimum", ">"),
        bound("minimum", ">="),
        bound("exclusiveMaximum", "<"),
        bound("maximum", "<="),
    ];
    let bounds: Vec<String> = bounds.into_iter().flatten().collect();
    if bounds.is_empty() { String::new() } else { format!(" {}", bounds.join(" and ")) }
}

/// A description on one line, as a cell of a table.
fn description(value: &Value) -> String {
    let text = value["description"].as_str().unwrap_or_default();
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// Adds the rows of a table's keys, and those of the tables within it.
fn add_keys(rows: &mut String, above: &str, table: &Value) {
    let needed: Vec<&str> =
        table["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    for (key, value) in table["properties"].as_object().into_iter().flatten() {
        let default = match &value["default"] {
            _ if needed.contains(&key.as_str()) => "needed".to_owned(),
            Value::Null => String::new(),
            Value::Object(_) => "table".to_owned(),
            default => format!("`{default}`").replace('|', "\\|"),
        };
        let row = format!(
            "| `{above}{key}` | {} | {default} | {} |\n",
            type_of(value),
            description(value)
        );
        *rows += &row.replace("|  |", "| |").replace("|  |", "| |");
        add_keys(rows, &format!("{above}{key}."), value);
    }
}

/// Writes one section: a type of the schema with its keys, or with the choices it has.
fn add_section(page: &mut String, title: &str, value: &Value) {
    writeln!(page, "\n## {title}\n\n{}", description(value)).unwrap();
    let head = "\n| Key | Type | Default | Meaning |\n|---|---|---|---|\n";
    let mut rows = String::new();
    add_keys(&mut rows, "", value);
    let choices = value["oneOf"].as_array().or_else(|| value["anyOf"].as_array());
    for choice in choices.into_iter().flatten() {
        let is_word = choice["properties"].is_null();
        match type_of(choice) {
            kind if is_word && !kind.is_empty() => {
                let meaning = description(choice);
                let row = format!("| | {kind} | | {meaning} |\n");
                rows += &row.replace("|  |", "| |");
            }
            _ => {
                for (key, inner) in choice["properties"].as_object().into_iter().flatten() {
                    let row =
                        format!("| `{key}` | {} | | {} |\n", type_of(inner), description(choice));
                    rows += &row.replace("|  |", "| |");
                    add_keys(&mut rows, &format!("{key}."), inner);
                }
            }
        }
    }
    if rows.is_empty() {
        writeln!(page, "\nType: {}.", type_of(value)).unwrap();
    } else {
        *page += head;
        *page += &rows;
    }
}

#[test]
fn the_page_of_keys_is_that_of_the_schema() {
    let schema: Value = serde_json::from_str(schema()).unwrap();
    let mut page = String::from(
        "# All keys\n\nEvery key of a case file, from the schema (`alewife schema`). \
         Explanations and examples are in\n[case files](case-file.md). Often looked for: \
         [`[[body]]`](#body), [`[[swimmer]]`](#swimmerspec),\n\
         [`[[joint]]`](#joint), [strokes](#stroke), [`boundary`](#boundarycondition), \
         [`mesh`](#meshsettings),\n[`time`](#timesettings).\n",
    );
    add_section(&mut page, "Top", &schema);
    let types = schema["$defs"].as_object().unwrap();
    assert!(types.len() > 50, "{} types", types.len());
    for (name, value) in types {
        add_section(&mut page, name, value);
    }
    up_to_date("docs/keys.md", &page);
}

#[test]
fn the_page_of_keys_of_soft_cases_is_that_of_their_schema() {
    let schema: Value = serde_json::from_str(soft::schema()).unwrap();
    let mut page = String::from(
        "# All keys of soft cases\n\nEvery key of a soft case, from its schema (`alewife schema --soft`). \
         Explanations and examples are in\n[soft cases](soft.md).\n",
    );
    add_section(&mut page, "Top", &schema);
    for (name, value) in schema["$defs"].as_object().unwrap() {
        add_section(&mut page, name, value);
    }
    up_to_date("docs/soft-keys.md", &page);
}
