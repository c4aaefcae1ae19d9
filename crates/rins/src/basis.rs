//! The basis of a result: its inputs, what was repaired in them, and what was assumed.

use rins_io::{InputFile, Measured, Provenance, Rig, shown};
use rins_report::{Cell, Column, Item, Section, Table};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::log::{Log, measured};

/// The version of this program.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The basis of a result: its inputs, what was repaired in them, and what was assumed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BasisResult {
    /// The program, its inputs, the item and its measurement.
    pub provenance: ProvenanceResult,
    /// What reading the logs has repaired or left out.
    pub repairs: Vec<String>,
    /// What was neither measured nor stated, and therefore assumed.
    pub assumptions: Vec<String>,
}

/// The program, its inputs, the item and its measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProvenanceResult {
    /// The version of rins.
    pub version: String,
    /// The files that were read.
    pub inputs: Vec<InputResult>,
    /// The IMU; a property in which the inputs differ is null.
    pub item: ItemResult,
    /// The measurements, one per log or calibration file.
    pub measured: Vec<MeasurementResult>,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct InputResult {
    /// Its path, as it was given.
    pub path: String,
    /// The SHA-256 of its content, 64 hexadecimal digits.
    pub sha256: String,
}

/// The IMU of a measurement; what is not stated is null.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ItemResult {
    /// Its maker.
    pub maker: Option<String>,
    /// Its model.
    pub model: Option<String>,
    /// Its serial number.
    pub serial: Option<String>,
}

/// A measurement (ISO/IEC 17025:2017, 7.8.2 and 7.8.4); what is not stated is null.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasurementResult {
    /// The rig file or calibration file that states it.
    pub file: String,
    /// The id of the run.
    pub run: Option<String>,
    /// When it started (RFC 3339).
    pub started: Option<String>,
    /// The name of the power-on.
    pub series: Option<String>,
    /// The smallest and largest temperature of the log \[°C\]; the mean twice if only that is known.
    pub temperature_degc: Option<[f64; 2]>,
    /// The laboratory.
    pub laboratory: Option<String>,
    /// The operator.
    pub operator: Option<String>,
    /// The procedure.
    pub procedure: Option<String>,
}

impl BasisResult {
    /// Of these files alone.
    pub(crate) fn of_files(inputs: impl IntoIterator<Item = InputFile>) -> Self {
        let inputs = inputs.into_iter().map(InputResult::from).collect();
        let version = VERSION.into();
        let provenance = ProvenanceResult { version, inputs, ..ProvenanceResult::default() };
        Self { provenance, ..Self::default() }
    }

    /// Of a log; an estimation adds its assumptions.
    pub(crate) fn of_log(log: &Log) -> Self {
        let loaded = &log.loaded;
        let temperature = loaded.recording.temperature.as_deref().unwrap_or_default();
        let extreme = |pick: fn(f64, f64) -> f64| temperature.iter().copied().reduce(pick);
        let range = extreme(f64::min).zip(extreme(f64::max)).map(|(low, high)| [low, high]);
        let mut basis = Self::of_rig(&loaded.rig, log.inputs.clone());
        for measured in &mut basis.provenance.measured {
            measured.file.clone_from(&log.name);
            measured.temperature_degc = range;
        }
        Self { repairs: log.repairs(), ..basis }
    }

    /// Of a rig and the files that it names.
    pub(crate) fn of_rig(rig: &Rig, inputs: Vec<InputFile>) -> Self {
        let run = &rig.run;
        let mut basis = Self::of_files(inputs);
        basis.provenance.item = ItemResult {
            maker: run.maker.clone(),
            model: run.model.clone(),
            serial: run.serial.clone(),
        };
        let measured = MeasurementResult::of(shown(&rig.path), &measured(rig, []));
        basis.provenance.measured = vec![MeasurementResult { run: run.id.clone(), ..measured }];
        basis
    }

    /// Of a calibration file.
    pub(crate) fn of_calibration(file: InputFile, measured: &Measured) -> Self {
        let name = shown(&file.path);
        let mut basis = Self::of_files([file]);
        basis.provenance.item.serial.clone_from(&measured.serial);
        basis.provenance.measured = vec![MeasurementResult::of(name, measured)];
        basis
    }

    /// With these assumptions beside its own.
    #[must_use]
    pub(crate) fn assuming(mut self, assumptions: impl IntoIterator<Item = String>) -> Self {
        self.assumptions.extend(assumptions);
        self
    }

    /// With further files beside its own.
    #[must_use]
    pub(crate) fn with_files(mut self, files: impl IntoIterator<Item = InputFile>) -> Self {
        self.provenance.inputs.extend(files.into_iter().map(InputResult::from));
        self
    }

    /// Of all of these together.
    pub(crate) fn together<'b>(each: impl IntoIterator<Item = &'b Self>) -> Self {
        let each: Vec<&Self> = each.into_iter().collect();
        let several = each.len() > 1;
        let mut all = Self::of_files([]);
        for (place, one) in each.iter().enumerate() {
            let Self { provenance, repairs, assumptions } = one;
            for input in &provenance.inputs {
                if !all.provenance.inputs.contains(input) {
                    all.provenance.inputs.push(input.clone());
                }
            }
            all.provenance.measured.extend(provenance.measured.iter().cloned());
            all.provenance.item = match place {
                0 => provenance.item.clone(),
                _ => all.provenance.item.shared(&provenance.item),
            };
            all.repairs.extend(repairs.iter().cloned());
            let name = provenance.measured.first().map(|one| one.file.as_str());
            all.assumptions.extend(assumptions.iter().map(|assumption| match name {
                Some(name) if several => format!("{name}: {assumption}"),
                _ => assumption.clone(),
            }));
        }
        all
    }

    /// What a calibration file states of it.
    pub(crate) fn provenance(&self) -> Provenance {
        let inputs = self.provenance.inputs.iter().map(|input| InputFile {
            path: input.path.clone().into(),
            sha256: input.sha256.clone(),
        });
        Provenance { version: Some(self.provenance.version.clone()), inputs: inputs.collect() }
    }

    /// The section of a report; properties that are not stated are shown as such.
    pub(crate) fn section(&self) -> Section {
        let ProvenanceResult { version, inputs, item, measured } = &self.provenance;
        let stated = |text: Option<&String>| {
            Cell::text(text.map_or("not stated", String::as_str).to_owned())
        };
        let mut items = Vec::new();
        let rows = inputs.iter().map(|one| vec![Cell::text(&one.path), Cell::text(&one.sha256)]);
        items.push(Item::Table(Table {
            caption: format!("Files read by rins {version}"),
            columns: vec![Column::text("file"), Column::id("SHA-256")],
            rows: rows.collect(),
        }));
        let temperature = |one: &MeasurementResult| {
            one.temperature_degc.map(|[low, high]| format!("{low:.1} to {high:.1}"))
        };
        let rows = measured.iter().map(|one| {
            vec![
                Cell::text(&one.file),
                stated(item.maker.as_ref()),
                stated(item.model.as_ref()),
                stated(item.serial.as_ref()),
                stated(one.started.as_ref()),
                stated(temperature(one).as_ref()),
                stated(one.laboratory.as_ref()),
                stated(one.operator.as_ref()),
                stated(one.procedure.as_ref()),
            ]
        });
        let columns = ["measurement", "maker", "model", "serial number", "date"].into_iter();
        let columns = columns.chain(["temperature [°C]", "laboratory", "operator", "procedure"]);
        if !measured.is_empty() {
            items.push(Item::Table(Table {
                caption: "Item and measurement (ISO/IEC 17025:2017, 7.8.2)".into(),
                columns: columns.map(Column::text).collect(),
                rows: rows.collect(),
            }));
        }
        items.extend(self.assumptions.iter().map(|told| Item::Text(format!("Assumed: {told}"))));
        Section { heading: "Provenance".into(), intro: String::new(), items }
    }
}

impl MeasurementResult {
    /// What this file states of when and how a measurement was made.
    fn of(file: String, measured: &Measured) -> Self {
        let Measured { laboratory, .. } = measured;
        Self {
            file,
            run: None,
            started: measured.started.as_ref().map(|started| started.text.clone()),
            series: measured.series.clone(),
            temperature_degc: measured.temperature.map(|mean| [mean; 2]),
            laboratory: laboratory.name.clone(),
            operator: laboratory.operator.clone(),
            procedure: laboratory.procedure.clone(),
        }
    }
}

impl ItemResult {
    /// What both state alike.
    fn shared(&self, other: &Self) -> Self {
        let same =
            |own: &Option<String>, other: &Option<String>| own.clone().filter(|_| own == other);
        Self {
            maker: same(&self.maker, &other.maker),
            model: same(&self.model, &other.model),
            serial: same(&self.serial, &other.serial),
        }
    }
}

impl From<InputFile> for InputResult {
    fn from(file: InputFile) -> Self {
        Self { path: shown(&file.path), sha256: file.sha256 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_that_are_read_twice_are_listed_once_and_an_item_is_what_all_share() {
        let folder = tempfile::tempdir().unwrap();
        let mut log = crate::demo::log(folder.path()).unwrap();
        log.loaded.rig.run.serial = Some("A".into());
        log.loaded.rig.run.maker = Some("M".into());
        let first = BasisResult::of_log(&log).assuming(["level".to_owned()]);
        log.loaded.rig.run.serial = Some("B".into());
        let second = BasisResult::of_log(&log);
        let both = BasisResult::together([&first, &second]);
        assert_eq!(both.provenance.inputs.len(), 2);
        assert_eq!(both.provenance.measured.len(), 2);
        assert_eq!(
            (both.provenance.item.serial, both.provenance.item.maker),
            (None, Some("M".into()))
        );
        assert_eq!(both.assumptions, [format!("{}: level", log.name)]);
        assert_eq!(BasisResult::together([&first]), first);
    }
}
