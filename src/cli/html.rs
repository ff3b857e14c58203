//! Pages that need nothing but themselves: style, text, tables and pictures in one file, in the dark and on a phone too.

use std::fmt::Write;

/// Ink, paper and sizes; plots are drawn in the colors of [`plot`](super::plot) and take these.
const STYLE: &str = "
:root { color-scheme: light dark; --ink: #1c1c1c; --paper: #fdfdfb; --quiet: #6a6a6a; --line: #d8d8d4; --dot: #2b6cb0; --front: #c05621 }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e6e3; --paper: #161616; --quiet: #a0a0a0; --line: #3a3a3a; --dot: #63b3ed; --front: #f6ad55 } }
* { box-sizing: border-box }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); max-width: 66rem; margin: auto; padding: 1rem }
h1 { font-size: 1.6rem; line-height: 1.2 } h2 { font-size: 1.25rem; margin-top: 2.5rem; border-top: 1px solid var(--line); padding-top: 1rem }
.wide { overflow-x: auto } .wide svg { display: block; width: 100%; min-width: 36rem; height: auto }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums }
td, th { padding: .2rem .7rem .2rem 0; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line) }
td.text, th.text { text-align: left } td.text { white-space: normal; min-width: 9rem } th { color: var(--quiet); font-weight: 500 } tr.front { font-weight: 600 }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 19rem), 1fr)); gap: 1.5rem }
figure { margin: 0 } figure img { display: block; width: 100%; height: auto; background: #000; border-radius: 4px }
figure.rays img { filter: brightness(6) }
figcaption { font-size: .875rem; margin-top: .5rem } blockquote { margin: .4rem 0; padding-left: .7rem; border-left: 3px solid var(--line); color: var(--quiet) }
code { font-size: .8rem; overflow-wrap: anywhere } .quiet { color: var(--quiet) }
.two { display: grid; grid-template-columns: 1fr 1fr; gap: 4px }
.slider { position: relative; max-width: 30rem; --at: 50% } .slider .over { position: absolute; inset: 0; clip-path: inset(0 calc(100% - var(--at)) 0 0) }
.slider .edge { position: absolute; top: 0; bottom: 0; left: var(--at); width: 2px; margin-left: -1px; background: var(--front); pointer-events: none }
.slider input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize }
.slider input:focus-visible ~ .edge { width: 4px; margin-left: -2px }
svg [fill=\"#010101\"] { fill: var(--ink) } svg [stroke=\"#010101\"] { stroke: var(--ink) } svg [stroke=\"#020202\"] { stroke: var(--line) }
svg [fill=\"#030303\"] { fill: var(--dot) } svg [fill=\"#040404\"] { fill: var(--front) } svg [stroke=\"#040404\"] { stroke: var(--front) } svg [fill=\"#050505\"] { fill: var(--quiet) }";

/// A page with a title and what is in its body.
pub fn page(title: &str, body: &str) -> String {
    let title = escaped(title);
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>{title}</title><style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n{body}</body></html>\n"
    )
}

/// Text within HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A table whose first row is its heading; columns named in `text` are flush on their left side, as the first is.
pub fn table<const N: usize>(rows: &[[String; N]], text: &[usize]) -> String {
    let mut html = "<div class=\"wide\"><table>\n".to_owned();
    for (at, row) in rows.iter().enumerate() {
        html.push_str("<tr>");
        for (column, cell) in row.iter().enumerate() {
            let tag = if at == 0 { "th" } else { "td" };
            let is_text = column == 0 || text.contains(&column);
            let class = if is_text { " class=\"text\"" } else { "" };
            let _ = write!(html, "<{tag}{class}>{}</{tag}>", escaped(cell));
        }
        html.push_str("</tr>\n");
    }
    html + "</table></div>\n"
}

/// A picture as part of the page.
pub fn image(png: &[u8], what: &str) -> String {
    format!("<img src=\"data:image/png;base64,{}\" alt=\"{}\">", base64(png), escaped(what))
}

/// Two pictures of the same size, one over the other up to where the reader drags the edge; a name each.
pub fn slider([left, right]: [&[u8]; 2], names: [&str; 2]) -> String {
    let [left, right] = [image(left, names[0]), image(right, names[1])];
    let said = escaped(&format!("from {} to {}", names[1], names[0]));
    format!(
        "<div class=\"slider\">{right}<div class=\"over\">{left}</div><input type=\"range\" min=\"0\" max=\"100\" step=\"0.1\" value=\"50\" aria-label=\"{said}\" oninput=\"this.parentNode.style.setProperty('--at',this.value+'%')\"><div class=\"edge\"></div></div>\n"
    )
}

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Bytes in letters, six bits each (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |at: usize| u32::from(three.get(at).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for at in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * at) & 63) as usize];
            text.push(if at <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_written_as_the_standard_writes_its_examples() {
        let pairs = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|t| base64(t.as_bytes()));
        assert_eq!(pairs, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
        assert_eq!(base64(&[255, 254, 253]), "//79");
    }

    #[test]
    fn text_cannot_become_markup() {
        let rows = [["a".to_owned()], ["<script>\"&".to_owned()]];
        assert!(table(&rows, &[]).contains("&lt;script&gt;&quot;&amp;"));
    }
}
