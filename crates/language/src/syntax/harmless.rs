//! Text from files, made harmless for a terminal.
//!
//! A name may hold characters that move the cursor, set the window's title or reverse the line. Everything that is
//! shown to people goes through [`harmless`]; files for other programs (CSV, JSON) keep names as they are.

/// The text with every control character (but line ends and tabs), and every character that changes the direction of
/// writing or breaks lines, replaced by U+FFFD.
pub fn harmless(text: &str) -> String {
    text.replace(is_harmful, "\u{fffd}")
}

/// Whether [`harmless`] replaces a character.
pub fn is_harmful(c: char) -> bool {
    let control = c.is_control() && !matches!(c, '\n' | '\t');
    control || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_replaced() {
        assert_eq!(harmless("a\u{1b}[31mb\u{7}\u{9b}2J\r\n\tθ"), "a\u{fffd}[31mb\u{fffd}\u{fffd}2J\u{fffd}\n\tθ");
        assert_eq!(harmless("\u{202e}x\u{2066}\u{200f}"), "\u{fffd}x\u{fffd}\u{fffd}");
    }
}
