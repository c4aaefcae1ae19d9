//! What was found in a run about any axis, by the names of the sensors' own axes.

use rins_frames::SignedAxes;
use rins_terms::{TermInstance, own_channel};

use crate::criticism::unexplained::Unexplained;
use crate::generic::disturbance::CHANNELS;
use crate::verdict::cause::Cause;
use crate::verdict::limits::Limit;

impl Cause {
    /// The same along the sensors' own axes, if it was found in a run with these axes.
    ///
    /// Its rivals' settings stay as they were sought.
    #[must_use]
    pub fn along_own(&self, axes: &SignedAxes) -> Self {
        let mut own = self.clone();
        let mut chosen = TermInstance::new(self.term);
        chosen.settings.clone_from(&self.settings);
        own.settings = self.term.own_settings(&self.settings, axes);
        own.parameters = self.parameters.iter().map(|e| e.along_own(&chosen, axes)).collect();
        let order = self.term.own_order(axes);
        let rank = |place: usize| order.iter().position(|other| *other == place);
        own.parameters.sort_by_key(|e| (e.run, rank(e.parameter.parameter)));
        own
    }
}

impl Unexplained {
    /// The same along the sensors' own axes, if it was found in a run with these axes.
    ///
    /// Attitude and velocity are along the axis frame's axes, whose z is the axis of rotation.
    #[must_use]
    pub fn along_own(&self, axes: &SignedAxes) -> Self {
        let mut own = self.clone();
        let name = own_channel(self.channel, axes);
        if let Some(channel) = CHANNELS.into_iter().find(|channel| *channel == name) {
            own.channel = channel;
        }
        for (id, _) in &mut own.worst {
            *id = own_channel(id, axes);
        }
        own
    }
}

impl Limit {
    /// The id of its parameter along the sensors' own axes, if it is of a run with these axes.
    pub fn own_id(&self, axes: &SignedAxes) -> String {
        format!("{}.{}", self.term.id, self.term.own_name(self.parameter, axes))
    }
}
