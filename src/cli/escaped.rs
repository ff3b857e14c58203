//! Text from files on its way to a terminal: what could command the terminal is spelled out.

use std::fmt::Write;

/// The text with control characters, but for line ends and tabs, as `\\x1b` or `\\u{202e}`: also those that turn the
/// direction of writing.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        let turns = matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        let _ = match letter {
            '\n' | '\t' => write!(safe, "{letter}"),
            _ if letter.is_ascii_control() => write!(safe, "\\x{:02x}", u32::from(letter)),
            _ if letter.is_control() || turns => write!(safe, "\\u{{{:x}}}", u32::from(letter)),
            _ => write!(safe, "{letter}"),
        };
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn what_commands_a_terminal_is_spelled_out_and_other_text_stays() {
        assert_eq!(escaped("größer\t1\n"), "größer\t1\n");
        assert_eq!(escaped("a\x1b[31m\r\x07\u{9b}b\u{202e}"), r"a\x1b[31m\x0d\x07\u{9b}b\u{202e}");
    }
}
