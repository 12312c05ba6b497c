#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::float_cmp, reason = "exactly equal is what is meant")]

mod limits;
mod oracle;
mod periodic;
mod random;
mod single;
mod soup;
mod watertight;
