//! What was typed to start this program, as it can be typed again.

/// How the program was called: from here that works again.
pub fn program(typed: &str) -> String {
    if typed.is_empty() { "alewife".to_owned() } else { quoted(typed) }
}

/// A word as a shell reads it.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_what_was_typed() {
        assert_eq!(program("alewife"), "alewife");
        assert_eq!(program("./my tools/alewife"), "'./my tools/alewife'");
        for typed in ["target/release/alewife", "/home/me/targets/alewife"] {
            assert_eq!(program(typed), typed);
        }
    }
}
