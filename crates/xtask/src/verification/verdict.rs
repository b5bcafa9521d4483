//! Verdicts on figures and their limits: of a figure, of a case, of a section, of all.

use super::interval::clopper_pearson;
use super::record::{Case, Figure, Section};

/// Ordered from the best: the worst of several counts.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Verdict {
    /// No figure of it has a limit.
    Recorded,
    Holds,
    /// The claim does not cover the case, for a stated reason.
    Excepted,
    NotMeasured,
    /// The confidence interval contains the limit.
    Undecided,
    Fails,
}

impl Verdict {
    pub fn name(self) -> &'static str {
        match self {
            Self::Recorded => "recorded",
            Self::Holds => "holds",
            Self::Excepted => "excepted",
            Self::NotMeasured => "not measured",
            Self::Undecided => "undecided",
            Self::Fails => "**fails**",
        }
    }
}

impl Figure {
    pub fn verdict(&self) -> Verdict {
        if let (Some(count), Some(of)) = (self.count, self.of) {
            let [lower, upper] = clopper_pearson(count, of);
            return match self.high {
                None => Verdict::Recorded,
                Some(high) if upper <= high => Verdict::Holds,
                Some(high) if lower > high => Verdict::Fails,
                Some(_) => Verdict::Undecided,
            };
        }
        let value = self.value.unwrap_or(f64::NAN);
        match (self.low, self.high) {
            (None, None) => Verdict::Recorded,
            (low, high) if low.is_none_or(|low| value >= low) && high.is_none_or(|high| value <= high) => {
                Verdict::Holds
            }
            _ => Verdict::Fails,
        }
    }
}

impl Case {
    pub fn verdict(&self) -> Verdict {
        let of_figures = self.figures.iter().map(Figure::verdict).max().unwrap_or(Verdict::Recorded);
        match self.exception {
            Some(_) => of_figures.max(Verdict::Excepted),
            None => of_figures,
        }
    }
}

impl Section {
    /// Excepted cases do not count, unless there are no others. A section whose commands were all omitted is not
    /// measured; one whose commands ran and measured nothing fails, since a claim needs a measurement.
    pub fn verdict(&self) -> Verdict {
        let is_wrong = |run: &&super::record::Run| run.error.is_some() || run.failed > 0;
        if self.runs.iter().any(|run| is_wrong(&run)) {
            return Verdict::Fails;
        }
        let ran = self.runs.iter().any(|run| run.left_out.is_none());
        let verdicts = self.cases.iter().map(Case::verdict);
        let counted = verdicts.filter(|own| *own != Verdict::Excepted).max();
        counted.unwrap_or(if ran { Verdict::Fails } else { Verdict::NotMeasured })
    }
}

#[cfg(test)]
mod tests {
    use super::super::record::Run;
    use super::*;

    fn section(figures: Vec<Figure>, exception: Option<&str>) -> Section {
        let case = Case { figures, exception: exception.map(str::to_owned), ..Case::default() };
        Section { runs: vec![Run::default()], cases: vec![case], ..Section::default() }
    }

    fn share(count: u64, of: u64) -> Figure {
        Figure { count: Some(count), of: Some(of), high: Some(0.01), ..Figure::default() }
    }

    #[test]
    fn figures_keep_their_limits_or_fail() {
        let of = |value, low, high| section(vec![Figure::number("", value, low, high)], None).verdict();
        assert_eq!(of(2.0, Some(1.9), Some(2.1)), Verdict::Holds);
        assert_eq!(of(1.8, Some(1.9), None), Verdict::Fails);
        assert_eq!(of(1.0, None, Some(0.5)), Verdict::Fails);
        assert_eq!(of(f64::NAN, None, Some(0.5)), Verdict::Fails);
        assert_eq!(of(f64::NAN, None, None), Verdict::Recorded);
    }

    #[test]
    fn shares_are_compared_by_their_intervals() {
        // 1 − 0.025^(1/n) falls below 1 % from 368 trials on.
        for (count, of, verdict) in [
            (0, 367, Verdict::Undecided),
            (0, 368, Verdict::Holds),
            (3, 500, Verdict::Undecided),
            (20, 500, Verdict::Fails),
        ] {
            assert_eq!(section(vec![share(count, of)], None).verdict(), verdict, "{count} of {of}");
        }
    }

    #[test]
    fn claim_without_measurements_fails() {
        let run = |error: Option<&str>, left_out: Option<&str>| Run {
            error: error.map(str::to_owned),
            left_out: left_out.map(str::to_owned),
            ..Run::default()
        };
        let of = |run| Section { runs: vec![run], ..Section::default() }.verdict();
        assert_eq!(of(run(None, None)), Verdict::Fails);
        assert_eq!(of(run(Some("killed"), None)), Verdict::Fails);
        assert_eq!(of(run(None, Some("not installed"))), Verdict::NotMeasured);
        // All cases excepted, and a case that holds in a run with a failed test.
        assert_eq!(section(Vec::new(), Some("not smooth")).verdict(), Verdict::Fails);
        let mut failed = section(vec![Figure::number("", 1.0, None, Some(2.0))], None);
        failed.runs[0].failed = 1;
        assert_eq!(failed.verdict(), Verdict::Fails);
    }
}
