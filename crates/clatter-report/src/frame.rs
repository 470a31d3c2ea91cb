//! This module checks that figures stay within their frames, for the tests of all pages.

/// Checks that no line of a figure leaves its frame, and that every coordinate is a number.
pub(crate) fn stay_within_their_frame(files: &[(&'static str, String)]) {
    for (name, svg) in files.iter().filter(|(name, _)| name.ends_with("svg")) {
        let size = svg.split("viewBox=\"0 0 ").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        let size: Vec<f64> = size.split(' ').map(|v| v.parse().unwrap()).collect();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        for d in svg.split(" d=\"M").skip(1).filter_map(|rest| rest.split('"').next()).filter(|d| !d.contains('a')) {
            for point in d.trim_end_matches('Z').split('L') {
                let point: Vec<f64> = point.split(' ').map(|v| v.parse().unwrap()).collect();
                let inside = point.iter().zip(&size).all(|(x, w)| (0.0..=*w).contains(x));
                assert!(inside, "{name}: {point:?} is outside {size:?}");
            }
        }
    }
}
