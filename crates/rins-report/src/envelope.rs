//! Thinning of long curves for display that preserves all peaks.

/// The rows to be drawn of columns with one ascending abscissa: all if they are few, otherwise, for each of `n_buckets`
/// equal divisions of the abscissa, the minimum and the maximum of every column and its first gap.
///
/// `position` maps the abscissa to its position in the plot (the identity, or a logarithm). The first and the last row
/// are always included. Rows are in ascending order. A value that is not finite is a gap.
pub(super) fn rows_to_draw(
    abscissa: &[f64],
    columns: &[&[f64]],
    n_buckets: usize,
    position: fn(f64) -> f64,
) -> Vec<usize> {
    let n_rows = abscissa.len();
    let few = 2 * n_buckets * columns.len().max(1);
    if n_rows <= few {
        return (0..n_rows).collect();
    }
    let start = position(abscissa[0]);
    let width = (position(abscissa[n_rows - 1]) - start) / n_buckets as f64;
    let bucket_of = |row: usize| ((position(abscissa[row]) - start) / width).floor();
    let share = |a: f64, b: f64| a.total_cmp(&b).is_eq() && a.is_finite();
    let mut kept = vec![0];
    let mut first = 0;
    while first < n_rows {
        let bucket = bucket_of(first);
        // A width of zero makes every bucket NaN, which is not equal to itself: then each row has its own bucket.
        let next = (first + 1..n_rows).take_while(|row| share(bucket_of(*row), bucket));
        let length = 1 + next.count();
        let begin = kept.len();
        for column in columns {
            kept.extend(extremes(&column[first..first + length]).map(|row| first + row));
        }
        kept[begin..].sort_unstable();
        first += length;
    }
    kept.push(n_rows - 1);
    kept.dedup();
    kept
}

/// The indices of the minimum, of the maximum and of the first gap of a column.
fn extremes(column: &[f64]) -> impl Iterator<Item = usize> {
    let (mut least, mut greatest, mut gap) = (None, None, None);
    for (row, value) in column.iter().enumerate() {
        if !value.is_finite() {
            gap = gap.or(Some(row));
            continue;
        }
        if least.is_none_or(|least: usize| *value < column[least]) {
            least = Some(row);
        }
        if greatest.is_none_or(|greatest: usize| *value > column[greatest]) {
            greatest = Some(row);
        }
    }
    [least, greatest, gap].into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(value: f64) -> f64 {
        value
    }

    fn times(n: usize) -> Vec<f64> {
        (0..n).map(|row| row as f64 * 0.01).collect()
    }

    #[test]
    fn few_rows_are_all_drawn() {
        assert_eq!(rows_to_draw(&times(20), &[&[1.0; 20]], 10, identity).len(), 20);
        assert_eq!(rows_to_draw(&[], &[&[]], 10, identity), Vec::<usize>::new());
        assert_eq!(rows_to_draw(&[1.0], &[], 0, identity), vec![0]);
    }

    #[test]
    fn every_single_sample_spike_survives_in_every_column() {
        let n = 100_000;
        let time = times(n);
        let smooth: Vec<f64> = time.iter().map(|t| (t / 40.0).sin()).collect();
        for spike in [1, 777, 50_000, n - 2] {
            for (column, height) in [(0, 5.0), (1, -5.0)] {
                let mut columns = [smooth.clone(), smooth.clone()];
                columns[column][spike] = height;
                let rows = rows_to_draw(&time, &[&columns[0], &columns[1]], 500, identity);
                assert!(rows.contains(&spike), "spike at {spike} of column {column} was lost");
                assert!(rows.len() < 2 * 2 * 500 + 3, "{} rows", rows.len());
            }
        }
    }

    #[test]
    fn a_single_gap_survives_and_rows_ascend_without_repeats() {
        let n = 50_000;
        let mut column: Vec<f64> = times(n).iter().map(|t| t.cos()).collect();
        column[31_234] = f64::NAN;
        let rows = rows_to_draw(&times(n), &[&column], 400, identity);
        assert!(rows.contains(&31_234), "the gap was lost");
        assert!(rows.windows(2).all(|pair| pair[0] < pair[1]), "rows do not ascend");
        assert_eq!((rows[0], rows[rows.len() - 1]), (0, n - 1));
    }

    #[test]
    fn a_decade_of_a_logarithmic_abscissa_gets_its_share() {
        // Half of the drawn width is below 0.1, although only one sample in a thousand is.
        let abscissa: Vec<f64> = (1..=100_000).map(|row| f64::from(row) * 1e-3).collect();
        let column: Vec<f64> = (1..=100_000).map(|row| f64::from(row % 7)).collect();
        let rows = rows_to_draw(&abscissa, &[&column], 1000, f64::ln);
        let below = rows.iter().filter(|row| abscissa[**row] < 0.1).count();
        assert_eq!(below, 99, "every one of the few samples below 0.1 is drawn");
    }

    #[test]
    fn an_abscissa_that_does_not_advance_is_drawn_in_full() {
        let rows = rows_to_draw(&[3.0; 1000], &[&[0.5; 1000]], 10, identity);
        assert_eq!(rows.len(), 1000);
    }
}
