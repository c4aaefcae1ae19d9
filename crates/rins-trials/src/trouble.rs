//! Why trials cannot go on.

use crate::stand::StandError;

/// Why trials cannot go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Trouble {
    /// A file or the program.
    #[error("a file or the program cannot be used")]
    File(#[from] std::io::Error),
    /// A model file.
    #[error("a model cannot be written")]
    Model(#[from] rins_io::IoError),
    /// A record that is none.
    #[error("a record cannot be read or written")]
    Record(#[from] serde_json::Error),
    /// A trial that cannot be made.
    #[error("a trial cannot be made")]
    Trial(#[from] StandError),
    /// A simulated history that cannot be analyzed.
    #[error("a history cannot be analyzed")]
    History(#[from] rins_history::HistoryError),
    /// Journals of different trials.
    #[error(
        "trial {index} has the seed {seed} or is timed, expected a blind trial of seed {expected}"
    )]
    Foreign {
        /// Its index.
        index: u64,
        /// Its seed.
        seed: u64,
        /// The seed of the first trial.
        expected: u64,
    },
    /// Journals that are not those of all shards.
    #[error("trial {index} where trial {expected} is expected, which is missing or there twice")]
    Trials {
        /// The index that was found.
        index: u64,
        /// The index expected.
        expected: u64,
    },
    /// Frozen trials that came out otherwise.
    #[error("{wrong} of {of} frozen trials did not come out as before")]
    Frozen {
        /// How many.
        wrong: usize,
        /// Of how many.
        of: usize,
    },
}

impl Trouble {
    /// The error and its causes, separated by colons.
    pub fn with_causes(&self) -> String {
        let mut text = self.to_string();
        let mut cause = std::error::Error::source(self);
        while let Some(why) = cause {
            text = format!("{text}: {why}");
            cause = why.source();
        }
        text
    }
}
