//! A tape as statements of C99.

use std::fmt::Write;

use super::tape::{Op, Operands, Tape, TapePart};
use crate::expr::{Binary, Spline, Unary};
use crate::tuning::TUNING;

/// Writes tapes over one memory `r` as C, and collects the tables that they name.
#[derive(Debug, Default)]
pub struct CWriter {
    splines: Vec<Spline>,
}

impl CWriter {
    /// A tape as a function `name` of a memory `r`: each statement is the same operation on doubles as in an evaluator;
    /// functions are those of C's library, and `mb_select`, `mb_sign`, `mb_min`, `mb_max` and `mb_spline`, which
    /// [`helpers`](Self::helpers) defines. A long tape becomes several functions, which the one of this name calls.
    pub fn function(&mut self, name: &str, tape: &Tape) -> String {
        let pieces = self.pieces(tape);
        let function =
            |name: &str, body: &str| format!("static void {name}(double *r)\n{{\n{body}    (void)r;\n}}\n\n");
        if let [body] = &pieces[..] {
            return function(name, body);
        }
        let names: Vec<String> = (1..=pieces.len()).map(|piece| format!("{name}_{piece}")).collect();
        let mut text: String = names.iter().zip(&pieces).map(|(name, body)| function(name, body)).collect();
        let calls: String = names.iter().map(|name| format!("    {name}(r);\n")).collect();
        text += &function(name, &calls);
        text
    }

    /// Statements of a tape, split between its regions into pieces that compile quickly.
    fn pieces(&mut self, tape: &Tape) -> Vec<String> {
        let (mut pieces, mut text) = (Vec::new(), String::new());
        let (mut index, mut ends, mut statements) = (0, Vec::new(), 0);
        loop {
            while ends.last() == Some(&index) {
                ends.pop();
                text += "    }\n";
            }
            let Some(part) = tape.part(&mut index) else {
                pieces.push(text);
                return pieces;
            };
            match part {
                TapePart::Region(region) => {
                    let (not, end) = (if region.is_elsewhere() { "" } else { "!" }, region.end());
                    // A NaN condition is positive, as everywhere.
                    let _ = writeln!(text, "    if ({not}(r[{}] <= 0.0)) {{", region.condition);
                    ends.push(end);
                }
                TapePart::Run(op, run) => {
                    for operands in run.each(*op) {
                        if statements >= TUNING.statements_of_function && ends.is_empty() {
                            pieces.push(std::mem::take(&mut text));
                            statements = 0;
                        }
                        statements += 1;
                        let _ = writeln!(text, "    {}", self.statement(*op, operands));
                    }
                }
            }
        }
    }

    fn statement(&mut self, op: Op, Operands { a, b, c, d }: Operands) -> String {
        match op {
            Op::Copy => format!("r[{d}] = r[{a}];"),
            Op::MulAdd => format!("{{ double p = r[{a}] * r[{b}]; r[{d}] = p + r[{c}]; }}"),
            Op::MulSub => format!("{{ double p = r[{a}] * r[{b}]; r[{d}] = p - r[{c}]; }}"),
            Op::NegMulAdd => format!("{{ double p = r[{a}] * r[{b}]; r[{d}] = r[{c}] - p; }}"),
            Op::Select => format!("r[{d}] = mb_select(r[{a}], r[{b}], r[{c}]);"),
            Op::SinCos => format!("{{ double x = r[{a}]; r[{d}] = sin(x); r[{b}] = cos(x); }}"),
            Op::Unary(function) => format!("r[{d}] = {};", self.unary(function, a)),
            Op::Binary(function) => format!("r[{d}] = {};", binary(function, a, b)),
        }
    }

    fn unary(&mut self, function: Unary, a: u32) -> String {
        let name = match function {
            Unary::Neg => return format!("-r[{a}]"),
            Unary::Spline(spline, order) => {
                let index = self.splines.iter().position(|known| *known == spline).unwrap_or(self.splines.len());
                if index == self.splines.len() {
                    self.splines.push(spline);
                }
                return format!("mb_spline(&mb_table_{index}, {order}, r[{a}])");
            }
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "asin",
            Unary::Acos => "acos",
            Unary::Atan => "atan",
            Unary::Sqrt => "sqrt",
            Unary::Exp => "exp",
            Unary::Log => "log",
            Unary::Abs => "fabs",
            Unary::Tanh => "tanh",
            Unary::Sign => "mb_sign",
            Unary::Floor => "floor",
        };
        format!("{name}(r[{a}])")
    }

    /// Definitions of the functions that statements call, and of the tables that they name; to be written before them.
    pub fn helpers(&self) -> String {
        let mut text = HELPERS.to_owned();
        if self.splines.is_empty() {
            return text;
        }
        text += SPLINE;
        for (index, spline) in self.splines.iter().enumerate() {
            let (knots, cubics, periodic) = spline.pieces();
            let knots_text: Vec<String> = knots.iter().map(|knot| c_number(*knot)).collect();
            let cubics_text = cubics.iter().flatten().map(|value| c_number(*value)).collect::<Vec<_>>();
            let _ = write!(
                text,
                "static const double mb_knots_{index}[] = {{ {} }};\nstatic const double mb_cubics_{index}[] = {{ {} }};\n\
                 static const mb_table mb_table_{index} = {{ {}, {}, mb_knots_{index}, mb_cubics_{index} }};\n",
                knots_text.join(", "),
                cubics_text.join(", "),
                knots.len(),
                i32::from(periodic),
            );
        }
        text
    }
}

fn binary(function: Binary, a: u32, b: u32) -> String {
    let call = |name: &str| format!("{name}(r[{a}], r[{b}])");
    match function {
        Binary::Add => format!("r[{a}] + r[{b}]"),
        Binary::Sub => format!("r[{a}] - r[{b}]"),
        Binary::Mul => format!("r[{a}] * r[{b}]"),
        Binary::Div => format!("r[{a}] / r[{b}]"),
        Binary::Pow => call("pow"),
        Binary::Atan2 => call("atan2"),
        Binary::Min => call("mb_min"),
        Binary::Max => call("mb_max"),
        Binary::Select => format!("mb_select(r[{a}], r[{b}], 0.0)"),
        Binary::SelectElse => format!("mb_select(r[{a}], 0.0, r[{b}])"),
    }
}

/// A number of C, by the shortest digits that are read as the same one.
pub fn c_number(value: f64) -> String {
    match value {
        value if value.is_nan() => "NAN".to_owned(),
        f64::INFINITY => "INFINITY".to_owned(),
        f64::NEG_INFINITY => "-INFINITY".to_owned(),
        value => format!("{value:e}"),
    }
}

const HELPERS: &str = "\
static inline double mb_select(double a, double b, double c) { return a <= 0.0 ? c : b; }
static inline double mb_sign(double a) { return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a; }
static inline double mb_min(double a, double b) { return a < b || isnan(a) ? a : b; }
static inline double mb_max(double a, double b) { return a > b || isnan(a) ? a : b; }
";

const SPLINE: &str = "\
typedef struct { int knots, periodic; const double *x, *cubics; } mb_table;
static double mb_spline(const mb_table *table, int order, double x)
{
    const double *knots = table->x;
    int count = table->knots, piece = 0;
    double first = knots[0], period = knots[count - 1] - first, s;
    const double *k;
    if (table->periodic) x -= period * floor((x - first) / period);
    while (piece < count && knots[piece] <= x) piece++;
    if (table->periodic) piece = piece < 1 ? 1 : piece > count - 1 ? count - 1 : piece;
    s = x - knots[(piece > 1 ? piece : 1) - 1];
    k = table->cubics + 4 * piece;
    switch (order) {
    case 0: return k[0] + s * (k[1] + s * (k[2] + s * k[3]));
    case 1: return k[1] + s * (2.0 * k[2] + 3.0 * s * k[3]);
    case 2: return 2.0 * (k[2] + 3.0 * s * k[3]);
    case 3: return 6.0 * k[3];
    default: return 0.0;
    }
}
";
