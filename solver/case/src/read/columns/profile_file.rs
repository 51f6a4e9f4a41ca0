//! Profiles from files: `profile = "inflow.csv"`, or one with a `file`, becomes one with `columns` and `rows`.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::point_file::{at_end, file_of, lines, rows, text_of, texts};
use crate::ProfileColumn;
use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// What a file of a profile holds.
const WANTED: &str = "write a header with names of coordinates and velocities, such as y,velocity.x, and in each row below a \
                      number for each of them (m, m/s), with decimal points; other columns are left out";

/// What ParaView calls columns of a line or a table.
const OF_PARAVIEW: [(&str, &str); 2] = [("points", ""), ("velocity", "velocity.")];

/// Puts tables in the place of the names of their files, so that a case stands for itself.
///
/// # Errors
/// When a file cannot be read, or holds no profile, or there are rows beside it.
pub fn resolve(root: &mut TomlNode) -> Result<(), TreeError> {
    let in_space = root.get("geometry").and_then(TomlNode::text) == Some("spatial");
    let sides = root.table_mut().and_then(|entries| entries.get_mut("boundary"));
    let Some(sides) = sides.and_then(TomlNode::table_mut) else { return Ok(()) };
    for side in sides.values_mut() {
        if let Some(profile) = side.table_mut().and_then(|entries| entries.get_mut("profile")) {
            resolve_profile(profile, in_space)?;
        }
    }
    Ok(())
}

fn resolve_profile(profile: &mut TomlNode, in_space: bool) -> Result<(), TreeError> {
    if profile.text().is_some() {
        // The short form
        let file = profile.clone();
        profile.value = TomlValue::Table(BTreeMap::from([("file".to_owned(), file)]));
    }
    let Some(file) = file_of(profile) else { return Ok(()) };
    let Some(entries) = profile.table_mut() else { return Ok(()) };
    if let Some(key) = ["columns", "rows"].into_iter().find(|key| entries.contains_key(*key)) {
        return Err(TreeError {
            origin: file.key.clone(),
            message: format!("the profile has both `{key}` and `file`"),
            help: "give one of them".to_owned(),
        });
    }
    let [columns, rows] = read(&file, in_space)?;
    entries.remove("file");
    entries.insert("columns".to_owned(), columns);
    entries.insert("rows".to_owned(), rows);
    Ok(())
}

/// Columns and rows of a file, without those columns that tell nothing.
fn read(file: &TomlNode, in_space: bool) -> Result<[TomlNode; 2], TreeError> {
    let source = Arc::new(text_of(file, "CSV")?);
    let mut lines = lines(&source);
    let wrong = |origin, message| TreeError { origin, message, help: WANTED.to_owned() };
    let Some(header) = lines.next() else {
        return Err(at_end(&source, format!("{} is empty", source.name), WANTED.to_owned()));
    };
    let names: Vec<&str> = header.text.split([',', ';', '\t']).map(str::trim).collect();
    let known: Vec<Option<ProfileColumn>> = names.iter().map(|name| column(name)).collect();
    let is_misspelt = |name: &&str| {
        let name = name.trim_matches('"').to_ascii_lowercase();
        name.starts_with("velocity") && !name.ends_with("magnitude") && column(&name).is_none()
    };
    if let Some(name) = names.iter().find(|name| is_misspelt(name)) {
        let message = format!("{}: `{name}` is no velocity that is known", source.name);
        return Err(wrong(header.origin, message));
    }
    let has = |kind: fn(ProfileColumn) -> Option<usize>| {
        known.iter().flatten().any(|one| kind(*one).is_some())
    };
    if !has(ProfileColumn::coordinate) || !has(ProfileColumn::velocity) {
        let what = if has(ProfileColumn::coordinate) { "velocity" } else { "coordinate" };
        let message = format!("{}: its header names no {what}: {}", source.name, names.join(", "));
        return Err(wrong(header.origin, message));
    }
    let mut table: Vec<Vec<f64>> = Vec::new();
    for line in lines {
        let words = line.text.split([',', ';', '\t']).map(str::trim);
        let row: Vec<&str> = words.collect();
        if row.len() != names.len() {
            let message =
                format!("this row has {} cells, and the header has {}", row.len(), names.len());
            return Err(wrong(line.origin, message));
        }
        if is_blank(&row, &known) {
            continue;
        }
        let number = |(word, name): (&&str, &&str)| {
            let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| {
                let message = format!("column `{name}` has \"{word}\", which is no number");
                let help = "leave out rows where nothing is known; numbers have decimal points";
                TreeError { origin: line.origin.clone(), message, help: help.to_owned() }
            })
        };
        let cells = row.iter().zip(&names).zip(&known).filter(|(_, known)| known.is_some());
        table.push(cells.map(|(cell, _)| number(cell)).collect::<Result<_, _>>()?);
    }
    if table.len() < 2 {
        let message = format!("{} has {} rows of numbers", source.name, table.len());
        return Err(at_end(&source, message, WANTED.to_owned()));
    }
    let known: Vec<ProfileColumn> = known.into_iter().flatten().collect();
    let told = telling(&known, &table, in_space);
    let names: Vec<&str> = told.iter().map(|nth| known[*nth].name()).collect();
    let told: Vec<Vec<f64>> =
        table.iter().map(|row| told.iter().map(|nth| row[*nth]).collect()).collect();
    Ok([texts(file, &names), rows(file, &told)])
}

/// Whether a row has no velocity: lines of other programs, and of this one, go on outside of the fluid.
fn is_blank(row: &[&str], known: &[Option<ProfileColumn>]) -> bool {
    let is_velocity = |one: &Option<ProfileColumn>| one.is_some_and(|one| one.velocity().is_some());
    let mut own = row.iter().zip(known).filter(|(_, known)| is_velocity(known));
    own.all(|(cell, _)| cell.is_empty() || cell.eq_ignore_ascii_case("nan"))
}

/// What a name of a file means, if it is known.
fn column(name: &str) -> Option<ProfileColumn> {
    let name = name.trim_matches('"').to_ascii_lowercase();
    let own = |wanted: &str| ProfileColumn::ALL.into_iter().find(|one| one.name() == wanted);
    own(&name).or_else(|| {
        OF_PARAVIEW.iter().find_map(|(theirs, ours)| {
            let axis = name.strip_prefix(theirs)?.strip_prefix([':', '_'])?;
            let number = ["0", "1", "2"].iter().position(|one| *one == axis);
            own(&format!("{ours}{}", number.map_or(axis, |number| ["x", "y", "z"][number])))
        })
    })
}

/// Columns but for those of z, where they are the same all over and the case has no z: other programs write three of each
/// in the plane, too.
fn telling(columns: &[ProfileColumn], table: &[Vec<f64>], in_space: bool) -> Vec<usize> {
    let is_same = |nth: usize| table.iter().all(|row| row[nth] == table[0][nth]);
    let of_z = [ProfileColumn::Z, ProfileColumn::VelocityZ];
    let tells = |nth: &usize| in_space || !of_z.contains(&columns[*nth]) || !is_same(*nth);
    (0..columns.len()).filter(tells).collect()
}

#[cfg(test)]
mod tests {
    use crate::{BoundaryCondition, Case, ProfileColumn, ProfileSpec, check};

    fn read(csv: &str, left: &str) -> Result<ProfileSpec, String> {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("in.csv"), csv).unwrap();
        let case = format!(
            "
title = 't'
geometry = 'planar'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.channel = {{ length = 3.0, height = 1.0 }}
boundary = {{ left = {left}, right = 'do-nothing', bottom = 'no-slip', top = 'no-slip' }}
mesh = {{ size = 0.5 }}
time.steady = {{}}
"
        );
        let path = directory.path().join("t.toml");
        std::fs::write(&path, case).unwrap();
        let file =
            Case::read(&path.display().to_string(), &[]).map_err(|error| error.to_string())?;
        if let Some(first) = check(&file).first() {
            return Err(format!("{}: {} {}", first.key, first.message, first.help));
        }
        let again = Case::parse("t.toml", &file.case().to_toml().unwrap(), &[]).unwrap();
        assert_eq!(again.case(), file.case());
        match &file.case().boundary["left"] {
            BoundaryCondition::Profile(profile) => Ok(profile.clone()),
            other => panic!("{other:?}"),
        }
    }

    const SHORT: &str = "{ profile = 'in.csv' }";

    #[test]
    fn columns_of_files_of_several_programs_are_known() {
        use ProfileColumn::{VelocityX, Y};
        for csv in [
            "y,velocity.x\n0,0\n0.5,1.5\n1,0\n",
            "# measured\nY; velocity.X\n0;0\n0.5;1.5\n1;0",
            "distance,x,y,velocity.x,velocity.y,speed\n0,0,0,0,0,0\n0.5,0,0.5,1.5,0,1.5\n1,0,1,0,0,0\n1.5,0,1.5,,,\n",
            "Points_X,Points_Y,velocity_X,velocity_Y,velocity_Magnitude\n0,0,0,0,0\n0,0.5,1.5,0,1.5\n0,1,0,0,0\n0,2,nan,nan,nan\n",
            "\"velocity:0\",\"velocity:1\",\"velocity:2\",\"arc_length\",\"Points:0\",\"Points:1\",\"Points:2\"\n\
             0,0,0,0,0,0,0\n1.5,0,0,0.5,0,0.5,0\n0,0,0,1,0,1,0\n",
        ] {
            let found = read(csv, SHORT).unwrap();
            let of = |what| found.columns.iter().position(|one| *one == what).unwrap();
            let pair = |row: &Vec<f64>| [row[of(Y)], row[of(VelocityX)]];
            let rows: Vec<[f64; 2]> = found.rows.iter().map(pair).collect();
            assert_eq!(rows, [[0.0, 0.0], [0.5, 1.5], [1.0, 0.0]], "{csv}");
            assert!(!found.columns.contains(&ProfileColumn::Z), "{csv}");
        }
        let long = "{ profile = { file = 'in.csv', factor.ramp.duration = 1.0 } }";
        let found = read("y,velocity.x\n0,0\n1,1\n", long).unwrap_err();
        assert!(found.contains("boundary.left.profile.factor: a steady solution"), "{found}");
    }

    #[test]
    fn what_is_no_profile_is_told_with_its_line_and_a_remedy() {
        for (csv, told) in [
            ("", "is empty"),
            ("y,u\n0,0\n1,1\n", "names no velocity: y, u"),
            ("height,velocity.x\n0,0\n1,1\n", "names no coordinate"),
            ("y,velocity.x\n0,0\n1,1,2\n", "this row has 3 cells"),
            ("y,velocity.x,velocity.y\n0,0,0\n1,nan,1\n", "column `velocity.x` has \"nan\""),
            ("y,velocity.x,velocity.yy\n0,0,0\n1,1,1\n", "`velocity.yy` is no velocity"),
            ("y,velocity.x\n0,0\n", "1 rows of numbers"),
            ("y,velocity.x\n0,0\n1,1\n0,2\n", "rows 1 and 3 of the profile are at one place"),
            ("y,y,velocity.x\n0,0,0\n1,1,1\n", "two columns `y`"),
            ("y,z,velocity.x\n0,0,0\n1,1,1\n2,0,1\n", "column `z`, and the case no z"),
        ] {
            let found = read(csv, SHORT).expect_err(csv);
            assert!(found.contains(told), "{csv}: {found}");
        }
        let found = read("", "{ profile = 'no.csv' }").unwrap_err();
        assert!(found.contains("no.csv") && found.contains("t.toml:"), "{found}");
        let both = "{ profile = { file = 'in.csv', rows = [[0.0, 1.0]] } }";
        assert!(read("y,velocity.x\n0,0\n1,1\n", both).unwrap_err().contains("both `rows`"));
        assert!(read("", "{ profile = {} }").unwrap_err().contains("no rows of numbers"));
    }
}
