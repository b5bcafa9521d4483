use super::*;

fn si(value: f64, unit: &str) -> (f64, String) {
    let unit = Unit::parse(unit).unwrap();
    (unit.to_si(value), unit.dimension.unit())
}

#[test]
fn units_become_si() {
    assert_eq!(si(150.0, "mm"), (0.15, "m".into()));
    assert_eq!(si(180.0, "deg"), (PI, "rad".into()));
    assert!((si(30.0, "rpm").0 - PI).abs() < 1e-15);
    assert_eq!(si(1.0, "rpm").1, "rad/s");
    assert_eq!(si(2.0, "kN"), (2000.0, "N".into()));
    assert_eq!(si(1.0, "N*s/m"), (1.0, "N*s/m".into()));
    assert_eq!(si(5.0, "N/mm"), (5000.0, "N/m".into()));
    for inertia in ["kg*m^2", "kg m^2", "kg·m²", "kg * m * m", "kg/m^-2"] {
        assert_eq!(si(1.0, inertia), (1.0, "kg*m^2".into()), "{inertia}");
    }
    assert_eq!(si(1.0, "N/(m/s)").1, "N*s/m");
    assert_eq!(si(3.0, "1/s"), (3.0, "1/s".into()));
    assert_eq!(si(1.0, "N*m/rad").1, "N*m/rad");
    assert_eq!(si(1.0, "m^3/s").1, "m^3/s");
}

/// By their definitions: NIST SP 811, appendix B.
#[test]
fn customary_units_are_exact() {
    let close = |unit: &str, value: f64| {
        let found = si(1.0, unit).0;
        assert!((found - value).abs() <= 4.0 * f64::EPSILON * value, "{unit}: {found:e}, not {value:e}");
    };
    close("psi", 6_894.757_293_168_361);
    close("hp", 745.699_871_582_270_2);
    close("kgf", 9.806_65);
    close("lbf", 4.448_221_615_260_5);
    close("ft*lbf", 1.355_817_948_331_400_4);
    close("ft·lbf", 1.355_817_948_331_400_4);
    close("arcmin", PI / 180.0 / 60.0);
    close("arcsec", PI / 180.0 / 3600.0);
    close("l/min", 1e-3 / 60.0);
    close("ppm", 1e-6);
    close("mil", 25.4e-6);
    close("thou", 25.4e-6);
    assert_eq!(si(1.0, "l/min").1, "m^3/s");
    assert_eq!(si(1.0, "ft*lbf").1, "N*m");
}

#[test]
fn a_number_a_minute_is_refused() {
    for unit in ["1/min", "min^-1", "1 / min", "1/h"] {
        let error = Unit::parse(unit).unwrap_err();
        assert!(error.help.unwrap().contains("`rpm`"), "{unit}");
    }
    for unit in ["rev/min", "rad/min", "1/s", "l/min", "m/min", "deg/min"] {
        assert!(Unit::parse(unit).is_ok(), "{unit}");
    }
}

#[test]
fn unit_within_a_formula_ends_before_the_next_operand() {
    let names = ["L", "m", "k", "l1", "s"];
    let leading = |text: &'static str| {
        let (unit, length) = Unit::leading(text, |name| names.contains(&name) || name == "pi").unwrap();
        (unit.dimension.unit(), &text[..length])
    };
    for (text, unit, read) in [
        ("deg)", "rad", "deg"),
        ("kg/m * L", "kg/m", "kg/m"),
        ("N*m", "N*m", "N*m"),
        ("N m^2 + 1", "kg*m^3/s^2", "N m^2"),
        ("N / k", "N", "N"),
        ("N/k", "N", "N"),
        ("N/(m/s)*2", "N*s/m", "N/(m/s)"),
        ("N/(l1 + L)", "N", "N"),
        ("m / s^2", "m", "m"),
        ("m/s^2", "m/s^2", "m/s^2"),
        ("m*sin(3)", "m", "m"),
        ("deg/s*t", "rad/s", "deg/s"),
        ("mm*pi", "m", "mm"),
        ("s and 3", "s", "s"),
        ("mm - 3", "m", "mm"),
        ("mm/2", "m", "mm"),
        ("s*body.x", "s", "s"),
        ("mm, 3", "m", "mm"),
    ] {
        assert_eq!(leading(text), (unit.to_owned(), read), "{text}");
    }
    let error = Unit::leading("N*sec/m", |_| false).unwrap_err();
    assert_eq!((error.message.as_str(), error.span), ("unknown unit `sec`", 2..5));
    assert!(Unit::leading("1/min", |_| false).unwrap_err().help.unwrap().contains("`rpm`"));
}

#[test]
fn unknown_units_are_located_with_suggestions() {
    let error = Unit::parse("N*sec/m").unwrap_err();
    assert_eq!((error.message.as_str(), error.span), ("unknown unit `sec`", 2..5));
    assert_eq!(Unit::parse("Mm").unwrap_err().help.unwrap(), "did you mean `mm`?");
    assert!(Unit::parse("Hz").unwrap_err().help.unwrap().contains("rev/s"));
    assert_eq!(Unit::parse("N*").unwrap_err().span, 2..2);
    assert!(Unit::parse(&"(".repeat(1000)).is_err());
    assert!(Unit::parse("m^99").is_err());
}

#[test]
fn quantities_are_distinguished_from_formulas() {
    assert_eq!(number_and_unit("120 mm"), Some((120.0, "mm", 4)));
    assert_eq!(number_and_unit("-9.81m/s^2"), Some((-9.81, "m/s^2", 5)));
    assert_eq!(number_and_unit("1e-3 kg"), Some((1e-3, "kg", 5)));
    assert_eq!(number_and_unit("1%"), Some((1.0, "%", 1)));
    for formula in ["120", "2*l1", "l1/2", "1 + t", "-l1", "1e3", "", "2 (3)"] {
        assert_eq!(number_and_unit(formula), None, "{formula}");
    }
}
