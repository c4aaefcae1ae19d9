//! Static intervals that the user states, and contradictions to them in the samples.

use std::ops::Range;

use super::bias::turning;
use super::interval::{NotStatic, StaticInterval};
use super::search::Search;
use super::split::SIGMAS;

impl Search<'_> {
    /// The intervals that the user states, and the contradictions to them.
    pub(super) fn stated(&self) -> Vec<StaticInterval> {
        let recording = self.recording;
        let slack = 0.5 * self.cells.interval;
        let stated = self.options.stated.iter().map(|&[from, to]| {
            let times = recording.times.iter().zip(&recording.increments);
            let inside =
                |time: f64, interval: f64| time - interval >= from - slack && time <= to + slack;
            let mut samples = times
                .enumerate()
                .filter(|(_, (time, sample))| inside(**time, sample.interval))
                .map(|(index, _)| index);
            let Some(first) = samples.next() else {
                let why = Some(NotStatic::NoSamples);
                return StaticInterval {
                    span: 0..0,
                    start: from,
                    end: to,
                    why,
                    stated: false,
                    disturbances: Vec::new(),
                };
            };
            let span = first..samples.next_back().unwrap_or(first) + 1;
            let why = self.contradiction(&span);
            self.of_samples(span, why, true, Vec::new())
        });
        stated.collect()
    }

    /// The reason why a span is not static.
    fn contradiction(&self, span: &Range<usize>) -> Option<NotStatic> {
        let cells = &self.cells;
        let inside = |cell: usize| {
            let samples = &cells.cells[cell].span;
            samples.start >= span.start && samples.end <= span.end
        };
        let first = (0..cells.len()).find(|cell| inside(*cell))?;
        let end = (first..cells.len()).take_while(|cell| inside(*cell)).last()? + 1;
        let run = first..end;
        if self.table.as_ref().is_some_and(|table| !table[run.clone()].iter().all(|stands| *stands))
        {
            return Some(NotStatic::TableTurns);
        }
        let lasting = cells.duration(&run);
        let sway = self.options.largest_sway;
        let [angle, _] = cells.excursion(&run, cells.rate(&run), cells.force(&run));
        if angle > sway + SIGMAS * self.noise.rate(lasting) * lasting {
            return Some(NotStatic::Rotates { angle });
        }
        let size = (2 * cells.window).min(run.len());
        let start = cells.up(&(run.start..run.start + size));
        let noise = SIGMAS * self.noise.force(cells.duration(&(run.start..run.start + size)))
            / cells.force(&run).norm().max(1e-9);
        let angle = (run.start..=run.end - size)
            .map(|at| cells.up(&(at..at + size)).angle(&start))
            .fold(0.0, f64::max);
        if angle > sway + 2.0 * noise {
            return Some(NotStatic::GravityTurns { angle });
        }
        if self.table.is_some() {
            return None;
        }
        turning(&[self.piece(&run)], self.options).pop().flatten()
    }
}
