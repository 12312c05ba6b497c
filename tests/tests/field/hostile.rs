//! Scenes that parse and were made to harm.
