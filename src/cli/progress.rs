//! How far the work is: a bar on a terminal, plain lines in a log with `-v`, nothing with `-q`.

use std::io::IsTerminal;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use crossbeam::channel::{Receiver, Sender, bounded, tick};
use crossbeam::select;
use gelray::schedule::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::failure::tell;
use super::flags::Flags;

/// Time between two looks at the watch.
const INTERVAL: Duration = Duration::from_millis(100);

/// Looks without a line in a log after which there is one.
const PATIENCE: u32 = 50;

/// A thread that shows how far the work is, until this is dropped.
pub struct Progress(Option<(Sender<()>, JoinHandle<()>)>);

impl Progress {
    /// Shows what a watch says, in the way that the flags and standard error ask for.
    pub fn show(watch: &Arc<Watch>, flags: &Flags) -> Self {
        let terminal = std::io::stderr().is_terminal();
        if flags.quiet || !(terminal || flags.verbose) {
            return Self(None);
        }
        let (stop, stopped) = bounded(1);
        let watch = Arc::clone(watch);
        let show = move || if terminal { bar(&watch, &stopped) } else { lines(&watch, &stopped) };
        // Without a thread there is no bar; the work goes on.
        Self(std::thread::Builder::new().spawn(show).ok().map(|thread| (stop, thread)))
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.0.take() {
            let _ = stop.send(());
            let _ = thread.join();
        }
    }
}

/// Calls `look` at equal intervals until told to stop.
fn each_interval(stopped: &Receiver<()>, mut look: impl FnMut()) {
    let ticks = tick(INTERVAL);
    loop {
        look();
        select! {
            recv(ticks) -> _ => (),
            recv(stopped) -> _ => break,
        }
    }
}

fn bar(watch: &Watch, stopped: &Receiver<()>) {
    let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{msg:<12} {wide_bar} {percent:>3} % {elapsed}")
    {
        bar.set_style(style);
    }
    each_interval(stopped, || {
        let (stage, done, total) = watch.progress();
        bar.set_message(stage);
        bar.set_length(total.max(1));
        bar.set_position(done.min(total));
    });
    bar.finish_and_clear();
}

fn lines(watch: &Watch, stopped: &Receiver<()>) {
    let (mut last, mut looks) = ("", 0);
    each_interval(stopped, || {
        let (stage, done, total) = watch.progress();
        looks += 1;
        if stage != last || looks > PATIENCE {
            match total {
                0 => tell(format_args!("{stage} …")),
                _ => tell(format_args!("{stage}: {done} of {total}")),
            }
            (last, looks) = (stage, 0);
        }
    });
}
