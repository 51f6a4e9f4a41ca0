//! How a value is written in place of one of another type.

/// A number with a point in it where a whole one is wanted.
pub(super) fn broken(found: &str, wanted: &str) -> Option<f64> {
    let number = found.strip_prefix('`')?.strip_suffix('`')?;
    let is_float = number.contains(['.', 'e', 'E']) || number.parse::<i64>().is_err();
    (is_float && wanted.starts_with("a whole number")).then(|| number.parse().ok())?
}

/// How a whole number is written instead of one with a point.
pub(super) fn whole_example(value: f64) -> String {
    // Larger ones have no point, and none of them is a count
    const LARGEST: f64 = 1e15;
    let (below, above) = (value.floor(), value.ceil());
    if value < 0.0 {
        "write a whole number of 0 or more".to_owned()
    } else if value.is_nan() || value.abs() > LARGEST {
        "write a whole number, without a point and a power of ten".to_owned()
    } else if below == above {
        format!("write it without a point: {below}")
    } else {
        format!("write {below} or {above}")
    }
}

/// How a number is written instead of a text.
pub(super) fn number_example(text: &str) -> String {
    let is_number = |text: &str| text.trim().parse::<f64>().is_ok();
    if text.matches(',').count() == 1 && is_number(&text.replace(',', ".")) {
        return format!("write it with a decimal point: {}", text.replace(',', "."));
    }
    if text.contains(':') && text.split(':').take(2).all(is_number) {
        return "one number; ranges are for `alewife sweep run`".to_owned();
    }
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c)));
    let (digits, unit) = text.split_at(end.unwrap_or(text.len()));
    if !is_number(digits) {
        return format!("\"{text}\" is no number");
    }
    if unit.is_empty() {
        return format!("write it without quotes: {digits}");
    }
    format!("write the number without quotes and without its unit, in those of the case: {digits}")
}

/// How an array is written instead of what is there.
pub(super) fn array_example(found: &str, wanted: &str) -> String {
    if let Some(text) = found.strip_prefix("the string ") {
        return format!("write it in brackets: [{text}]");
    }
    if let Some(n) =
        wanted.strip_prefix("an array of ").and_then(|rest| rest.strip_suffix(" texts"))
    {
        return format!("write {n} texts in brackets, with commas between them");
    }
    let number = found.trim_matches('`');
    match number.parse::<f64>() {
        Ok(_) if wanted == "an array of 3 numbers" => {
            format!("write three numbers in brackets, such as [{number}, 0.0, 0.0]")
        }
        Ok(_) => format!("write numbers in brackets: [x, y], such as [{number}, 0.0]"),
        Err(_) if wanted == "an array of 4 numbers" => {
            "write four numbers in brackets, with commas between them: [w, x, y, z]".to_owned()
        }
        Err(_) if wanted == "an array of 3 numbers" => {
            "write three numbers in brackets, with commas between them: [x, y, z]".to_owned()
        }
        Err(_) => "write values in brackets, with commas between them: [x, y]".to_owned(),
    }
}
