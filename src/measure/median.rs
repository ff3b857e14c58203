//! The middle one of some numbers.

/// The median: of an even count the greater of the two in the middle; 0 of none. A NaN counts as greater than all.
#[must_use]
pub fn median(numbers: &[f64]) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_numbers_are_no_greater_than_their_median() {
        assert_eq!([median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0])], [2.0, 4.0]);
        assert_eq!([median(&[]), median(&[f64::NAN, 1.0, 5.0])], [0.0, 5.0]);
    }
}
