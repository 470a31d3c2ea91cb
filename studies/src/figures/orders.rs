//! Convergence of the flight models to one another: differences over the group that decides.

use clatter_figures::FigureError;
use clatter_figures::draw::{Anchor, Axes, Axis, BLUES, GRAY, GUIDE, Ink, Label, Paper, RUST, SMALL};

use crate::Order;

/// One panel: the group that goes to zero, the orders that share it, their names.
#[derive(Debug)]
pub struct Panel<'a> {
    /// Title, in figure markup.
    pub title: &'a str,
    /// The order by theory, in figure markup.
    pub guide: &'a str,
    /// The curves, each with its name.
    pub curves: Vec<(&'a Order, String)>,
}

/// Draws a panel for each group, a guide of the order that theory gives below its curves.
pub fn orders(panels: &[Panel<'_>; 3]) -> Result<String, FigureError> {
    // The first is wide and light, the second thin upon it: they all but coincide.
    let inks = [Ink::line(BLUES[4], 3.0), Ink::line(RUST, 0.9)];
    let steps = |panel: &Panel<'_>| panel.curves.iter().flat_map(|(order, _)| order.steps.clone()).collect::<Vec<_>>();
    let all: Vec<f64> = panels.iter().flat_map(&steps).map(|step| step.1).collect();
    let y = Axis::log_over(all.iter().flat_map(|v| [0.25 * v, 2.0 * v]), 12.0, "");
    let mut paper = Paper::new(465.0, 190.0);
    let mut left = 42.0;
    for (i, panel) in panels.iter().enumerate() {
        let x = Axis::log_over(steps(panel).iter().flat_map(|step| [0.8 * step.0, 1.25 * step.0]), 12.0, panel.title);
        let title = if i == 0 { "largest relative difference" } else { "" };
        let axes = Axes { corner: [left, 6.0], size: [120.0, 124.0], x, y: Axis { title, ..y } };
        let axes = axes.on(&mut paper, 30.0);
        let mut lines = Vec::new();
        if let Some((order, _)) = panel.curves.first()
            && let [(from, size), .., (last, _)] = order.steps[..]
        {
            let guide = |x: f64| (x, 0.4 * size * (x / from).powf(order.expected));
            axes.curve(&mut paper, [guide(from), guide(last)].into_iter(), GUIDE);
        }
        for ((order, name), ink) in panel.curves.iter().zip(inks) {
            axes.curve(&mut paper, order.steps.iter().copied(), ink);
            lines.push((ink, name.as_str()));
        }
        for (x, y) in panel.curves.iter().flat_map(|(order, _)| &order.steps) {
            axes.mark(&mut paper, *x, *y, "#ffffff");
        }
        if let Some(&(x, y)) = panel.curves.first().and_then(|(order, _)| order.steps.get(1)) {
            let [x, y] = axes.at(x, 0.4 * y);
            paper.text([x + 3.0, y + 11.0], panel.guide, Label { anchor: Anchor::Start, color: GRAY, ..SMALL });
        }
        axes.border(&mut paper);
        paper.key([left, 172.0], &lines);
        left += 151.0;
    }
    paper.finish("Differences between the flight models over the group that decides them")
}
