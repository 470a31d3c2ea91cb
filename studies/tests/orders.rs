//! The order in which each model tends to the one below it: the rows of the accuracy table.

use clatter_studies::{orders, residues};

/// The order holds between all steps, not only between the last two.
#[test]
fn every_model_tends_to_its_limit_in_the_order_that_theory_gives() {
    let rows = orders().expect("valid scenes");
    assert_eq!(rows.len(), 5, "rows");
    for row in rows {
        for pair in row.steps.windows(2) {
            let order = (pair[0].1 / pair[1].1).ln() / (pair[0].0 / pair[1].0).ln();
            // The next term of the largest step: 4° of tilt, a hundredth of h0/v0 of contact.
            assert!((order - row.expected).abs() < 0.05, "{order}: {row:?}");
        }
        let (_, last) = row.steps[row.steps.len() - 1];
        assert!(last > 1e-12, "nothing left to measure: {row:?}");
        assert!((row.measured() - row.expected).abs() < 0.01, "{}: {row:?}", row.measured());
    }
}

#[test]
fn only_rounding_is_left_where_models_agree() {
    let rows = residues().expect("valid scenes");
    assert_eq!(rows.len(), 5, "rows");
    for row in rows {
        assert!(row.value <= row.allowed, "{row:?}");
        assert!(row.value > 0.0, "compared with itself: {row:?}");
    }
}
