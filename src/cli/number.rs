//! Numbers as tables print them.

/// Six digits at the most.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e9).contains(&size) {
        return format!("{value:.4e}");
    }
    let before = if size >= 1.0 { size.log10() as usize + 1 } else { 1 };
    let text = format!("{value:.*}", 6_usize.saturating_sub(before));
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
