//! 75 components driven by a clatter, against values computed with exact rational trains and 50-digit arithmetic.

use clatter::{Bar, Start};
use clatter_shock::accuracy::TRAIN;
use clatter_shock::{DampingRatio, Suspension, respond};
use serde_json::Value;

#[test]
fn peaks_agree_with_the_reference() {
    let data: Value = serde_json::from_str(include_str!("data/response.json")).expect("value");
    let cases = data["cases"].as_array().expect("value");
    assert_eq!(cases.len(), 75, "cases");
    let number = |v: &Value| v.as_f64().unwrap_or_else(|| v.as_str().expect("value").parse().expect("value"));
    for case in cases {
        let bar = Bar::new(number(&case["q"]), number(&case["e"])).expect("value");
        let damping = DampingRatio::new(number(&case["damping"])).expect("value");
        let suspension = Suspension::new(number(&case["omega"]), damping).expect("value");
        let got = respond(&bar, &Start::default(), number(&case["position"]), &suspension).expect("value");
        let name = &case["case"];
        for (key, value) in [
            ("omega_peak_relative_displacement", got.response.pseudo_velocity().magnitude()),
            ("peak_absolute_acceleration_over_omega", got.response.acceleration_over_omega().magnitude()),
        ] {
            let want = number(&case[key]);
            let error = (value / want - 1.0).abs();
            assert!(error <= TRAIN.error, "{name}: {key} = {value:?}, not {want:?}, off by {error:e}");
        }
        assert!(got.omitted <= 1e-14, "{name}: {:e} left out", got.omitted);
    }
}
