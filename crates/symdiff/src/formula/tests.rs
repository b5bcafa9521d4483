use super::*;

fn value(text: &str) -> f64 {
    let builder = Builder::new();
    let built = Formula::parse(text).unwrap().build(&builder, |name| Err(name.to_owned())).unwrap();
    built.as_constant().unwrap()
}

#[test]
fn precedence_and_associativity_follow_mathematics() {
    assert_eq!(value("1 + 2*3"), 7.0);
    assert_eq!(value("10 - 4 - 3"), 3.0);
    assert_eq!(value("2^3^2"), 512.0);
    assert_eq!(value("-2^2"), -4.0);
    assert_eq!(value("2^-1"), 0.5);
    assert_eq!(value("12/3/2"), 2.0);
    assert_eq!(value("2*-3"), -6.0);
    assert_eq!(value("1.5e2 + .5 + 2."), 152.5);
    assert_eq!(value("max(1, 2) + min(3, 4) + abs(-1) + sign(-5)"), 5.0);
    assert!((value("sin(pi/6)") - 0.5).abs() < 1e-15);
    assert!((value("atan2(1, -1)") - 0.75 * std::f64::consts::PI).abs() < 1e-15);
}

#[test]
fn functions_with_steps_have_their_usual_values() {
    for (text, wanted) in [
        ("floor(2.5) + floor(-2.5)", -1.0),
        ("ceil(2.5) + 10*ceil(-2.5)", -17.0),
        ("round(2.5) + 10*round(-2.5) + 100*round(2.4)", 183.0),
        ("mod(7, 3) + 10*mod(-7, 3) + 100*mod(7, -3)", -179.0),
        ("if(1 < 2, 3, 4)", 3.0),
        ("if(2 <= 1, 3, 4)", 4.0),
        ("if(0, 3, 4) + if(2, 30, 40) + if(-1, 300, 400)", 434.0),
        ("clamp(5, 1, 3) + 10*clamp(-5, 1, 3) + 100*clamp(2, 1, 3)", 213.0),
        ("smoothstep(1, 3, 0) + 10*smoothstep(1, 3, 4) + 100*smoothstep(1, 3, 2)", 60.0),
        ("smoothstep(0, 1, 0.25)", 0.156_25),
        ("smoothstep(1, 0, 0.25)", 0.843_75),
        ("deg(pi - 1 + 1)", 180.0),
    ] {
        let value = match text.starts_with("deg") {
            true => built(text, std::f64::consts::PI),
            false => value(text),
        };
        assert!((value - wanted).abs() < 1e-12, "{text}: {value}");
    }
}

/// With a value `x` for the name `pi`, since `deg` of a bare number is refused.
fn built(text: &str, x: f64) -> f64 {
    let builder = Builder::new();
    let text = text.replace("pi", "x");
    let resolve = |_: &str| Ok::<_, ()>(builder.number(x));
    Formula::parse(&text).unwrap().build(&builder, resolve).unwrap().as_constant().unwrap()
}

#[test]
fn comparisons_are_one_if_true() {
    for (text, wanted) in [
        ("1 < 2", 1.0),
        ("2 < 1", 0.0),
        ("1 < 1", 0.0),
        ("1 <= 1", 1.0),
        ("2 <= 1", 0.0),
        ("1 >= 1", 1.0),
        ("1 >= 2", 0.0),
        ("2 > 1", 1.0),
        ("1 > 1", 0.0),
        ("1 == 1", 1.0),
        ("1 == 2", 0.0),
        ("1 != 2", 1.0),
        ("1 != 1", 0.0),
        ("1 < 2 and 3 < 2", 0.0),
        ("1 < 2 and 2 < 3", 1.0),
        ("1 < 2 or 3 < 2", 1.0),
        ("2 < 1 or 3 < 2", 0.0),
        ("not 1 < 2", 0.0),
        ("not (1 < 2) or 5", 1.0),
        ("5 and 3", 1.0),
        ("-5 or 0", 0.0),
        ("1 + 1 < 1*3", 1.0),
        ("0 < 1 and not 2 < 1 or 0", 1.0),
        ("(1 < 2)*5 + (2 < 1)", 5.0),
        ("if(1 < 2 and 2 < 3, 7, 8)", 7.0),
        ("if(not 1 < 2, 7, 8)", 8.0),
        ("if(1 == 2, 7, 8)", 8.0),
    ] {
        assert_eq!(value(text), wanted, "{text}");
    }
    for (text, wanted) in [
        ("1 < 2 < 3", "comparisons do not chain"),
        ("1 < ", "the formula ends too early"),
        ("1 = 2", "unexpected `=` in formula"),
        ("and", "`and` joins two conditions"),
        ("deg(30)", "`deg(x)` is the angle x in degrees"),
        ("if(1, 2)", "`if` takes three arguments: `if(condition, a, b)`"),
        ("clamp(1, 2, 3, 4)", "`clamp` takes three arguments: `clamp(x, low, high)`"),
    ] {
        assert_eq!(Formula::parse(text).unwrap_err().message, wanted, "{text}");
    }
}

#[test]
fn notations_of_other_languages_give_help() {
    for (text, wanted) in [
        ("0,5", "decimals stand behind a point: `0.5`"),
        ("0.49..0.51", "an interval is written `[0.1, 0.2]`"),
        ("2·a", "a product is written `*`"),
        ("l**2", "a power is written `^`"),
        ("a, 5", "expected an operator or the end of the formula"),
    ] {
        assert_eq!(Formula::parse(text).unwrap_err().help.as_deref(), Some(wanted), "{text}");
    }
}

#[test]
fn units_are_read_by_the_caller() {
    let unit = |value: f64, text: &str| match text.strip_prefix("mm") {
        Some(_) => Ok(Quantity { value: value / 1e3, mark: 7, length: 2 }),
        None => Err(SyntaxError { message: "no unit".to_owned(), span: 0..1, help: None }),
    };
    let vocabulary = Vocabulary { unit: Some(&unit), ..Vocabulary::default() };
    let formula = Formula::parse_with("2*150 mm + x", &vocabulary).unwrap();
    assert_eq!(formula.terms()[1], (Term::Quantity(0.15, 7), 2..8));
    assert_eq!(Formula::parse_with("2 + 3 km", &vocabulary).unwrap_err().span, 6..7);
    assert_eq!(Formula::parse("2 mm").unwrap_err().message, "unexpected `m` in formula");
    assert!(Formula::parse_with("if(2 mm > 1 and 3 mm < 1, 1, 2)", &vocabulary).is_ok());
    assert!(Formula::parse_with("if(2 and 3, 1, 2)", &vocabulary).is_ok());
}

#[test]
fn a_floor_is_a_name_unless_it_is_called() {
    let formula = Formula::parse("floor.force + floor(round)").unwrap();
    assert_eq!(formula.names().map(|(name, _)| name).collect::<Vec<_>>(), ["floor.force", "round"]);
}

#[test]
fn names_keep_dots_and_spans() {
    let formula = Formula::parse("crank.angle + rod.C.y*l1").unwrap();
    let names: Vec<_> = formula.names().collect();
    assert_eq!(names, [("crank.angle", 0..11), ("rod.C.y", 14..21), ("l1", 22..24)]);
}

#[test]
fn errors_have_spans() {
    let span = |text: &str| Formula::parse(text).unwrap_err().span;
    assert_eq!(span("1 + * 2"), 4..5);
    assert_eq!(span("1 +"), 3..3);
    assert_eq!(span("(1 + 2"), 6..6);
    assert_eq!(span("1 2"), 2..3);
    assert_eq!(span("foo(1)"), 0..3);
    assert_eq!(span("2 + sin"), 4..7);
    assert_eq!(span("sin(1, 2)"), 0..9);
    assert_eq!(span("1e999"), 0..5);
    assert_eq!(span(""), 0..0);
    assert!(Formula::parse(&"(".repeat(10_000)).unwrap_err().message.contains("nests deeper"));
    assert!(Formula::parse(&"-".repeat(10_000)).unwrap_err().message.contains("nests deeper"));
}

#[test]
fn long_sums_do_not_nest() {
    assert_eq!(value(&vec!["1"; 100_000].join("+")), 100_000.0);
}

fn value_of(text: &str, known: &[(&str, f64)]) -> f64 {
    let builder = Builder::new();
    let formula = Formula::parse(text).unwrap();
    let find = |name: &str| known.iter().find(|(known, _)| *known == name).map(|(_, value)| builder.number(*value));
    formula.build(&builder, |name| find(name).ok_or_else(|| name.to_owned())).unwrap().as_constant().unwrap()
}

#[test]
fn sums_are_read_once_for_each_value_of_their_index() {
    assert_eq!(value_of("sum(i, 1..4, i^2)", &[]), 30.0);
    assert_eq!(value_of("2*sum(i, 1..2, a_{i}.x) - 1", &[("a_1.x", 3.0), ("a_2.x", 4.0)]), 13.0);
    assert_eq!(value_of("sum(i, 0..1, sum(j, i..i + 1, 10*i + j))", &[]), 24.0);
    assert_eq!(value_of("sum(k, -1..-1, max(k, p_{k + 2}))", &[("p_1", 5.0)]), 5.0);
    let formula = Formula::parse("1 + sum(i, 1..2, a_{i}.x)").unwrap();
    assert_eq!(formula.names().collect::<Vec<_>>(), [("a_1.x", 17..24), ("a_2.x", 17..24)]);
    for (text, message, span) in [
        ("sum(i, 3..1, i)", "there is no number from 3 to 1", 6..11),
        ("sum(i, 1..n, i)", "`n` is not a whole number", 10..11),
        ("sum(1..3, i)", "`sum` takes an index, its range and a formula", 4..5),
        ("sum(i, 1..3)", "the formula ends too early", 12..12),
        ("sum(i, 1..99999, i)", "a sum has at most 10000 terms", 6..15),
        ("sum(i, 1..2, a_{i - 2}b{)", "this brace does not close", 23..24),
        ("sum(i, 1..2, {i})", "`1` is no name", 13..16),
        ("a_{i}", "unexpected `{` in formula", 2..3),
    ] {
        let error = Formula::parse(text).unwrap_err();
        assert_eq!((error.message.as_str(), error.span), (message, span), "{text}");
    }
}
