//! The lanes that know less than real tilt, along the strikes of the lane with all physics.

use super::both::Both;
use super::ends::Ends;
use super::lane::{Lane, MapLane, Own, Strike};

/// A strike of the lane with all physics, as it lands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Landing {
    pub(super) end: usize,
    /// Whether it presses an end that lies there into the ground.
    pub(super) presses: bool,
    /// The end that lies on the ground after it.
    pub(super) rests: Option<usize>,
}

impl Landing {
    /// The first touch.
    pub(super) const NONE: Self = Self { end: 0, presses: false, rests: None };
}

/// The same strike in the map and as parabolas; `None` once one had another strike.
#[derive(Debug, Clone, Copy)]
pub(super) struct Alike {
    pub(super) own: [Option<Own>; 2],
    /// Over how large a share of a contact time the strikes of the map are spread, where both ends land at once.
    pub(super) spread: f64,
}

/// Strikes of the map at most that are taken as one.
const MOST_AT_ONCE: usize = 32;

/// Both, after the strikes so far.
#[derive(Debug, Clone)]
pub(super) struct Coarse {
    /// The map with all its strikes, as far as those that belong to the ones followed, and the one after these.
    map: MapLane,
    mapped: MapLane,
    ahead: Option<Strike>,
    parabolas: Lane<false>,
    alive: [bool; 2],
    touched: bool,
}

impl Coarse {
    /// At the first touch, as [`Lane::start`].
    pub(super) fn start(ends: &Ends, touch: (f64, f64, f64), gravity: f64) -> Self {
        let parabolas = Lane::start(ends, touch, gravity);
        let map = MapLane::start(ends, &parabolas);
        let mut mapped = map.clone();
        let ahead = mapped.next();
        Self { map, mapped, ahead, parabolas, alive: [true; 2], touched: false }
    }
    /// The map from the first touch on.
    pub(super) fn map(&self) -> &MapLane {
        &self.map
    }
    /// Twice the energy that parabolas have left, if they had the same strikes.
    pub(super) fn twice_energy(&self, ends: &Ends) -> Option<f64> {
        self.alive[1].then(|| self.parabolas.twice_energy(ends))
    }
    /// The next strike; `impacts` are those of both ends, where it presses the one that lies.
    pub(super) fn along(&mut self, ends: &Ends, landing: &Landing, impacts: Option<&Both>, contact_s: f64) -> Alike {
        let first = !std::mem::replace(&mut self.touched, true);
        let (mut own, mut spread) = ([None; 2], 0.0);
        if self.alive[0]
            && let Some((end, after, mut sum)) = self.ahead
            && end == landing.end
        {
            self.ahead = self.mapped.next();
            if landing.presses {
                // In place, every step would wait for what the one before has written.
                let (mut map, mut ahead, mut last) = (self.mapped.clone(), self.ahead, 0.0);
                for _ in 0..MOST_AT_ONCE {
                    let Some((_, after, more)) = ahead.filter(|(_, after, _)| last + after < contact_s) else {
                        break;
                    };
                    last += after;
                    ahead = map.next();
                    sum = (sum.0 + more.0, sum.1 + more.1);
                }
                (self.mapped, self.ahead) = (map, ahead);
                spread = if last > 0.0 { last / contact_s } else { 0.0 };
            }
            own[0] = Some((after, sum));
        }
        if self.alive[1] {
            own[1] = self.parabolas.along(ends, (landing.end, 0.0), first, impacts, landing.rests);
        }
        self.alive = own.map(|own| own.is_some());
        Alike { own, spread }
    }
}
