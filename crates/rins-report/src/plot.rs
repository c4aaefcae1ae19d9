//! The content of a plot, before it is prepared for display.

/// Curves over a common abscissa.
///
/// Abscissae ascend; a sample whose abscissa is not finite is omitted and counted in the caption.
/// An ordinate that is not finite, or not positive on a logarithmic scale, is a gap.
/// If abscissa and ordinate have different lengths, the common beginning is drawn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// The title.
    pub title: String,
    /// The abscissa with its unit in brackets, such as "Time \[s\]".
    pub x_label: String,
    /// The ordinate with its unit in brackets.
    pub y_label: String,
    /// The scale of the abscissa.
    pub x_scale: Scale,
    /// The scale of the ordinate.
    pub y_scale: Scale,
    /// The curves, the last one on top.
    pub series: Vec<Series>,
    /// Shaded regions behind the curves, such as ±3σ.
    pub bands: Vec<Band>,
    /// Horizontal lines with a name; always in the visible range until the reader zooms.
    pub references: Vec<Reference>,
    /// What the reader should notice; may be empty.
    pub caption: String,
}

/// The scale of an axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equal differences.
    #[default]
    Linear,
    /// Equal steps are equal ratios; powers of ten are marked.
    Logarithmic,
}

/// A curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Abscissae, ascending, in the unit of the plot's label.
    pub x: Vec<f64>,
    /// Ordinates, in the unit of the plot's label.
    pub y: Vec<f64>,
    /// The style.
    pub style: Style,
}

/// The style of a curve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Style {
    /// Samples joined by a line.
    #[default]
    Line,
    /// Samples joined by a dashed line.
    Dashed,
    /// A dot for each sample, not joined.
    Points,
    /// Each sample held until the next.
    Steps,
}

/// The region between two curves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Band {
    /// Its name in the legend, such as "±3σ".
    pub name: String,
    /// Abscissae, ascending, in the unit of the plot's label.
    pub x: Vec<f64>,
    /// The lower edge, in the unit of the plot's label.
    pub lower: Vec<f64>,
    /// The upper edge, in the unit of the plot's label.
    pub upper: Vec<f64>,
}

/// A horizontal line.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reference {
    /// Its name, written on the line.
    pub name: String,
    /// Its ordinate, in the unit of the plot's label.
    pub value: f64,
}
