//! Values on a grid: the regions where they are negative, and the lines on which they vanish.

/// A polygon of a plane, or a line.
pub(crate) type Shape = Vec<(f64, f64)>;

/// The cells of a grid, cut where the values vanish.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    /// Regions of negative values, in pieces that may overlap.
    pub(crate) shapes: Vec<Shape>,
    /// The lines that bound these regions; negative values are to the left of each.
    pub(crate) lines: Vec<Shape>,
    /// Regions of unknown values.
    pub(crate) unknown: Vec<Shape>,
}

/// Cuts each cell along straight lines. For the grid point in row i and column j `place` returns its position, `value`
/// its value, or none where that is unknown. Rows go upward and columns to the right.
pub(crate) fn cells(
    [rows, columns]: [usize; 2],
    place: impl Fn(usize, usize) -> (f64, f64),
    value: impl Fn(usize, usize) -> Option<f64>,
) -> Cells {
    let mut cells = Cells::default();
    for i in 1..rows {
        for j in 1..columns {
            let corners = [(i - 1, j - 1), (i - 1, j), (i, j), (i, j - 1)];
            let places = corners.map(|(i, j)| place(i, j));
            let [Some(a), Some(b), Some(c), Some(d)] = corners.map(|(i, j)| value(i, j)) else {
                cells.unknown.push(places.to_vec());
                continue;
            };
            let values = [a, b, c, d];
            let (mut shape, mut cuts) = (Vec::new(), Vec::new());
            for k in 0..4 {
                let ((x, y), (x2, y2)) = (places[k], places[(k + 1) % 4]);
                let (v, v2) = (values[k], values[(k + 1) % 4]);
                if v < 0.0 {
                    shape.push((x, y));
                }
                if (v < 0.0) != (v2 < 0.0) {
                    let share = v / (v - v2);
                    let cut = (x + share * (x2 - x), y + share * (y2 - y));
                    shape.push(cut);
                    cuts.push(cut);
                }
            }
            if shape.len() > 2 {
                cells.shapes.push(shape);
            }
            // Around the cell one leaves the negative region and comes back to it.
            if values[0] >= 0.0 {
                cuts.reverse();
            }
            cells.lines.extend(cuts.chunks_exact(2).map(<[_]>::to_vec));
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of a saddle and of a plane on a grid from −2 to 2: whichever corner a cell begins with.
    #[test]
    fn what_is_negative_lies_to_the_left_of_each_line() {
        let at = |i: usize, j: usize| {
            let along = |k: usize| f64::from(u8::try_from(k).unwrap()) - 2.1;
            (along(j), along(i))
        };
        let surfaces: [fn(f64, f64) -> f64; 3] = [|x, y| x * y + 0.3, |x, y| x + 0.4 * y, |x, y| 1.3 - x * x - y * y];
        for value in surfaces {
            let found = cells([5, 5], at, |i, j| Some(value(at(i, j).0, at(i, j).1)));
            assert!(found.lines.len() > 3 && found.unknown.is_empty());
            for line in &found.lines {
                let [(x, y), (x2, y2)] = line[..] else { panic!("a straight line") };
                let (dx, dy) = (x2 - x, y2 - y);
                let beside = |side: f64| value(0.5 * (x + x2) - side * dy, 0.5 * (y + y2) + side * dx);
                assert!(beside(0.5) < beside(-0.5), "({x}, {y}) to ({x2}, {y2})");
            }
        }
    }
}
