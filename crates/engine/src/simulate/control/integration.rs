//! How the steps of a schedule are taken.

use serde::{Deserialize, Serialize};

use crate::numerics::STEP_NODES;

/// Method of a schedule's steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integration {
    /// The scheme, once.
    #[default]
    Plain,
    /// The scheme on several levels, each with the steps of the one before halved, combined so that the leading terms
    /// of their errors cancel.
    Extrapolated {
        /// 2, 3 or 4.
        levels: usize,
    },
    /// Dormand and Prince's explicit method of order 8.
    Explicit,
    /// The same method in segments that end at events.
    Segments,
    /// The scheme on several levels, in segments that end at events.
    SchemeSegments {
        /// 1 to 4; 1 is the scheme itself.
        levels: usize,
    },
}

impl Integration {
    /// Integration with `levels` levels; one is the scheme itself.
    pub fn of_levels(levels: usize) -> Self {
        if levels > 1 { Self::Extrapolated { levels } } else { Self::Plain }
    }

    /// Steps that are taken for each of the schedule's.
    pub fn steps(self) -> usize {
        match self {
            Self::Plain | Self::Explicit | Self::Segments => 1,
            Self::Extrapolated { levels } => (1 << levels) - 1,
            // One of the first level between each two of the states that its polynomial goes through.
            Self::SchemeSegments { levels } => (STEP_NODES - 1) * ((1 << levels) - 1),
        }
    }

    /// Whether motions are cut at events.
    pub fn is_cut(self) -> bool {
        matches!(self, Self::Segments | Self::SchemeSegments { .. })
    }

    /// Whether a name is that of one by which motions are cut at events.
    pub fn is_cut_by_name(name: &str) -> bool {
        let all = std::iter::once(Self::Segments).chain((1..=4).map(|levels| Self::SchemeSegments { levels }));
        all.filter_map(Self::name).any(|own| own == name)
    }

    /// The order at which the error falls with the steps where the motion is smooth.
    pub fn order(self) -> usize {
        match self {
            Self::Plain => 2,
            Self::Extrapolated { levels } | Self::SchemeSegments { levels } => levels + 1,
            Self::Explicit | Self::Segments => 8,
        }
    }

    /// Name for summaries; `None` for the scheme itself.
    pub fn name(self) -> Option<String> {
        match self {
            Self::Plain => None,
            Self::Extrapolated { levels } => Some(format!("HHT-I3 extrapolated over {levels} levels")),
            Self::Explicit => Some("Dormand–Prince 8(5,3), explicit".to_owned()),
            Self::Segments => Some("Dormand–Prince 8(5,3), explicit, between events".to_owned()),
            Self::SchemeSegments { levels: 1 } => Some("HHT-I3 between events".to_owned()),
            Self::SchemeSegments { levels } => {
                Some(format!("HHT-I3 extrapolated over {levels} levels, between events"))
            }
        }
    }
}
