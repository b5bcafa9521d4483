//! Which joints can close loops in joint coordinates.
//!
//! A mechanism with loops has a tree for every choice of the joints that close them (Wittenburg, *Dynamics of Systems of Rigid Bodies*
//! (1977), ch. 5.3). Every tree is reached from every other by exchanges: a joint that closes a loop becomes an inboard joint, and another
//! of its loop closes it.

use super::tree::Tree;
use crate::model::Description;

/// Of more bodies only the cut of the shallowest trees is looked at.
const MOST_BODIES: usize = 50;

/// The cuts that differ from a description's own in one exchange, each with all joints that close a loop; first those that promise the
/// fewest operations; none of large mechanisms.
pub fn other_cuts(description: &Description) -> Vec<Vec<usize>> {
    if description.bodies.len() > MOST_BODIES {
        return Vec::new();
    }
    let tree = Tree::spanning(description, |_| true);
    let cut = tree.closing(description);
    let mut cuts = Vec::new();
    let mut exchanged = description.clone();
    for &closing in &cut {
        let kind = &description.joints[closing].kind;
        let (Some([first, second]), Some(_)) = (kind.between(), kind.mobilizer()) else { continue };
        if description.joints[closing].merged {
            continue;
        }
        for joint in tree.joints_between([first.body, second.body]) {
            let mut other: Vec<usize> = cut.iter().copied().filter(|&one| one != closing).chain([joint]).collect();
            other.sort_unstable();
            exchanged.cut_at(&other);
            cuts.push((effort(&exchanged), other));
        }
    }
    cuts.sort();
    cuts.into_iter().map(|(_, cut)| cut).collect()
}

/// About how many operations a cut takes: those of the elimination of M, and of each closure with the joints of its loop.
fn effort(description: &Description) -> usize {
    let tree = Tree::spanning(description, |_| true);
    let lengths = tree.closing(description).into_iter().filter_map(|joint| {
        let [first, second] = description.joints[joint].kind.between()?;
        Some(tree.joints_between([first.body, second.body]).len())
    });
    lengths.map(|length| length * length).sum::<usize>() + tree.elimination()
}
