//! Questions of a page, and their answers.

mod answer;
mod question;
mod running;

pub use answer::answer;
pub use running::Host;
