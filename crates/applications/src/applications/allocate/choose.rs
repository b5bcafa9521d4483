//! The cheapest multiples of tolerances that leave something of every margin.

use super::items::{Choice, Item};
use super::tuning::TUNING;
use super::worst::Slack;
use crate::numerics::{Linear, Power, cheapest};
use symdiff::math;

/// The choice.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    pub multiples: Vec<f64>,
    /// Whether no cheaper combination was omitted from the search.
    pub is_exhaustive: bool,
}

/// The cheapest multiples, searched from `start` on; `None` if not even the tightest are good enough.
pub fn choose(slack: &mut dyn Slack, items: &[Item], start: &[f64]) -> Option<Chosen> {
    let tightest: Vec<f64> = items.iter().map(Item::tightest).collect();
    if !is_good(slack, &tightest) {
        return None;
    }
    if items.iter().any(|item| item.choice == Choice::Together) {
        let multiples = together(slack, items, &tightest);
        return Some(Chosen { multiples, is_exhaustive: true });
    }
    if items.iter().any(|item| matches!(item.choice, Choice::Grades(_))) {
        let mut search = Grades { slack, items, start, best: None, tried: 0 };
        search.descend(&mut tightest.clone(), 0, 0.0);
        let is_exhaustive = search.tried < TUNING.combinations;
        return search.best.map(|(_, multiples)| Chosen { multiples, is_exhaustive });
    }
    Some(Chosen { multiples: continuous(slack, items, &tightest, start), is_exhaustive: true })
}

fn is_good(slack: &mut dyn Slack, multiples: &[f64]) -> bool {
    slack.least(multiples) >= -TUNING.rounding
}

/// One factor for all that may change.
fn together(slack: &mut dyn Slack, items: &[Item], tightest: &[f64]) -> Vec<f64> {
    let with = |factor: f64| -> Vec<f64> {
        let of = |(item, least): (&Item, &f64)| match item.choice {
            Choice::Together => factor.clamp(*least, item.widest),
            _ => 1.0,
        };
        items.iter().zip(tightest).map(of).collect()
    };
    let widest = items.iter().map(|item| item.widest).fold(1.0, f64::max);
    let least = tightest.iter().copied().fold(1.0, f64::min);
    with(largest(slack, least, widest, &with))
}

/// The largest factor up to `most` that is good; `least` is. By the Illinois variant of false position (M. Dowell & P.
/// Jarratt, BIT 11 (1971) 168), which keeps the root between two factors.
fn largest(slack: &mut dyn Slack, least: f64, most: f64, with: &dyn Fn(f64) -> Vec<f64>) -> f64 {
    let mut high = (most, slack.least(&with(most)));
    if high.1 >= -TUNING.rounding {
        return most;
    }
    let mut low = (least, slack.least(&with(least)));
    let (mut weights, mut side) = ([low.1.max(0.0), high.1], 0);
    for _ in 0..TUNING.secants {
        if low.1 < TUNING.close || high.0 - low.0 < TUNING.close * high.0 || slack.is_interrupted() {
            break;
        }
        let middle = (low.0 * weights[1] - high.0 * weights[0]) / (weights[1] - weights[0]);
        let middle = if middle > low.0 && middle < high.0 { middle } else { 0.5 * (low.0 + high.0) };
        let found = (middle, slack.least(&with(middle)));
        if found.1 >= -TUNING.rounding {
            if side == 1 {
                weights[1] *= 0.5;
            }
            (low, weights[0], side) = (found, found.1, 1);
        } else {
            if side == -1 {
                weights[0] *= 0.5;
            }
            (high, weights[1], side) = (found, found.1, -1);
        }
    }
    low.0
}

/// Multiples of those that have a cost for each; others keep their least ones.
fn continuous(slack: &mut dyn Slack, items: &[Item], tightest: &[f64], start: &[f64]) -> Vec<f64> {
    let priced: Vec<usize> = (0..items.len()).filter(|&i| matches!(items[i].choice, Choice::Reciprocal(_))).collect();
    if priced.is_empty() {
        return tightest.to_vec();
    }
    let mut from = tightest.to_vec();
    priced.iter().for_each(|&i| from[i] = start[i].clamp(tightest[i], items[i].widest));
    // If worst cases lie inside of the box, sizes hardly change them: the linearisation begins where all requirements
    // hold.
    let is_flat = slack.power() == Power::First && is_flat(slack, &from, tightest);
    let starts = if is_flat { flat_starts(slack, items, tightest, &priced, &from) } else { vec![from] };
    let cost = |multiples: &[f64]| priced.iter().filter_map(|&i| items[i].cost(multiples[i])).sum::<f64>();
    let found = starts.into_iter().map(|start| settled(slack, items, tightest, &priced, start));
    let cheaper = |a: Vec<f64>, b: Vec<f64>| if cost(&b) < cost(&a) { b } else { a };
    found.reduce(cheaper).unwrap_or_else(|| tightest.to_vec())
}

/// Starts at which all requirements hold: with all sizes smaller by a factor, and, since one that passes its worst case
/// costs nothing more of a margin, with each at its widest and the others smaller.
fn flat_starts(
    slack: &mut dyn Slack,
    items: &[Item],
    tightest: &[f64],
    priced: &[usize],
    from: &[f64],
) -> Vec<Vec<f64>> {
    let mut starts = Vec::new();
    for wide in std::iter::once(None).chain(priced.iter().map(|&wide| Some(wide))) {
        let with = |factor: f64| -> Vec<f64> {
            let of = |i: usize| match wide == Some(i) {
                true => items[i].widest,
                false if priced.contains(&i) => (factor * from[i]).max(tightest[i]),
                false => from[i],
            };
            (0..items.len()).map(of).collect()
        };
        let least = priced.iter().map(|&i| tightest[i] / from[i]).fold(1.0, f64::min);
        if wide.is_none() || !slack.is_interrupted() && is_good(slack, &with(least)) {
            starts.push(with(largest(slack, least, 1.0, &with)));
        }
    }
    starts
}

/// The cheapest multiples near to some, by linearisation.
fn settled(
    slack: &mut dyn Slack,
    items: &[Item],
    tightest: &[f64],
    priced: &[usize],
    mut multiples: Vec<f64>,
) -> Vec<f64> {
    let costs: Vec<f64> = priced.iter().filter_map(|&i| items[i].cost(1.0)).collect();
    let which = usize::from(slack.power() == Power::Second);
    let (rounds, settled) = (TUNING.rounds_of_choice[which], TUNING.settled_choice[which]);
    let pick = |all: &[f64]| -> Vec<f64> { priced.iter().map(|&i| all[i]).collect() };
    for round in 0..rounds {
        if slack.power() == Power::First {
            slack.left(&multiples);
        }
        let mut constraints = slack.linearised(&multiples);
        constraints.iter_mut().for_each(|constraint| constraint.slopes = pick(&constraint.slopes));
        let change = math::pow(TUNING.first_change, 1.0 / (1.0 + round as f64 / 8.0));
        let ends = |to: f64| priced.iter().map(move |&i| (i, to));
        let least: Vec<f64> = ends(1.0 / change).map(|(i, change)| (multiples[i] * change).max(tightest[i])).collect();
        let most: Vec<f64> = ends(change).map(|(i, change)| (multiples[i] * change).min(items[i].widest)).collect();
        let found = cheapest(&costs, slack.power(), &pick(&multiples), &constraints, &least, &most);
        let moved = priced.iter().zip(&found).map(|(&i, found)| (found / multiples[i] - 1.0).abs()).fold(0.0, f64::max);
        priced.iter().zip(&found).for_each(|(&i, &found)| multiples[i] = found);
        if moved < settled || slack.is_interrupted() {
            break;
        }
    }
    // One factor for all makes up for the error of the linearisation.
    let with = |factor: f64| -> Vec<f64> {
        let of = |i: usize| match priced.contains(&i) {
            true => (factor * multiples[i]).clamp(tightest[i], items[i].widest),
            false => multiples[i],
        };
        (0..items.len()).map(of).collect()
    };
    let least = priced.iter().map(|&i| tightest[i] / multiples[i]).fold(1.0, f64::min);
    with(largest(slack, least, 1.0, &with))
}

/// Whether, by its linearisation in the multiples, a constraint does not hold with the tightest ones either, with which
/// all do.
fn is_flat(slack: &mut dyn Slack, multiples: &[f64], tightest: &[f64]) -> bool {
    slack.left(multiples);
    let moves: Vec<f64> = multiples.iter().zip(tightest).map(|(at, least)| least - at).collect();
    let with_tightest = |constraint: &Linear| {
        constraint.value + constraint.slopes.iter().zip(&moves).map(|(slope, moved)| slope * moved).sum::<f64>()
    };
    slack.linearised(multiples).iter().any(|constraint| with_tightest(constraint) < -TUNING.rounding)
}

/// A search through grades, depth first, the cheapest of each first.
struct Grades<'a> {
    slack: &'a mut dyn Slack,
    items: &'a [Item],
    start: &'a [f64],
    /// Cost and multiples.
    best: Option<(f64, Vec<f64>)>,
    tried: usize,
}

impl Grades<'_> {
    /// Chooses for the items from `index` on; those before are chosen and cost so much.
    fn descend(&mut self, multiples: &mut Vec<f64>, index: usize, cost: f64) {
        let least: f64 = self.items[index..].iter().map(|item| item.cost(item.widest).unwrap_or(0.0)).sum();
        if self.best.as_ref().is_some_and(|best| cost + least >= best.0)
            || self.tried >= TUNING.combinations
            || self.slack.is_interrupted()
        {
            return;
        }
        let Some(item) = self.items.get(index) else {
            let mut found = multiples.clone();
            if self.items.iter().any(|item| matches!(item.choice, Choice::Reciprocal(_))) {
                found = continuous(self.slack, self.items, &found, self.start);
            }
            let whole: f64 = self.items.iter().zip(&found).filter_map(|(item, multiple)| item.cost(*multiple)).sum();
            if self.best.as_ref().is_none_or(|best| whole < best.0) {
                self.best = Some((whole, found));
            }
            return;
        };
        let Choice::Grades(grades) = &item.choice else { return self.descend(multiples, index + 1, cost) };
        let tightest = multiples[index];
        for (multiple, own, _) in grades {
            multiples[index] = *multiple;
            self.tried += 1;
            // Those that come are at their tightest still.
            if !self.slack.is_known_to_fail(multiples) && is_good(self.slack, multiples) {
                self.descend(multiples, index + 1, cost + own);
            }
        }
        multiples[index] = tightest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 − Σ s f.
    struct Stack(Vec<f64>);

    impl Slack for Stack {
        fn left(&mut self, multiples: &[f64]) -> Vec<f64> {
            vec![1.0 - self.0.iter().zip(multiples).map(|(s, f)| s * f).sum::<f64>()]
        }

        fn is_known_to_fail(&self, _: &[f64]) -> bool {
            false
        }

        fn linearised(&mut self, multiples: &[f64]) -> Vec<Linear> {
            let value = 1.0 - self.0.iter().zip(multiples).map(|(s, f)| s * f).sum::<f64>();
            vec![Linear { value, slopes: self.0.iter().map(|s| -s).collect() }]
        }

        fn is_interrupted(&self) -> bool {
            false
        }

        fn power(&self) -> Power {
            Power::First
        }

        fn slopes_at_least(&mut self, _: &[f64], _: usize) -> Vec<f64> {
            self.0.iter().map(|s| -s).collect()
        }

        fn reserves(&mut self) -> &mut [f64] {
            &mut []
        }
    }

    fn item(choice: Choice) -> Item {
        let widest = match &choice {
            Choice::Fixed => 1.0,
            Choice::Grades(grades) => grades.iter().map(|grade| grade.0).fold(0.0, f64::max),
            _ => 10.0,
        };
        Item { name: String::new(), unit: String::new(), nominal: 0.0, above: 1.0, below: 1.0, choice, widest }
    }

    #[test]
    fn grades_match_brute_force() {
        let sets = [
            vec![(0.9, 1.0), (0.5, 2.0), (0.2, 5.0), (0.1, 9.0)],
            vec![(0.8, 0.5), (0.4, 3.0), (0.1, 4.0)],
            vec![(0.7, 2.0), (0.3, 2.5), (0.05, 7.0)],
        ];
        let slopes = vec![0.7, 1.1, 0.9];
        let items: Vec<Item> = sets
            .iter()
            .map(|set| item(Choice::Grades(set.iter().map(|(f, c)| (*f, *c, String::new())).collect())))
            .collect();
        let found = choose(&mut Stack(slopes.clone()), &items, &[1.0; 3]).unwrap();
        let mut best = (f64::INFINITY, Vec::new());
        for a in &sets[0] {
            for b in &sets[1] {
                for c in &sets[2] {
                    let (sum, cost) = (slopes[0] * a.0 + slopes[1] * b.0 + slopes[2] * c.0, a.1 + b.1 + c.1);
                    if sum <= 1.0 && cost < best.0 {
                        best = (cost, vec![a.0, b.0, c.0]);
                    }
                }
            }
        }
        assert!(found.is_exhaustive && found.multiples == best.1, "{found:?} {best:?}");
    }

    #[test]
    fn common_multiples_and_mixed_costs_are_optimal() {
        let found =
            choose(&mut Stack(vec![0.2, 0.3]), &[item(Choice::Together), item(Choice::Together)], &[1.0; 3]).unwrap();
        assert!(found.multiples.iter().all(|f| (f - 2.0).abs() < 1e-6), "{found:?}");
        let fixed = [item(Choice::Fixed), item(Choice::Together)];
        let found = choose(&mut Stack(vec![0.5, 0.25]), &fixed, &[1.0; 3]).unwrap();
        assert!(found.multiples[0] == 1.0 && (found.multiples[1] - 2.0).abs() < 1e-6, "{found:?}");
        assert_eq!(choose(&mut Stack(vec![1.5, 0.1]), &fixed, &[1.0; 3]), None);
        // A grade and a cost by tolerance: the pair with the least sum of costs.
        let grades = Choice::Grades(vec![(0.5, 1.0, String::new()), (0.1, 2.0, String::new())]);
        let mixed = [item(grades), item(Choice::Reciprocal(1.0))];
        let found = choose(&mut Stack(vec![1.0, 1.0]), &mixed, &[1.0; 3]).unwrap();
        // 1 + 1/0.5 = 3 and 2 + 1/0.9 = 3.11.
        assert!(found.multiples[0] == 0.5 && (found.multiples[1] - 0.5).abs() < 1e-6, "{found:?}");
    }
}
