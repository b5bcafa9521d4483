//! A model as a unit of FMI 3.0 for co-simulation: descriptions, and a wrapper about its C.

use std::fmt::Write;

use symdiff::c_number;

use crate::simulate::Schedule;

/// The wrapper, with names of the model's parts as macros.
const WRAPPER: &str = include_str!("fmi3.c");

/// What a unit says of a model.
pub(super) struct Unit<'u> {
    /// Of its files.
    pub name: &'u str,
    /// Of its functions.
    pub prefix: &'u str,
    /// Names and units of the outputs.
    pub outputs: &'u [(&'u str, &'u str)],
    pub schedule: &'u Schedule,
}

/// Files of the unit, by their paths in it; `code` has the model's C.
pub(super) fn files(unit: &Unit, code: &[(String, String)]) -> Vec<(String, String)> {
    let token = token(code);
    let mut files = vec![
        ("modelDescription.xml".to_owned(), unit.description(&token)),
        ("sources/buildDescription.xml".to_owned(), unit.build()),
        ("sources/fmi3.c".to_owned(), unit.wrapper(&token)),
    ];
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
    /// Length of the model's steps, s.
    fn step(&self) -> f64 {
        self.schedule.first_step()
    }

    fn wrapper(&self, token: &str) -> String {
        let Self { name, prefix, outputs, .. } = self;
        let mut text = format!("#include \"{name}.h\"\n\n#define TOKEN \"{token}\"\n");
        let _ =
            writeln!(text, "#define MODEL_H {}\n#define MODEL_OUTPUT_COUNT {}", c_number(self.step()), outputs.len());
        for (name, own) in
            [("MODEL_TYPE", "model"), ("MODEL_START", "start"), ("MODEL_STEP", "step"), ("MODEL_OUTPUTS", "outputs")]
        {
            let _ = writeln!(text, "#define {name} {prefix}_{own}");
        }
        text + "\n" + WRAPPER
    }

    fn build(&self) -> String {
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<fmiBuildDescription fmiVersion=\"3.0\">
  <BuildConfiguration modelIdentifier=\"{}\">
    <SourceFileSet language=\"C99\">
      <SourceFile name=\"{name}.c\"/>
      <SourceFile name=\"fmi3.c\"/>
    </SourceFileSet>
    <Library name=\"m\"/>
  </BuildConfiguration>
</fmiBuildDescription>
",
            self.prefix,
            name = escaped(self.name),
        )
    }

    fn description(&self, token: &str) -> String {
        let (name, step, end) = (escaped(self.name), c_number(self.step()), c_number(self.schedule.end()));
        let mut units: Vec<&str> = self.outputs.iter().map(|(_, unit)| *unit).filter(|unit| !unit.is_empty()).collect();
        units.push("s");
        units.sort_unstable();
        units.dedup();
        let units = units.iter().map(|unit| format!("    <Unit name=\"{}\"/>\n", escaped(unit))).collect::<String>();
        let (mut variables, mut structure, mut unknowns) = (String::new(), String::new(), String::new());
        for (reference, (name, unit)) in (1..).zip(self.outputs) {
            let unit = if unit.is_empty() { String::new() } else { format!(" unit=\"{}\"", escaped(unit)) };
            let _ = writeln!(
                variables,
                "    <Float64 name=\"{}\" valueReference=\"{reference}\" causality=\"output\" variability=\"continuous\" initial=\"calculated\"{unit}/>",
                escaped(name)
            );
            let _ = writeln!(structure, "    <Output valueReference=\"{reference}\"/>");
            let _ = writeln!(unknowns, "    <InitialUnknown valueReference=\"{reference}\"/>");
        }
        let is_taken = |name: &str| self.outputs.iter().any(|(own, _)| *own == name);
        let time = if is_taken("time") { "independent time" } else { "time" };
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{name}\" instantiationToken=\"{token}\" generationTool=\"mbint {}\" license=\"that of the model\">
  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" fixedInternalStepSize=\"{step}\"/>
  <UnitDefinitions>
{units}  </UnitDefinitions>
  <DefaultExperiment startTime=\"0\" stopTime=\"{end}\" stepSize=\"{}\"/>
  <ModelVariables>
    <Float64 name=\"{time}\" valueReference=\"0\" causality=\"independent\" variability=\"continuous\" unit=\"s\"/>
{variables}  </ModelVariables>
  <ModelStructure>
{structure}{unknowns}  </ModelStructure>
</fmiModelDescription>
",
            env!("CARGO_PKG_VERSION"),
            self.prefix,
            c_number(self.schedule.output_step),
        )
    }
}

/// A text of XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
