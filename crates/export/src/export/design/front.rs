//! Cost against margin: a table, and a figure.

use crate::export::csv::number;
use crate::export::figure::Caption;
use crate::export::sweep::{TradeAxis, TradeMark, trade_svg};
use crate::results::{DesignStudy, DesignTrade};

/// Columns: margin, error, cost, a column for each parameter, and deviations upwards and downwards for each tolerance,
/// in SI; margins are shares of limits.
pub(super) fn table(design: &DesignStudy) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    let names = design.parameters.iter().map(|own| own.name.clone());
    let tolerances = design.front.first().map_or(&[][..], |own| &own.tolerances);
    let sides = tolerances.iter().flat_map(|own| ["above", "below"].map(|side| format!("{}.{side}", own.parameter)));
    writer.write_record(["margin", "error", "cost"].map(str::to_owned).into_iter().chain(names).chain(sides))?;
    for own in &design.front {
        let sides = own.tolerances.iter().flat_map(|own| [own.after.above, own.after.below]);
        let numbers = [own.margin, own.error, own.cost].into_iter().chain(own.values.iter().copied()).chain(sides);
        writer.write_record(numbers.map(number))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// The front, with the best point in addition if that has another objective.
pub(super) fn drawn(design: &DesignStudy) -> String {
    let at = |own: &DesignTrade| (100.0 * own.margin, own.cost);
    let line: Vec<(f64, f64)> = design.front.iter().map(at).collect();
    let present = design.allocation.as_ref().and_then(|own| own.costs()[0]);
    let best = design.best().zip(present).filter(|_| !design.is_priced());
    let marks: Vec<TradeMark> = match best {
        Some((best, cost)) => vec![TradeMark { label: "optimum", at: (100.0 * best.worst, cost) }],
        None => line.first().map(|&at| TradeMark { label: "optimum", at }).into_iter().collect(),
    };
    let axes = [TradeAxis { name: "margin, % of limits", unit: "" }, TradeAxis { name: "cost", unit: "" }];
    trade_svg(Caption { model: &design.model, prefix: "design" }, "cost against margin", axes, &line, &marks)
}
