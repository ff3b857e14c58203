//! The library's errors in the program's words: whose fault, and the flag that mends it.

use gelray::Error;
use gelray::error::{Blame, SceneError};

/// The flag that files which are nowhere want.
pub const DATA: &str = "folders of data are given with --data DIR";

/// An error as the program says it: one sentence.
pub fn sentence(error: &Error) -> String {
    match error {
        Error::Scene(fault) => {
            let remedy = fault.missing.as_ref().map_or_else(String::new, |_| format!(" ({DATA})"));
            format!("{}: {}{remedy}", place(fault), fault.message)
        }
        Error::Memory { needed, allowed } => format!(
            "the plan needs up to {needed} bytes and --max-memory allows {allowed}; raise the limit, choose a smaller `size`, volume or texture, or a smaller `texel`"
        ),
        error => error.to_string(),
    }
}

/// Where a fault of a scene is: the file with line and column, or the flag that brought it in.
pub fn place(fault: &SceneError) -> String {
    let name = &fault.name;
    let place = match fault.blame {
        Blame::Scene => name.clone(),
        Blame::Overridden => format!("{name} with --set"),
        Blame::Override => format!("--set {name}"),
    };
    match fault.at {
        Some([line, column]) => format!("{place}:{line}:{column}"),
        None => place,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_speaks_of_no_flag_and_the_program_names_the_one_that_mends() {
        let memory = Error::Memory { needed: 9, allowed: 5 };
        let change = Error::from(SceneError::of_override("a.b=1", "no such entity"));
        let fault = SceneError::elsewhere("a.toml", "`b.nrrd` is nowhere");
        let missing = SceneError { missing: Some("b.nrrd".into()), ..fault };
        let missing = Error::from(missing);
        for (error, flag) in
            [(memory, "--max-memory"), (change, "--set a.b=1"), (missing, "--data")]
        {
            assert!(!error.to_string().contains("--"), "{error}");
            assert!(sentence(&error).contains(flag), "{}", sentence(&error));
        }
    }
}
