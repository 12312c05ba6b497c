//! What the validation tests share.
