//! Reduced outputs and requirements of subsystems as those of the whole model.

use crate::methods::Method;
use crate::numerics::ParameterBox;
use crate::reduce::Subsystem;
use crate::results::{ParameterSummary, ReducedContribution, ReducedSummary, RequirementSummary, Summary};

/// The uncertain parameters of a whole model.
#[derive(Clone, Copy)]
pub struct Parameters<'a> {
    pub all: &'a [ParameterSummary],
    pub domain: &'a ParameterBox,
}

/// Takes the results of subsystems out of their summaries: all reduced outputs and requirements, in the model's order.
pub fn together<'s>(
    parameters: Parameters,
    ran: impl Iterator<Item = (&'s Subsystem, &'s mut Summary)>,
) -> (Vec<ReducedSummary>, Vec<RequirementSummary>) {
    let (mut reduced, mut requirements) = (Vec::new(), Vec::new());
    for (subsystem, summary) in ran {
        for (&number, mut own) in subsystem.reduced.iter().zip(std::mem::take(&mut summary.reduced)) {
            parameters.widen(subsystem, &mut own);
            reduced.push((number, own));
        }
        for (&number, mut own) in subsystem.requirements.iter().zip(std::mem::take(&mut summary.requirements)) {
            if let Some(case) = &mut own.nearest {
                case.parameters = parameters.spread(subsystem, &case.parameters);
            }
            requirements.push((number, own));
        }
    }
    reduced.sort_by_key(|(number, _)| *number);
    requirements.sort_by_key(|(number, _)| *number);
    let requirements = requirements.into_iter().map(|(_, own)| own);
    (reduced.into_iter().map(|(_, own)| own).collect(), requirements.collect())
}

impl Parameters<'_> {
    /// A subsystem's sample among all parameters, the others nominal.
    fn spread(self, subsystem: &Subsystem, sample: &[f64]) -> Vec<f64> {
        let mut all = self.domain.nominal.to_vec();
        subsystem.parameters.iter().zip(sample).for_each(|(&index, &value)| all[index] = value);
        all
    }

    /// A reduced output of a subsystem among all parameters: those that do not reach it contribute nothing.
    fn widen(self, subsystem: &Subsystem, own: &mut ReducedSummary) {
        let cases = own.worst.iter_mut().flatten().map(|case| &mut case.parameters);
        for sample in cases.chain(own.occurs.iter_mut().flat_map(|occurs| &mut occurs.absent)) {
            *sample = self.spread(subsystem, sample);
        }
        let band = own.bands.iter().find(|band| band.method == Method::Chebyshev.name());
        let Some(width_without) = band.map(|band| band.upper - band.lower).filter(|_| !own.contributions.is_empty())
        else {
            return;
        };
        let others = self.all.iter().enumerate().filter(|(index, _)| !subsystem.parameters.contains(index));
        let nothing = |(_, parameter): (usize, &ParameterSummary)| ReducedContribution {
            parameter: parameter.name.clone(),
            main: 0.0,
            total: 0.0,
            width_without,
        };
        own.contributions.extend(others.map(nothing));
    }
}
