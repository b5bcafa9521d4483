//! Traits of bounding methods, and the list of methods.

use std::fmt::Debug;

use super::ensemble::{Ensemble, EnsembleError, Observed};
use super::request::{Budget, Problem};
use super::result::MethodResult;
use super::validation::Validation;
use super::{BoundsRequest, Method};
use crate::numerics::ParameterBox;
use crate::syntax::{Code, Coded};

/// Why a method cannot be run, for people.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(pub String);

impl Refusal {
    /// Equations are needed, and a black box has none.
    pub(super) fn no_equations(method: &str) -> Self {
        Self(format!(
            "`{method}` needs the equations of motion, and a black box has none: ask for `chebyshev` or `scan`"
        ))
    }

    /// More simulations than can be run.
    pub(super) fn too_many(method: &str, simulations: f64, parameters: usize) -> Self {
        Self(format!(
            "`{method}` of {parameters} uncertain parameters needs {simulations:.2e} simulations: say in the model how many it shall take"
        ))
    }
}

/// Quantity that a curve of `mbint cost` varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varied {
    /// The degree of a polynomial.
    Order,
    /// Points along each axis.
    Points,
}

/// A variant of a method that `mbint cost` tries with several counts.
#[derive(Clone, Copy, Debug)]
pub struct CostCurve {
    /// In files.
    pub name: &'static str,
    /// For people.
    pub label: &'static str,
    /// Red, green and blue.
    pub color: [u8; 3],
    /// Meaning of the counts.
    pub varied: Varied,
    /// The counts that are tried.
    pub counts: &'static [usize],
    /// Whether outputs have to follow from expanded coordinates.
    pub composes: bool,
    /// Simulations that it takes with a count, of k parameters; products of a jet's coefficients count as such.
    pub simulations: fn(usize, usize) -> f64,
    /// Asks for it with a count, of k parameters.
    pub ask: fn(&mut BoundsRequest, usize, usize),
}

/// A curve of the registry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Curve {
    /// Its method.
    pub method: Method,
    /// Index among the method's curves.
    pub index: usize,
}

impl Curve {
    /// All curves, method by method.
    pub fn all() -> impl Iterator<Item = Self> {
        let of = |method: Method| (0..method.about().curves.len()).map(move |index| Self { method, index });
        Method::ALL.into_iter().flat_map(of)
    }

    /// Description.
    pub fn about(self) -> &'static CostCurve {
        &self.method.about().curves[self.index]
    }
}

/// Description of a method for people.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// In legends.
    pub label: &'static str,
    /// Effect.
    pub summary: &'static str,
    /// Its source.
    pub source: &'static str,
    /// Red, green and blue. Colours differ for every colour vision and in grey.
    pub color: [u8; 3],
    /// Opacity of the band.
    pub fill: f64,
    /// Lengths of dash and gap of the band's edges, px: where bands coincide, an earlier method shows through the gaps.
    pub dashes: Option<[f64; 2]>,
    /// Whether it bounds from simulations of samples. Such a method has the steps' error, and of a deterministic
    /// mechanism its bounds are the nominal motion.
    pub is_sampled: bool,
    /// Whether it finds sensitivities.
    pub has_sensitivities: bool,
    /// Curves of `mbint cost`.
    pub curves: &'static [CostCurve],
}

/// A method of the registry: its description and its default request.
pub trait Registered: BoundingMethod + Sized {
    /// For people.
    const ABOUT: About;

    /// The request that is run where the command line names the method and the model does not.
    fn default_for(problem: &Problem) -> Self;
}

/// A request for bounds by one method.
pub trait BoundingMethod: Debug {
    /// Adjusts the request to the problem.
    ///
    /// # Errors
    /// If the method cannot bound it.
    fn fit(&mut self, _problem: &Problem) -> Result<(), Refusal> {
        Ok(())
    }

    /// Keeps only the settings of these parameters.
    fn narrow(&mut self, _kept: &[usize]) {}

    /// Adjusts the request to a part of the box.
    fn restrict(&mut self, _part: &ParameterBox, _whole: &ParameterBox) {}

    /// Samples that it asks for; `None` if that depends on the response.
    fn samples(&self) -> Option<f64> {
        Some(0.0)
    }

    /// Simulations that it counts as in progress reports.
    fn work(&self, budget: &Budget) -> usize {
        self.samples().map_or(budget.simulations, |samples| samples as usize)
    }

    /// Highest degree in a parameter of its surrogate; 0 if it has none, or if the degree follows from the response.
    fn degree(&self) -> usize {
        0
    }

    /// The knowledge of the validation samples that it needs.
    fn observes(&self, _problem: &Problem) -> Observed {
        Observed::Outputs
    }

    /// Whether it bounds motions that are cut at events, whose instants depend on the parameters.
    fn follows_events(&self, _problem: &Problem) -> bool {
        false
    }

    /// Bounds all outputs.
    ///
    /// # Errors
    /// If the ensemble has no result at all.
    fn bound(
        &self,
        ensemble: &dyn Ensemble,
        validation: &Validation,
        request: &BoundsRequest,
    ) -> Result<MethodResult, EnsembleError>;
}

/// Makes [`Method`](super::Method) and [`BoundsRequest`](super::BoundsRequest) of the list of methods.
macro_rules! methods {
    ($($(#[doc = $doc:literal])* $keyword:ident: $Type:ident $(, keys $keys:path)?;)*) => {
        /// A bounding method.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Method {
            $($(#[doc = $doc])* $Type,)*
        }

        impl Method {
            /// All of them, in the order in which they are reported.
            pub const ALL: [Self; [$(stringify!($Type)),*].len()] = [$(Self::$Type),*];

            /// Name in files and on the command line.
            pub fn name(self) -> &'static str {
                match self { $(Self::$Type => stringify!($keyword),)* }
            }

            /// The schema of its keys in a file; absent if only the command line asks for it.
            pub fn schema(self) -> Option<schemars::Schema> {
                match self { $(Self::$Type => registry::schema!($($keys)?),)* }
            }

            /// Description for people.
            pub fn about(self) -> &'static $crate::methods::About {
                match self { $(Self::$Type => &<$Type as $crate::methods::Registered>::ABOUT,)* }
            }
        }

        /// The bounds that are asked for; lists by parameter run over the uncertain parameters in file order.
        #[derive(Clone, Debug, Default)]
        pub struct BoundsRequest {
            /// Error allowed of every bound, relative to how far its output ranges over the run.
            pub tolerance: Option<f64>,
            /// Limits of simulations and time.
            pub budget: Budget,
            /// Which surrogates are stored after the run.
            pub keep: $crate::methods::Keep,
            $($(#[doc = $doc])* pub $keyword: Option<$Type>,)*
        }

        registry::keys! { {} $({ $(#[doc = $doc])* $keyword $(: $keys)? })* }

        impl BoundsRequest {
            /// The methods that are asked for.
            pub fn methods(&self) -> Vec<(Method, &dyn BoundingMethod)> {
                let mut methods: Vec<(Method, &dyn BoundingMethod)> = Vec::new();
                $(if let Some(request) = &self.$keyword {
                    methods.push((Method::$Type, request));
                })*
                methods
            }

            /// The same, to be changed.
            pub fn methods_mut(&mut self) -> Vec<(Method, &mut dyn BoundingMethod)> {
                let mut methods: Vec<(Method, &mut dyn BoundingMethod)> = Vec::new();
                $(if let Some(request) = &mut self.$keyword {
                    methods.push((Method::$Type, request));
                })*
                methods
            }

            /// Asks for a method, if the request does not do so already.
            pub fn ask(&mut self, method: Method, problem: &Problem) {
                match method {
                    $(Method::$Type => {
                        self.$keyword.get_or_insert_with(|| <$Type as $crate::methods::Registered>::default_for(problem));
                    })*
                }
            }

            /// Reads the keys of each method in a file.
            fn read_methods<S: $crate::grammar::SymbolTable>(
                &mut self,
                reader: &mut $crate::grammar::Reader<'_, S>,
                fields: &$crate::grammar::Fields<'_>,
                uncertain: &[String],
            ) {
                $($(if let Some(node) = fields.get(stringify!($keyword))
                    && let Some(fields) = reader.fields::<$keys>(node, fields.key_span(stringify!($keyword)))
                {
                    self.$keyword = $Type::read(reader, &fields, uncertain, self.tolerance);
                })?)*
            }

            /// Leaves out a method.
            pub fn omit(&mut self, method: Method) {
                match method { $(Method::$Type => self.$keyword = None,)* }
            }
        }
    };
}

/// The mapping `bounds:`, of the methods that have keys.
macro_rules! keys {
    ({ $($done:tt)* } { $(#[doc = $doc:literal])* $keyword:ident: $keys:path } $($rest:tt)*) => {
        registry::keys! { { $($done)* $(#[doc = $doc])* $keyword: Option<$keys>, } $($rest)* }
    };
    ({ $($done:tt)* } { $(#[doc = $doc:literal])* $keyword:ident } $($rest:tt)*) => {
        registry::keys! { { $($done)* } $($rest)* }
    };
    ({ $($done:tt)* }) => {
        /// Keys of the file.
        pub mod keys {
            use schemars::JsonSchema;

            use super::*;
            use crate::grammar::values::Number;

            crate::grammar::mapping::grammar! {
                /// Which bounds to compute; a method that is not named is not run.
                Bounds is "`bounds`" {
                    /// Error allowed of every bound, relative to how far its output ranges over the run. Chebyshev's
                    /// degree (if it has no `order`) and the steps are then chosen to meet it; bounds that miss it are
                    /// flagged.
                    tolerance: Option<Number>,
                    /// Simulations and time that may be spent on the tolerance.
                    budget: Option<request::keys::Budget>,
                    $($done)*
                }
            }
        }
    };
}

/// The schema of a method's keys.
macro_rules! schema {
    () => {
        None
    };
    ($keys:path) => {
        Some(schemars::schema_for!($keys))
    };
}

pub(super) use {keys, methods, schema};

impl BoundsRequest {
    /// Whether no method is asked for.
    pub fn is_empty(&self) -> bool {
        self.methods().is_empty()
    }

    /// Highest degree in a parameter of any surrogate.
    pub fn degree(&self) -> usize {
        self.methods().into_iter().map(|(_, method)| method.degree()).max().unwrap_or(0)
    }

    /// The request adjusted to a problem, with these methods instead of its own if they are given.
    ///
    /// # Errors
    /// If a method cannot bound it.
    pub fn fitted(&self, methods: Option<&[Method]>, problem: &Problem) -> Result<Self, Refusal> {
        let mut request = self.clone();
        for method in Method::ALL {
            match methods {
                Some(methods) if methods.contains(&method) => request.ask(method, problem),
                Some(_) if method.about().is_sampled => request.omit(method),
                _ => (),
            }
        }
        request.methods_mut().into_iter().try_for_each(|(_, request)| request.fit(problem))?;
        Ok(request)
    }
}

impl Coded for Refusal {
    fn code(&self) -> Option<Code> {
        Some(Code::Unanswerable)
    }
}
