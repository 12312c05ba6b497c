//! Cases that were right from the start and stay so.
