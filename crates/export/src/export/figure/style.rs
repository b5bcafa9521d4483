//! Colours of figures: for light and dark readers, and distinct for every colour vision.
//!
//! Programs without custom properties (editors, converters) ignore a declaration with `var()`, and take the one before
//! it.

/// Style of all figures. A figure may be in a page with others: every rule applies to figures only.
pub const STYLE: &str = "
.mbint-figure { --mb-paper: #fff; --mb-ink: #222; --mb-frame: #666; --mb-grid: #e4e4e4; font-family: Helvetica, Arial, sans-serif; font-size: 13px; }
.mbint-figure text { fill: #222; fill: var(--mb-ink); }
.mbint-figure .heading { font-weight: bold; font-size: 14px; }
.mbint-figure .paper { fill: #fff; fill: var(--mb-paper); }
.mbint-figure .grid { stroke: #e4e4e4; stroke: var(--mb-grid); }
.mbint-figure .frame { stroke: #666; stroke: var(--mb-frame); fill: none; }
.mbint-figure .ink { color: #222; color: var(--mb-ink); }
.mbint-figure .hue { color: var(--mb-light); }
.mbint-figure .line { stroke: currentColor; fill: none; stroke-linejoin: round; vector-effect: non-scaling-stroke; }
.mbint-figure .band { stroke: currentColor; fill: currentColor; stroke-linejoin: round; vector-effect: non-scaling-stroke; }
.mbint-figure .area { fill: currentColor; stroke: none; }
.mbint-figure .layer { fill: currentColor; stroke: #fff; stroke: var(--mb-paper); stroke-width: 0.7; }
.mbint-figure .hollow { fill: #fff; fill: var(--mb-paper); stroke: currentColor; }
.mbint-figure .limit { stroke: #c00; stroke: var(--mb-limit, #c00); stroke-width: 1.5; stroke-dasharray: 7 3; fill: none; }
.mbint-figure .forbidden { fill: #c00; fill: var(--mb-limit, #c00); fill-opacity: 0.08; }
@media (prefers-color-scheme: dark) {
.mbint-figure { --mb-paper: #151515; --mb-ink: #eee; --mb-frame: #999; --mb-grid: #333; --mb-limit: #ff7b6b; }
.mbint-figure .hue { color: var(--mb-dark); }
}
";

/// A colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(pub [u8; 3]);

/// Colours that every colour vision distinguishes, in the order of their use (after Okabe and Ito, 2008).
pub const PALETTE: [Color; 7] = [
    Color([0, 114, 178]),
    Color([230, 130, 0]),
    Color([0, 158, 115]),
    Color([204, 60, 140]),
    Color([86, 180, 233]),
    Color([150, 40, 20]),
    Color([110, 110, 110]),
];

/// Factor by which each repetition of the palette is darker.
const DARKER: f64 = 0.6;

/// Luminance that a colour needs on dark paper.
const BRIGHT: f64 = 0.3;

impl Color {
    /// The colour with index `index`.
    pub fn of(index: usize) -> Self {
        let scale = DARKER.powi((index / PALETTE.len()) as i32);
        Self(PALETTE[index % PALETTE.len()].0.map(|part| (f64::from(part) * scale) as u8))
    }

    /// The notation of SVG: `#0072b2`.
    pub fn hex(self) -> String {
        let [red, green, blue] = self.0;
        format!("#{red:02x}{green:02x}{blue:02x}")
    }

    /// The same hue on dark paper: mixed with white until it is bright enough.
    pub fn on_dark(self) -> Self {
        let mixed = |white: f64| Self(self.0.map(|part| (f64::from(part) * (1.0 - white) + 255.0 * white) as u8));
        let bright = (0..=20).map(|step| mixed(f64::from(step) / 20.0)).find(|color| color.luminance() >= BRIGHT);
        bright.unwrap_or(Self([255; 3]))
    }

    /// Approximate share of white's light, 0 to 1; with a gamma of 2 instead of the standard's 2.2.
    fn luminance(self) -> f64 {
        let [red, green, blue] = self.0.map(|part| (f64::from(part) / 255.0).powi(2));
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    }

    /// Both forms as an element's style.
    pub fn properties(self) -> String {
        format!("--mb-light:{};--mb-dark:{}", self.hex(), self.on_dark().hex())
    }
}

/// A colour, or that of the ink.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hue {
    /// Black on light paper, white on dark paper.
    Ink,
    /// A colour.
    Color(Color),
}

impl Hue {
    /// Paints an element in this colour: shapes of the classes `line`, `band`, `area` and `hollow` inside it inherit
    /// it.
    pub fn paint(self, element: svg::node::element::Group, class: &str) -> svg::node::element::Group {
        match self {
            Self::Ink => element.set("class", format!("{class} ink")),
            Self::Color(color) => {
                element.set("class", format!("{class} hue")).set("color", color.hex()).set("style", color.properties())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_of_the_palette_differ_in_grey_and_on_dark_paper() {
        let all: Vec<Color> = (0..20).map(Color::of).collect();
        for (index, color) in all.iter().enumerate() {
            assert!(!all[..index].contains(color), "{index}");
            assert!(color.on_dark().luminance() >= BRIGHT);
        }
        assert_eq!(Color([0, 114, 178]).hex(), "#0072b2");
        assert_eq!(Color([240, 200, 60]).on_dark(), Color([240, 200, 60]), "bright enough");
    }
}
