//! The Pareto front: what no other choice beats in both cost and error.

/// The choices that are on the front, cheapest first: of each `[cost, error]`, both the less the better. Choices that are
/// not numbers are not on it; of equal ones the first is.
#[must_use]
pub fn front(choices: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..choices.len()).collect();
    order.retain(|&at| choices[at].iter().all(|number| !number.is_nan()));
    order.sort_by(|&a, &b| {
        let [a, b] = [choices[a], choices[b]];
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    });
    let mut least = None;
    order.retain(|&at| {
        let better = least.is_none_or(|least| choices[at][1] < least);
        if better {
            least = Some(choices[at][1]);
        }
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beaten_in_both_is_not_on_the_front() {
        let choices = [[3.0, 0.1], [1.0, 0.5], [2.0, 0.5], [2.0, 0.3], [4.0, 0.2], [f64::NAN, 0.0]];
        assert_eq!(front(&choices), [1, 3, 0]);
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn of_equal_choices_one_is_on_the_front() {
        assert_eq!(front(&[[1.0, 1.0], [1.0, 1.0]]), [0]);
        assert_eq!(front(&[[1.0, 0.0], [2.0, f64::INFINITY]]), [0]);
    }
}
