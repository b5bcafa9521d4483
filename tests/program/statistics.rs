//! The example of the guide to statistics is run, and what it says is there.

use std::fs;
use std::path::Path;

use crate::place::Place;

#[test]
fn the_guides_example_has_statistics_beside_its_bounds() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guides/statistics.md")).unwrap();
    let example = page.split("```yaml\n").nth(1).unwrap().split("```").next().unwrap();
    let place = Place::new();
    fs::write(place.path().join("stack.yaml"), example).unwrap();
    let (printed, _) = place.run("run stack.yaml -o out", 0);
    for word in
        ["worst case", "RSS", "a normal (deviation 3.333e-5, of which the tolerance is three)", "d.deviation uniform"]
    {
        assert!(printed.contains(word), "{word}: {printed}");
    }
    let table = fs::read_to_string(place.path().join("out/statistics.csv")).unwrap();
    let heading = "t,gap.mean,gap.mean.error,gap.deviation,gap.deviation.error,gap.q0.05,gap.q0.05.error,gap.q0.5,gap.q0.5.error,\
        gap.q0.95,gap.q0.95.error,gap.linear,gap.rss,unresolved";
    assert_eq!(table.lines().next().unwrap(), heading);
    assert_eq!(table.lines().count(), 4);
    // ± 0.1, 0.2, 0.1 and 0.01 mm.
    let last: Vec<f64> = table.lines().last().unwrap().split(',').take(13).map(|cell| cell.parse().unwrap()).collect();
    assert!((last[1] - 1e-3).abs() < 1e-7 && (last[11] - 0.41e-3).abs() < 1e-9, "{last:?}");
}
