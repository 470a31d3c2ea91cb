//! 75 components driven by a clatter, against values computed with exact rational trains and 50-digit arithmetic.

use clatter::{Bar, Start};
use clatter_shock::{DampingRatio, Suspension, respond};
use serde_json::Value;

/// Share of the peak: the stated accuracy of the response to trains of up to 300 shocks.
const ALLOWED: f64 = 1e-12;

#[test]
fn peaks_agree_with_the_reference() {
    let data: Value = serde_json::from_str(include_str!("data/response.json")).unwrap();
    let cases = data["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 75, "cases");
    let number = |v: &Value| v.as_f64().unwrap_or_else(|| v.as_str().unwrap().parse().unwrap());
    let mut worst = 0.0_f64;
    for case in cases {
        let bar = Bar::new(number(&case["q"]), number(&case["e"])).unwrap();
        let damping = DampingRatio::new(number(&case["damping"])).unwrap();
        let suspension = Suspension::new(number(&case["omega"]), damping).unwrap();
        let got = respond(&bar, &Start::default(), number(&case["position"]), &suspension).unwrap();
        let name = &case["case"];
        for (key, value) in [
            ("omega_peak_relative_displacement", got.response.pseudo_velocity().magnitude()),
            (
                "peak_absolute_acceleration_over_omega",
                got.response.absolute_acceleration.magnitude() / suspension.omega(),
            ),
        ] {
            let want = number(&case[key]);
            let error = (value / want - 1.0).abs();
            worst = worst.max(error);
            assert!(error <= ALLOWED, "{name}: {key} = {value:?}, not {want:?}, off by {error:e}");
        }
        assert!(got.omitted <= 1e-14, "{name}: {:e} left out", got.omitted);
    }
    println!("worst relative error {worst:e}");
}
