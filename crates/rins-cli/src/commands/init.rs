//! `rins init`: drafts a rig file from a log.

use crate::args::Init;
use crate::outcome::Outcome;

pub(crate) fn run(_arguments: &Init) -> anyhow::Result<Outcome> {
    anyhow::bail!("not yet")
}
