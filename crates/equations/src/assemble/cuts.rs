//! Which joints can close loops in joint coordinates.
//!
//! A mechanism with loops has a tree for every choice of the joints that close them (Wittenburg, *Dynamics of Systems
//! of Rigid Bodies* (1977), ch. 5.3). Every tree is reached from every other by exchanges: a joint that closes a loop
//! becomes an inboard joint, and another of its loop closes it. Joints of several axes can be constraints where they
//! close no loop, too: the bodies behind them have coordinates of their own then.

use super::questions::Questions;
use super::tree::Tree;
use crate::assemble::tuning::TUNING;
use crate::elements::joints::Mobilizer;

/// The cuts that differ from the given one in one exchange, each with all joints that are constraints; first
/// those that promise the fewest operations; none of large mechanisms.
pub fn other_cuts(questions: &Questions) -> Vec<Vec<usize>> {
    let description = questions.description;
    if description.bodies.len() > TUNING.bodies_with_cuts {
        return Vec::new();
    }
    let tree = Tree::spanning(questions, |_| true);
    let cut = tree.closing(description);
    let mut cuts = Vec::new();
    let mut add = |mut other: Vec<usize>| {
        other.sort_unstable();
        cuts.push((effort(&questions.cut_at(other.clone())), other));
    };
    for &closing in &cut {
        let kind = &description.joints[closing].kind;
        let (Some([first, second]), Some(_)) = (kind.between(), kind.mobilizer()) else { continue };
        if questions.is_merged(closing) {
            continue;
        }
        let bodies = [first.body, second.body];
        let others = cut.iter().copied().filter(|&one| one != closing);
        // Between two trees a joint closes no loop.
        let roots = bodies.map(|body| tree.root_of(body));
        let moves = |root: &usize| description.bodies[*root].is_free(description.space.spatial);
        if roots[0] != roots[1] && roots.iter().any(moves) {
            add(others.collect());
            continue;
        }
        for joint in tree.joints_between(bodies) {
            add(others.clone().chain([joint]).collect());
        }
    }
    cuts.sort();
    cuts.into_iter().map(|(_, cut)| cut).collect()
}

/// The cuts that take further joints of several axes: all spherical ones, and all; none of large mechanisms.
pub fn cuts_of_several_axes(questions: &Questions) -> Vec<Vec<usize>> {
    let description = questions.description;
    if description.bodies.len() > TUNING.bodies_with_cuts {
        return Vec::new();
    }
    let tree = Tree::spanning(questions, |_| true);
    let cut = tree.closing(description);
    let with = |of: fn(&Mobilizer) -> bool| {
        let joints = description.joints.iter().enumerate().filter(|(joint, _)| tree.contains(*joint));
        let found = joints.filter(|(_, joint)| joint.kind.mobilizer().is_some_and(|mobilizer| of(&mobilizer)));
        let mut other: Vec<usize> = found.map(|(joint, _)| joint).chain(cut.iter().copied()).collect();
        other.sort_unstable();
        other
    };
    let spherical = with(|mobilizer| matches!(mobilizer, Mobilizer::FreeRotation));
    let several = with(|mobilizer| !mobilizer.has_one_axis());
    let mut cuts = vec![spherical, several];
    cuts.dedup();
    cuts.retain(|other| *other != cut);
    cuts
}

/// Approximate number of operations that a cut takes: those of the elimination of M, and of each closure with the
/// joints of its loop.
fn effort(questions: &Questions) -> usize {
    let description = questions.description;
    let tree = Tree::spanning(questions, |_| true);
    let lengths = tree.closing(description).into_iter().filter_map(|joint| {
        let [first, second] = description.joints[joint].kind.between()?;
        Some(tree.joints_between([first.body, second.body]).len())
    });
    lengths.map(|length| length * length).sum::<usize>() + tree.elimination()
}
