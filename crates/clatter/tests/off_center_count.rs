//! Counts of off-center bars against whole numbers: next to the endless curve and next to ties, where one rounding of
//! the inertia ratio or of the starting velocity decides.
use clatter::{Bar, Count, Mass, Start};
use num_bigint::{BigInt, Sign};

/// The two matrices of a bar (Eqs. 1 and 2 with q_a and q_b), each times a positive integer that makes it whole, and
/// the velocities of the ends times another one. Only signs are needed.
struct Whole {
    strike: [[[BigInt; 2]; 2]; 2],
    velocity: [BigInt; 2],
    /// 4e I_a I_b − P² (1 + e)²: positive where the train ends whatever the start.
    discriminant: BigInt,
}

/// Binary digits that are kept of numbers in a product of matrices.
const BITS: u64 = 4096;

/// Returns the whole numbers v 2^x with the least x that makes all of them whole.
fn whole<const N: usize>(v: [f64; N]) -> [BigInt; N] {
    let parts = v.map(|v| {
        let (fraction, biased) = (v.abs().to_bits() & ((1 << 52) - 1), v.abs().to_bits() >> 52);
        let m = BigInt::from(if biased == 0 { fraction } else { fraction | 1 << 52 });
        (if v < 0.0 { -m } else { m }, biased.max(1))
    });
    let least = parts.iter().map(|(_, x)| *x).min().unwrap();
    parts.map(|(m, x)| m << (x - least))
}

/// Returns v 2^112, for v = 0 or |v| ≥ 2⁻⁶⁰.
fn fixed(v: f64) -> BigInt {
    assert!(v == 0.0 || v.abs() >= 2f64.powi(-60), "{v} has more digits");
    whole([v, 2f64.powi(-60)])[0].clone() * i32::from(v != 0.0)
}

/// Returns the matrix product, without the digits that no sign will need.
fn product<const N: usize>(m: &[[BigInt; 2]; 2], by: &[[BigInt; N]; 2]) -> [[BigInt; N]; 2] {
    let mut p = [0, 1].map(|i| std::array::from_fn(|j| &m[i][0] * &by[0][j] + &m[i][1] * &by[1][j]));
    let bits = p.iter().flatten().map(|x: &BigInt| x.bits()).max().unwrap();
    for x in p.iter_mut().flatten() {
        *x >>= bits.saturating_sub(BITS);
    }
    p
}

impl Whole {
    /// Creates it from the distances of both ends to the center of mass, as sums of two floats each.
    fn new([[a, a_rest], [b, b_rest]]: [[f64; 2]; 2], rho: f64, e: f64, velocity: [f64; 2]) -> Self {
        let [a, a_rest, b, b_rest, rho] = whole([a, a_rest, b, b_rest, rho]);
        Self::of([a + a_rest, b + b_rest], &rho * &rho, e, velocity)
    }

    /// Creates it from masses on a bar of half-length 1, at points or spread evenly from one to another. With the sums M of m, F of
    /// m x and S of m (x² + w²/12) the arms are (M ± F)/M and the square of the radius is (S M − F²)/M².
    fn of_masses(masses: &[[f64; 3]], e: f64, velocity: [f64; 2]) -> Self {
        // M, 2 F and 12 S.
        let [mut mass, mut first, mut second] = [0, 0, 0].map(BigInt::from);
        for piece in masses {
            let [m, from, to] = piece.map(fixed);
            let (twice, width) = (&from + &to, to - from);
            second += &m * (3 * (&twice * &twice) + &width * &width);
            first += &m * twice;
            mass += m;
        }
        // All lengths times 6 M.
        let (arm, offset) = (6 * fixed(1.0) * &mass, 3 * &first);
        Self::of([&arm + &offset, arm - offset], 3 * (second * mass - 3 * (&first * &first)), e, velocity)
    }

    fn of([a, b]: [BigInt; 2], square: BigInt, e: f64, velocity: [f64; 2]) -> Self {
        let [e, one] = whole([e, 1.0]);
        let (i_a, i_b, far) = (&a * &a + &square, &b * &b + &square, (&a * &b - square) * (&one + &e));
        let zero = || BigInt::from(0);
        let first = [[-&e * &i_a, zero()], [far.clone(), &one * &i_a]];
        let second = [[&one * &i_b, far.clone()], [zero(), -&e * &i_b]];
        let discriminant = 4 * (&e * &one) * (i_a * i_b) - &far * &far;
        Self { strike: [first, second], velocity: whole(velocity), discriminant }
    }

    /// Returns the sign of the velocity of the end about to make strike n + 1.
    fn sign(&self, n: u64) -> Sign {
        let mut power = product(&self.strike[1], &self.strike[0]);
        let mut v = self.velocity.clone().map(|v| [v]);
        let mut pairs = n / 2;
        while pairs > 0 {
            if pairs % 2 == 1 {
                v = product(&power, &v);
            }
            power = product(&power, &power);
            pairs /= 2;
        }
        if n % 2 == 1 {
            v = product(&self.strike[0], &v);
        }
        v[usize::from(n % 2 == 1)][0].sign()
    }

    /// Returns the number of impacts, strike by strike, where it is at most `most`.
    fn count(&self, most: u64) -> Option<u64> {
        let mut v = self.velocity.clone().map(|v| [v]);
        for n in 1..=most {
            v = product(&self.strike[usize::from(n % 2 == 0)], &v);
            if v[usize::from(n % 2 == 1)][0].sign() != Sign::Minus {
                return Some(n);
            }
        }
        None
    }

    /// Returns whether `count` is that of these numbers. A wave that has a second half turn behind it is not negative
    /// at half of it.
    fn has(&self, count: Count) -> bool {
        match count {
            Count::Finite(n) if n < 200 => self.count(200) == Some(n),
            Count::Finite(n) => {
                let negative = |n: u64| self.sign(n) == Sign::Minus;
                !negative(n) && negative(n - 1) && (1..16).all(|k| negative(n / 16 * k))
            }
            Count::Endless => self.discriminant.sign() != Sign::Plus && self.count(400).is_none(),
            Count::Huge(_) => false,
        }
    }
}

/// Returns numbers in [0, 1), always the same.
fn random() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let x = (state >> 11) as f64 / (1_u64 << 53) as f64;
        x
    }
}

/// Counts of bars and starts that differ from those of whole numbers, and what differs first. The summary, the train
/// and the count by itself must say the same.
#[derive(Default)]
struct Wrong {
    of: u32,
    cases: Vec<String>,
}

impl Wrong {
    fn look(&mut self, bar: &Bar, start: &Start, whole: &Whole) {
        let count = bar.count(start);
        let train = match count {
            Count::Finite(n) if n < 3000 => bar.train(start).take(5000).count() as u64 == n,
            _ => bar.train(start).take(3000).count() == 3000,
        };
        let ends = match count {
            Count::Finite(n) if n >= 3000 => {
                let last = usize::try_from(n).unwrap() - 1;
                bar.train(start).nth(last).is_some() && bar.train(start).nth(last + 1).is_none()
            }
            _ => true,
        };
        self.of += 1;
        if !(whole.has(count) && bar.summary(start).count == count && bar.count_is_exact(start) && train && ends) {
            self.cases.push(format!("{count:?}, {bar:?}, {start:?}"));
        }
    }

    fn none(self) {
        let Self { of, cases } = self;
        assert!(cases.is_empty(), "{} of {of} counts are wrong; the first: {}", cases.len(), cases[0]);
        assert!(of >= 300, "only {of} cases");
    }
}

/// Returns e for which this bar is on the endless curve: √e = (1 − k)/(1 + k) with k² = (1 − q)/(1 + q).
fn on_the_curve(q: f64) -> f64 {
    let k = ((1.0 - q) / (1.0 + q)).sqrt();
    ((1.0 - k) / (1.0 + k)).powi(2)
}

/// Returns a restitution near the curve: a neighboring float, or one 10⁻¹⁶ to 10⁻⁹ off.
fn near_curve(e: f64, random: &mut impl FnMut() -> f64) -> f64 {
    let x = random() * 12.0;
    let e = if x < 5.0 { f64::from_bits(e.to_bits() + 3).min(e + (x.floor() - 2.0) * e * f64::EPSILON) } else { e };
    let off = 10f64.powf(-16.0 + 7.0 * random());
    (if x < 5.0 { e } else { e * (1.0 + if x < 8.5 { off } else { -off }) }).clamp(1e-300, 1.0)
}

#[test]
fn counts_next_to_the_endless_curve_are_those_of_whole_numbers() {
    let mut random = random();
    let mut wrong = Wrong::default();
    for _ in 0..600 {
        let (a, b, rho) = (0.2 + random(), 0.2 + 2.0 * random(), 10f64.powf(-3.0 * random()));
        let q = (a * b - rho * rho) / (a.hypot(rho) * b.hypot(rho));
        if q < 1e-3 {
            continue;
        }
        let e = near_curve(on_the_curve(q), &mut random);
        let velocity = [-1.0, [-1.0, 0.0, -3.0 * random()][wrong.of as usize % 3]];
        let start = Start::new(velocity, 1.0).unwrap();
        let bar = Bar::from_arms([a, b], rho, e).unwrap();
        wrong.look(&bar, &start, &Whole::new([[a, 0.0], [b, 0.0]], rho, e, velocity));
    }
    wrong.none();
}

/// The arms 1 + c and 1 − c are no floats.
#[test]
fn counts_of_a_bar_with_a_given_center_of_mass_are_those_of_whole_numbers() {
    let mut random = random();
    let mut wrong = Wrong::default();
    for _ in 0..600 {
        let (c, k) = (1.8 * random() - 0.9, 10f64.powf(-3.0 * random()));
        let q = (1.0 - c * c - k * k) / ((1.0 + c).hypot(k) * (1.0 - c).hypot(k));
        if q < 1e-3 {
            continue;
        }
        let e = near_curve(on_the_curve(q), &mut random);
        let velocity = [-1.0, [-1.0, 0.0, -3.0 * random()][wrong.of as usize % 3]];
        let start = Start::new(velocity, 1.0).unwrap();
        let bar = Bar::from_center_of_mass(c, k, e).unwrap();
        wrong.look(&bar, &start, &Whole::new([[1.0, c], [1.0, -c]], k, e, velocity));
    }
    wrong.none();
}

/// With arms, radius and restitution of few digits, the velocities that make the last end come to rest with strike n
/// are floats: the train ends there, and one float of v_b upward or downward decides.
#[test]
fn counts_at_ties_are_those_of_whole_numbers() {
    let mut random = random();
    let mut wrong = Wrong::default();
    let mut pick = |least: f64, n: f64, unit: f64| (least + (random() * n).floor()) * unit;
    for case in 0..3000 {
        let (a, b, rho, e) = (pick(1.0, 6.0, 0.5), pick(1.0, 6.0, 0.5), pick(1.0, 4.0, 0.5), pick(1.0, 4.0, 0.25));
        // With u_0 = 0, u_1 = 1, u_{n+1} = P (1 + e) u_n − e I_a I_b u_{n−1}, the velocity of the end about to make strike
        // n + 1 is a positive multiple of u_{n+1} v_a + I_a u_n v_b.
        let (i_a, i_b, far) = (a * a + rho * rho, b * b + rho * rho, (a * b - rho * rho) * (1.0 + e));
        let (mut u, mut next, n) = (1.0, far, 1 + case % 12);
        for _ in 1..n {
            (u, next) = (next, far * next - e * i_a * i_b * u);
        }
        let (va, tie) = (-i_a * f64::abs(u), next * u.signum());
        if a - b == 0.0 || u == 0.0 || Whole::new([[a, 0.0], [b, 0.0]], rho, e, [va, tie]).sign(n) != Sign::NoSign {
            continue;
        }
        for vb in [tie, tie.next_up(), tie.next_down()] {
            let (bar, start) = (Bar::from_arms([a, b], rho, e).unwrap(), Start::new([va, vb], 1.0).unwrap());
            wrong.look(&bar, &start, &Whole::new([[a, 0.0], [b, 0.0]], rho, e, [va, vb]));
        }
    }
    wrong.none();
}

/// Beyond the endless curve a fast turn upward of end b may end a train. Where it only just does, one float decides.
#[test]
fn counts_of_trains_that_hardly_end_are_those_of_whole_numbers() {
    let mut random = random();
    let mut wrong = Wrong::default();
    for _ in 0..600 {
        let (a, b, rho) = (0.2 + random(), 0.2 + 2.0 * random(), 10f64.powf(-3.0 * random()));
        let root = a.hypot(rho) * b.hypot(rho);
        let q = (a * b - rho * rho) / root;
        let e = 0.7 * random() * on_the_curve(q.max(0.0));
        let t = q * (1.0 + e);
        if q < 1e-3 || e <= 0.0 {
            continue;
        }
        let vb = 0.5 * (t + (t * t - 4.0 * e).sqrt()) * (b.hypot(rho) / a.hypot(rho));
        let velocity = [-1.0, f64::from_bits(vb.to_bits() + 6) - (12.0 * random()).floor() * vb * 0.5 * f64::EPSILON];
        let (bar, start) = (Bar::from_arms([a, b], rho, e).unwrap(), Start::new(velocity, 1.0).unwrap());
        wrong.look(&bar, &start, &Whole::new([[a, 0.0], [b, 0.0]], rho, e, velocity));
    }
    wrong.none();
}

/// A count that is said to be exact is that of the masses, and it is said of every bar that is not next to where the
/// count changes.
#[test]
fn a_count_of_masses_says_whether_it_is_exact() {
    let mut random = random();
    let (mut doubtful, mut sure) = (0, 0);
    for case in 0..1200 {
        let mut piece = |m: f64, spread: f64| {
            let (x, w) = (1.8 * random() - 0.9, spread * random());
            [m + random(), x - w, x + w]
        };
        let masses = [piece(0.1, 0.0), piece(0.1, 0.5), piece(2.0, 0.1)];
        let list = masses.map(|[mass_kg, from_m, to_m]| Mass::Slab { mass_kg, from_m, to_m });
        let anywhere = case % 3 == 0;
        let bar = |e| Bar::from_masses(2.0, &list, e).unwrap();
        let (q, velocity) = (bar(0.0).q(), [-1.0, [-1.0, 0.5 * random(), -2.0 * random()][case % 3]]);
        let e = if anywhere { random() } else { on_the_curve(q.max(1e-3)) };
        let e = if anywhere { e } else { near_curve(e, &mut random) };
        let (bar, start) = (bar(e), Start::new(velocity, 1.0).unwrap());
        if bar.count_is_exact(&start) {
            sure += 1;
            let count = bar.count(&start);
            assert!(Whole::of_masses(&masses, e, velocity).has(count), "{count:?} of {list:?} at {e}");
        } else {
            doubtful += 1;
            assert!(!anywhere, "{list:?} at {e}");
        }
    }
    assert!(doubtful > 200 && sure > 450, "{doubtful} doubtful, {sure} sure");
    // A count that is a float is not exact.
    let huge = Bar::from_gyration_ratio(1e-25, 1.0).unwrap();
    assert!(!huge.count_is_exact(&Start::default()), "{:?}", huge.count(&Start::default()));
}

/// D = 0 in whole numbers: I_a I_b = 12.5², q = 10/12.5 and T = 1 = 2√e.
#[test]
fn a_bar_on_the_curve_itself_is_endless() {
    let bar = Bar::from_arms([2.0, 5.5], 1.0, 0.25).unwrap();
    let start = Start::default();
    let summary = bar.summary(&start);
    assert!(summary.count == Count::Endless && bar.count(&start) == Count::Endless && bar.count_is_exact(&start));
    // a_n of end a is −(1 + n σ/λ) 2⁻ⁿ with λ = 1/2, σ = λ + κ and κ² = 5/31.25 = 0.4²; of end b it is that over κ. The
    // impacts tend to κ/σ.
    for impact in bar.train(&start).take(60) {
        let n = f64::from(u32::try_from(impact.number).unwrap() - 1);
        let want = -(1.0 + 1.8 * n) * 0.5f64.powf(n) / if n % 2.0 == 0.0 { 1.0 } else { 0.4 };
        assert!((impact.approach / want - 1.0).abs() < 1e-13, "{impact:?}, not {want}");
    }
    assert!((summary.duration - 0.4 / 0.9).abs() < 1e-15);
    // The second strike is the largest: 1.4/0.4 at end b beside 1 at end a.
    assert!((summary.peak.end - 1.25 * 3.5).abs() < 1e-14, "{:?}", summary.peak);
    let finite = Bar::from_arms([2.0, 5.5], 1.0, 0.25_f64.next_up()).unwrap();
    assert!(matches!(finite.count(&start), Count::Finite(_)), "{:?}", finite.count(&start));
}
