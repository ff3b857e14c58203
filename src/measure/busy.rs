//! Processor time of this program: what it took of the machine, however busy the machine is with others.

use std::fs::read_to_string;

/// Seconds that processors were busy with the threads that this program has now, all together; `None` where the system does
/// not tell. Of a thread that is running the last few milliseconds may not be counted yet.
#[must_use]
pub fn busy_seconds() -> Option<f64> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let nanoseconds = |task: std::io::Result<std::fs::DirEntry>| -> Option<u64> {
        let told = read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        told.split_whitespace().next()?.parse().ok()
    };
    // A thread that ended while it was looked at took what nobody can tell.
    let mut told = tasks.filter_map(nanoseconds).peekable();
    told.peek()?;
    Some(told.sum::<u64>() as f64 * 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processor_time_is_told_in_seconds() {
        // Other tests run beside this one, on threads that end: nothing can be said of differences.
        if let Some(busy) = busy_seconds() {
            assert!((0.0..1e7).contains(&busy), "{busy}");
        }
    }
}
