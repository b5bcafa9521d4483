//! Limits that requirements set, in the figure of an output.

use svg::node::element::{Group, Path, Title};

use super::figure::data::{SeriesData, extremes};
use super::figure::legend::{Entry, Sign};
use super::figure::panel::Panel;
use super::figure::path::{Point, line_data, runs, thinned};
use crate::results::{LimitLine, RequirementSummary};

/// A constant limit of an output over some time.
#[derive(Clone, Debug)]
pub(super) struct Limit {
    /// Key of its group, as in the figure's groups and legend.
    group: String,
    /// The requirement: its name and its text.
    label: String,
    /// In SI.
    pub value: f64,
    /// Whether values above it fail; otherwise those below it do.
    is_upper: bool,
    /// Start and end of its time, s.
    times: (f64, f64),
}

/// All constant limits of an output.
pub(super) fn limits(requirements: &[RequirementSummary], output: &str) -> Vec<Limit> {
    let lines = requirements.iter().flat_map(|own| own.limits.iter().map(move |line| (own, line)));
    let of_output = lines.filter(|(_, line)| line.output == output && line.value.is_finite());
    let limit = |(index, (own, line)): (usize, (&RequirementSummary, &LimitLine))| Limit {
        group: format!("limit-{index}"),
        label: format!("{}: {}", own.name, own.text),
        value: line.value,
        is_upper: line.is_upper,
        times: (line.from, line.to),
    };
    of_output.enumerate().map(limit).collect()
}

impl Limit {
    /// The limit minus a course at each of its times; NaN at other times.
    pub fn less(&self, times: &[f64], course: &[f64]) -> Vec<f64> {
        let holds = |time: f64| time >= self.times.0 && time <= self.times.1;
        times.iter().zip(course).map(|(&time, x)| if holds(time) { self.value - x } else { f64::NAN }).collect()
    }

    /// The same limit over the whole axis of a figure, such as a parameter's values instead of times.
    pub fn everywhere(&self) -> Self {
        Self { times: (f64::NEG_INFINITY, f64::INFINITY), ..self.clone() }
    }

    /// Its entry in the legend; a limit may be too far away to be seen.
    pub fn entry(&self, is_seen: bool) -> Entry {
        let label = if is_seen { self.label.clone() } else { format!("{} (beyond the plot)", self.label) };
        Entry { group: self.group.clone(), label, sign: Sign::Limit }
    }

    /// The limit in a panel of values, and the forbidden side.
    pub fn drawn(&self, panel: &Panel) -> Group {
        let (first, last) = (panel.x.min * panel.x.unit.factor, panel.x.max * panel.x.unit.factor);
        let [from, to] = [self.times.0.max(first), self.times.1.min(last)].map(|time| panel.place(time, self.value));
        let edge = if self.is_upper { panel.top } else { panel.bottom };
        let forbidden = line_data(&[from, to, (to.0, edge), (from.0, edge)]) + "z";
        self.series(panel)
            .add(Path::new().set("class", "forbidden").set("d", forbidden))
            .add(Path::new().set("class", "limit").set("d", line_data(&[from, to])))
    }

    /// The limit minus the nominal course, in a panel of deviations.
    pub fn drawn_below(&self, panel: &Panel, times: &[f64], course: &[f64]) -> Group {
        let less = self.less(times, course);
        runs([times, &less]).into_iter().fold(self.series(panel), |group, rows| {
            let points: Vec<Point> = rows.map(|row| panel.place(times[row], less[row])).collect();
            let points = thinned(points.into_iter());
            group.add(Path::new().set("class", "limit").set("d", line_data(&points)))
        })
    }

    /// Its series, for the scripts that show the figure; `course` is zero in a panel of values.
    pub fn data(&self, panel: &Panel, times: &[f64], course: &[f64]) -> SeriesData {
        let less = self.less(times, course);
        let [lower, upper] = extremes(&less, &less, panel.y);
        let (id, group, label) = (self.id(panel), self.group.clone(), self.label.clone());
        SeriesData { id, group, label, kind: "limit", panel: panel.id.clone(), time: None, lower, upper }
    }

    fn id(&self, panel: &Panel) -> String {
        format!("{}-{}", panel.id, self.group)
    }

    fn series(&self, panel: &Panel) -> Group {
        let id = self.id(panel);
        let group = Group::new().set("class", "series").set("data-series", id).set("data-group", self.group.clone());
        group.add(Title::new(self.label.clone()))
    }
}

/// For each limit, whether it is near enough to `values` to be shown: at most as far away as these extend.
pub(super) fn near<'l>(limits: &'l [Limit], values: &[f64]) -> impl Iterator<Item = bool> + use<'l> {
    let finite = values.iter().filter(|x| x.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    let reach = if high > low { high - low } else { f64::INFINITY };
    limits.iter().map(move |limit| limit.value >= low - reach && limit.value <= high + reach)
}
