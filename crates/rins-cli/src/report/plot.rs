//! What a plot shows, before it is prepared for display.

/// Curves over a common abscissa.
///
/// Abscissae ascend; a sample whose abscissa is not finite is left out and the caption counts it.
/// An ordinate that is not finite, or not positive on a logarithmic scale, is a gap.
/// Of an abscissa and an ordinate of different lengths the common beginning is drawn.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Plot {
    /// What is shown.
    pub(crate) title: String,
    /// The abscissa with its unit in brackets, such as "Time \[s\]".
    pub(crate) x_label: String,
    /// The ordinate with its unit in brackets.
    pub(crate) y_label: String,
    /// How the abscissa is divided.
    pub(crate) x_scale: Scale,
    /// How the ordinate is divided.
    pub(crate) y_scale: Scale,
    /// The curves, the last one on top.
    pub(crate) series: Vec<Series>,
    /// Shaded regions behind the curves, such as ±3σ.
    pub(crate) bands: Vec<Band>,
    /// Horizontal lines with a name; always in view until the reader zooms.
    pub(crate) references: Vec<Reference>,
    /// What to see in it; may be empty.
    pub(crate) caption: String,
}

/// How an axis is divided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Scale {
    /// Equal steps are equal differences.
    #[default]
    Linear,
    /// Equal steps are equal ratios; powers of ten are marked.
    Logarithmic,
}

/// A curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Series {
    /// Its name in the legend.
    pub(crate) name: String,
    /// Abscissae, ascending, in the unit of the plot's label.
    pub(crate) x: Vec<f64>,
    /// Ordinates, in the unit of the plot's label.
    pub(crate) y: Vec<f64>,
    /// How it is drawn.
    pub(crate) style: Style,
}

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Style {
    /// Samples joined by a line.
    #[default]
    Line,
    /// Samples joined by a broken line.
    Dashed,
    /// Each sample a dot, not joined.
    Points,
    /// Each sample held until the next.
    Steps,
}

/// The region between two curves.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Band {
    /// Its name in the legend, such as "±3σ".
    pub(crate) name: String,
    /// Abscissae, ascending, in the unit of the plot's label.
    pub(crate) x: Vec<f64>,
    /// The lower edge, in the unit of the plot's label.
    pub(crate) lower: Vec<f64>,
    /// The upper edge, in the unit of the plot's label.
    pub(crate) upper: Vec<f64>,
}

/// A horizontal line.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Reference {
    /// Its name, written on the line.
    pub(crate) name: String,
    /// Where it lies, in the unit of the ordinate.
    pub(crate) value: f64,
}
