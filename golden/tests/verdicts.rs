//! The verdicts on the worked products.

use std::fmt::Write as _;

use clatter_scene::ProductFile;

const EXAMPLES: [&str; 3] = [
    include_str!("../../reports/examples/phone.toml"),
    include_str!("../../reports/examples/handheld-terminal.toml"),
    include_str!("../../reports/examples/laptop.toml"),
];

/// Three digits, more than any drop is known to: the search resolves no more, and a demand that is proven stands up to
/// half a percent above the worst drop.
#[test]
fn the_worked_products() {
    let mut text = String::new();
    for example in EXAMPLES {
        let assessment = ProductFile::read(example, "example").unwrap().assess().unwrap();
        let _ = writeln!(text, "{}: {:?}", assessment.product, assessment.verdict);
        for component in &assessment.components {
            let _ = writeln!(text, "  {}: {:?}", component.name, component.verdict);
            for limit in &component.limits {
                let proof = if limit.guaranteed { "proven" } else { "searched" };
                let _ = writeln!(
                    text,
                    "    {:<24} allowed {:.2e}, demand {:.2e} {:<6} margin {:+.2}; {} {}, {proof}",
                    limit.limit.name(),
                    limit.allowed,
                    limit.demand,
                    limit.unit.name(),
                    limit.margin,
                    limit.model.bar.name(),
                    limit.model.component.name(),
                );
            }
        }
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("verdicts", text));
}
