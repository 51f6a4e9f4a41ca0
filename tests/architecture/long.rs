//! Every test that is not run daily says why, and which small one is run for the same fault.

use std::collections::BTreeSet;

use super::sources::{CRATES, TESTS, sources};

#[test]
fn long_tests_have_small_ones() {
    let mut daily = BTreeSet::new();
    let mut long = Vec::new();
    let mut wrong = Vec::new();
    for (file, text) in TESTS.into_iter().chain(CRATES).flat_map(sources) {
        for test in text.split("#[test]\n").skip(1) {
            let mut lines = test.lines().map(str::trim);
            let ignored = lines.clone().take_while(|line| !line.starts_with("fn "));
            let ignored = ignored.filter_map(|line| line.strip_prefix("#[ignore")).last();
            let name = lines.find_map(|line| line.strip_prefix("fn ")?.split('(').next());
            let name = name.unwrap_or_default().to_owned();
            match ignored {
                Some(reason) => long.push((file.clone(), name, reason.to_owned())),
                None => _ = daily.insert(name),
            }
        }
    }
    for (file, name, reason) in &long {
        let small =
            reason.strip_prefix(" = \"long: ").and_then(|rest| rest.split_once("; small: "));
        let small = small.map(|(_, small)| small.trim_end_matches("\"]"));
        if !small.is_some_and(|small| daily.contains(small)) {
            wrong.push(format!("{file}: {name} is left out, and names no small test that is not"));
        }
    }
    assert!(daily.len() > 500 && long.len() > 7, "{} daily, {} long", daily.len(), long.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
