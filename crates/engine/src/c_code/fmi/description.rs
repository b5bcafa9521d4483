//! Descriptions of a unit.

use symdiff::c_number;

use super::Unit;
use crate::assemble::UncertainParameter;
use crate::c_code::LICENCE;
use crate::grammar::unit;

/// Type of annotations.
const ANNOTATION: &str = "org.mbint.parameters";

/// Attributes of the time, of an output, of a variable that may change, and of one that is set before the motion.
const TIME: &str = "causality=\"independent\" variability=\"continuous\"";
const OUTPUT: &str = "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
const INPUT: &str = "causality=\"input\" variability=\"continuous\"";
const PARAMETER: &str = "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"";

/// A variable of the unit.
struct Variable {
    reference: usize,
    /// Name as written in XML.
    name: String,
    /// Attributes of its causality and variability.
    kind: &'static str,
    /// Attributes of its values: start and unit.
    values: String,
}

/// The time, the outputs and the parameters, in the order of their references.
fn variables(own: &Unit) -> Vec<Variable> {
    let time = (time_name(own).to_owned(), TIME, unit_attribute("s"));
    let output = |(name, unit): &(&str, &str)| ((*name).to_owned(), OUTPUT, unit_attribute(unit));
    let parameter = |(parameter, is_input): (&UncertainParameter, &bool)| {
        let values = format!(" start=\"{}\"{}", c_number(parameter.nominal), unit_attribute(&parameter.unit));
        (parameter_name(own, &parameter.name), if *is_input { INPUT } else { PARAMETER }, values)
    };
    let outputs = own.outputs.iter().map(output);
    let all = std::iter::once(time).chain(outputs).chain(own.parameters.iter().zip(own.inputs).map(parameter));
    let numbered = all.enumerate();
    numbered
        .map(|(reference, (name, kind, values))| Variable { reference, name: escaped(&name), kind, values })
        .collect()
}

/// Elements of all variables, in lines.
fn listed(own: &Unit, element: impl Fn(&Variable) -> String) -> String {
    variables(own).iter().map(|variable| format!("    {}\n", element(variable))).collect()
}

/// `modelDescription.xml` of 2.0.
pub fn of_two(own: &Unit, token: &str) -> String {
    let name = escaped(own.name);
    let fixed = fixed_step(own, "step");
    let variables = listed(own, |Variable { reference, name, kind, values }| {
        format!(
            "<ScalarVariable name=\"{name}\" valueReference=\"{reference}\" {kind}><Real{values}/></ScalarVariable>"
        )
    });
    // The time is the first variable.
    let output = |reference: usize| format!("      <Unknown index=\"{}\"/>\n", reference + 1);
    let structure: String = (1..=own.outputs.len()).map(output).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{name}\" guid=\"{token}\" generationTool=\"mbint {}\" license=\"{LICENCE}\" numberOfEventIndicators=\"0\">
  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\">
    <SourceFiles>
      <File name=\"{name}.c\"/>
      <File name=\"fmi2.c\"/>
    </SourceFiles>
  </CoSimulation>
  <UnitDefinitions>
{}  </UnitDefinitions>
  <DefaultExperiment startTime=\"0\" stopTime=\"{}\" stepSize=\"{}\"/>
  <VendorAnnotations>
    <Tool name=\"mbint\">
      <Parameters{fixed}>
{}      </Parameters>
    </Tool>
  </VendorAnnotations>
  <ModelVariables>
{variables}  </ModelVariables>
  <ModelStructure>
    <Outputs>
{structure}    </Outputs>
    <InitialUnknowns>
{structure}    </InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
",
        env!("CARGO_PKG_VERSION"),
        own.prefix,
        units(own),
        c_number(own.schedule.end()),
        c_number(own.schedule.output_step),
        intervals(own),
    )
}

/// `modelDescription.xml` of 3.0.
pub fn of_three(own: &Unit, token: &str) -> String {
    let name = escaped(own.name);
    let fixed = fixed_step(own, "fixedInternalStepSize");
    let variables = listed(own, |Variable { reference, name, kind, values }| {
        format!("<Float64 name=\"{name}\" valueReference=\"{reference}\" {kind}{values}/>")
    });
    let of_outputs = |element: &str| -> String {
        let line = |reference: usize| format!("    <{element} valueReference=\"{reference}\"/>\n");
        (1..=own.outputs.len()).map(line).collect()
    };
    let (structure, unknowns) = (of_outputs("Output"), of_outputs("InitialUnknown"));
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{name}\" instantiationToken=\"{token}\" generationTool=\"mbint {}\" license=\"{LICENCE}\">
  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"{fixed}/>
  <UnitDefinitions>
{}  </UnitDefinitions>
  <DefaultExperiment startTime=\"0\" stopTime=\"{}\" stepSize=\"{}\"/>
  <ModelVariables>
{variables}  </ModelVariables>
  <ModelStructure>
{structure}{unknowns}  </ModelStructure>
  <Annotations>
    <Annotation type=\"{ANNOTATION}\">
{}    </Annotation>
  </Annotations>
</fmiModelDescription>
",
        env!("CARGO_PKG_VERSION"),
        own.prefix,
        units(own),
        c_number(own.schedule.end()),
        c_number(own.schedule.output_step),
        intervals(own),
    )
}

/// `buildDescription.xml` of 3.0.
pub fn of_build(own: &Unit) -> String {
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
        own.prefix,
        name = escaped(own.name),
    )
}

/// Attribute of the length of steps, where they have one.
fn fixed_step(own: &Unit, name: &str) -> String {
    if own.has_fixed_steps() { format!(" {name}=\"{}\"", c_number(own.step())) } else { String::new() }
}

/// Name of a parameter, which no output may have.
fn parameter_name(own: &Unit, name: &str) -> String {
    let is_taken = own.outputs.iter().any(|(output, _)| *output == name) || name == "time";
    if is_taken { format!("parameter {name}") } else { name.to_owned() }
}

/// Name of the time, which no output may have.
fn time_name(own: &Unit) -> &'static str {
    let is_taken = own.outputs.iter().any(|(name, _)| *name == "time");
    if is_taken { "independent time" } else { "time" }
}

fn unit_attribute(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" unit=\"{}\"", escaped(unit)) }
}

/// Definitions of all units by powers of base units.
fn units(own: &Unit) -> String {
    let mut names: Vec<&str> = own.outputs.iter().map(|(_, unit)| *unit).filter(|unit| !unit.is_empty()).collect();
    names.extend(own.parameters.iter().map(|own| own.unit.as_str()).filter(|unit| !unit.is_empty()));
    names.push("s");
    names.sort_unstable();
    names.dedup();
    let definition = |name: &str| {
        let Ok(found) = unit::Unit::parse(name) else { return format!("    <Unit name=\"{}\"/>\n", escaped(name)) };
        let powers = ["m", "kg", "s", "rad"].iter().zip(found.dimension.powers()).filter(|(_, power)| *power != 0);
        let powers: String = powers.map(|(base, power)| format!(" {base}=\"{power}\"")).collect();
        format!("    <Unit name=\"{}\"><BaseUnit{powers}/></Unit>\n", escaped(name))
    };
    names.into_iter().map(definition).collect()
}

/// Intervals of the uncertain parameters, for tools that know them: in SI.
fn intervals(own: &Unit) -> String {
    let line = |own: &UncertainParameter| {
        format!(
            "      <Parameter name=\"{}\" nominal=\"{}\" min=\"{}\" max=\"{}\"{}/>\n",
            escaped(&own.name),
            c_number(own.nominal),
            c_number(own.lower),
            c_number(own.upper),
            unit_attribute(&own.unit)
        )
    };
    own.parameters.iter().map(line).collect()
}

/// A text of XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
