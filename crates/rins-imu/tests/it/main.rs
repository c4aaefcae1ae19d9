//! The statistics of the noise against what its coefficients mean.
mod noise;
