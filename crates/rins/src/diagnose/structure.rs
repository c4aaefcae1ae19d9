//! What no effect explains, in words.

use rins_diagnosis::{Stratum, Structure, Unexplained};

use rins_report::number::figure;

/// An order so near to a whole one is that one: a run of a hundred turns tells no finer.
const NEARLY: f64 = 5e-3;

/// What it looks like.
pub(super) fn structure_in_words(one: &Unexplained) -> String {
    match one.structure {
        Structure::Line(frequency) => format!("spectral line of {} Hz", figure(frequency, 4)),
        Structure::Chirp(from, to) => {
            format!("spectral line that moves from {} to {} Hz", figure(from, 3), figure(to, 3))
        }
        Structure::Order(order) => order_in_words(order),
        Structure::Modulated(order) => format!("{}, modulated", order_in_words(order)),
        Structure::Drift => "drift, slower than three periods in the run".into(),
        Structure::Waveform(frequency) => {
            format!("periodic with {} s, not sinusoidal", figure(1.0 / frequency, 3))
        }
        Structure::EveryTurn(highest) => {
            format!("periodic with one revolution, not sinusoidal: harmonic orders up to {highest}")
        }
        Structure::Switching(times) => format!("switches between two levels, {times} times"),
        Structure::Spread(along) => format!("spread that depends on {}", along_in_words(along)),
        Structure::Noisier(times) => {
            format!("noise {} times that of the other sensor across the axis", figure(times, 3))
        }
        Structure::Tails => "more outliers than normal noise has".into(),
        Structure::Shocks(1, at) => format!("shock at {at:.1} s"),
        Structure::Shocks(count, at) => {
            format!("{count} shocks, the strongest at {at:.1} s")
        }
        Structure::Inconstant(along) => {
            let of = one.of.unwrap_or("a cause");
            format!("{of} is not constant: it depends on {}", along_in_words(along))
        }
    }
}

/// How large it is, with its unit, if it is a signal.
pub(super) fn size_in_words(one: &Unexplained) -> Option<String> {
    let (amplitude, unit) = one.amplitude?;
    Some(format!("{} {}", figure(amplitude / unit.factor, 2), unit.symbol))
}

fn order_in_words(order: f64) -> String {
    let against = if order < 0.0 { ", against the table" } else { "" };
    let size = order.abs();
    if (size - size.round()).abs() > NEARLY {
        return format!("order {} in table angle{against}", figure(size, 3));
    }
    let size = size.round();
    let ending = match (size % 10.0, size % 100.0) {
        (_, 11.0..14.0) => "th",
        (1.0, _) => "st",
        (2.0, _) => "nd",
        (3.0, _) => "rd",
        _ => "th",
    };
    format!("{size}{ending} order in table angle{against}")
}

const fn along_in_words(along: Stratum) -> &'static str {
    match along {
        Stratum::Time => "time",
        Stratum::Sense => "the direction of rotation",
        Stratum::Rate => "the table's rate",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_ordinals() {
        assert_eq!(order_in_words(5.0), "5th order in table angle");
        assert_eq!(order_in_words(-2.0), "2nd order in table angle, against the table");
        assert_eq!(order_in_words(11.0), "11th order in table angle");
        assert_eq!(order_in_words(21.0), "21st order in table angle");
        assert_eq!(order_in_words(0.43), "order 0.430 in table angle");
    }
}
