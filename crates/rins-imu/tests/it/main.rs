//! The statistics of the noise against the meaning of its parameters.
mod noise;
