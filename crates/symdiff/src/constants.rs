//! Adjustable constants of a room: limits, defaults and thresholds, each with its reason and with the results that move
//! if it changes. A room has them in one struct, `Tuning`; `mbint explain --tuning` lists them (decision 0157).

/// A constant, for people.
#[derive(Clone, Debug)]
pub struct Constant {
    /// The room to which it belongs.
    pub room: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its value as written in the source.
    pub value: &'static str,
    /// Its meaning and the reason for its value.
    pub why: &'static str,
    /// Results and messages that depend on it.
    pub moves: &'static str,
}

/// Declares the struct `Tuning` of a room and its value `TUNING`.
#[doc(hidden)]
#[macro_export]
macro_rules! __tuning {
    (
        $(#[doc = $doc:literal])*
        $room:literal {
            $($(#[doc = $why:literal])+ $name:ident: $type:ty = $value:expr, moves $moves:literal;)*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct Tuning {
            $($(#[doc = $why])+ pub $name: $type,)*
        }

        /// The constants of this room.
        pub const TUNING: Tuning = Tuning { $($name: $value,)* };

        impl Tuning {
            /// The constants, for people.
            pub fn constants() -> Vec<$crate::constants::Constant> {
                vec![$($crate::constants::Constant {
                    room: $room,
                    name: stringify!($name),
                    value: stringify!($value),
                    why: concat!($($why),+).trim_ascii(),
                    moves: $moves,
                }),*]
            }
        }
    };
}

pub use __tuning as tuning;
