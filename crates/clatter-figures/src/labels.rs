//! Labels beside marks: none over another, over a mark or beyond the frame.

use crate::style::{Pt, width};

/// Font size and line height of the labels.
pub(super) const SIZE: f64 = 7.5;
const LINE: f64 = 8.5;

/// A label that has to stand near a point.
#[derive(Debug)]
pub(super) struct LabelRequest<'a> {
    pub(super) at: Pt,
    /// Radius of the mark at the point.
    pub(super) radius: f64,
    pub(super) text: &'a str,
}

/// The place of a label.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    corner: Pt,
    size: Pt,
}

impl Placed {
    /// Returns the overlap of two boxes; negative where they are apart.
    fn overlap(&self, other: &Self) -> f64 {
        let along = |k: usize| {
            let end = (self.corner[k] + self.size[k]).min(other.corner[k] + other.size[k]);
            end - self.corner[k].max(other.corner[k])
        };
        along(0).min(along(1))
    }
    /// Returns the begin of its words, at their foot.
    pub(super) fn baseline(&self) -> Pt {
        [self.corner[0], self.corner[1] + 0.79 * LINE]
    }
    /// Returns the point nearest to `p`, and how far it is.
    fn nearest(&self, p: Pt) -> (Pt, f64) {
        let near: Pt = std::array::from_fn(|k| p[k].clamp(self.corner[k], self.corner[k] + self.size[k]));
        (near, (near[0] - p[0]).hypot(near[1] - p[1]))
    }
    /// Returns the begin of a line to the mark, if that is too far to be recognized as its own.
    pub(super) fn leader(&self, of: &LabelRequest<'_>) -> Option<Pt> {
        let (near, far) = self.nearest(of.at);
        (far > of.radius + 5.0).then_some(near)
    }
    /// Returns whether a line crosses the box.
    fn is_crossed(&self, [a, b]: [Pt; 2]) -> bool {
        (0..=40).any(|i| {
            let t = f64::from(i) / 40.0;
            (0..2).all(|k| {
                let p = a[k] + t * (b[k] - a[k]);
                (self.corner[k]..=self.corner[k] + self.size[k]).contains(&p)
            })
        })
    }
}

/// Returns boxes for all labels: apart from one another, from all marks and within the frame. Each is as near to its
/// point as the ones before it leave, and clear of the lines where possible.
pub(super) fn arrange(wanted: &[LabelRequest<'_>], [from, to]: [Pt; 2], lines: &[[Pt; 2]]) -> Vec<Placed> {
    let around = |p: Pt, r: f64| Placed { corner: [p[0] - r, p[1] - r], size: [2.0 * r, 2.0 * r] };
    let marks: Vec<Placed> = wanted.iter().map(|w| around(w.at, w.radius + 1.2)).collect();
    let (mut placed, mut leaders) = (Vec::<Placed>::new(), Vec::<[Pt; 2]>::new());
    for w in wanted {
        let size = [1.1 * width(w.text, SIZE), LINE];
        let mut best: Option<(f64, Placed)> = None;
        for ring in 0..28 {
            let r = w.radius + 2.5 + 6.0 * f64::from(ring);
            for turn in 0..24 {
                let (sin, cos) = (f64::from(turn) * std::f64::consts::PI / 12.0).sin_cos();
                // The box touches the ring from outside.
                let middle = [w.at[0] + cos * (r + 0.5 * size[0]), w.at[1] - sin * (r + 0.5 * size[1])];
                let label = Placed { corner: [middle[0] - 0.5 * size[0], middle[1] - 0.5 * size[1]], size };
                let inside =
                    (0..2).all(|k| label.corner[k] > from[k] + 1.0 && label.corner[k] + label.size[k] < to[k] - 1.0);
                if !inside || marks.iter().chain(&placed).any(|other| label.overlap(other) > 0.0) {
                    continue;
                }
                let (near, far) = label.nearest(w.at);
                let crossed = lines.iter().filter(|line| label.is_crossed(**line)).count();
                // A leader through other words misleads.
                let through = marks.iter().chain(&placed).filter(|other| other.is_crossed([near, w.at])).count();
                let through = through.saturating_sub(1) // its own mark
                    + leaders.iter().filter(|leader| label.is_crossed(**leader)).count();
                #[expect(clippy::cast_precision_loss, reason = "a few")]
                let cost = far + 14.0 * crossed as f64 + 30.0 * through as f64 + if cos < -0.5 { 1.0 } else { 0.0 };
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, label));
                }
            }
            // Farther rings cost more by themselves.
            if best.is_some_and(|(least, _)| least < r - w.radius) {
                break;
            }
        }
        // In a frame without any room the box is empty, so that no words cover others.
        let label = best.map_or(Placed { corner: w.at, size: [0.0, 0.0] }, |(_, label)| label);
        leaders.extend(label.leader(w).map(|near| [near, w.at]));
        placed.push(label);
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Pt = [352.0, 236.0];
    const MARK: f64 = 3.2;

    #[test]
    fn labels_of_a_crowd_keep_apart_and_within_the_frame() {
        // Eighteen marks: four heaps of four, two apart.
        let at = |k: u8| {
            let (heap, i) = (f64::from(k / 4), f64::from(k % 4));
            [40.0 + 70.0 * heap + 5.0 * i, 60.0 + 30.0 * heap + 4.0 * (i * 7.0 % 3.0)]
        };
        let wanted: Vec<LabelRequest<'_>> =
            (0..18).map(|k| LabelRequest { at: at(k), radius: MARK, text: "finite tilt, largest shock" }).collect();
        let labels = arrange(&wanted, [[0.0, 0.0], FRAME], &[]);
        for (i, a) in labels.iter().enumerate() {
            assert!(a.size[0] > 50.0, "label {i} has found a place");
            let inside = |k: usize| a.corner[k] > 0.0 && a.corner[k] + a.size[k] < FRAME[k];
            assert!(inside(0) && inside(1), "label {i}: {a:?}");
            for b in &labels[..i] {
                assert!(a.overlap(b) <= 0.0, "{a:?} and {b:?}");
            }
            for (j, w) in wanted.iter().enumerate() {
                let p = Placed { corner: w.at, size: [0.0, 0.0] };
                assert!(a.overlap(&p) <= 0.0, "label {i} on mark {j}");
            }
        }
    }

    #[test]
    fn a_frame_without_room_leaves_words_out() {
        let wanted = [LabelRequest { at: [5.0, 5.0], radius: MARK, text: "closed form, net change" }];
        let [label] = arrange(&wanted, [[0.0, 0.0], [10.0, 10.0]], &[])[..] else { panic!("one label") };
        assert!(label.size[0].abs() < f64::EPSILON, "{label:?}");
    }
}
