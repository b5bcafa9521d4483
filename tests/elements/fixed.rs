//! Fixed joints: reactions that do no work, and a weld that carries a weight.

use crate::common::power::{assert_balance, pair, spatial_pair};

#[test]
fn its_reactions_do_no_work() {
    assert_balance(&pair("  j: { fixed: { between: [a.P, b.P], angle: 0.3 } }", "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }", ""), "0");
    assert_balance(&spatial_pair("  j: { fixed: { between: [a.P, b.P], angle: 0.3 } }", "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }", ""), "0");
}
