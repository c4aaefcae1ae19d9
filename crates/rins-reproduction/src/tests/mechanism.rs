//! Eqs. (6), (8), (9) over a small grid, and the sensitivity of its bounds.

use crate::grid::{Errors, Row, grid};

#[test]
fn no_bound_is_broken() {
    let rows =
        grid(&[9.0, 90.0], &[[30.0, 20.0, 40.0], [-60.0, 45.0, 160.0]], &[10.0, -5.0]).unwrap();
    assert_eq!(rows.len(), 8);
    let broken: Vec<String> = rows.iter().flat_map(Row::broken).collect();
    assert!(broken.is_empty(), "{broken:?}");
}

#[test]
fn each_bound_breaks_for_a_form_that_is_wrong() {
    let row = grid(&[90.0], &[[30.0, 20.0, 40.0]], &[10.0]).unwrap()[0];
    let scaled = |errors: Errors, factor: f64| Errors {
        velocity: errors.velocity * factor,
        attitude: errors.attitude * factor,
    };
    let broken = |row: Row| row.broken().len();
    assert_eq!(broken(row), 0);
    // As if the printed sign were right.
    assert_eq!(broken(Row { printed: row.corrected, ..row }), 1);
    assert_eq!(broken(Row { extended: scaled(row.extended, 1.01), ..row }), 1);
    assert_eq!(broken(Row { flat: scaled(row.flat, 1.01), ..row }), 1);
    assert_eq!(broken(Row { integration: f64::NAN, ..row }), 1);
    let off = row.broken();
    assert!(off.is_empty());
    let message = Row { printed: row.corrected, ..row }.broken().remove(0);
    assert!(message.contains("at 90 s, 10 deg/s, roll 30, pitch 20, yaw 40 deg"), "{message}");
}
