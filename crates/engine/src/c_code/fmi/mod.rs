//! A model as a unit of FMI 2.0 or 3.0 for co-simulation: descriptions, and a wrapper about its C.

mod description;

use std::fmt::Write;

use symdiff::c_number;

use super::NOTICE;
use crate::assemble::UncertainParameter;
use crate::simulate::Schedule;

/// Parts of the wrapper that versions share, with names of the model's parts as macros.
const CORE: &str = include_str!("core.c");

/// Functions of 2.0, and of 3.0.
const TWO: &str = include_str!("fmi2.c");
const THREE: &str = include_str!("fmi3.c");

/// Version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FmiVersion {
    /// 2.0
    Two,
    /// 3.0
    Three,
}

/// Contents of a unit's description, in addition to its code.
pub(super) struct Unit<'u> {
    /// Name of its files.
    pub name: &'u str,
    /// Prefix of its functions.
    pub prefix: &'u str,
    /// Names and units of the outputs.
    pub outputs: &'u [(&'u str, &'u str)],
    /// Uncertain parameters, whose intervals are annotations.
    pub parameters: &'u [UncertainParameter],
    /// Which of them may change during a motion.
    pub inputs: &'u [bool],
    pub schedule: &'u Schedule,
}

/// Files of the unit, by their paths in it; `code` has the model's C.
pub(super) fn files(unit: &Unit, version: FmiVersion, code: &[(String, String)]) -> Vec<(String, String)> {
    let token = token(code);
    let mut files = match version {
        FmiVersion::Two => vec![
            ("modelDescription.xml".to_owned(), description::of_two(unit, &token)),
            ("sources/fmi2.c".to_owned(), unit.wrapper(&token, version)),
        ],
        FmiVersion::Three => vec![
            ("modelDescription.xml".to_owned(), description::of_three(unit, &token)),
            ("sources/buildDescription.xml".to_owned(), description::of_build(unit)),
            ("sources/fmi3.c".to_owned(), unit.wrapper(&token, version)),
        ],
    };
    // Where both versions of the standard have it.
    files.push(("documentation/licenses/license.txt".to_owned(), format!("{}\n", NOTICE.replace("\n * ", "\n"))));
    files.extend(code.iter().map(|(name, text)| (format!("sources/{name}"), text.clone())));
    files
}

/// A number of the model's code: an instance of another model is refused (Fowler, Noll and Vo's hash).
fn token(code: &[(String, String)]) -> String {
    let bytes = code.iter().flat_map(|(_, text)| text.bytes());
    let hash =
        bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    format!("{{{hash:016x}}}")
}

impl Unit<'_> {
    /// Longest of the model's steps, s.
    fn step(&self) -> f64 {
        if self.has_fixed_steps() { self.schedule.first_step() } else { self.schedule.longest_step() }
    }

    /// Whether all steps have one length.
    fn has_fixed_steps(&self) -> bool {
        self.schedule.steps_per_row().is_some()
    }

    fn wrapper(&self, token: &str, version: FmiVersion) -> String {
        let Self { name, prefix, outputs, .. } = self;
        let mut text = format!("/* {NOTICE} */\n\n#include \"{name}.h\"\n\n#define TOKEN \"{token}\"\n");
        let _ =
            writeln!(text, "#define MODEL_H {}\n#define MODEL_OUTPUT_COUNT {}", c_number(self.step()), outputs.len());
        for (name, own) in [
            ("MODEL_TYPE", "model"),
            ("MODEL_START", "start"),
            ("MODEL_STEP", "step"),
            ("MODEL_ROW", "row"),
            ("MODEL_ROWS", "rows"),
            ("MODEL_TIME", "time"),
            ("MODEL_OUTPUTS", "outputs"),
        ] {
            let _ = writeln!(text, "#define {name} {prefix}_{own}");
        }
        let _ = writeln!(text, "#define MODEL_PARAMETER_COUNT {}", self.parameters.len());
        if !self.parameters.is_empty() {
            for (name, own) in
                [("MODEL_START_AT", "start_at"), ("MODEL_SET", "set"), ("MODEL_PARAMETER_VALUES", "parameter_values")]
            {
                let _ = writeln!(text, "#define {name} {prefix}_{own}");
            }
            let inputs: Vec<String> = self.inputs.iter().map(|own| i32::from(*own).to_string()).collect();
            let _ = writeln!(text, "static const int is_input[] = {{ {} }};", inputs.join(", "));
        }
        let (log, functions) = match version {
            FmiVersion::Two => ("void *, const char *, int, const char *, const char *, ...", TWO),
            FmiVersion::Three => ("void *, int, const char *, const char *", THREE),
        };
        format!("{text}\ntypedef void (*LOG)({log});\n\n{CORE}{functions}")
    }
}
