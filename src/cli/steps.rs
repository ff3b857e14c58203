//! How far work of equal steps is: a bar with the time that is left on a terminal, lines with `-v`, nothing with `-q`.

use std::io::IsTerminal;

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::failure::tell;
use super::flags::Flags;

/// So many steps, one after the other.
pub struct Steps {
    bar: ProgressBar,
    tells: bool,
}

impl Steps {
    /// So many steps are to be done.
    pub fn new(count: usize, flags: &Flags) -> Self {
        let shows = !flags.quiet && std::io::stderr().is_terminal();
        let target =
            if shows { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(count as u64), target);
        let form = "{wide_bar} {pos}/{len}  {elapsed} gone, about {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(form) {
            bar.set_style(style);
        }
        Self { bar, tells: flags.verbose && !shows }
    }

    /// So many more are to be done.
    pub fn expect(&self, more: usize) {
        self.bar.inc_length(more as u64);
    }

    /// The next step begins.
    pub fn begin(&self, what: &str) {
        self.bar.set_message(what.to_owned());
        // A bar that nobody sees does not draw itself, and reckons all the same.
        self.bar.tick();
        let (at, all) = (self.bar.position(), self.bar.length().unwrap_or(0));
        if self.tells {
            let left = if at == 0 {
                String::new()
            } else {
                let left = self.bar.elapsed().mul_f64(all.saturating_sub(at) as f64 / at as f64);
                format!(", about {} left", HumanDuration(left))
            };
            tell(format_args!("{} of {all}: {what}{left}", at + 1));
        }
    }

    /// A step is done.
    pub fn done(&self) {
        self.bar.inc(1);
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
