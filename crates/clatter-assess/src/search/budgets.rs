//! How much the search looks at: every number that trades its time for what it may miss, in one table.
//!
//! What set them is the brute force (`studies/brute`): over 1586 limits of 455 random bars, plates and boxes no single drop exceeded what was
//! told, where coarser ones had missed five of 408. With the first twelve of them halved one by one, the worst drops of 45 limits of 14 random
//! products fell by less than 0.1 %: the rare product needs them.

// Natural frequencies of a part in one drop.

/// Frequencies of a part within its range in one drop, besides the end of it, at least and at most.
pub(super) const FREQUENCIES: [f64; 2] = [2.0, 16.0];
/// The same, at least, in drops that are followed for longer.
pub(super) const FREQUENCIES_LATE: u32 = 4;
/// Frequencies in one turn of a part between the first two strikes: its demand goes up and down with its phase at the
/// second.
pub(super) const IN_A_TURN: f64 = 4.0;

// The grid over the tilt.

/// Tilts of the grid at least and at most.
pub(super) const TILTS: [f64; 2] = [12.0, 128.0];
/// Phase in rad by which the stiffest part turns between the first strikes of neighboring tilts.
pub(super) const PHASE: f64 = 0.8;
/// Tilts in a contact time, and contact times over which tilts lie so closely: where contacts overlap, velocity shocks
/// change by steps.
pub(super) const OVERLAPS: [f64; 2] = [12.0, 4.0];
/// Touches and partings of a drop that are put in order to find edges. Later ones are small.
pub(super) const EVENTS: usize = 6;
/// Halvings of the space between two tilts of the grid about such an edge.
pub(super) const EDGE_HALVINGS: u32 = 8;

// The directions of a plate.

/// Lines of drops over the tilt of a plate, besides those that land on an edge.
pub(super) const LINES: u32 = 6;
/// Lines more for each quarter of a turn.
pub(super) const LINES_A_QUARTER: u32 = 3;
/// Directions with closely lying tilts in each quarter of a turn.
pub(super) const OVERLAPS_A_QUARTER: u32 = 4;
/// Drops of the grid of a plate that may rise to several directions, at least.
pub(super) const DROPS_OF_PLATE: usize = 1024;
/// Tilts at which a plate is turned, as shares of the root of the range.
pub(super) const TURNED_AT: [f64; 3] = [1.0, 0.6, 0.0];
/// The least of these where the range ends flat, which has no direction.
pub(super) const TURNED_NEXT_TO_FLAT: f64 = 0.2;
/// Part of a contact by which the second corner comes later next to a landing on an edge.
pub(super) const PART_OF_CONTACT: f64 = 0.25;

// The tilts of a box off its face, edge or corner.

/// Directions in which a box is turned off a face, where it clatters.
pub(super) const AROUND_FACE: u32 = 16;
/// Directions in which it is turned off an edge or a corner.
pub(super) const AROUND: u32 = 8;
/// Tilts along an edge, to either side.
pub(super) const ALONG_EDGE: u32 = 32;
/// Tilts off a face, as shares of the root of the tolerance.
pub(super) const TILTS_OF_FACE: [f64; 6] = [1.0, 0.87, 0.72, 0.58, 0.44, 0.3];

// Drops that are followed after rebounds.

/// Times the moment at which a plate has bounced clear until which it is followed, at first and at last.
pub(super) const REBOUNDS: [f64; 2] = [3.0, 6.0];
/// Drops that are followed besides those of the grid: with contacts that take time, and by instant impacts, which cost
/// a tenth.
pub(super) const SAMPLE: [usize; 2] = [128, 512];
/// The same of a box until it lands again, half of them until its energy allows little more: shared among all drops that it is put through,
/// and of each at least.
pub(super) const SAMPLE_OF_BOX: [usize; 2] = [192, 16];

// Later landings.

/// Landings with the energy left, in any posture.
pub(super) const LANDINGS: u32 = 408;
/// Range of the tries of a climb from the worst of them.
pub(super) const LANDING_REACH: f64 = 0.15;
/// Tries of such a climb.
pub(super) const LANDING_TRIES: u32 = 64;
/// A box is followed to its later landings where they may ask for so much of a limit.
pub(super) const LATER_DECIDES: f64 = 1.0;

// Climbs from the highest drops.

/// Share of the worst above which a drop is climbed from.
pub(super) const NEAR: f64 = 0.8;
/// Climbs of a limit at most.
pub(super) const CLIMBS: usize = 6;
/// Drops that are followed in a climb, about.
pub(super) const CLIMB: usize = 72;
/// Halvings of the steps of a climb.
pub(super) const CLIMB_HALVINGS: u32 = 6;
/// First step in the direction, as a share of its range: beyond it another drop of the grid is close.
pub(super) const DIRECTION_STEP: f64 = 0.125;
/// Range of the tries of a climb where the demand changes by edges or steps.
pub(super) const EDGES_REACH: f64 = 0.1;
/// Tries of such a climb.
pub(super) const EDGES_TRIES: u32 = 96;
/// Range of the tries of a climb after rebounds.
pub(super) const LATE_REACH: f64 = 0.5;
/// Tries of such a climb, with contacts that take time and by instant impacts.
pub(super) const LATE_TRIES: [u32; 2] = [160, 480];
/// Time over that of its first peak until which such a climb follows.
pub(super) const LATER: f64 = 2.0;
/// Range of the tries of a climb of a box.
pub(super) const BOX_REACH: f64 = 0.3;
/// Tries of a box on a corner or after rebounds.
pub(super) const BOX_TRIES: u32 = 24;
/// Tries of a box on a face or an edge.
pub(super) const FACE_TRIES: u32 = 72;
/// Range of the last try of a climb over that of the first.
pub(super) const CLOSER: f64 = 0.004;

// The box beside a worst drop of a plate, and the last answers.

/// Drops of the box next to a worst drop of a plate.
pub(super) const AS_BLOCK: u32 = 24;
/// How far they lie from it, as a share of the ranges.
pub(super) const NEXT: f64 = 0.04;
/// Time over that of its peak until which they are followed.
pub(super) const BEYOND_PEAK: f64 = 1.5;
/// Worst cases that are answered to the tolerance, early ones and late ones.
pub(super) const TRIES: usize = 8;
/// Halvings of the space between two places of an extended part about the worst.
pub(super) const NARROWED: usize = 7;
