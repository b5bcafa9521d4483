//! `report.html`: one page of a model's results, or of all its scenes', that loads nothing from elsewhere.

use data_encoding::BASE64;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::html::{escaped, image, inline_svg, is_figure, script_json};
use super::script::{REPORT_STYLE, SCRIPT};
use super::statistics;
use super::tables::{self, text};

/// A scene of a page, or the model if it has no scenes.
#[derive(Debug)]
pub(in crate::export) struct PageScene {
    /// The scene's name; the model's own if it has no scenes.
    pub name: String,
    /// `summary.json`
    pub summary: Value,
    /// `motion.json`; null if absent.
    pub motion: Value,
    /// Figures of each output.
    pub figures: Vec<PageFigure>,
}

/// The pictures of an output.
#[derive(Clone, Debug)]
pub(in crate::export) struct PageFigure {
    /// The output.
    pub output: String,
    /// SVG documents: its bounds, and the contributions of parameters if they are known.
    pub plots: Vec<String>,
}

/// The page.
pub(in crate::export) fn page(model: &str, scenes: &[PageScene]) -> String {
    let data: Vec<Value> = scenes.iter().map(data).collect();
    let contents: String =
        scenes.iter().enumerate().map(|(index, scene)| content(index, scene, scenes.len())).collect();
    let description = scenes.iter().map(|scene| text(&scene.motion, "description")).find(|text| !text.is_empty());
    let description = description.map(|text| format!("<p class=\"description\">{}</p>", escaped(text)));
    let title = escaped(model);
    let icon = "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg'/%3E";
    let data = script_json(&Value::Array(data));
    // Hash of the whole contents of the page, so that nothing in it can know it.
    let nonce =
        BASE64.encode(&Sha256::new().chain_update(&contents).chain_update(&data).chain_update(&title).finalize());
    // Nothing is fetched, and a browser that is asked to would refuse; no script runs but this page's own.
    let policy = format!(
        "default-src 'none'; style-src 'unsafe-inline'; script-src 'nonce-{nonce}'; img-src data:; base-uri 'none'; \
         form-action 'none'"
    );
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title} – mbint</title>\n\
         <link rel=\"icon\" href=\"{icon}\">\n<style>{REPORT_STYLE}</style>\n</head>\n<body>\n\
         <header><div class=\"title\"><h1>{title}</h1>{}</div><nav id=\"scenes\" aria-label=\"Scenes\"></nav></header>\n\
         <main>\n<div id=\"stage\" hidden></div>\n{contents}</main>\n\
         <footer>Made by mbint {}. Nothing on this page comes from elsewhere.</footer>\n\
         <script type=\"application/json\" id=\"mbint-data\">{}</script>\n\
         <script type=\"module\" nonce=\"{nonce}\">{}</script>\n</body>\n</html>\n",
        description.unwrap_or_default(),
        escaped(scenes.first().map_or("", |scene| text(&scene.summary, "mbint"))),
        data,
        SCRIPT.as_str(),
    )
}

/// Data of the scripts: without the picture, which the page has as elements.
fn data(scene: &PageScene) -> Value {
    let mut motion = scene.motion["motion"].clone();
    if let Some(motion) = motion.as_object_mut() {
        motion.remove("picture");
    }
    json!({
        "name": scene.name,
        "duration": scene.summary["duration"],
        "outputs": scene.figures.iter().map(|figure| &figure.output).collect::<Vec<_>>(),
        "requirements": scene.summary.get("requirements").unwrap_or(&Value::Null),
        "motion": motion,
        "derivatives": scene.motion["derivatives"],
    })
}

/// A scene's article: warnings, verdicts, plots and tables.
pub(super) fn content(index: usize, scene: &PageScene, scenes: usize) -> String {
    let PageScene { name, summary, motion, figures } = scene;
    let heading = if scenes > 1 { format!("<h2>{}</h2>", escaped(name)) } else { String::new() };
    let warnings = tables::warnings(summary, motion);
    let picture = text(&motion["motion"], "picture");
    let picture = match picture.is_empty() {
        true => String::new(),
        // As a separate picture: its style is not that of the page.
        false => {
            format!("<div class=\"still\"><img alt=\"The mechanism at its start\" src=\"{}\"></div>", image(picture))
        }
    };
    let plots: String = figures
        .iter()
        .enumerate()
        .map(|(number, figure)| {
            let prefix = |kind: usize| format!("s{index}p{number}k{kind}-");
            let svgs = figure.plots.iter().enumerate();
            let output = escaped(&figure.output);
            // Figures of other programs are images, in which nothing acts.
            let plot = |(kind, svg): (usize, &String)| match is_figure(svg) {
                true => inline_svg(svg, &prefix(kind)),
                false => format!("<img alt=\"{output}\" src=\"{}\">", image(svg)),
            };
            let svgs: String = svgs.map(|plot_of| format!("<div class=\"plot\">{}</div>", plot(plot_of))).collect();
            format!("<figure data-output=\"{number}\"><figcaption>{output}</figcaption>{svgs}</figure>\n")
        })
        .collect();
    [
        format!("<article class=\"scene\" data-scene=\"{index}\">{heading}\n"),
        tables::warning_list(&warnings),
        tables::requirements(summary),
        picture,
        format!("<section class=\"plots\">{plots}</section>\n"),
        statistics::statistics(summary),
        tables::reduced(summary),
        tables::events(summary),
        tables::bounds(summary),
        tables::parameters(summary),
        tables::settings(summary),
        tables::model_text(motion),
        "</article>\n".to_owned(),
    ]
    .concat()
}
