//! Flags before the verb: the verb is put first, so that a flag means the same wherever it stands.
//!
//! The parser would keep flags before and after a verb apart, and of a repeated one only those after it.

use std::ffi::OsString;

use clap::{Arg, Command, CommandFactory};

use super::Cli;

/// The arguments (the program's own name among them) with the verb, if there is one, as the first.
pub fn verb_first(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let command = Cli::command();
    let mut at = 1;
    while let Some(word) = arguments.get(at).and_then(|word| word.to_str()) {
        if !word.starts_with('-') {
            if command.find_subcommand(word).is_some() {
                let verb = arguments.remove(at);
                arguments.insert(1, verb);
            }
            break;
        }
        at += if takes_the_next(&command, word) { 2 } else { 1 };
    }
    arguments
}

/// Whether the word after a flag is the flag's value.
fn takes_the_next(command: &Command, flag: &str) -> bool {
    let valued = |names: &dyn Fn(&Arg) -> bool| {
        command.get_arguments().any(|arg| arg.get_action().takes_values() && names(arg))
    };
    if let Some(long) = flag.strip_prefix("--") {
        return valued(&|arg| arg.get_long() == Some(long));
    }
    // Of letters in a row (`-qt2`), the first that takes a value takes the rest of the word.
    let mut letters = flag.chars().skip(1);
    letters.any(|letter| valued(&|arg| arg.get_short() == Some(letter))) && letters.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(words: &str) -> String {
        let arguments = verb_first(words.split(' ').map(OsString::from).collect());
        let words: Vec<_> = arguments.iter().map(|word| word.to_string_lossy()).collect();
        words.join(" ")
    }

    #[test]
    fn a_verb_is_found_behind_flags_and_their_values() {
        assert_eq!(moved("gelray -q -t 2 --set a=b render x"), "gelray render -q -t 2 --set a=b x");
        assert_eq!(moved("gelray -qt2 --set=a=b plan"), "gelray plan -qt2 --set=a=b");
        assert_eq!(moved("gelray -qo render render"), "gelray render -qo render");
    }

    #[test]
    fn what_is_no_verb_stays_where_it_is() {
        for words in ["gelray", "gelray --help", "gelray -q rendr -o x", "gelray render -q plan"] {
            assert_eq!(moved(words), words);
        }
    }
}
