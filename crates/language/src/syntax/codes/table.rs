//! Every code, by blocks. A number is given once: `recorded.txt` keeps it.

use super::Block;

macro_rules! codes {
    ($(block $letters:literal $about:literal { $($name:ident $id:literal $title:literal,)* })*) => {
        /// A kind of mistake that has one cure.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $($(#[doc = concat!("`", $id, "`: ", $title, ".")] $name,)*)*
        }

        impl Code {
            /// All codes, in the order of their numbers.
            pub const ALL: &'static [Self] = &[$($(Self::$name,)*)*];

            /// All blocks, in their order.
            pub const BLOCKS: &'static [Block] =
                &[$(Block { letters: $letters, about: $about, codes: &[$(Self::$name,)*] },)*];

            /// Its number, e.g. `E0201`.
            pub const fn id(self) -> &'static str {
                match self {
                    $($(Self::$name => $id,)*)*
                }
            }

            /// The kind of mistake, in a line.
            pub const fn title(self) -> &'static str {
                match self {
                    $($(Self::$name => $title,)*)*
                }
            }

            /// Its page without the heading: meaning, reason, example and cure.
            pub(super) const fn text(self) -> &'static str {
                match self {
                    $($(Self::$name => include_str!(concat!("pages/", $id, ".md")),)*)*
                }
            }
        }
    };
}

codes! {
    block "E01" "the text, and YAML" {
        UnreadableFile "E0101" "a file cannot be read",
        NotText "E0102" "a file is not UTF-8 text",
        EmptyFile "E0103" "a file is empty",
        NotYaml "E0104" "a text is not YAML",
        UnsupportedYaml "E0105" "YAML that model files do not have",
        GivenTwice "E0106" "something is given twice",
        UnquotedComma "E0107" "a comma ends a text too early",
        TooLarge "E0108" "a model asks for more than the limits allow",
        BadKey "E0109" "a key is not a word",
    }
    block "E02" "keys and their values" {
        UnknownKey "E0201" "a key that does not exist here",
        MissingKey "E0202" "a key is missing",
        WrongShape "E0203" "a mapping, a list or a word stands where another belongs",
        UnknownKind "E0204" "a kind that does not exist",
        OneKind "E0205" "one kind belongs here",
        BadName "E0206" "a name that cannot be one",
        ExclusiveKeys "E0207" "two keys exclude each other",
        MisplacedKey "E0208" "a key without meaning among the others",
        UnknownWord "E0209" "a word that is not one of the choices",
        MissingSection "E0210" "a section of the model is missing",
    }
    block "E03" "quantities, units and formulas" {
        WrongDimension "E0301" "a quantity of another dimension belongs here",
        MisplacedTolerance "E0302" "a tolerance or an interval outside of `parameters`",
        BadFormula "E0303" "a formula that cannot be read",
        UnknownUnit "E0304" "a unit that cannot be read",
        AmbiguousUnit "E0305" "a unit that may mean something else",
        NotANumber "E0306" "a value is not a finite number",
        OutOfRange "E0307" "a value outside of its range",
        MustBeCertain "E0308" "a number that must be the same for all samples",
        MissingUnit "E0309" "a number without a unit next to one with a unit",
        ZeroDirection "E0310" "a direction of length zero",
        ReversedRange "E0311" "a range that ends before it begins",
        NotPlanar "E0312" "a part of space in a planar model, or the reverse",
    }
    block "E04" "names" {
        UnknownName "E0401" "a name that stands for nothing",
        NameTaken "E0402" "a name that is taken",
        NotHere "E0403" "a quantity that is not known here",
        Circle "E0404" "definitions that depend on each other in a circle",
    }
    block "E05" "bodies and joints" {
        SameBody "E0501" "two different parts are needed",
        NoAngle "E0502" "a body that has no angle",
        UnsuitableJoint "E0503" "a joint that does not have this motion",
        BadInertia "E0504" "an inertia tensor that no body has",
        BadCoordinates "E0505" "coordinates of a body that do not fit together",
        DrivenTwice "E0506" "a coordinate that is prescribed twice",
        BadEquation "E0507" "an invalid equation",
        BadStart "E0508" "a start that cannot be chosen",
        BadMotor "E0509" "a motor whose motion is not defined",
    }
    block "E06" "effects, parts and tables" {
        IncompleteElement "E0601" "an element lacks one of several keys",
        BadSurface "E0602" "a surface or a course that has no shape",
        BadMatrix "E0603" "matrices of a superelement that do not fit",
        BadFilter "E0604" "a transfer function that cannot be realised",
        BadPlacement "E0605" "a part that cannot be turned, mirrored or placed so",
        BadRepetition "E0606" "a repetition whose index is not defined",
        WorldEffect "E0607" "an effect of the whole model within an assembly",
        BadZone "E0608" "a tolerance zone that is not defined",
        BadChain "E0609" "dimensions that do not determine each other",
        BadTable "E0610" "a table whose points do not make a function",
        BadTrajectory "E0611" "a trajectory whose points do not make a motion",
        BadExcitation "E0612" "an excitation that is not defined",
    }
    block "E07" "parameters, outputs and requests" {
        NoValue "E0701" "a parameter without a value",
        BadTolerance "E0702" "an invalid tolerance",
        BadClass "E0703" "a tolerance class that does not exist",
        BadCost "E0704" "an invalid cost",
        BadDistribution "E0705" "an invalid distribution",
        BadCorrelation "E0706" "an invalid correlation",
        NotUncertain "E0707" "a key of uncertain parameters at one that is certain",
        WrongAnalysis "E0708" "something that the analysis does not know",
        ConstantOutput "E0709" "an output that is constant",
        BadRequirement "E0710" "a requirement that compares nothing",
        BadReducedOutput "E0711" "a reduced output that is not defined",
        BadTimes "E0712" "times that do not fit together",
        BadDesign "E0713" "a design without ranges or objective",
        BadProgram "E0714" "a program that is not described",
        BadFmu "E0715" "a functional mock-up unit that does not fit",
        BadStatistics "E0716" "statistics that are not defined",
        BadMethod "E0717" "a method whose keys do not fit",
        BadOverride "E0718" "a change of the model that cannot be read",
        BadScene "E0719" "a scene that changes nothing",
    }
    block "E08" "files, robots and meshes" {
        OutsideFolder "E0801" "a file outside of the model's folder",
        BadXml "E0802" "a text is not XML",
        WrongRobot "E0803" "a file of another format",
        UnknownXml "E0804" "an element or attribute that does not exist",
        MissingXml "E0805" "an element or attribute is missing",
        BadXmlValue "E0806" "a value of an attribute that does not fit",
        NotATree "E0807" "links that do not form a tree",
        UnsupportedXml "E0808" "a part of the format that mbint does not have",
        BadMesh "E0809" "a mesh that cannot be used",
        NothingMoves "E0810" "a robot that cannot move",
        BadLimits "E0811" "limits of joints that cannot be used",
    }
    block "E09" "the mechanism and its simulation" {
        CannotAssemble "E0901" "the mechanism cannot be assembled",
        NotConverged "E0902" "a step does not converge",
        Locked "E0903" "the mechanism locks",
        StepsTooSmall "E0904" "the tolerance asks for too many steps",
        NoEquilibrium "E0905" "there is no equilibrium",
        NotDriven "E0906" "motors leave something free",
        Contradiction "E0907" "constraints contradict each other",
        NotFinite "E0908" "a force or a mass is not finite",
        StartsOutside "E0909" "a part starts outside of its enclosure",
        NotExplicit "E0910" "the explicit method cannot integrate this",
        ProgramFails "E0911" "a program does not answer",
        TooFast "E0912" "something changes too fast to follow",
        Massless "E0913" "a coordinate without inertia or place",
        NoJointCoordinates "E0914" "joint coordinates are not possible",
        BadTeeth "E0915" "teeth that cannot touch",
    }
    block "E10" "studies, files of results and commands" {
        Unanswerable "E1001" "a question that cannot be answered for this model",
        Infeasible "E1002" "some samples cannot be assembled",
        TooCostly "E1003" "a study takes too long, or too much memory",
        NoParameter "E1004" "nothing is uncertain",
        NoDerivatives "E1005" "outputs have no derivatives",
        Unsuitable "E1006" "the model does not ask for this",
        NoSteps "E1007" "an analysis that takes no steps",
        NoCode "E1008" "a model that cannot be exported as C",
        BadData "E1009" "measured data that cannot be used",
        CannotWrite "E1010" "results cannot be written",
        NoResults "E1011" "a folder has no results",
        NoStudy "E1012" "a folder has no study",
        BadWitness "E1013" "a witness of another model",
    }
    block "W" "warnings" {
        AngleWithoutUnit "W0301" "a large angle without a unit",
        LengthWithoutUnit "W0302" "a large length without a unit",
        DifferenceOfNumbers "W0303" "a difference that may be meant as an interval",
        FractionOfUnits "W0304" "a fraction of units that may be read otherwise",
        UnitLeftOut "W0305" "a number without the unit that the model gives",
        UnusedExcitation "W0601" "an excitation that nothing uses",
        UnusedParameter "W0701" "a parameter that nothing uses",
        NothingUncertain "W0702" "bounds without an uncertain parameter",
        XmlIgnored "W0801" "a part of a robot's file is ignored",
        MasslessLink "W0802" "a link without a usable mass",
        ContactsIgnored "W0803" "contacts of geoms are ignored",
        NoLimits "W0804" "a stop in a joint without limits",
        MeshIgnored "W0805" "a mesh that is no closed surface",
        OverlapsAtStart "W0901" "surfaces overlap at the start",
    }
}
