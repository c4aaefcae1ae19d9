//! The data that the page's script receives.

use super::*;
use crate::{Band, Reference, Series};
use serde_json::Value;

fn series(name: &str, x: Vec<f64>, y: Vec<f64>) -> Series {
    Series { name: name.into(), x, y, style: Style::Line }
}

fn read(plot: &Plot, n_points: usize) -> Value {
    serde_json::from_str(&Drawing::new(plot, n_points).to_json()).unwrap()
}

fn numbers(value: &Value) -> Vec<Option<f64>> {
    value.as_array().unwrap().iter().map(Value::as_f64).collect()
}

#[test]
fn curves_of_one_abscissa_share_it_and_bands_lie_below() {
    let x = vec![0.0, 1.0, 2.0];
    let plot = Plot {
        series: vec![
            series("estimate", x.clone(), vec![1.0, 2.0, 3.0]),
            series("truth", vec![0.0, 2.0], vec![1.5, 2.5]),
        ],
        bands: vec![Band {
            name: "±3σ".into(),
            x: x.clone(),
            lower: vec![-1.0; 3],
            upper: vec![4.0; 3],
        }],
        ..Plot::default()
    };
    let drawn = read(&plot, 4000);
    let groups = drawn["groups"].as_array().unwrap();
    assert_eq!(groups.len(), 2);
    assert_eq!(groups[0]["entries"][0]["style"], "band");
    assert_eq!(groups[0]["entries"][1]["name"], "estimate");
    assert_eq!(groups[0]["y"].as_array().unwrap().len(), 3);
    assert_eq!(numbers(&groups[1]["x"]), [Some(0.0), Some(2.0)]);
    assert_eq!(groups[1]["entries"][0]["colour"], 1);
}

#[test]
fn what_is_not_finite_is_a_gap_and_what_has_no_place_is_counted() {
    let x = vec![0.0, 1.0, f64::NAN, 3.0, 4.0];
    let y = vec![1.0, f64::NAN, 7.0, f64::INFINITY, 5.0];
    let plot = Plot {
        series: vec![series("a", x, y)],
        references: vec![Reference { name: "nowhere".into(), value: f64::NAN }],
        ..Plot::default()
    };
    let drawing = Drawing::new(&plot, 4000);
    assert_eq!((drawing.n_misplaced, drawing.thinned_from), (1, None));
    let drawn = read(&plot, 4000);
    assert_eq!(numbers(&drawn["groups"][0]["y"][0]), [Some(1.0), None, None, Some(5.0)]);
    assert_eq!(drawn["references"].as_array().unwrap().len(), 0);
}

#[test]
fn a_logarithmic_plot_has_no_room_for_zero_and_less() {
    let plot = Plot {
        series: vec![series("a", vec![-1.0, 0.0, 0.01, 100.0], vec![1.0, 1.0, 0.0, 2e-9])],
        x_scale: Scale::Logarithmic,
        y_scale: Scale::Logarithmic,
        ..Plot::default()
    };
    let drawn = read(&plot, 4000);
    assert_eq!(numbers(&drawn["groups"][0]["x"]), [Some(0.01), Some(100.0)]);
    assert_eq!(numbers(&drawn["groups"][0]["y"][0]), [None, Some(2e-9)]);
    assert_eq!(Drawing::new(&plot, 4000).n_misplaced, 2);
}

#[test]
fn samples_out_of_order_are_drawn_in_order() {
    let plot = Plot {
        series: vec![series("a", vec![2.0, 0.0, 1.0], vec![20.0, 0.0, 10.0])],
        ..Plot::default()
    };
    let drawn = read(&plot, 4000);
    assert_eq!(numbers(&drawn["groups"][0]["x"]), [Some(0.0), Some(1.0), Some(2.0)]);
    assert_eq!(numbers(&drawn["groups"][0]["y"][0]), [Some(0.0), Some(10.0), Some(20.0)]);
}

#[test]
fn lengths_that_differ_and_empty_curves_do_no_harm() {
    let plot = Plot {
        series: vec![series("a", vec![0.0, 1.0], vec![5.0]), series("b", vec![], vec![1.0])],
        ..Plot::default()
    };
    assert_eq!(numbers(&read(&plot, 4000)["groups"][0]["y"][0]), [Some(5.0)]);
    assert!(Drawing::new(&plot, 4000).has_samples());
    assert!(!Drawing::new(&Plot::default(), 4000).has_samples());
}

#[test]
fn thinning_keeps_within_its_points_and_owns_up() {
    let n = 200_000;
    let x: Vec<f64> = (0..n).map(|row| f64::from(row) * 0.01).collect();
    let y: Vec<f64> = x.iter().map(|t| (t * 12.3).sin()).collect();
    let plot = Plot { series: vec![series("a", x, y)], ..Plot::default() };
    let drawing = Drawing::new(&plot, 4000);
    assert_eq!(drawing.thinned_from, Some(200_000));
    let n_drawn = drawing.groups[0].x.len();
    assert!((3000..=4002).contains(&n_drawn), "{n_drawn} points");
}

#[test]
fn rounding_is_finer_than_a_pixel_and_keeps_small_variations_of_large_numbers() {
    let x: Vec<f64> = (0..1000).map(|row| 1.7e9 + f64::from(row) * 0.02).collect();
    let y: Vec<f64> = (0..1000).map(|row| 0.597_777_7 + 1e-9 * f64::from(row)).collect();
    let plot = Plot { series: vec![series("a", x.clone(), y.clone())], ..Plot::default() };
    let group = &Drawing::new(&plot, 4000).groups[0];
    // A ten-thousandth of the range is less than a pixel of any screen.
    for (drawn, given) in [(&group.x, &x), (&group.y[0], &y)] {
        let pixel = 1e-4 * (given[999] - given[0]);
        let worst = drawn.iter().zip(given).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < pixel, "off by {worst}, a pixel is {pixel}");
    }
    assert!(group.x.windows(2).all(|pair| pair[0] <= pair[1]), "abscissae out of order");
}
