//! What a misspelt word may have meant: the nearest known word by edit distance.

/// The known word nearest to `word`, if it is near enough to have been meant: a third of its letters wrong at the most.
pub(super) fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let distances = known.iter().map(|&k| (edits(word, k), k));
    let (distance, best) = distances.min_by_key(|&(distance, _)| distance)?;
    let letters = best.chars().count().max(word.chars().count());
    (distance <= letters.div_ceil(3)).then_some(best)
}

/// `; did you mean …?` where a known word is near, and the known words in any case.
pub(super) fn suggestion(word: &str, known: &[&str]) -> String {
    let meant = nearest(word, known).map(|best| format!("did you mean `{best}`? "));
    format!("{}known: {}", meant.unwrap_or_default(), list(known))
}

/// Words between back quotes, with commas.
pub(super) fn list(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// Levenshtein's distance: letters put in, left out or changed.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, other) in b.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_count_letters_put_in_left_out_and_changed() {
        assert_eq!(edits("", "iso"), 3);
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("colour", "color"), 1);
    }

    #[test]
    fn a_near_word_is_suggested_and_a_far_one_is_not() {
        assert_eq!(nearest("opacty", &["color", "opacity"]), Some("opacity"));
        assert_eq!(nearest("banana", &["color", "opacity"]), None);
    }
}
